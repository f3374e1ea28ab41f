# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tasks: parameters refused, overheads, blocking, tables, limits, and what always holds."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core.blocking import Section, blockers, ceilings
from ravenchart.analysis.core.fixed_priority import analyse_tasks, response_under
from ravenchart.analysis.core.multiframe import Demand
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.responses import Reason, Response
from ravenchart.analysis.core.tasks import TableRow, Task, with_full_jobs
from tests.support.core_cases import cases, sections_of, tasks_of


def task(name: str, priority: int, wcet: int, period: int, **more: Any) -> Task:
    return Task(name, priority, period, more.pop("deadline", period), wcet, **more)


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (lambda: task("a", 1, 1, 0), "period of task a must be an integer above 0, not 0"),
        (lambda: task("a", 1, 0, 9), "wcet of task a must be an integer above 0, not 0"),
        (lambda: task("a", 1, -3, 9), "wcet of task a must be an integer above 0, not -3"),
        (lambda: task("a", 1, 1, 9, deadline=0), "deadline of task a must be an integer above 0"),
        (lambda: task("a", 1, 1, 9, jitter=-1), "jitter of task a must be an integer from 0 up"),
        (lambda: task("a", 1, 1, 9.5), "period of task a must be an integer above 0, not 9.5"),  # type: ignore[arg-type]
        (lambda: TableRow("r", 0), "wcet of row r must be an integer above 0, not 0"),
        (lambda: TableRow("r", 1, 2, 2), "phase of row r must be below 2, not 2"),
        (lambda: Section("o", "a", 0), "length of the section of a on o must be an integer above"),
        (lambda: Platform(tick_wcet=1), "tick_period of the platform must be above 0"),
        (lambda: Platform(release=-1), "release of the platform must be an integer from 0 up"),
        (lambda: analyse_tasks([task("a", 1, 1, 9)] * 2), "two tasks have the name a"),
        (
            lambda: task("a", 1, 0, 9, rows=(TableRow("r", 1), TableRow("r", 2))),
            "two rows of task a have the name r",
        ),
        (
            lambda: analyse_tasks([task("a", 1, 2, 9)], [Section("o", "a", 3)]),
            "the section of a on o must be at most 2, the WCET of the task, not 3",
        ),
        (
            lambda: ceilings([task("a", 2, 2, 9)], [Section("o", "a", 1)], {"o": 1}),
            "ceiling of o must be at least 2, the priority of task a",
        ),
        (
            lambda: ceilings(
                [task("a", 2, 2, 9), task("b", 1, 2, 9, core="other")],
                [Section("o", "a", 1), Section("o", "b", 1)],
            ),
            "users of o are on several cores",
        ),
    ],
)
def test_what_has_no_meaning_is_refused_by_name(made: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        made()


# --- The terms -----------------------------------------------------------------------


def test_the_breakdown_adds_up_by_hand() -> None:
    #  c: w = 5 + ceil(20/7) 3 + ceil(20/12) 3 = 5 + 9 + 6 = 20
    c = analyse_tasks([task("a", 3, 3, 7), task("b", 2, 3, 12), task("c", 1, 5, 20)])[2]
    assert [(i.task.name, i.releases, i.time) for i in c.interference] == [("a", 3, 9), ("b", 2, 6)]
    assert (c.own, c.blocked, c.bound, c.jobs, c.slack, c.met) == (5, 0, 20, 1, 0, True)


def test_equal_priorities_interfere_both_ways_and_do_not_block() -> None:
    pair = [task("a", 5, 2, 20), task("b", 5, 3, 20)]
    sections = [Section("o", "a", 2), Section("o", "b", 3)]
    assert [(r.bound, r.blocked) for r in analyse_tasks(pair, sections)] == [(5, 0), (5, 0)]


def test_one_tick_past_the_deadline_is_a_miss() -> None:
    interfering = task("a", 2, 3, 10)
    for wcet, met in ((4, True), (5, False)):
        assert analyse_tasks([interfering, task("b", 1, wcet, 20, deadline=7)])[1].met == met


def test_tasks_of_other_cores_do_not_meet() -> None:
    far = task("z", 9, 9, 10, core="other")
    assert [r.bound for r in analyse_tasks([task("a", 1, 5, 10), far])] == [5, 9]


def test_bystanders_are_blocked_and_an_interrupt_ceiling_blocks_the_interrupt() -> None:
    tasks = [task("irq", 9, 1, 50), task("mid", 2, 1, 50), task("low", 1, 8, 50)]
    sections = [Section("log", "low", 4), Section("device", "low", 6)]
    held = blockers(tasks, sections, {"log": 2, "device": 9})
    assert {name: (s.resource, s.length) for name, s in held.items()} == {
        "irq": ("device", 6),
        "mid": ("device", 6),
    }


def test_a_user_that_is_no_task_blocks_all_below_the_ceiling() -> None:
    tasks = [task("high", 3, 1, 50), task("low", 1, 5, 50)]
    held = blockers(tasks, [Section("o", "low", 2), Section("o", "main", 7)], {"o": 3})
    assert {name: section.user for name, section in held.items()} == {"high": "main", "low": "main"}


def test_sections_block_on_their_own_core_only() -> None:
    tasks = [task("a", 5, 3, 50), task("b", 1, 3, 50), task("c", 3, 3, 50, core="other")]
    held = blockers(tasks, [Section("o", "a", 1), Section("o", "b", 2)])
    assert {name: section.user for name, section in held.items()} == {"a": "b"}


def test_overheads_by_hand() -> None:
    platform = Platform(context_switch=1, release=2, tick_period=50, tick_wcet=3)
    tasks = [task("a", 2, 10, 100, timed=True), task("b", 1, 20, 200)]
    #  b: 20 + 2 switches; a: 10 + 2, once for w <= 50; a tick in 50; a release of each
    a, b = analyse_tasks(tasks, (), {"": platform})
    assert (b.window, b.bound) == (22 + 12 + 3 + 4, 41)
    #  a is late by a tick's period: b's release costs it time although b is below it
    assert (a.jitter, a.window, a.bound) == (50, 12 + 3 + 4, 69)
    o = b.overheads
    assert (o.switches, o.switch_time, o.ticks, o.tick_time) == (4, 4, 1, 3)
    assert (o.releases, o.release_time, o.time) == (2, 4, 11)
    assert b.level.load == Fraction(12, 100) + Fraction(22, 200) + Fraction(3, 50) + Fraction(
        3, 100
    )


# --- Tables ----------------------------------------------------------------------------


def test_demand_is_the_worst_of_all_first_frames() -> None:
    demand = Demand((5, 0, 3, 3))
    assert [demand.most(k) for k in range(6)] == [0, 5, 8, 11, 11, 16]
    assert [demand.first(k) for k in range(1, 4)] == [0, 3, 2]
    assert [demand.before(k, 0) for k in range(6)] == [0, 3, 6, 6, 11, 14]


def test_a_table_runs_as_it_is_and_beside_it_the_plain_sum() -> None:
    rows = (TableRow("fast", 2), TableRow("slow", 3, 4, 1), TableRow("other", 4, 4, 3))
    table = task("table", 2, 1, 20, rows=rows)
    assert [sum(r.wcet for r in frame) for frame in table.frames] == [2, 5, 2, 6]
    below = task("below", 1, 14, 80)
    exact = analyse_tasks([table, below])
    assert [r.bound for r in exact] == [7, 14 + 7 + 3]
    assert {r.row.name: (r.bound, r.frame) for r in exact[0].rows} == {
        "fast": (3, 0),
        "slow": (6, 1),
        "other": (7, 3),
    }
    assert [r.bound for r in analyse_tasks([with_full_jobs(table), below])] == [10, 14 + 2 * 10]
    assert (exact[1].interference[0].frame, exact[1].interference[0].releases) == (2, 2)


def test_a_table_that_hardly_repeats_counts_in_full() -> None:
    rows = tuple(TableRow(f"r{n}", 1, n) for n in (7, 11, 13, 17))
    long = task("long", 1, 1, 100, rows=rows)
    assert long.frame_count == 1
    assert analyse_tasks([long])[0].bound == analyse_tasks([with_full_jobs(long)])[0].bound == 5


# --- Limits ----------------------------------------------------------------------------


def test_full_load_has_bounds_and_more_has_none() -> None:
    assert [r.bound for r in analyse_tasks([task("a", 2, 1, 2), task("b", 1, 2, 4)])] == [1, 4]
    a, b, c = analyse_tasks([task("a", 3, 6, 10), task("b", 2, 5, 10), task("c", 1, 1, 10)])
    assert (a.met, b.bound, b.reason, c.reason) == (True, None, Reason.OVERLOAD, Reason.OVERLOAD)
    assert b.level.load == Fraction(11, 10)
    assert (b.interference, b.slack, b.overheads.time) == ((), None, 0)


def test_jitter_beyond_the_period_releases_several_jobs_at_once() -> None:
    #  at 0 the jobs of -25, -15 and -5 are released, and of b one
    a, b = analyse_tasks([task("a", 2, 3, 10, jitter=25), task("b", 1, 1, 17)])
    assert (a.bound, b.bound, b.interference[0].releases) == (28, 10 + 3, 4)


@pytest.mark.parametrize("spare", [1, 1_000, 10**6])
def test_huge_hyperperiods_just_under_full_load_end(spare: int) -> None:
    tasks = [task("a", 3, 499_979, 999_983), task("b", 2, 500_000_000 - spare, 1_000_000_007)]
    for response in analyse_tasks([*tasks, task("c", 1, 1, 10**9)]):
        assert response.bound is not None or response.reason is Reason.EFFORT


def test_full_load_of_coprime_periods_ends_without_a_bound() -> None:
    first, second = 1_000_003, 999_983
    wcet = (first - 1) * second // first
    tasks = [task("a", 2, 1, first, jitter=5), task("b", 1, wcet, second, jitter=second)]
    a, b = analyse_tasks(tasks)
    assert a.bound == 6
    assert b.bound is not None or b.reason is Reason.EFFORT


def test_numbers_beyond_64_bits_are_exact() -> None:
    year = 10**30
    a, b = analyse_tasks([task("a", 2, year // 2, year), task("b", 1, year // 2 - 1, year)])
    assert (a.bound, b.bound) == (year // 2, year - 1)


def test_many_tasks_of_one_priority_and_five_thousand_levels() -> None:
    assert {r.bound for r in analyse_tasks([task(f"t{n}", 1, 1, 1_000) for n in range(300)])} == {
        300
    }
    many = [task(f"t{n}", n, 1, 10_000 + n) for n in range(5_000)]
    assert [r.bound for r in analyse_tasks(many)] == list(range(5_000, 0, -1))


# --- What always holds -------------------------------------------------------------------


@st.composite
def systems(draw: st.DrawFn) -> tuple[list[Task], list[Section], Platform]:
    """One to four tasks with short periods, tables, jitter, ties and sections."""
    tasks = []
    for index in range(draw(st.integers(1, 4))):
        rows = tuple(
            TableRow(f"r{n}", draw(st.integers(1, 3)), every, draw(st.integers(0, every - 1)))
            for n, every in enumerate(draw(st.lists(st.integers(1, 3), max_size=3)))
        )
        period = draw(st.integers(4, 30))
        made = task(f"t{index}", draw(st.integers(1, 4)), draw(st.integers(1, 4)), period)
        late = draw(st.integers(0, 9))
        offset = draw(st.none() | st.integers(0, 60))
        timed = draw(st.booleans())
        tasks.append(replace(made, rows=rows, jitter=late, timed=timed, offset=offset))
    sections = [
        Section(f"o{draw(st.integers(0, 1))}", t.name, draw(st.integers(1, t.plain_wcet)))
        for t in tasks
    ]
    return tasks, sections, draw(st.sampled_from([Platform(), Platform(1, 1, 9, 1)]))


def adds_up(r: Response) -> bool:
    window = r.blocked + r.own + sum(i.time for i in r.interference) + r.overheads.time
    if r.alignment is None:
        assert r.lead == r.worst_job * r.task.period - r.jitter
    return window == r.window and r.bound == window - r.lead


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(systems())
def test_the_terms_add_up_and_rows_end_with_their_job(
    system: tuple[list[Task], list[Section], Platform],
) -> None:
    tasks, sections, platform = system
    for r in analyse_tasks(tasks, sections, {"": platform}):
        if r.bound is not None:
            assert adds_up(r), r
            assert 0 <= r.worst_job < r.jobs
            assert all(row.bound <= r.bound for row in r.rows)


@settings(max_examples=200, deadline=None)
@given(systems(), st.sampled_from(["wcet", "jitter", "priority", "section", "platform", "plain"]))
def test_no_bound_falls_when_load_grows(
    system: tuple[list[Task], list[Section], Platform], what: str
) -> None:
    tasks, sections, platform = system
    grown, held, worse = list(tasks), list(sections), platform
    if what == "wcet":
        grown[0] = replace(tasks[0], wcet=tasks[0].wcet + 1)
    elif what == "jitter":
        grown[0] = replace(tasks[0], jitter=tasks[0].jitter + 1)
    elif what == "priority":
        grown.append(task("extra", 5, 1, 7))
    elif what == "section":
        grown.append(task("extra", 0, 5, 99))
        held.append(Section("o0", "extra", 5))
    elif what == "platform":
        worse = replace(platform, context_switch=platform.context_switch + 1)
    else:
        grown = [with_full_jobs(t) for t in tasks]
    before = analyse_tasks(tasks, sections, {"": platform})
    after = analyse_tasks(grown, held, {"": worse})
    for old, new in zip(before, after, strict=False):
        assert new.bound is None or (old.bound is not None and new.bound >= old.bound)


@settings(max_examples=100, deadline=None)
@given(systems())
def test_one_response_alone_is_the_same(
    system: tuple[list[Task], list[Section], Platform],
) -> None:
    tasks, sections, platform = system
    held = blockers(tasks, sections)
    for r in analyse_tasks(tasks, sections, {"": platform}):
        interfering = [t for t in tasks if t.priority >= r.task.priority and t is not r.task]
        below = [t for t in tasks if t.priority < r.task.priority]
        alone = response_under(r.task, interfering, below, held.get(r.task.name), platform)
        assert (alone.bound, alone.window, alone.alignment) == (r.bound, r.window, r.alignment)


@pytest.mark.slow
@settings(max_examples=300, deadline=None)
@given(systems())
def test_offsets_only_make_bounds_shorter(
    system: tuple[list[Task], list[Section], Platform],
) -> None:
    tasks, sections, platform = system
    blind = [replace(task, offset=None) for task in tasks]
    for known, any_ in zip(
        analyse_tasks(tasks, sections, {"": platform}),
        analyse_tasks(blind, sections, {"": platform}),
        strict=True,
    ):
        assert known.reason is any_.reason
        if known.bound is None or any_.bound is None:
            assert known.bound is any_.bound
            continue
        assert known.bound <= any_.bound
        assert all(k.bound <= a.bound for k, a in zip(known.rows, any_.rows, strict=True))
        assert known.alignment is not None or known.bound == any_.bound


def test_the_reference_cases_add_up() -> None:
    for case in cases("rta.json", "fp"):
        assert all(adds_up(r) for r in analyse_tasks(tasks_of(case), sections_of(case)))


def test_each_suspension_of_a_job_costs_two_switches_and_a_release() -> None:
    platform = {"": Platform(context_switch=5, release=3)}
    fast = task("fast", 2, 10, 100, suspensions=2)
    low = task("low", 1, 20, 1_000)
    found = {r.task.name: r for r in analyse_tasks([fast, low], (), platform)}
    #  each job of `fast`: 10 + 4 x 5, and 2 x 3 to make it ready
    assert found["fast"].bound == 10 + 4 * 5 + 2 * 3 + 3
    assert found["low"].bound == 20 + 2 * 5 + 3 + 10 + 4 * 5 + 2 * 3
    assert (found["low"].overheads.switches, found["low"].overheads.releases) == (6, 3)
    assert found["low"].level.load == Fraction(30 + 6, 100) + Fraction(30 + 3, 1_000)
    with pytest.raises(ValueError, match="suspensions of task a must be an integer above 0"):
        task("a", 1, 1, 9, suspensions=0)
