# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tasks and buses that release each other: jitter is inherited until it no longer changes.

Tindell and Clark, Holistic schedulability analysis for distributed hard real-time
systems (1994). An item that another one releases arrives with its completion, at the
latest. Its jitter is the difference to its best case. Jitter begins at zero and only
grows, and responses grow with it. So the first state that repeats itself is the least.
A system without such a state is not bounded by the values it went through. Steps of a
chain count as independent of each other, which is safe. In a network that is
``together``, `transactions` finds the responses that their distances make shorter.

A best case is the sum of the best cases (`best`) along the chain, 0 unless given.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from . import can, fixed_priority
from .blocking import Section
from .bus import INTERMISSION, Bus, Frame
from .can_response import FrameResponse
from .checks import distinct
from .platform import Platform
from .responses import Reason, Response
from .tasks import Task
from .transactions import ends

ROUNDS = 200
"""Rounds of the iteration; if it has not settled by then, released items have no bound."""

STRAINED = 5
"""Rounds in which an analysis may reach the end of the work allowed."""

LATEST = 1_000
"""Periods of jitter above which there is no bound."""


@dataclass(frozen=True, slots=True)
class Network:
    """Tasks, buses, and the releases between them.

    ``frames`` and ``buses`` go by the name of a bus. ``released_by`` has the releaser of each
    task or frame that the completion of another one releases; its own jitter then comes on
    top. Its period is that of its releaser, or a multiple where not every job releases it.
    Names are distinct over tasks and frames. ``platforms`` goes by the name of a core,
    ``ceilings`` by resource, as in `fixed_priority.analyse_tasks`. A released item has no
    offset. ``together``: steps of one chain count with the distances that they have.
    """

    tasks: tuple[Task, ...]
    frames: Mapping[str, tuple[Frame, ...]] = field(default_factory=dict)
    buses: Mapping[str, Bus] = field(default_factory=dict)
    released_by: Mapping[str, str] = field(default_factory=dict)
    sections: tuple[Section, ...] = ()
    platforms: Mapping[str, Platform] = field(default_factory=dict)
    ceilings: Mapping[str, int] = field(default_factory=dict)
    together: bool = False

    def __post_init__(self) -> None:
        """Refuse names given twice, unknown names, cycles and other periods."""
        items = self.items()
        for name, by in self.released_by.items():
            for one in (name, by):
                if one not in items:
                    raise ValueError(f"{one} is neither a task nor a message")
            if items[name].period % items[by].period:
                raise ValueError(
                    f"period of {name} must be a multiple of {items[by].period}, that of {by} "
                    f"which releases it, not {items[name].period}"
                )
            if name in self.releasers(name):
                raise ValueError(f"{name} is released by itself")
            item = items[name]
            if isinstance(item, Task) and item.offset is not None:
                raise ValueError(f"offset of {name} has no meaning: {by} releases it")
        for bus in self.frames:
            if bus not in self.buses:
                raise ValueError(f"there are messages on {bus}, but no such bus")

    def items(self) -> dict[str, Task | Frame]:
        """Every task and frame by name; ValueError for a name given twice."""
        items: list[Task | Frame] = list(self.tasks)
        for frames in self.frames.values():
            items += frames
        distinct("tasks or messages", [item.name for item in items])
        return {item.name: item for item in items}

    def least(self) -> dict[str, int]:
        """The least time from the release of each item until the items that it releases arrive.

        A frame is received before the bits between frames, which its times contain.
        """
        least = {task.name: task.best for task in self.tasks}
        for bus, frames in self.frames.items():
            after = INTERMISSION * self.buses[bus].bit_time
            least |= {frame.name: max(0, frame.best - after) for frame in frames}
        return least

    def releasers(self, name: str) -> tuple[str, ...]:
        """The items that release it, directly and through others; stops where a cycle closes."""
        found: list[str] = []
        while (by := self.released_by.get(name)) is not None and by not in found:
            found.append(by)
            name = by
        return tuple(found)


@dataclass(frozen=True, slots=True)
class Holistic:
    """The responses of a network, by name, after so many ``rounds``.

    ``inherited`` is the jitter that an item has from its releasers, and ``best`` the
    least time from the event of its chain to its arrival. The bound of a response
    counts from there: ``best + bound`` is the time from the event of the chain. ``ends`` has
    shorter such times, where the steps of a chain do not all meet.
    """

    responses: Mapping[str, Response | FrameResponse]
    inherited: Mapping[str, int]
    best: Mapping[str, int]
    rounds: int
    ends: Mapping[str, int] = field(default_factory=dict)

    def from_event(self, name: str) -> int | None:
        """The longest time from the event that begins its chain to its completion."""
        bound = self.responses[name].bound
        return None if bound is None else self.ends.get(name, self.best[name] + bound)

    @property
    def met(self) -> bool:
        """Every task and frame has a bound and meets its deadline, from its chain's event."""
        return all(self.meets(name) for name in self.responses)

    def deadline(self, name: str) -> int:
        """The deadline of a task or frame."""
        response = self.responses[name]
        item = response.task if isinstance(response, Response) else response.frame
        return item.deadline

    def meets(self, name: str) -> bool:
        """Whether it has a bound from its chain's event, which is at most its deadline."""
        needed = self.from_event(name)
        return needed is not None and needed <= self.deadline(name)


def analyse(network: Network) -> Holistic:
    """The responses of all tasks and frames of ``network``.

    ValueError as the analyses of tasks and frames.
    """
    items = network.items()
    least = network.least()
    best = {name: sum(least[one] for one in network.releasers(name)) for name in items}
    late: dict[str, int | None] = dict.fromkeys(items, 0)
    rounds, strained, settled = 0, 0, False
    sooner: dict[str, int] = {}
    while not settled and rounds < ROUNDS and strained < STRAINED:
        rounds += 1
        responses = _responses(network, late)
        strained += any(r.reason is Reason.EFFORT for r in responses.values())
        if network.together:
            sooner = ends(network, responses, best)
        found: dict[str, int | None] = dict.fromkeys(items, 0)
        for name, by in network.released_by.items():
            bound = responses[by].bound
            end = None if bound is None else sooner.get(by, best[by] + bound)
            jitter = None if end is None else end - best[name]
            lost = jitter is None or jitter > LATEST * items[name].period
            found[name] = None if lost else jitter
        settled = found == late
        late = found
    if not settled:
        late = {name: None if network.releasers(name) else 0 for name in items}
        responses, sooner = _responses(network, late), {}
    known = {name: jitter for name, jitter in late.items() if jitter is not None}
    return Holistic(responses, known, best, rounds, sooner)


def analyses(network: Network) -> Iterator[Holistic]:
    """The responses for any offsets, then those with offsets, where these may be shorter.

    A search stops after the first result if that meets its condition.
    """
    blind = tuple(task.at_any_time() for task in network.tasks)
    known = blind != network.tasks
    found = analyse(replace(network, tasks=blind) if known else network)
    yield found
    if known and not any(r.reason is Reason.OVERLOAD for r in found.responses.values()):
        yield analyse(network)


def met(network: Network) -> bool:
    """Every task and frame has a bound and meets its deadline."""
    return any(found.met for found in analyses(network))


def _responses(
    network: Network, late: Mapping[str, int | None]
) -> dict[str, Response | FrameResponse]:
    """All responses with the inherited jitter ``late``; None is a jitter without bound."""
    found: dict[str, Response | FrameResponse] = {}
    tasks = tuple(replace(t, jitter=t.jitter + (late[t.name] or 0)) for t in network.tasks)
    lost = {
        core: max(t.priority for t in tasks if t.core == core and _delays(t, core, network, late))
        for core in {t.core for t in tasks if late[t.name] is None}
    }
    for response in fixed_priority.analyse_tasks(
        tasks, network.sections, network.platforms, network.ceilings
    ):
        task = response.task
        if task.core in lost and task.priority <= lost[task.core]:
            response = replace(response, bound=None, rows=(), reason=Reason.DELAYED)
        found[task.name] = response
    for bus, frames in network.frames.items():
        given = tuple(replace(f, jitter=f.jitter + (late[f.name] or 0)) for f in frames)
        first = min((_reach(f, given) for f in given if late[f.name] is None), default=None)
        for sent in can.analyse(given, network.buses[bus]):
            if first is not None and _level(sent.frame, given) >= first:
                sent = replace(sent, bound=None, reason=Reason.DELAYED)
            found[sent.frame.name] = sent
    return found


def _delays(task: Task, core: str, network: Network, late: Mapping[str, int | None]) -> bool:
    """Whether tasks of its priority lose their bounds; all do where releases take time."""
    platform = network.platforms.get(core)
    return late[task.name] is None or (platform is not None and platform.release > 0)


def _reach(frame: Frame, frames: Sequence[Frame]) -> int:
    """The most urgent rank that a frame and its queue can delay."""
    return min(f.rank for f in frames if f == frame or (f.queue and f.queue == frame.queue))


def _level(frame: Frame, frames: Sequence[Frame]) -> int:
    """The least urgent rank that a frame and its queue are analysed at."""
    if frame.reloaded:
        return max(f.rank for f in frames)
    return max(f.rank for f in frames if f == frame or (f.queue and f.queue == frame.queue))
