# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Allocation of activities to tasks: strategies, each result checked by the analysis of tasks.

A task runs a table of activities (rows): its period is the shortest of theirs, and the
others' are multiples of it. Few tasks need few switches and stacks; many tasks let urgent
activities run before others. Cores are given: no activity changes its core.

    by period     one task for each period of a core, as in the original pattern
    by locality   activities of one owner share a task as long as their rates fit together
    search        from both, and from one task for each activity, the best move of one
                  activity into another task or one of its own, until none is better

Tasks get deadline-monotonic priorities by their most urgent activity. This activity comes
first in the table, so its own deadline counts for it alone. Slower activities of a table
get the phases with the least execution time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction

from .blocking import Section
from .checks import distinct, positive
from .fixed_priority import analyse_tasks
from .platform import Platform
from .responses import Response
from .tasks import FRAME_LIMIT, TableRow, Task

WIDEST = 16
"""A table's longest period is at most so many of its shortest, where locality decides."""

TRIALS = 20_000
"""Tables that one search may analyse; then the search returns the best so far."""


@dataclass(frozen=True, slots=True)
class Movable:
    """A piece of work, all times in ticks above 0; ``owner`` is the instance that it is part of."""

    name: str
    period: int
    wcet: int
    deadline: int
    owner: str = ""
    core: str = ""

    def __post_init__(self) -> None:
        """Refuse values out of range, with a ValueError that names field and activity."""
        owner = f"activity {self.name}"
        positive(owner, period=self.period, wcet=self.wcet, deadline=self.deadline)


class Strategy(Enum):
    """The strategy by which activities are put together."""

    BY_PERIOD = "by period"
    BY_LOCALITY = "by rate and locality"
    FEWEST_TASKS = "fewest tasks"
    MOST_SLACK = "most slack"


Table = tuple[Movable, ...]
"""Activities of one task, in the order in which it executes them."""


@dataclass(frozen=True, slots=True)
class Allocation:
    """Tables with the tasks that execute them, and the responses of these tasks.

    Task n executes table n and has the name of its first activity.
    """

    tables: tuple[Table, ...]
    tasks: tuple[Task, ...]
    responses: tuple[Response, ...]

    def response(self, activity: str) -> int | None:
        """The bound of an activity; None where there is none. KeyError for an unknown one."""
        for response in self.responses:
            for row in response.task.rows:
                if row.name == activity:
                    found = (one.bound for one in response.rows if one.row.name == activity)
                    return next(found, None)
        raise KeyError(activity)

    @property
    def slack(self) -> Fraction | None:
        """The least (deadline - response) / deadline of all activities; None without a bound."""
        least: Fraction | None = None
        for table, response in zip(self.tables, self.responses, strict=True):
            if response.bound is None:
                return None
            bounds = {one.row.name: one.bound for one in response.rows}
            for activity in table:
                slack = Fraction(activity.deadline - bounds[activity.name], activity.deadline)
                least = slack if least is None else min(least, slack)
        return least

    @property
    def met(self) -> bool:
        """Every activity meets its deadline."""
        return self.slack is not None and self.slack >= 0


def allocate(
    activities: Sequence[Movable],
    strategy: Strategy,
    sections: Sequence[Section] = (),
    platforms: Mapping[str, Platform] | None = None,
    above: Sequence[Task] = (),
    *,
    whole: bool = False,
) -> Allocation:
    """The activities put together by that strategy, and the analysis of the result.

    ``sections`` name activities as users. Tasks ``above`` are more urgent than all tables,
    in their own order. With ``whole`` a job must end by the shortest deadline of its table,
    and all rows begin with the first release. The result may miss deadlines: see
    `Allocation.met`. ValueError for a name given twice, and as the analysis.
    """
    distinct("activities", [activity.name for activity in activities])
    tables: list[Table] = []
    for core in dict.fromkeys(activity.core for activity in activities):
        here = [activity for activity in activities if activity.core == core]
        if strategy is Strategy.BY_PERIOD:
            tables += by_period(here)
        elif strategy is Strategy.BY_LOCALITY:
            tables += by_locality(here)
        else:
            names = {activity.name for activity in here}
            mine = [section for section in sections if section.user in names]
            urgent = [task for task in above if task.core == core]

            def check(
                some: Sequence[Table],
                mine: Sequence[Section] = mine,
                urgent: Sequence[Task] = urgent,
            ) -> Allocation:
                return checked(some, mine, platforms, urgent, whole=whole)

            tables += _searched(here, strategy, check)
    return checked(tables, sections, platforms, above, whole=whole)


def by_period(activities: Sequence[Movable]) -> list[Table]:
    """One table for each period."""
    periods = sorted({activity.period for activity in activities})
    return [tuple(a for a in activities if a.period == period) for period in periods]


def by_locality(activities: Sequence[Movable]) -> list[Table]:
    """For each owner, tables of activities whose periods are multiples of the first one's."""
    tables: list[list[Movable]] = []
    for owner in dict.fromkeys(activity.owner for activity in activities):
        first = len(tables)
        mine = [activity for activity in activities if activity.owner == owner]
        for activity in sorted(mine, key=lambda activity: activity.period):
            for table in tables[first:]:
                ratio, rest = divmod(activity.period, table[0].period)
                if rest == 0 and ratio <= WIDEST:
                    table.append(activity)
                    break
            else:
                tables.append([activity])
    return [tuple(table) for table in tables]


def checked(
    tables: Sequence[Table],
    sections: Sequence[Section] = (),
    platforms: Mapping[str, Platform] | None = None,
    above: Sequence[Task] = (),
    *,
    whole: bool = False,
) -> Allocation:
    """The analysis of tables, each in order of deadlines; ValueError for one that is impossible.

    A section that is longer than its whole table counts with the length of the table.
    """
    if whole:
        tables = [tuple(_hurried(table)) for table in tables]
    ordered = tuple(tuple(sorted(table, key=lambda a: a.deadline)) for table in tables)
    urgent = sorted(ordered, key=lambda table: -table[0].deadline)
    level = {table[0].name: number for number, table in enumerate(urgent, 1)}
    tasks = tuple(_task(table, level[table[0].name], phased=not whole) for table in ordered)
    rank = sorted({task.priority for task in above})
    lifted = [replace(task, priority=len(tasks) + 1 + rank.index(task.priority)) for task in above]
    home = {activity.name: table[0].name for table in ordered for activity in table}
    wcets = {table[0].name: sum(activity.wcet for activity in table) for table in ordered}
    held = []
    for section in sections:
        user = home.get(section.user, section.user)
        #  No job is inside an object for longer than it takes.
        length = min(section.length, wcets.get(user, section.length))
        held.append(Section(section.resource, user, length))
    responses = analyse_tasks((*tasks, *lifted), held, platforms)
    return Allocation(ordered, tasks, responses[: len(tasks)])


def _hurried(table: Table) -> Iterator[Movable]:
    """The activities, each with the deadline by which the last must be done."""
    first = min(activity.deadline for activity in table)
    for activity in table:
        yield replace(activity, deadline=first)


def _task(table: Table, priority: int, *, phased: bool) -> Task:
    """The task that executes a table; ``phased``: its phases level the times of its jobs."""
    period = min(activity.period for activity in table)
    for activity in table:
        if activity.period % period:
            raise ValueError(
                f"period of {activity.name} must be a multiple of {period}, "
                f"the shortest of its table, not {activity.period}"
            )
    count = min(FRAME_LIMIT, max(activity.period // period for activity in table))
    wcets = [0] * count
    phases: dict[str, int] = {}
    for activity in sorted(table, key=lambda activity: (activity.period, -activity.wcet)):
        every = activity.period // period
        choice = range(min(every, count)) if phased else range(1)
        phase = min(choice, key=lambda k: max(wcets[k::every]))
        phases[activity.name] = phase
        for k in range(phase, count, every):
            wcets[k] += activity.wcet
    rows = tuple(
        TableRow(activity.name, activity.wcet, activity.period // period, phases[activity.name])
        for activity in table
    )
    deadline = max(activity.deadline for activity in table)
    return Task(table[0].name, priority, period, deadline, core=table[0].core, rows=rows)


Rank = tuple[bool, Fraction, Fraction]
"""The quality of tables: the larger, the better."""


def _rank(tables: Sequence[Table], strategy: Strategy, found: Allocation) -> Rank:
    """Deadlines first; then the aim of the strategy, then the other aim."""
    slack = found.slack
    few = Fraction(-len(tables))
    if slack is None:
        #  Nothing to compare by: tables of few activities are nearest to a bound.
        return False, Fraction(-(10**9)), -few
    if slack < 0:
        return False, slack, few
    return (True, few, slack) if strategy is Strategy.FEWEST_TASKS else (True, slack, few)


def _searched(
    activities: Sequence[Movable],
    strategy: Strategy,
    check: Callable[[Sequence[Table]], Allocation],
) -> list[Table]:
    """The best tables of one core that moves of single activities and tables lead to."""
    alone: list[Table] = [(activity,) for activity in activities]
    left = TRIALS
    best: tuple[Rank, list[Table]] | None = None
    for start in (alone, by_locality(activities), by_period(activities)):
        now = start
        rank = _rank(now, strategy, check(now))
        better = True
        while better and left > 0:
            better = False
            for other in neighbours(now):
                left -= 1
                found = _rank(other, strategy, check(other))
                if found > rank:
                    now, rank, better = other, found, True
                    break
                if left <= 0:
                    break
        if best is None or rank > best[0]:
            best = rank, now
    assert best is not None
    return best[1]


def neighbours(tables: list[Table]) -> Iterator[list[Table]]:
    """Two tables in one; an activity in another table, or in one of its own."""
    for n, one in enumerate(tables):
        for m in range(n):
            if _fit(one + tables[m]):
                yield [*tables[:m], *tables[m + 1 : n], *tables[n + 1 :], tables[m] + one]
    for n, one in enumerate(tables):
        for activity in one if len(one) > 1 else ():
            rest = tuple(other for other in one if other is not activity)
            if not _fit(rest):
                continue
            others = [*tables[:n], *tables[n + 1 :]]
            yield [*others, rest, (activity,)]
            for m, into in enumerate(others):
                if _fit((*into, activity)):
                    yield [*others[:m], *others[m + 1 :], rest, (*into, activity)]


def _fit(table: Table) -> bool:
    """Whether one core has all, periods are multiples of the shortest, and none is too long."""
    shortest = min(activity.period for activity in table)
    return all(
        activity.core == table[0].core
        and activity.period % shortest == 0
        and activity.period // shortest <= FRAME_LIMIT
        for activity in table
    )
