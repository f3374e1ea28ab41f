# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Assignment, scaling, growth and the binding constraint, against trying everything."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import permutations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core import can, fixed_priority
from ravenchart.analysis.core.assignment import (
    Order,
    audsley_frames,
    deadline_monotonic,
)
from ravenchart.analysis.core.blocking import Section, blockers
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.sensitivity import growth, scaled, scaling, tightest
from ravenchart.analysis.core.tasks import TableRow, Task
from tests.support.priorities import audsley_tasks, with_priorities, with_ranks


def met(tasks: list[Task] | tuple[Task, ...], sections: list[Section]) -> bool:
    return all(r.met for r in fixed_priority.analyse_tasks(tasks, sections))


@st.composite
def task_sets(draw: st.DrawFn) -> tuple[list[Task], list[Section]]:
    tasks = []
    for index in range(draw(st.integers(1, 4))):
        period = draw(st.integers(4, 24))
        deadline, late = draw(st.integers(3, 40)), draw(st.integers(0, 3))
        tasks.append(Task(f"t{index}", 0, period, deadline, draw(st.integers(1, 5)), late))
    sections = [
        Section(f"o{draw(st.integers(0, 1))}", t.name, draw(st.integers(1, t.wcet)))
        for t in tasks
        if draw(st.booleans())
    ]
    return tasks, sections


@settings(max_examples=200, deadline=None)
@given(task_sets())
def test_a_blocking_that_is_given_counts_as_the_section_that_it_stands_for(
    some: tuple[list[Task], list[Section]],
) -> None:
    ordered = [replace(task, priority=number) for number, task in enumerate(some[0])]
    held = blockers(ordered, some[1])
    given = [
        replace(task, held=held[task.name].length) if task.name in held else task
        for task in ordered
    ]
    wanted = fixed_priority.analyse_tasks(ordered, some[1])
    found = fixed_priority.analyse_tasks(given)
    assert [(r.bound, r.blocked) for r in found] == [(r.bound, r.blocked) for r in wanted]
    assert fixed_priority.bounds(given) == fixed_priority.bounds(ordered, some[1])


def test_a_blocking_that_is_given_is_suffered_besides_the_sections() -> None:
    tasks = [Task("high", 2, 20, 20, 3, held=4), Task("low", 1, 20, 20, 5)]
    high, low = fixed_priority.analyse_tasks(
        tasks, [Section("o", "low", 2), Section("o", "high", 1)]
    )
    assert (high.bound, high.blocked) == (3 + 4 + 2, 6)
    assert (low.bound, low.blocked) == (8, 0)


@pytest.mark.parametrize("count", [2, 40])
def test_many_tasks_are_held_up_as_few_are(count: int) -> None:
    tasks = [Task(f"t{n}", n, 1000 + n, 1000, 2, held=5 + n) for n in range(count)]
    wanted = [2 * (count - n) + 5 + n for n in range(count)]
    assert list(fixed_priority.bounds(tasks)) == wanted
    assert [r.bound for r in fixed_priority.analyse_tasks(tasks)] == wanted


@settings(max_examples=150, deadline=None)
@given(task_sets())
def test_audsley_finds_an_order_exactly_when_there_is_one(
    drawn: tuple[list[Task], list[Section]],
) -> None:
    tasks, sections = drawn
    names = [task.name for task in tasks]
    some = any(met(with_priorities(tasks, Order(order)), sections) for order in permutations(names))
    found = audsley_tasks(tasks, sections)
    assert found.complete == some
    assert set(found.names) | set(found.unplaced) == set(names)
    if some:
        assert met(with_priorities(tasks, found), sections)


@pytest.mark.slow
@settings(max_examples=100, deadline=None)
@given(task_sets(), st.integers(0, 3), st.sets(st.integers(0, 3)))
def test_audsley_finds_identifiers_exactly_when_there_are_some(
    drawn: tuple[list[Task], list[Section]], unknown: int, queued: set[int]
) -> None:
    bus = Bus(1, unknown)
    frames = [
        Frame(t.name, n, t.period, t.deadline, t.wcet, t.jitter, "q" * (n in queued), reloaded=True)
        for n, t in enumerate(drawn[0])
    ]

    def good(order: Order) -> bool:
        ranked = with_ranks(frames, order, range(len(frames)))
        return all(r.met for r in can.analyse(ranked, bus))

    found = audsley_frames(frames, bus)
    assert found.complete == any(
        good(Order(order)) for order in permutations(f.name for f in frames)
    )
    assert not found.complete or good(found)


def test_a_frame_that_fills_its_bus_is_placed_as_it_is_analysed() -> None:
    """It may be late once, and is never early again: its queue may never be empty."""
    bus, frame = Bus(1, unknown=1), Frame("m", 0, 4, 8, 4, queue="q", reloaded=True)
    assert not audsley_frames([frame], bus).complete
    assert can.analyse([frame], bus)[0].bound is None


def test_no_frame_is_placed_below_a_queue_whose_delay_has_no_bound() -> None:
    bus = Bus(1, unknown=1)
    frames = [Frame("m", 0, 4, 120, 2), Frame("queued", 1, 4, 99, 2, queue="q", reloaded=True)]
    assert [r.bound is None for r in can.analyse(frames, bus)] == [False, True]
    assert audsley_frames(frames, bus).names == ()
    alone = can.analyse([replace(frame, queue="") for frame in frames], bus)
    assert [r.bound for r in alone] == [4, 5]


def test_deadline_monotonic_goes_by_deadline_less_jitter() -> None:
    tasks = [Task("a", 0, 20, 10, 1), Task("b", 0, 20, 12, 1, jitter=3), Task("c", 0, 20, 10, 1)]
    assert [t.name for t in deadline_monotonic(tasks)] == ["b", "a", "c"]


def test_what_cannot_be_ordered_is_refused() -> None:
    with pytest.raises(ValueError, match="several cores"):
        audsley_tasks([Task("a", 0, 9, 9, 1), Task("b", 0, 9, 9, 1, core="other")])
    with pytest.raises(ValueError, match="queue of message m must be empty here, or reloaded"):
        audsley_frames([Frame("m", 0, 9, 9, 1, queue="q")], Bus(1))


# --- Room ------------------------------------------------------------------------------


def test_the_factor_is_the_last_step_that_meets_every_deadline() -> None:
    tasks = [Task("a", 2, 100, 50, 20), Task("b", 1, 200, 200, 60)]
    found = scaling(tasks)
    assert found is not None and found.binding is not None
    #  20 f <= 50, and 60 f + 2 x 20 f <= 200 up to f = 2
    assert (found.factor, found.binding.task.name) == (Fraction(2), "b")
    short = scaling([Task("a", 1, 30, 30, 90)])
    assert short is not None and short.factor == Fraction(3_333, 10_000)
    assert scaling([Task("a", 1, 30, 30, 90)], steps=3) is not None
    assert scaling([Task("a", 1, 30, 30, 9, jitter=30)]) is None


def test_sections_and_rows_grow_with_the_rest() -> None:
    tasks = [Task("a", 2, 100, 30, 10), Task("b", 1, 1_000, 1_000, 10)]
    found = scaling(tasks, [Section("o", "a", 1), Section("o", "b", 10)])
    assert found is not None and found.factor == Fraction(3, 2)
    table = Task("t", 1, 10, 10, 1, rows=(TableRow("r", 3),))
    grown = scaled(table, Fraction(3, 2))
    assert (grown.wcet, grown.rows[0].wcet) == (2, 5)


@settings(max_examples=60, deadline=None)
@given(task_sets())
def test_growth_of_one_task_is_found_by_counting(drawn: tuple[list[Task], list[Section]]) -> None:
    tasks = [replace(t, priority=9 - n) for n, t in enumerate(drawn[0])]
    sections = drawn[1]
    for n, one in enumerate(tasks):
        room = growth(one.name, tasks, sections)
        more = -1
        while met([*tasks[:n], replace(one, wcet=one.wcet + more + 1), *tasks[n + 1 :]], sections):
            more += 1
        assert room == (None if more < 0 else more)


def test_the_tightest_come_first_and_no_bound_before_all() -> None:
    tasks = [Task("a", 4, 10, 10, 1), Task("b", 3, 10, 5, 3), Task("c", 2, 10, 7, 4)]
    found = tightest(fixed_priority.analyse_tasks([*tasks, Task("d", 1, 9, 9, 9)]))
    assert [r.task.name for r in found] == ["d", "c", "b", "a"]
