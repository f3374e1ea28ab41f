# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Offsets in the analysis of tasks: what they shorten, where they are left out, what is refused."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core import fixed_priority, holistic, offsets
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.changes import stretched
from ravenchart.analysis.core.fixed_priority import analyse_tasks
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.core.sensitivity import network_scaling
from ravenchart.analysis.core.tasks import TableRow, Task, with_full_jobs
from tests.support.priorities import audsley_tasks, with_priorities


def task(name: str, priority: int, wcet: int, period: int, offset: int | None) -> Task:
    return Task(name, priority, period, period, wcet, offset=offset)


def found(*tasks: Task, platform: Platform | None = None) -> dict[str, Response]:
    platforms = {} if platform is None else {"": platform}
    return {r.task.name: r for r in analyse_tasks(tasks, (), platforms)}


def test_tasks_that_never_meet_do_not_delay_each_other() -> None:
    a, b = task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)
    assert [r.bound for r in analyse_tasks([a, b])] == [4, 3]
    assert [r.bound for r in analyse_tasks([replace(a, offset=None), b])] == [4, 7]
    response = found(a, b)["b"]
    assert response.alignment is not None
    assert (response.alignment.start, response.lead) == (5, 0)
    assert response.alignment.tasks == {"a", "b"}
    assert response.interference == ()


def test_nothing_is_known_of_the_distance_of_two_epochs() -> None:
    a, b = task("a", 3, 4, 10, 0), task("b", 2, 3, 10, 5)
    assert found(replace(a, epoch="x"), replace(b, epoch="x"))["b"].bound == 3
    assert found(a, replace(b, epoch="x"))["b"].bound == 4 + 3
    c = Task("c", 1, 20, 20, 1, offset=0, epoch="x")
    assert found(a, b, c)["c"].bound == 4 + 1  # a and b never meet, whenever c comes
    assert found(a, replace(b, epoch="y"), c)["c"].bound == 4 + 3 + 1
    with pytest.raises(ValueError, match="epoch of task a has no meaning: it has no offset"):
        replace(a, offset=None, epoch="x")


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.sampled_from((4, 6, 8, 12)), st.integers(1, 3), st.integers(0, 11), st.booleans()
        ),
        min_size=2, max_size=5,
    )
)  # fmt: skip
def test_no_distance_of_two_epochs_makes_a_longer_response(
    some: list[tuple[int, int, int, bool]],
) -> None:
    tasks = [
        Task(f"t{n}", n, period, 30, wcet, offset=offset, epoch="x" if apart else "")
        for n, (period, wcet, offset, apart) in enumerate(some)
    ]
    bounds = fixed_priority.bounds([one.at_any_time() for one in tasks])
    assume(None not in bounds)
    responses = analyse_tasks(tasks)
    for shift in range(24):
        known = [
            replace(one, epoch="", offset=(one.offset or 0) + (shift if one.epoch else 0))
            for one in tasks
        ]
        for exact, several, free in zip(analyse_tasks(known), responses, bounds, strict=True):
            assert exact.bound is not None and several.bound is not None and free is not None
            assert exact.bound <= several.bound <= free


def test_a_busy_period_may_begin_before_the_worst_job_arrives() -> None:
    """a runs in 0 .. 6; b arrives at 2 and waits for 4 of it."""
    response = found(task("a", 2, 6, 20, 0), task("b", 1, 3, 20, 2))["b"]
    assert (response.bound, response.lead, response.window) == (7, 2, 9)
    assert [(i.task.name, i.releases, i.time) for i in response.interference] == [("a", 1, 6)]


def test_rows_count_in_their_own_release() -> None:
    """The long rows of both tables are due in turns, so they never meet."""
    rows = TableRow("short", 1), TableRow("long", 4, every=2, phase=0)
    other = TableRow("short", 1), TableRow("long", 4, every=2, phase=1)
    a = Task("a", 2, 10, 10, rows=rows, offset=0)
    b = Task("b", 1, 10, 10, rows=other, offset=0)
    assert found(a, b)["b"].bound == 1 + 5
    assert {r.row.name: r.bound for r in found(a, b)["b"].rows} == {"short": 5 + 1, "long": 1 + 5}
    assert found(a, replace(b, offset=10))["b"].bound == 5 + 5
    assert found(replace(a, offset=None), b)["b"].bound == 5 + 5
    assert found(with_full_jobs(a), with_full_jobs(b))["b"].bound == 5 + 5


def test_jitter_brings_jobs_together_that_offsets_keep_apart() -> None:
    a, b = task("a", 2, 4, 20, 0), task("b", 1, 3, 20, 5)
    found_with = [found(replace(a, jitter=late), b)["b"].bound for late in (0, 1, 2, 5, 19)]
    assert found_with == [3, 3, 4, 7, 7]
    platform = Platform(tick_period=2)
    timed = [replace(a, timed=True), replace(b, timed=True)]
    assert found(*timed, platform=platform)["b"].bound == 2 + 3


def test_overheads_count_as_without_offsets() -> None:
    """Two switches a job, two releases of each in the window, a tick for every four units."""
    platform = Platform(context_switch=1, release=1, tick_period=50, tick_wcet=1)
    a, b = task("a", 2, 4, 100, 0), task("b", 1, 3, 100, 50)
    response = found(a, b, platform=platform)["b"]
    assert response.bound == 3 + 2 + 1 + 1
    assert response.overheads.time == 2 + 1 + 1
    lower = task("low", 0, 1, 100, 25)
    assert found(a, b, lower, platform=platform)["b"].bound == 3 + 2 + 2 + 1


def test_the_section_of_a_less_urgent_task_still_holds_up() -> None:
    a, b = task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)
    sections = (Section("o", "a", 1), Section("o", "b", 2))
    assert [r.bound for r in analyse_tasks([a, b], sections)] == [6, 3]


def test_an_offset_counts_from_its_first_job_on() -> None:
    """A period later is the same, but for a table whose second release is then the first."""
    a, b = task("a", 2, 4, 10, 3), task("b", 1, 3, 10, 8)
    assert found(a, b)["b"].bound == found(replace(a, offset=123), b)["b"].bound == 3


def test_tasks_of_one_core_only_are_laid_against_each_other() -> None:
    a, b = task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)
    c = replace(task("c", 3, 2, 10, None), core="other")
    assert found(a, b, c)["b"].bound == 3
    assert found(replace(a, core="other"), b, c)["b"].alignment is None


def test_what_would_make_too_many_instants_counts_at_any_time() -> None:
    """10007 and 10009 have no common multiple below 10^8."""
    a, b = task("a", 9, 30, 100, 0), task("b", 8, 20, 100, 50)
    odd, odder = task("odd", 7, 5, 10_007, 0), task("odder", 6, 10, 10_009, 0)
    response = found(a, b, odd, odder)["odder"]
    assert response.alignment is not None
    assert response.alignment.tasks == {"a", "b"}
    assert response.bound == 30 + 5 + 10
    assert found(replace(a, offset=None), b, odd, odder)["odder"].bound == 30 + 20 + 5 + 10


def test_without_effort_the_bound_is_that_for_all_offsets(monkeypatch: pytest.MonkeyPatch) -> None:
    a, b = task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)
    monkeypatch.setattr(fixed_priority, "OFFSETS_EFFORT", 3)
    assert (found(a, b)["b"].bound, found(a, b)["b"].alignment) == (7, None)


def test_many_tasks_with_random_offsets_end_soon() -> None:
    chance = random.Random(1)
    periods = [chance.choice((7, 11, 13, 17, 19, 23)) * 1_000 for _ in range(150)]
    tasks = [
        task(f"t{n}", n, max(1, period // 160), period, chance.randrange(period))
        for n, period in enumerate(periods)
    ]
    some = analyse_tasks(tasks)
    blind = analyse_tasks([replace(t, offset=None) for t in tasks])
    assert all(s.bound and b.bound and s.bound <= b.bound for s, b in zip(some, blind, strict=True))
    assert any(s.alignment is not None for s in some)


@pytest.mark.parametrize("spare", [1, 10**6])
def test_a_core_just_under_full_load_ends(spare: int) -> None:
    """A section, and all but one part in 10^12 of the time: no window settles soon."""
    period = 10**12
    tasks = [task(f"t{n}", 9 - n, 10 - n, 40, n) for n in range(4)]
    tasks.append(task("low", 1, 6 * period // 40 - spare, period, 7))
    sections = Section("o", "low", 5), Section("o", "t0", 1)
    some = {r.task.name: r for r in analyse_tasks(tasks, sections)}
    blind = {
        r.task.name: r for r in analyse_tasks([replace(t, offset=None) for t in tasks], sections)
    }
    for name, response in some.items():
        bound, other = response.bound, blind[name].bound
        assert (bound is None) == (other is None)
        assert bound is None or other is None or bound <= other


def test_an_order_is_found_that_only_offsets_allow() -> None:
    tight = Task("tight", 1, 10, 3, 3, offset=5), Task("late", 2, 10, 4, 4, offset=0)
    order = audsley_tasks(tight)
    assert order.complete
    assert all(r.met for r in analyse_tasks(with_priorities(tight, order)))
    assert not audsley_tasks([replace(t, offset=None) for t in tight]).complete


def test_which_offsets_are_used_does_not_depend_on_priorities() -> None:
    chance = random.Random(7)
    periods = (7, 10, 11, 13, 100, 1_000, 9_973, 10_007)
    tasks = [task(f"t{n}", n, 1, t, chance.randrange(t)) for n, t in enumerate(periods)]
    chosen = set()
    for _ in range(20):
        chance.shuffle(tasks)
        order = [replace(t, priority=9 - n) for n, t in enumerate(tasks)]
        lowest = replace(task("low", 0, 1, 10_000, None))
        names = {t.name for t in offsets.aligned(analyse_tasks([*order, lowest])[-1])}
        chosen.add(frozenset(names))
    assert len(chosen) == 1


def test_a_longer_period_has_no_known_offset() -> None:
    network = Network((task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)))
    longer = stretched(network, "a", Fraction(3, 2))
    assert [t.offset for t in longer.tasks] == [None, 5]


def test_what_cannot_have_an_offset_is_refused() -> None:
    with pytest.raises(ValueError, match="offset of task a must be an integer from 0 up, not -1"):
        task("a", 1, 1, 10, -1)
    with pytest.raises(ValueError, match="offset of task a has no meaning: it is sporadic"):
        Task("a", 1, 10, 10, 1, sporadic=True, offset=0)
    a, b = task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)
    with pytest.raises(ValueError, match="offset of b has no meaning: a releases it"):
        Network((a, b), released_by={"b": "a"})


def test_searches_look_at_offsets_only_where_they_can_help() -> None:
    network = Network((task("a", 2, 4, 10, 0), task("b", 1, 3, 10, 5)))
    tight = replace(network, tasks=(network.tasks[0], replace(network.tasks[1], deadline=4)))
    assert len(list(holistic.analyses(tight))) == 2
    assert holistic.met(tight)
    blind = replace(tight, tasks=tuple(replace(t, offset=None) for t in tight.tasks))
    assert len(list(holistic.analyses(blind))) == 1
    assert not holistic.met(blind)
    over = replace(tight, tasks=(*tight.tasks, task("c", 3, 5, 10, 0)))
    assert len(list(holistic.analyses(over))) == 1
    scaling = network_scaling(tight, None, 4)
    assert scaling is not None
    assert (scaling.factor, scaling.binding) == (Fraction(5, 4), "b")
