# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Audsley's assignment for tasks, and tasks and frames with the order that was found."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ravenchart.analysis.core.assignment import Order, audsley, longest_deadline_first
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.fixed_priority import NO_OVERHEAD, response_under
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import Task


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

    return audsley(tasks, fits, longest_deadline_first)


def with_priorities(tasks: Sequence[Task], order: Order, lowest: int = 1) -> tuple[Task, ...]:
    """The tasks with the priorities of a complete order, from ``lowest`` up, as given."""
    level = {name: lowest + n for n, name in enumerate(reversed(order.names))}
    return tuple(replace(task, priority=level[task.name]) for task in tasks)


def with_ranks(frames: Sequence[Frame], order: Order, ranks: Sequence[int]) -> tuple[Frame, ...]:
    """The frames with the given ``ranks``, the lowest for the most urgent of a complete order."""
    given = dict(zip(order.names, sorted(ranks), strict=True))
    return tuple(replace(frame, rank=given[frame.name]) for frame in frames)
