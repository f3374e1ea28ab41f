# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The failures that are causes, and those that only depend on others.

A full bus or core delays everything that follows it, and a late message delays the task
that it releases. Such a dependent is judged only after its cause is corrected.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.chains import Latency
from ravenchart.analysis.core.responses import Reason, Response
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.diagnostics import Diagnostic


def is_full(response: Response | FrameResponse) -> bool:
    """Whether its level needs more than all of the core or bus, apart from other delays."""
    return response.reason is Reason.OVERLOAD or response.level.load > 1


def _is_delayed(response: Response | FrameResponse) -> bool:
    return response.reason is Reason.DELAYED and not is_full(response)


@dataclass(frozen=True, slots=True)
class RootFinding:
    """An error or warning of the bus, task or message ``cause``.

    ``dependents`` errors that only depend on it are left out.
    """

    cause: str
    diagnostic: Diagnostic
    dependents: int = 0

    @property
    def shown(self) -> Diagnostic:
        """It with a note on those that are left out."""
        one, count = self.diagnostic, self.dependents
        if not count:
            return one
        what = "1 error that depends" if count == 1 else f"{count} errors that depend"
        verb = "is" if count == 1 else "are"
        text = f"{what} on this {verb} left out: check again when this is corrected"
        return replace(one, notes=(*one.notes, (one.origin, text)))


@dataclass
class Causes:
    """The failures of an analysis: a cause is a bus, or a task or message, by its name."""

    analysis: Analysis
    failed: Sequence[str]
    dependents: dict[str, int] = field(default_factory=dict)
    """The number of errors that are left out, by their cause."""

    def __post_init__(self) -> None:
        """Find the cause of each failure that has another one."""
        responses, network = self.analysis.found.responses, self.analysis.network
        unbounded = [name for name in self.failed if responses[name].bound is None]
        buses = [bus.name for bus in self.analysis.overloaded]
        sent = {frame.name: bus for bus in buses for frame in network.frames[bus]}
        self.cause = {name: sent[name] for name in unbounded if name in sent}
        self.cause |= dict(self._less_urgent(unbounded))
        first = [n for n in unbounded if n not in self.cause and not _is_delayed(responses[n])]
        self.first = next(iter([*buses, *first]), None)
        """The first bus, task or message without a bound that none of these delays."""
        if self.first is not None:
            for name in unbounded:
                if name not in self.cause and _is_delayed(responses[name]):
                    self.cause[name] = self.first
        for name in self.failed:
            late = [one for one in network.releasers(name) if one in self.failed]
            if late and name not in self.cause:
                self.cause[name] = self.cause.get(late[-1], late[-1])

    def _less_urgent(self, unbounded: Sequence[str]) -> Iterator[tuple[str, str]]:
        """The tasks of a core below the first one for which the core has no time left."""
        found = [self.analysis.found.responses[name] for name in unbounded]
        full = [one for one in found if isinstance(one, Response) and is_full(one)]
        heads: dict[str, str] = {}
        for one in sorted(full, key=lambda response: -response.task.priority):
            head = heads.setdefault(one.task.core, one.task.name)
            if head != one.task.name:
                yield one.task.name, head

    def of_chain(self, found: Latency) -> str | None:
        """The cause of a chain that is late: a step that is late or has no bound."""
        processor = {
            slot.element: name for name, task in self.analysis.tasks.items() for slot in task.slots
        }
        for hop in found.hops:
            name = processor.get(hop.step.name, hop.step.name)
            if name in self.failed:
                return self.cause.get(name, name)
            if hop.response is None and self.first is not None:
                return self.first
        return None

    def of_reception(self, processor: str) -> str | None:
        """The cause of a reception that may wait without bound."""
        return self.cause.get(processor, processor) if processor in self.failed else self.first

    def leave_out(self, cause: str | None) -> bool:
        """Count one error for its cause, if there is one."""
        if cause is not None:
            self.dependents[cause] = self.dependents.get(cause, 0) + 1
        return cause is not None

    def counted(self, cause: str, one: Diagnostic) -> RootFinding:
        """The error of a cause, with the number of those that are left out."""
        return RootFinding(cause, one, self.dependents.get(cause, 0))
