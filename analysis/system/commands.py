# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The times of each required command: in its caller's WCET, or until another row executes it.

A direct call is part of its caller's execution. A queued call waits for the row that serves
it. A call to another node also waits for frames and receptions. All times count from the
release of the caller.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ravenchart.gen.derive.calls import asking, published_by, serving
from ravenchart.gen.model.commands import (
    Binding,
    Device,
    Gathered,
    Remote,
    RemoteRead,
    Server,
    wcet_of,
)
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import Carried, Stop

if TYPE_CHECKING:
    from .timing import Analysis


@dataclass(frozen=True, slots=True)
class CommandTimes:
    """A required command of a row; times in ns, None where there is no bound.

    ``how`` is ``direct``, ``queued``, over a bus, ``copied`` or ``fallback``.
    """

    caller: str
    command: str
    provider: str
    how: str
    wcet: int
    """C of one call, as part of its caller's."""
    executed: int | None = 0
    """The time until the provider's row has executed it."""
    answered: int | None = None
    """The time until the reply from another node has arrived; the age of a value read there."""
    limit: int | None = None
    """The limit of ``answered``."""
    waits: bool = False
    """Whether another row executes it."""


def command_times(analysis: Analysis) -> Iterator[CommandTimes]:
    """Every required command, for each row that uses it."""
    for binding in analysis.system.bindings:
        if isinstance(binding.provider, Gathered):
            continue  # its elements follow
        for row in asking(analysis.system, binding):
            yield _times(analysis, binding, row)


def _times(analysis: Analysis, binding: Binding, row: End) -> CommandTimes:
    need, provider, caller = binding.need, binding.provider, str(row)
    name = need.command.name
    if isinstance(provider, Device):
        return CommandTimes(caller, name, provider.name, "direct", wcet_of(binding))
    if isinstance(provider, Remote):
        message = next(m for m in analysis.system.messages if m.name == provider.request)
        served = serving(provider.server)
        whole = {chain.name: found.reaction for chain, found in analysis.limited}
        answered = whole.get(provider.request) if provider.reply else None
        return CommandTimes(
            caller,
            name,
            str(served),
            f"over {message.bus}",
            0,
            analysis.latency((Carried(provider.request), served)).reaction,
            answered,
            provider.time_limit or None,
            waits=True,
        )
    if isinstance(provider, RemoteRead):
        message = next(m for m in analysis.system.messages if m.name == provider.message)
        age = analysis.latency((Carried(provider.message), row)).age
        source, how, limit = str(message.source), f"over {message.bus}", provider.time_limit
        return CommandTimes(caller, name, source, how, 0, answered=age, limit=limit)
    if isinstance(provider, Server):
        if published_by(binding) is not None:
            item = f"{provider.instance}.{published_by(binding)}"
            return CommandTimes(caller, name, item, "copied", 0)
        served = serving(provider)
        found = from_release(analysis, (row, served))
        within = binding.time_limit if need.is_part and need.reply is not None else None
        answered = None if within is None else found
        return CommandTimes(
            caller, name, str(served), "queued", 0, found, answered, within, waits=True
        )
    fallback = "nothing"
    if need.fallback is not None:
        fallback = f"{binding.instance}.{need.fallback.item}"
    return CommandTimes(caller, name, fallback, "fallback", 0)


def from_release(analysis: Analysis, way: Sequence[Stop]) -> int | None:
    """The latency of a way from the release of the row that it begins with."""
    first, *others = analysis.latency(way).hops
    parts = [first.response, *(part for hop in others for part in (hop.wait, hop.response))]
    known = [part for part in parts if part is not None]
    return sum(known) if len(known) == len(parts) else None
