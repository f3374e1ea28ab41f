# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Blocking of a task by less urgent tasks, under immediate ceilings.

Inside a protected object a task runs at the object's ceiling (Ada RM D.3,
Ceiling_Locking). A section can block a task when its user is less urgent and
the ceiling reaches the task, whether or not the task ever uses the object. Blocking
occurs once in a busy period, because only one section can have begun before it
(Sha, Rajkumar, Lehoczky 1990; Baker 1991). A user of equal priority interferes.
A ceiling among the interrupt priorities blocks the interrupts as well, when
they are given as tasks of such a priority.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .checks import positive
from .tasks import Task


@dataclass(frozen=True, slots=True)
class Section:
    """The longest time (ticks, above 0) that one call of ``user`` spends inside ``resource``.

    A user that is no task, such as the main program, is less urgent than all.
    """

    resource: str
    user: str
    length: int

    def __post_init__(self) -> None:
        """Refuse a length that is out of range, with a ValueError."""
        positive(f"the section of {self.user} on {self.resource}", length=self.length)


def ceilings(
    tasks: Sequence[Task], sections: Sequence[Section], given: Mapping[str, int] | None = None
) -> dict[str, int]:
    """The ceiling of each resource: the highest priority of its users, unless ``given``.

    ValueError where users sit on several cores, which ceilings do not protect, or
    where a given ceiling is below the priority of a user.
    """
    users = {task.name: task for task in tasks}
    found = dict(given or {})
    needed: dict[str, int] = {}
    cores: dict[str, str] = {}
    for section in sections:
        task = users.get(section.user)
        if task is None:
            continue
        if cores.setdefault(section.resource, task.core) != task.core:
            raise ValueError(f"users of {section.resource} are on several cores")
        if section.resource in found and found[section.resource] < task.priority:
            raise ValueError(
                f"ceiling of {section.resource} must be at least {task.priority}, "
                f"the priority of task {task.name}"
            )
        needed[section.resource] = max(needed.get(section.resource, task.priority), task.priority)
    return needed | found


def blockers(
    tasks: Sequence[Task], sections: Sequence[Section], given: Mapping[str, int] | None = None
) -> dict[str, Section]:
    """The longest section that can block each task, by the name of the task.

    Of several sections of that length it is the first given. A user that is no task
    blocks the cores whose tasks use its resource, or all cores where no task does.
    ValueError as `ceilings`, and where a section is longer than its user's whole job.
    """
    users = {task.name: task for task in tasks}
    lengths = {task.name: task.plain_wcet for task in tasks}
    for section in sections:
        user = users.get(section.user)
        if user is not None and section.length > lengths[section.user]:
            raise ValueError(
                f"the section of {section.user} on {section.resource} must be at most "
                f"{lengths[section.user]}, the WCET of the task, not {section.length}"
            )
    reach = ceilings(tasks, sections, given)
    homes = {s.resource: users[s.user].core for s in sections if s.user in users}
    found: dict[str, Section] = {}
    for core in {task.core: None for task in tasks} if sections else ():
        here = [section for section in sections if homes.get(section.resource, core) == core]
        members = [task for task in tasks if task.core == core]
        levels = sorted({task.priority for task in members})
        longest = _by_level(levels, _spans(levels, users, here, reach))
        found |= {t.name: longest[t.priority] for t in members if t.priority in longest}
    return found


def held_up(task: Task, section: Section | None) -> int:
    """The blocking time of a task: its longest section below, and the given ``held``."""
    return task.held + (0 if section is None else section.length)


HeldSection = tuple[int, int, Section]
"""Indices of the levels that a section can block, the last one not included."""


def _spans(
    levels: Sequence[int],
    users: Mapping[str, Task],
    sections: Sequence[Section],
    reach: Mapping[str, int],
) -> list[HeldSection]:
    """The levels that each section can block: above its user, up to its resource's ceiling."""
    spans = []
    for section in sections:
        if section.resource in reach:
            user = users.get(section.user)
            first = 0 if user is None else bisect_right(levels, user.priority)
            spans.append((first, bisect_right(levels, reach[section.resource]), section))
    return spans


def _by_level(levels: Sequence[int], spans: Sequence[HeldSection]) -> dict[int, Section]:
    """The longest section over each level: the longest take their levels first."""
    free = list(range(len(levels) + 1))
    longest: dict[int, Section] = {}
    for first, last, section in sorted(spans, key=lambda span: -span[2].length):
        at = _next_free(free, first)
        while at < last:
            longest[levels[at]] = section
            free[at] = at + 1
            at = _next_free(free, at)
    return longest


def _next_free(free: list[int], at: int) -> int:
    """The first level from ``at`` on that has no section yet; shortens the way for later."""
    while free[at] != at:
        free[at] = free[free[at]]
        at = free[at]
    return at
