# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Allocation: every strategy's tables hold by the analysis, and search is near the best."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction

import pytest

from ravenchart.analysis.core.allocation import (
    Allocation,
    Movable,
    Strategy,
    Table,
    allocate,
    by_locality,
    by_period,
    checked,
)
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import Task


def names(tables: Sequence[Table]) -> list[list[str]]:
    return [[activity.name for activity in table] for table in tables]


def partitions(items: Sequence[Movable]) -> Iterator[list[Table]]:
    """Every way to put the activities together, possible or not."""
    if not items:
        yield []
        return
    first, *rest = items
    for tables in partitions(rest):
        yield [(first,), *tables]
        for n, table in enumerate(tables):
            yield [*tables[:n], (first, *table), *tables[n + 1 :]]


def some_activities(chance: random.Random, count: int, load: float) -> list[Movable]:
    found = []
    for n in range(count):
        period = 100 * chance.choice((1, 2, 3, 4, 6, 8))
        wcet = max(1, int(period * load / count * chance.uniform(0.4, 1.6)))
        deadline = chance.choice((period, max(wcet, period // 2)))
        found.append(Movable(f"a{n}", period, wcet, deadline, f"o{chance.randint(0, 2)}"))
    return found


def consistent(found: Allocation, activities: Sequence[Movable]) -> None:
    """Every activity is in one table, and the tasks execute the tables as they are."""
    assert sorted(a.name for table in found.tables for a in table) == sorted(
        a.name for a in activities
    )
    for table, task in zip(found.tables, found.tasks, strict=True):
        assert {a.core for a in table} == {task.core}
        assert [row.name for row in task.rows] == [a.name for a in table]
        for activity, row in zip(table, task.rows, strict=True):
            assert row.every * task.period == activity.period


# --- The strategies ---------------------------------------------------------------------


def test_by_period_there_is_one_task_for_each_period() -> None:
    activities = [
        Movable("a", 10, 1, 10, "x"),
        Movable("b", 20, 1, 20, "x"),
        Movable("c", 10, 1, 10, "y"),
        Movable("d", 15, 1, 15, "y"),
    ]
    assert names(by_period(activities)) == [["a", "c"], ["d"], ["b"]]


def test_by_locality_an_owners_activities_share_where_their_rates_fit() -> None:
    activities = [
        Movable("slow", 40, 1, 40, "x"),
        Movable("fast", 10, 1, 10, "x"),
        Movable("odd", 15, 1, 15, "x"),
        Movable("rare", 10 * 17, 1, 170, "x"),
        Movable("other", 10, 1, 10, "y"),
    ]
    assert names(by_locality(activities)) == [["fast", "slow"], ["odd"], ["rare"], ["other"]]


def test_phases_level_what_a_job_costs() -> None:
    activities = tuple(Movable(f"a{n}", 40, 5, 40) for n in range(4))
    found = checked([(Movable("fast", 10, 1, 10), *activities)])
    (task,) = found.tasks
    assert sorted(row.phase for row in task.rows if row.every == 4) == [0, 1, 2, 3]
    assert found.responses[0].bound == 6


def test_an_activitys_own_deadline_counts_and_the_urgent_one_runs_first() -> None:
    activities = (Movable("late", 10, 5, 10), Movable("soon", 10, 2, 3))
    found = checked([activities])
    assert (found.response("soon"), found.response("late")) == (2, 7)
    assert (found.met, found.slack) == (True, Fraction(3, 10))
    with pytest.raises(KeyError):
        found.response("none")


def test_cores_are_kept_apart() -> None:
    activities = [Movable(f"a{n}", 10, 4, 10, core=f"c{n % 2}") for n in range(4)]
    for strategy in Strategy:
        found = allocate(activities, strategy)
        consistent(found, activities)
        assert found.met and len(found.tables) == 2


def test_what_is_impossible_is_refused() -> None:
    with pytest.raises(ValueError, match=r"period of b must be a multiple of 10, .* not 15"):
        checked([(Movable("a", 10, 1, 10), Movable("b", 15, 1, 15))])
    with pytest.raises(ValueError, match="two activities have the name a"):
        allocate([Movable("a", 10, 1, 10)] * 2, Strategy.BY_PERIOD)
    with pytest.raises(ValueError, match="wcet of activity a must be an integer above 0"):
        Movable("a", 10, 0, 10)


def test_an_overload_is_no_allocation_that_meets_deadlines() -> None:
    activities = [Movable(f"a{n}", 10, 6, 10) for n in range(3)]
    for strategy in Strategy:
        found = allocate(activities, strategy)
        consistent(found, activities)
        assert not found.met


# --- Against all there are --------------------------------------------------------------


def best(
    activities: Sequence[Movable], sections: Sequence[Section], platforms: dict[str, Platform]
) -> tuple[int, object]:
    """Fewest tasks and most slack over all partitions that meet every deadline."""
    fewest, slack = len(activities) + 1, None
    for tables in partitions(activities):
        try:
            found = checked(tables, sections, platforms)
        except ValueError:
            continue
        if found.met:
            assert found.slack is not None
            fewest = min(fewest, len(tables))
            slack = found.slack if slack is None else max(slack, found.slack)
    return fewest, slack


@pytest.mark.slow
def test_search_finds_the_best_nearly_always_and_never_a_wrong_one() -> None:
    few, most, possible = 0, 0, 0
    for seed in range(40):
        chance = random.Random(seed)
        activities = some_activities(chance, 5, chance.choice((0.5, 0.8, 0.95)))
        sections = [Section("o", a.name, 1) for a in activities if chance.random() < 0.3]
        platforms = {"": Platform(context_switch=chance.randint(0, 3))}
        fewest, slack = best(activities, sections, platforms)
        small = allocate(activities, Strategy.FEWEST_TASKS, sections, platforms)
        roomy = allocate(activities, Strategy.MOST_SLACK, sections, platforms)
        for found in (small, roomy):
            consistent(found, activities)
            assert found == checked(found.tables, sections, platforms)
        if slack is None:
            assert not small.met and not roomy.met
            continue
        possible += 1
        for strategy in (Strategy.BY_PERIOD, Strategy.BY_LOCALITY):
            simple = allocate(activities, strategy, sections, platforms)
            if simple.met:
                assert small.met and len(small.tables) <= len(simple.tables)
                assert roomy.slack is not None and simple.slack is not None
                assert roomy.slack >= simple.slack
        few += small.met and len(small.tables) == fewest
        most += roomy.slack == slack
    assert possible > 20
    assert few >= possible - 2 and most >= possible - 2, (few, most, possible)


def test_forty_activities_are_searched_in_seconds() -> None:
    activities = some_activities(random.Random(1), 40, 0.7)
    by_rates = allocate(activities, Strategy.BY_PERIOD)
    small = allocate(activities, Strategy.FEWEST_TASKS)
    consistent(small, activities)
    if by_rates.met:
        assert len(small.tables) <= len(by_rates.tables)


def test_whole_jobs_have_the_shortest_deadline_and_no_phases() -> None:
    """b comes with every second a, in the first release too, and is done by the deadline of a."""
    activities = [Movable("a", 100, 20, 60), Movable("b", 200, 30, 200)]
    found = checked([tuple(activities)], whole=True)
    assert [(row.every, row.phase) for row in found.tasks[0].rows] == [(1, 0), (2, 0)]
    assert (found.tasks[0].deadline, found.slack) == (60, Fraction(10, 60))
    parted = checked([tuple(activities)])
    assert parted.tasks[0].deadline == 200


def test_tasks_above_delay_every_table() -> None:
    above = [Task("driver", 1, 100, 100, 10), Task("probe", 2, 100, 100, 5)]
    activities = [Movable("a", 100, 20, 100), Movable("b", 200, 30, 200)]
    for strategy in Strategy:
        found = allocate(activities, strategy, above=above)
        consistent(found, activities)
        assert min(found.response("a") or 0, found.response("b") or 0) >= 35
