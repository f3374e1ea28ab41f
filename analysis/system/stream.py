# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The stream of each node: whether trace and snapshots reach a monitor in time.

The main program runs at the lowest priority. It empties the trace once every `DRAIN_PERIOD`, and
writes a snapshot at the first of these instants that is `SNAPSHOT_PERIOD` after the last one. So
no window of a length w has more work of it than

    ceil(w / SNAPSHOT_PERIOD) * C,  C: one snapshot and the drains of one SNAPSHOT_PERIOD

which is the demand of one periodic task with T = D = SNAPSHOT_PERIOD. Its response follows from
the tasks of its core (Joseph and Pandya 1986; Audsley et al. 1993), with the jitter that these have
in the whole system. Drains and a snapshot that are due within a period of this task are done when
its job is done. So R bounds the response of each of them. No task waits for the main program except
in its protected sections, which the analysis of the others has: this analysis changes no other
bound.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

from ravenchart.analysis.core.fixed_priority import response_under
from ravenchart.analysis.core.holistic import Holistic, Network
from ravenchart.analysis.core.responses import Reason, Response
from ravenchart.analysis.core.tasks import Task
from ravenchart.gen.derive.sharing import MAIN
from ravenchart.gen.model.nodes import DRAIN_PERIOD, SNAPSHOT_PERIOD, STREAM, Node
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

from .records import Records, most_noted

LOWEST = 0
"""The priority of the main program, below all that a model can give."""


@dataclass(frozen=True, slots=True)
class StreamResponse:
    """The response of the main program of a node that has a `stream`; times in ns."""

    node: Node
    origin: Origin
    response: Response
    records: Records | None
    """The most that is noted between the ends of two drains; None where none is known."""

    @property
    def name(self) -> str:
        """As the tasks of a node that no processor is."""
        return self.response.task.name

    @property
    def bound(self) -> int | None:
        """R: the longest time from when a drain or snapshot is due until it is done."""
        return self.response.bound

    @property
    def holds(self) -> bool:
        """Whether ten snapshots a second are done, each before the next one is due."""
        return self.response.met

    @property
    def load(self) -> Fraction:
        """Share of its core that all tasks and the stream need together."""
        return self.response.level.load

    @property
    def unread(self) -> int | None:
        """The longest time from when the trace is empty until it is empty again.

        The trace must hold all records of such a time: one drain may end when it is due, and the
        next one R after it was due.
        """
        return _unread(self.response)

    @property
    def waiting(self) -> int | None:
        """The depth that `trace` needs: that of the buffer of values is the same."""
        return None if self.records is None else max(self.records.trace, self.records.values)

    @property
    def is_short(self) -> bool:
        """Whether there is a trace that may be too short for what waits in it."""
        return 0 < self.node.trace_depth < (self.waiting or 0)

    @property
    def apart(self) -> int | None:
        """The longest time from the end of one snapshot to the end of the next.

        The next one is due at the first drain that is due `SNAPSHOT_PERIOD` after the last one.
        """
        return None if self.unread is None else SNAPSHOT_PERIOD + self.unread


def streams(system: System, network: Network, found: Holistic) -> Iterator[StreamResponse]:
    """The stream of each node that has one, on the node's first core."""
    for node in system.nodes:
        if node.stream is not None:
            core = node.core_names[0]
            task = Task(
                name=f"{node.name}.{STREAM}",
                priority=LOWEST,
                period=SNAPSHOT_PERIOD,
                deadline=SNAPSHOT_PERIOD,
                wcet=node.stream.wcet,
                core=core,
                timed=node.tick is not None,
                suspensions=SNAPSHOT_PERIOD // DRAIN_PERIOD,
            )
            others = [
                one
                for one in found.responses.values()
                if isinstance(one, Response) and one.task.core == core
            ]
            urgent = sorted((one.task for one in others), key=lambda one: -one.priority)
            response = response_under(task, urgent, platform=network.platforms[core])
            if response.bound is not None and any(one.reason is Reason.DELAYED for one in others):
                response = Response(task, response.level, None, None, reason=Reason.DELAYED)
            unread = _unread(response)
            records = None if unread is None else most_noted(system, node.name, others, unread)
            yield StreamResponse(node, node.stream.origin, response, records)


def network_with_streams(network: Network, found: Iterable[StreamResponse]) -> Network:
    """The same with the main programs of ``found`` as tasks, which use what they lock."""
    mains = {one.response.task.core: one.response.task for one in found}
    cores = {task.name: task.core for task in network.tasks}
    home = {one.resource: cores[one.user] for one in network.sections if one.user in cores}
    sections = (
        replace(one, user=mains[home[one.resource]].name)
        if one.user == MAIN and home.get(one.resource) in mains
        else one
        for one in network.sections
    )
    return replace(network, tasks=(*network.tasks, *mains.values()), sections=tuple(sections))


def _unread(response: Response) -> int | None:
    return None if response.bound is None else DRAIN_PERIOD + response.bound
