# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Single changes that would meet all deadlines, each as small as suffices.

Every candidate is judged by the analysis itself (`holistic`, or a stricter ``met``). So
each change that is reported to suffice does. Shorter execution times and longer periods
only help, so the smallest change is found by halving. Orders of priorities and identifiers are
tried by deadline (`assignment`), and from the lowest place up as Audsley (1991) does. With
inherited jitter the latter may miss an order that exists, but never accepts a wrong one.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction

from . import holistic
from .bus import Frame
from .holistic import Network
from .sensitivity import greatest
from .tasks import Task

STEPS = 1_000
"""Execution times are shortened, and periods lengthened, by whole multiples of 1 / this."""

LONGEST = 10
"""A period is lengthened to at most so many times its length."""

ORDERED = 30
"""With more tasks or frames, no order is searched for from the lowest place up."""


class ChangeKind(Enum):
    """The kind of a change."""

    WCET = "wcet"
    PERIOD = "period"
    ORDER = "order"
    PLACE = "place"


@dataclass(frozen=True, slots=True)
class Change:
    """One change; ``enough`` when it meets all deadlines alone.

    ``factor`` is the largest one of the execution time, or the smallest one of the period,
    that suffices; None where none does and for orders. ``order`` names tasks of a core or
    frames of a bus, most urgent first.
    """

    kind: ChangeKind
    name: str
    enough: bool
    factor: Fraction | None = None
    order: tuple[str, ...] = ()

    @property
    def amount(self) -> Fraction:
        """Share of the time that is changed; 0 for orders, which need no time."""
        return Fraction(0) if self.factor is None else abs(self.factor - 1)


Part = tuple[str, str]
"""A task and one of its rows, or "" for its own time."""

Met = Callable[[Network], bool]
"""Whether a network meets all its requirements."""


def ranked(changes: Sequence[Change]) -> tuple[Change, ...]:
    """Sufficient changes first: orders, then the smallest share of a time."""
    return tuple(sorted(changes, key=lambda one: (not one.enough, one.amount)))


def shorter(
    network: Network, groups: Mapping[str, Collection[Part]], holds: Met
) -> Iterator[Change]:
    """For each group of parts, the factor by which their execution times must shrink together."""
    for name, members in groups.items():

        def suffices(count: int, members: Collection[Part] = members) -> bool:
            return holds(shrunk(network, members, Fraction(count, STEPS)))

        last = greatest(suffices, 1, STEPS - 1)
        factor = None if last is None else Fraction(last, STEPS)
        yield Change(ChangeKind.WCET, name, factor is not None, factor)


def parts(task: Task) -> tuple[Part, ...]:
    """All that takes time in a task."""
    return ((task.name, ""), *((task.name, row.name) for row in task.rows))


def shrunk(network: Network, chosen: Collection[Part], factor: Fraction) -> Network:
    """The network with the times of these parts multiplied and rounded up.

    No section stays longer than the job that it is part of.
    """

    def short(wcet: int) -> int:
        return -(-wcet * factor.numerator // factor.denominator)

    def less(task: Task) -> Task:
        wcet = short(task.wcet) if (task.name, "") in chosen else task.wcet
        rows = tuple(
            replace(row, wcet=short(row.wcet)) if (task.name, row.name) in chosen else row
            for row in task.rows
        )
        found = replace(task, wcet=wcet, rows=rows, best=0)
        return replace(found, best=min(task.best, found.plain_wcet))

    tasks = tuple(map(less, network.tasks))
    longest = {task.name: task.plain_wcet for task in tasks}
    sections = tuple(
        replace(s, length=min(s.length, longest.get(s.user, s.length))) for s in network.sections
    )
    return replace(network, tasks=tasks, sections=sections)


def slower(network: Network, roots: Sequence[str], holds: Met) -> Iterator[Change]:
    """For each item that an event releases, the factor by which its period must grow.

    The periods of the items that follow it grow with it; deadlines stay. Its releases then
    come at other times between those of others, so its offset does not count.
    """
    least, most = STEPS + 1, LONGEST * STEPS
    for root in roots:

        def suffices(less: int, root: str = root) -> bool:
            return holds(stretched(network, root, Fraction(most - less, STEPS)))

        last = greatest(suffices, 0, most - least)
        factor = None if last is None else Fraction(most - last, STEPS)
        yield Change(ChangeKind.PERIOD, root, factor is not None, factor)


def stretched(network: Network, root: str, factor: Fraction) -> Network:
    """The network with the period of ``root``, and of its followers, multiplied, rounded down."""
    period = network.items()[root].period
    longer = period * factor.numerator // factor.denominator

    def changed(item: Task | Frame) -> int:
        follows = item.name == root or root in network.releasers(item.name)
        return item.period // period * longer if follows else item.period

    return replace(
        network,
        tasks=tuple(
            replace(task.at_any_time() if task.name == root else task, period=changed(task))
            for task in network.tasks
        ),
        frames={
            bus: tuple(replace(frame, period=changed(frame)) for frame in frames)
            for bus, frames in network.frames.items()
        },
    )


def reordered(network: Network, movable: Collection[str], holds: Met) -> Iterator[Change]:
    """For each core and each bus, whether another order of the movable tasks or frames suffices.

    The change has the first order found, or an empty one.
    """
    wide = _spread(network)
    places: list[tuple[str, Sequence[Task | Frame]]] = [
        (core, [task for task in wide.tasks if task.core == core])
        for core in dict.fromkeys(task.core for task in wide.tasks)
    ]
    for place, members in (*places, *wide.frames.items()):
        items = [item for item in members if item.name in movable]
        if len(items) < 2:
            continue
        found: tuple[str, ...] = ()
        for order in _orders(wide, items):
            if order != _now(items) and holds(_in_order(wide, items, order)):
                found = order
                break
        yield Change(ChangeKind.ORDER, place, bool(found), order=found)


def moved(network: Network, name: str, holds: Met) -> Iterator[Change]:
    """How few places the late frame ``name`` must move up in the order of its bus."""
    wide = _spread(network)
    for frames in wide.frames.values():
        now = _now(frames)
        if name not in now:
            continue
        rest = [other for other in now if other != name]
        for place in reversed(range(now.index(name))):
            order = (*rest[:place], name, *rest[place:])
            if holds(_in_order(wide, frames, order)):
                yield Change(ChangeKind.PLACE, name, enough=True, order=order)
                return
        yield Change(ChangeKind.PLACE, name, enough=False)


def _orders(network: Network, items: Sequence[Task | Frame]) -> Iterator[tuple[str, ...]]:
    """Orders to try: by deadline less the jitter found, then as Audsley assigns places."""
    late = holistic.analyse(network).inherited
    by_deadline = sorted(items, key=lambda i: i.deadline - i.jitter - late.get(i.name, 0))
    left = [item.name for item in by_deadline]
    yield tuple(left)
    if len(items) > ORDERED:
        return
    placed: list[str] = []
    while left:
        for name in reversed(left):
            order = (*(other for other in left if other != name), name, *placed)
            if holistic.analyse(_in_order(network, items, order)).meets(name):
                left.remove(name)
                placed.insert(0, name)
                break
        else:
            return
    yield tuple(placed)


def _now(items: Sequence[Task | Frame]) -> tuple[str, ...]:
    """The names, most urgent first."""
    return tuple(item.name for item in sorted(items, key=_rank))


def _rank(item: Task | Frame) -> int:
    """The lower, the more urgent."""
    return item.rank if isinstance(item, Frame) else -item.priority


def _in_order(network: Network, items: Sequence[Task | Frame], order: Sequence[str]) -> Network:
    """The network with the places of these items given out anew; ceilings follow their users."""
    rank = dict(zip(order, sorted(map(_rank, items)), strict=True))
    return replace(
        network,
        tasks=tuple(
            replace(t, priority=-rank[t.name]) if t.name in rank else t for t in network.tasks
        ),
        frames={
            bus: tuple(replace(f, rank=rank.get(f.name, f.rank)) for f in frames)
            for bus, frames in network.frames.items()
        },
    )


def _spread(network: Network) -> Network:
    """The network with different priorities on each core, and different ranks on each bus.

    Tasks of one priority delayed each other; now only one delays the other. Ceilings above
    their users stay above all.
    """
    count = max(len(network.tasks), *map(len, network.frames.values()), 0) + 1
    seen: dict[tuple[str, int], int] = {}
    tasks = []
    for task in network.tasks:
        number = seen[task.core, task.priority] = seen.get((task.core, task.priority), 0) + 1
        tasks.append(replace(task, priority=task.priority * count + count - number))
    priorities = {task.name: task.priority for task in network.tasks}
    highest = max((task.priority for task in tasks), default=0)
    above = {}
    for resource, ceiling in network.ceilings.items():
        users = [priorities[s.user] for s in network.sections
                 if s.resource == resource and s.user in priorities]  # fmt: skip
        if not users or ceiling > max(users):
            above[resource] = max(highest, ceiling * count)
    frames = {
        bus: tuple(replace(frame, rank=frame.rank * count + n) for n, frame in enumerate(some))
        for bus, some in network.frames.items()
    }
    return replace(network, tasks=tuple(tasks), frames=frames, ceilings=above)
