"""Priorities for tasks and identifiers for frames.

Deadline monotonic order (Leung and Whitehead 1982), here by deadline less jitter, is
optimal for plain tasks with deadlines up to the period. With longer deadlines,
sections, or on a bus it is only a good guess. Audsley's assignment (1991, 2001) finds
an order whenever there is one that this analysis accepts: whether a task is accepted
depends on which tasks are more urgent, not on their order among each other. That
holds for ceiling blocking too, which depends on the same two sets.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from . import can
from .blocking import Section
from .bus import Bus, Frame
from .fixed_priority import NO_OVERHEAD, response_under
from .platform import Platform
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

    Their priorities are not looked at. ValueError where they are on several cores.
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

    return _audsley(tasks, fits)


def audsley_frames(frames: Sequence[Frame], bus: Bus) -> Order:
    """An order of the frames of one bus in which all deadlines are met, if there is one.

    Their ranks are not looked at. ValueError for frames with a first-in first-out
    queue: their responses depend on the order within the queue's ranks.
    """
    for frame in frames:
        if frame.queue:
            raise ValueError(f"queue of message {frame.name} must be empty here")
    return _audsley(
        frames, lambda frame, above, below: can.response_under(frame, above, below, bus).met
    )


def with_priorities(tasks: Sequence[Task], order: Order, lowest: int = 1) -> tuple[Task, ...]:
    """The tasks with the priorities of a complete order, from ``lowest`` up, as given."""
    level = {name: lowest + n for n, name in enumerate(reversed(order.names))}
    return tuple(replace(task, priority=level[task.name]) for task in tasks)


def with_ranks(frames: Sequence[Frame], order: Order, ranks: Sequence[int]) -> tuple[Frame, ...]:
    """The frames with the given ``ranks``, the lowest for the most urgent of a complete order."""
    given = dict(zip(order.names, sorted(ranks), strict=True))
    return tuple(replace(frame, rank=given[frame.name]) for frame in frames)


def _audsley(
    items: Sequence[Item], fits: Callable[[Item, Sequence[Item], Sequence[Item]], bool]
) -> Order:
    """From the lowest place up, whichever fits there; the longest deadline is tried first."""
    left = deadline_monotonic(items)
    placed: list[Item] = []
    while left:
        for item in reversed(left):
            above = [other for other in left if other is not item]
            if fits(item, above, placed):
                left = above
                placed.insert(0, item)
                break
        else:
            break
    return Order(tuple(item.name for item in placed), tuple(item.name for item in left))
