# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Priorities for tasks and identifiers for frames.

Deadline monotonic order (Leung and Whitehead 1982), here by deadline less jitter, is
optimal for plain tasks with deadlines up to the period. With longer deadlines,
sections, or on a bus it is only a good guess. Audsley's assignment (1991, 2001) finds
an order whenever there is one that this analysis accepts. The reason: the acceptance of
a task depends on the set of more urgent tasks, not on their order among each other. This
holds for ceiling blocking too, which depends on the same two sets.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from . import can
from .blocking import Section
from .bus import Bus, Frame
from .can_response import FrameLevel, FrameResponse
from .fixed_priority import NO_OVERHEAD, response_under
from .platform import Platform
from .responses import Reason
from .tasks import Task

Item = TypeVar("Item", Task, Frame)


@dataclass(frozen=True, slots=True)
class Order:
    """Names, most urgent first, when ``complete``; else ``names`` are those that fit.

    Of an incomplete order ``names`` are the least urgent ones, and none of the
    ``unplaced`` meets its deadline below all others of them.
    """

    names: tuple[str, ...]
    unplaced: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Every deadline is met in this order."""
        return not self.unplaced


def deadline_monotonic(items: Sequence[Item]) -> list[Item]:
    """The items by deadline less jitter, shortest first; equal ones as given."""
    return sorted(items, key=lambda item: item.deadline - item.jitter)


def audsley_tasks(
    tasks: Sequence[Task], sections: Sequence[Section] = (), platform: Platform = NO_OVERHEAD
) -> Order:
    """An order of the tasks of one core in which all deadlines are met, if there is one.

    Their priorities do not count. ValueError where they are on several cores.
    """
    if len({task.core for task in tasks}) > 1:
        raise ValueError("tasks of several cores have no common order")
    users: dict[str, set[str]] = {}
    for section in sections:
        users.setdefault(section.resource, set()).add(section.user)

    def fits(task: Task, above: Sequence[Task], below: Sequence[Task]) -> bool:
        urgent = {task.name, *(other.name for other in above)}
        blocking = max(
            (s for s in sections if s.user not in urgent and users[s.resource] & urgent),
            key=lambda section: section.length,
            default=None,
        )
        return response_under(task, above, below, blocking, platform).met

    return _audsley(tasks, fits, longest_deadline_first)


Candidates = Callable[[Sequence[Item], Sequence[Item]], Iterable[Item]]
"""The items that may go directly above those placed, in the order to try: (left, placed)."""


def longest_deadline_first(left: Sequence[Item], _: Sequence[Item]) -> Iterable[Item]:
    """All that are left, from the longest deadline less jitter."""
    return reversed(left)


def audsley_frames(
    frames: Sequence[Frame], bus: Bus, candidates: Candidates[Frame] = longest_deadline_first
) -> Order:
    """An order of the frames of one bus in which all deadlines are met, if there is one.

    Their ranks do not count. The assignment is optimal on CAN too: of the less urgent frames only
    the longest counts, which does not depend on their order (Davis et al. 2007).
    ``candidates`` may hold back frames whose place is bound. ValueError for a
    first-in first-out queue that is not ``reloaded``: there the order within it counts.
    """
    fits = responses_in_place(frames, bus)
    return _audsley(frames, lambda frame, above, below: fits(frame, above, below).met, candidates)


def responses_in_place(
    frames: Sequence[Frame], bus: Bus
) -> Callable[[Frame, Sequence[Frame], Sequence[Frame]], FrameResponse]:
    """The response of a frame, of the frames above it and of those below it.

    ValueError as for `audsley_frames`.
    """
    delays = can.delays_in_any_order(frames, bus)
    known = {name: delay for name, delay in delays.items() if delay is not None}

    def response(frame: Frame, above: Sequence[Frame], below: Sequence[Frame]) -> FrameResponse:
        if frame.queue:
            above, below = (*above, *below), ()
        for other in (frame, *above):
            if delays.get(other.name, 0) is None:
                level = FrameLevel((*above, frame, *below), len(above) + 1, bus, known)
                return FrameResponse(frame, level, None, reason=Reason.DELAYED)
        return can.response_under(frame, above, below, bus, known)

    return response


def with_priorities(tasks: Sequence[Task], order: Order, lowest: int = 1) -> tuple[Task, ...]:
    """The tasks with the priorities of a complete order, from ``lowest`` up, as given."""
    level = {name: lowest + n for n, name in enumerate(reversed(order.names))}
    return tuple(replace(task, priority=level[task.name]) for task in tasks)


def with_ranks(frames: Sequence[Frame], order: Order, ranks: Sequence[int]) -> tuple[Frame, ...]:
    """The frames with the given ``ranks``, the lowest for the most urgent of a complete order."""
    given = dict(zip(order.names, sorted(ranks), strict=True))
    return tuple(replace(frame, rank=given[frame.name]) for frame in frames)


def _audsley(
    items: Sequence[Item],
    fits: Callable[[Item, Sequence[Item], Sequence[Item]], bool],
    candidates: Candidates[Item],
) -> Order:
    """From the lowest place up, the first of the candidates that fits there."""
    left = deadline_monotonic(items)
    placed: list[Item] = []
    while left:
        for item in candidates(left, placed):
            above = [other for other in left if other is not item]
            if fits(item, above, placed):
                left = above
                placed.insert(0, item)
                break
        else:
            break
    return Order(tuple(item.name for item in placed), tuple(item.name for item in left))
