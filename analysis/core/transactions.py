# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Responses where steps of one chain meet on a core or bus: they are not all released at once.

A transaction is the set of steps that one event releases, directly or by other steps. Its
step j arrives at the soonest phi_j after the event and at the latest J_j later (dynamic
offsets). The longest busy period begins where a step c of the transaction is released as
late as possible. From there on step j arrives first after

    phi_jc = T - (phi_c + J_c - phi_j) mod T                                    in (0, T]

and a window w holds this demand of the transaction, the jobs delayed until its beginning included:

    W_c(w) = sum over j of  (floor((J_j + phi_jc) / T) + max(0, ceil((w - phi_jc) / T))) C_j

Palencia and Gonzalez Harbour, Schedulability analysis for tasks with static and dynamic offsets
(RTSS 1998). Each step of the own transaction is tried as c. Of every other one the c counts that
has the largest demand. With job p of the own step b, from 1 - floor((J_b + phi_bc) / T) on,

    w(p) = B + (jobs of b up to p) C_b + sum of all W(w)
    R    = max over c and p of  w(p) - phi_bc - (p - 1) T + phi_b

R counts from the event. On a bus the job itself is not in w, which then ends with arbitration, a
bit later, as in `can`. Steps that follow every n-th job only count as transactions of their own.
So do steps of a sporadic event that may arrive a period after it or later: the next event does
not determine when they do. The bound is safe, and may not be attained.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .bus import Frame
from .can_response import FrameResponse
from .responses import Response, demand_of, jitter_of, release_time
from .tasks import Task
from .window import Effort, Source, constant_source, execution_of, releases_in

if TYPE_CHECKING:
    from .holistic import Network

STEPS_EFFORT = 500_000
"""Terms of windows in one call; later items have the bound without transactions."""


@dataclass(frozen=True, slots=True)
class LevelItem:
    """An item of a transaction as one level sees it: times from the event, C of a job."""

    name: str
    offset: int
    jitter: int
    period: int
    wcet: int

    def phase(self, first: LevelItem) -> int:
        """phi_jc: its first arrival after the late release of another step of its transaction."""
        return self.period - (first.offset + first.jitter - self.offset) % self.period


@dataclass(frozen=True, slots=True)
class _Arriving:
    """A step in a busy period: the jobs waiting at its beginning, and the next arrival."""

    step: LevelItem
    waiting: int
    phase: int

    @classmethod
    def behind(cls, step: LevelItem, first: LevelItem) -> _Arriving:
        """The step where the busy period begins with the late release of ``first``."""
        phase = step.phase(first)
        return cls(step, (step.jitter + phase) // step.period, phase)

    def demand(self, window: int) -> int:
        """The demand of its jobs in a window."""
        later = max(0, -((self.phase - window) // self.step.period))
        return (self.waiting + later) * self.step.wcet


@dataclass(frozen=True, slots=True)
class _Level:
    """The interference of one item: its own transaction, others, and sources without offsets."""

    own: LevelItem
    mates: tuple[LevelItem, ...]
    others: tuple[tuple[LevelItem, ...], ...]
    sources: tuple[Source, ...]
    fixed: int
    after: int = 0
    """The part of C that is not delayed any more: of a frame all, of a task nothing."""
    closing: int = 0
    """The time after a window's end until which an item may still take part in it."""

    @property
    def together(self) -> bool:
        """Whether steps of one transaction meet here."""
        return bool(self.mates) or any(len(steps) > 1 for steps in self.others)


def ends(
    network: Network,
    responses: Mapping[str, Response | FrameResponse],
    best: Mapping[str, int],
) -> dict[str, int]:
    """The time from the event to the completion, of each item for which it is shorter here.

    ``responses`` are those of the items with their inherited jitter, ``best`` the least
    time from the event of each item until it arrives.
    """
    found: dict[str, int] = {}
    events = _events(network, responses, best) if network.released_by else {}
    homes = _shared(network, events)
    effort = Effort(STEPS_EFFORT)
    for name, response in responses.items():
        if response.bound is None or name not in homes:
            continue
        effort.left -= response.level.reach
        known = best[name] + response.bound
        level = (
            _of_task(response, events, best)
            if isinstance(response, Response)
            else _of_frame(response, events, best)
        )
        if level is None or not level.together:
            continue
        end = _longest(level, known, effort)
        if effort.left <= 0:
            break
        if end < known:
            found[name] = end
    return found


def _events(
    network: Network,
    responses: Mapping[str, Response | FrameResponse],
    best: Mapping[str, int],
) -> dict[str, str]:
    """The item that begins the transaction of each item; none for items that count alone."""
    items, found = network.items(), {}
    for name, item in items.items():
        first = (name, *network.releasers(name))[-1]
        response = responses[name]
        late = _latest(response)
        apart = items[first].sporadic and best[name] + late >= item.period
        if item.period == items[first].period and not apart:
            found[name] = first
    return found


def _shared(network: Network, events: Mapping[str, str]) -> set[str]:
    """The items of the cores and buses on which several steps of one transaction are."""
    homes: dict[tuple[str, str], list[str]] = {}
    for task in network.tasks:
        homes.setdefault(("core", task.core), []).append(task.name)
    for bus, frames in network.frames.items():
        homes["bus", bus] = [frame.name for frame in frames]
    found: set[str] = set()
    for names in homes.values():
        began = [events[name] for name in names if name in events]
        if len(set(began)) < len(began):
            found |= set(names)
    return found


def _latest(response: Response | FrameResponse) -> int:
    """The longest time from its arrival until an item is released or takes part in arbitration."""
    if isinstance(response, Response):
        return response.jitter
    return response.frame.jitter + response.level.delays.get(response.frame.name, 0)


def _of_task(response: Response, events: Mapping[str, str], best: Mapping[str, int]) -> _Level:
    """The level of a task, with the overheads of its core."""
    platform, order = response.level.platform, response.level.order
    steps = [
        LevelItem(
            task.name, best[task.name], jitter_of(task, platform), task.period,
            max(demand_of(task, platform).wcets),
        )
        for task in order[: response.level.reach]
    ]  # fmt: skip
    sources = [constant_source(platform.tick_period, 0, platform.tick_wcet)] * bool(
        platform.tick_wcet
    )
    for task in order if platform.release else ():
        wcet = release_time(task, platform)
        sources.append(constant_source(task.period, jitter_of(task, platform), wcet))
    return _level(response.task, steps, events, sources, response.blocked)


def _of_frame(
    response: FrameResponse, events: Mapping[str, str], best: Mapping[str, int]
) -> _Level | None:
    """The level of a frame; none where it waits in a first-in first-out queue."""
    frame, level = response.frame, response.level
    if frame.queue:
        return None
    bit = level.bus.bit_time
    steps = [
        LevelItem(
            other.name, best[other.name],
            frame.jitter if other.name == frame.name else level.jitter(other, frame),
            other.period, other.transmission_time,
        )
        for other in level.order[: level.reach]
    ]  # fmt: skip
    errors, fixed = level.bus.errors, level.blocker[1]
    sources = []
    if errors is not None:
        fixed += (errors.burst - 1) * level.error_overhead
        late = max(0, frame.transmission_time - bit)  # `closing` adds a bit
        sources.append(constant_source(errors.period, late, level.error_overhead))
    return _level(frame, steps, events, sources, fixed, frame.transmission_time, bit)


def _level(
    item: Task | Frame,
    steps: Iterable[LevelItem],
    events: Mapping[str, str],
    sources: Iterable[Source],
    fixed: int,
    after: int = 0,
    closing: int = 0,
) -> _Level:
    """The level of an item: its steps grouped by the first items of their transactions."""
    groups: dict[str, list[LevelItem]] = {}
    alone = list(sources)
    own: LevelItem | None = None
    event = events.get(item.name)
    for step in steps:
        if step.name == item.name:
            own = step
        elif step.name in events:
            groups.setdefault(events[step.name], []).append(step)
        else:
            alone.append(constant_source(step.period, step.jitter, step.wcet))
    assert own is not None
    mates = groups.pop(event, []) if event is not None else []
    others = []
    for group in groups.values():
        if len(group) > 1:
            others.append(tuple(group))
        else:
            alone.append(constant_source(group[0].period, group[0].jitter, group[0].wcet))
    return _Level(own, tuple(mates), tuple(others), tuple(alone), fixed, after, closing)


def _longest(level: _Level, known: int, effort: Effort) -> int:
    """The longest time from the event to the completion; at most ``known`` is searched for."""
    others = [
        [[_Arriving.behind(step, first) for step in steps] for first in steps]
        for steps in level.others
    ]
    longest = 0
    for first in (level.own, *level.mates):
        own = _Arriving.behind(level.own, first)
        mates = [_Arriving.behind(step, first) for step in level.mates]
        for end in _of_jobs(level, own, mates, others, effort):
            longest = max(longest, end)
            if longest >= known or effort.left <= 0:
                return known
    return longest


def _of_jobs(
    level: _Level,
    own: _Arriving,
    mates: list[_Arriving],
    others: list[list[list[_Arriving]]],
    effort: Effort,
) -> Iterator[int]:
    """The time from the event to the completion, for each job of one busy period."""
    step, number = level.own, 1 - own.waiting
    terms = 1 + len(mates) + len(level.sources) + sum(len(c) ** 2 for c in others)

    def settled(fixed: int, closing: int, length: int) -> int:
        while True:
            effort.left -= terms
            window = length + closing
            needed = fixed + sum(mate.demand(window) for mate in mates)
            needed += sum(
                max(sum(one.demand(window) for one in case) for case in cases) for cases in others
            )
            needed += sum(execution_of(s, releases_in(window, s[0], s[1])) for s in level.sources)
            if needed <= length or effort.left <= 0:
                return length
            length = needed

    length, busy = 0, 0
    while effort.left > 0:
        before = number - (1 - own.waiting)
        fixed = level.fixed + (before + 1) * step.wcet - level.after
        length = settled(fixed, level.closing, length)
        arrival = own.phase + (number - 1) * step.period
        yield length + level.after - arrival + step.offset
        busy = settled(level.fixed + (before + 1) * step.wcet, 0, busy)
        number += 1
        if number > 0 and busy <= own.phase + (number - 1) * step.period:
            return
