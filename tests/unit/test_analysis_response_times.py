"""The response-time analysis: reference figures, hand-checked details, properties."""

from __future__ import annotations

import json
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from analysis.response_times import (
    Analysis,
    Blocking,
    Verdict,
    analyse,
    growth_margin,
    response_times,
)
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from gen.model import SharedObject, Task
from tests.support.simulation import longest_responses
from tests.support.systems import shared, system, task

REFERENCE = Path(__file__).parents[1] / "reference" / "rta.json"


def reference_cases() -> list[Any]:
    cases = json.loads(REFERENCE.read_text(encoding="utf-8"))["cases"]
    return [pytest.param(c, id=c["name"]) for c in cases if c["model"] == "fp"]


def read_case(case: Any) -> tuple[list[Task], list[SharedObject]]:
    tasks = [
        task(t["name"], t["prio"], t["C"], t["T"], t["D"], t.get("J", 0)) for t in case["tasks"]
    ]
    sections: dict[str, list[tuple[str, int, int]]] = {}
    for t in case["tasks"]:
        for name, length in t.get("cs", []):
            sections.setdefault(name, []).append((t["name"], t["prio"], length))
    objects = [
        shared(
            name,
            max(p for _, p, _ in users),
            max(s for _, _, s in users),
            *(user for user, _, _ in users),
        )
        for name, users in sections.items()
    ]
    return tasks, objects


@pytest.mark.parametrize("case", reference_cases())
def test_reference_cases_are_reproduced_exactly(case: Any) -> None:
    for response in response_times(*read_case(case)):
        expected = case["expected"][response.task.element]
        assert response.bound == expected["R"]
        assert (response.verdict is Verdict.MET) == expected["ok"]
        assert response.worst_job == expected.get("worst_job", 0)
        assert response.blocked == expected.get("B", 0)


def test_every_model_of_the_reference_file_is_accounted_for() -> None:
    assert len(reference_cases()) == 6


def test_the_breakdown_adds_up_by_hand() -> None:
    #  c: w = 5 + ceil(20/7) 3 + ceil(20/12) 3 = 5 + 9 + 6 = 20
    tasks = [task("a", 3, 3, 7), task("b", 2, 3, 12), task("c", 1, 5, 20)]
    c = analyse(system(tasks)).response("c")
    assert [(i.element, i.releases, i.time) for i in c.interference] == [("a", 3, 9), ("b", 2, 6)]
    assert (c.own, c.blocked, c.bound, c.jobs, c.slack) == (5, 0, 20, 1, 0)


def test_the_second_job_of_the_busy_period_can_be_the_worst() -> None:
    #  b: w(0) = 14 + 2 x 3 = 20 > 19; w(1) = 28 + 4 x 3 = 40 - 19 = 21
    b = response_times([task("a", 2, 3, 12), task("b", 1, 14, 19, 25)])[1]
    assert (b.bound, b.worst_job, b.own, b.interference[0].releases) == (21, 1, 28, 4)
    assert b.jobs >= 2


def test_response_equal_to_deadline_passes_and_one_nanosecond_more_fails() -> None:
    tight = [task("a", 2, 3, 10), task("b", 1, 4, 20, 7)]
    assert [r.verdict for r in response_times(tight)] == [Verdict.MET, Verdict.MET]
    late = [task("a", 2, 3, 10), task("b", 1, 5, 20, 7)]
    assert [r.verdict for r in response_times(late)] == [Verdict.MET, Verdict.MISSED]
    assert response_times(late)[1].slack == -1


def test_equal_priorities_interfere_both_ways() -> None:
    a, b = response_times([task("a", 5, 2, 20), task("b", 5, 3, 20)])
    assert (a.bound, b.bound) == (5, 5)


def test_tasks_of_other_nodes_do_not_interfere() -> None:
    elsewhere = Task("z", task("z", 1, 1, 1).origin, "other", *(10, 0, 10, 9, 9))  # type: ignore[arg-type]
    assert response_times([task("a", 1, 5, 10), elsewhere])[0].bound == 5


def test_full_load_has_a_bound() -> None:
    rs = response_times([task("a", 2, 1, 2), task("b", 1, 2, 4)])
    assert [r.bound for r in rs] == [1, 4]
    assert growth_margin([r.task for r in rs]) == 0


def test_full_load_with_jitter_ends_after_one_repetition_of_the_pattern() -> None:
    a, b = response_times([task("a", 2, 1, 2, 9, jitter=1), task("b", 1, 1, 2, 9)])
    assert a.bound == 2
    assert b.bound == 3
    assert b.jobs == 1


def test_load_above_one_has_no_bound_and_says_so() -> None:
    a, b = response_times([task("a", 2, 6, 10), task("b", 1, 5, 10)])
    assert a.verdict is Verdict.MET
    assert (b.verdict, b.bound, b.slack) == (Verdict.NO_BOUND, None, None)
    assert b.reason == "it and what preempts it need 110.0 % of the core"


@pytest.mark.parametrize("spare", [1, 1_000])
def test_a_load_just_under_one_with_coprime_periods_ends(spare: int) -> None:
    tasks = [task("a", 3, 499_979, 999_983), task("b", 2, 500_000_000 - spare, 1_000_000_007)]
    for response in response_times([*tasks, task("c", 1, 1, 10**9)]):
        assert response.bound is not None or response.reason


def test_the_blocker_is_the_longest_section_below_whose_ceiling_reaches_the_task() -> None:
    tasks = [task("high", 3, 1, 50), task("middle", 2, 1, 50), task("low", 1, 1, 50)]
    objects = [
        shared("queue", 3, 4, "high", "low"),
        shared("store", 2, 9, "middle", "low"),
        shared("log", 3, 6, "high", "main"),
    ]
    high, middle, low = response_times(tasks, objects)
    assert high.blocking == Blocking("log", "main", 6)  # type: ignore[arg-type]
    assert middle.blocking == Blocking("store", "low", 9)  # type: ignore[arg-type]
    assert low.blocking == Blocking("log", "main", 6)  # type: ignore[arg-type]


def test_users_of_equal_priority_do_not_block() -> None:
    rs = response_times([task("a", 2, 1, 9), task("b", 2, 1, 9)], [shared("o", 2, 5, "a", "b")])
    assert [r.blocked for r in rs] == [0, 0]


def test_worst_slack_comes_first_and_no_bound_before_all() -> None:
    tasks = [task("a", 4, 1, 10), task("b", 3, 3, 10, 5), task("c", 2, 4, 10, 7)]
    tasks.append(task("d", 1, 9, 9))
    assert [r.task.element for r in analyse(system(tasks)).worst_first()] == ["d", "c", "b", "a"]


def test_utilisation_is_exact() -> None:
    tasks = [task("a", 2, 1, 3), task("b", 1, 1, 6)]
    assert analyse(system(tasks)).utilisation("cpu") == Fraction(1, 2)


def test_the_growth_margin_is_the_last_step_that_meets_every_deadline() -> None:
    tasks = [task("a", 1, 400_000, 1_000_000)]
    assert growth_margin(tasks) == 1500
    assert growth_margin([task("a", 1, 2_000_000, 1_000_000)]) == -500
    assert growth_margin([task("a", 1, 1, 10, 10, jitter=11)]) is None
    assert growth_margin([]) is None


# --- Properties --------------------------------------------------------------


@st.composite
def task_sets(draw: st.DrawFn, jitter: bool = True) -> list[Task]:
    """One to four tasks with short periods; any load, ties included."""
    tasks = []
    for index in range(draw(st.integers(1, 4))):
        period = draw(st.integers(2, 12))
        tasks.append(
            task(
                f"t{index}",
                draw(st.integers(1, 4)),
                draw(st.integers(1, 5)),
                period,
                draw(st.integers(1, 40)),
                draw(st.integers(0, 6)) if jitter else 0,
            )
        )
    return tasks


def bounds(tasks: list[Task], section: int = 0) -> list[float]:
    objects = [shared("o", 4, section, "main")] if section else []
    found = response_times(tasks, objects)
    return [float("inf") if r.bound is None else r.bound for r in found]


@settings(max_examples=150, deadline=None)
@given(task_sets(), st.integers(0, 3), st.sampled_from(["budget", "jitter", "section", "task"]))
def test_no_response_falls_when_load_grows(tasks: list[Task], at: int, what: str) -> None:
    before = bounds(tasks)
    one = tasks[at % len(tasks)]
    grown = task(
        one.element,
        one.priority,
        one.budget + (what == "budget"),
        one.period,
        one.deadline,
        one.jitter + (what == "jitter"),
    )
    more = [grown if t is one else t for t in tasks]
    if what == "task":
        more.append(task("extra", 4, 1, 7))
    after = bounds(more, section=2 if what == "section" else 0)
    assert all(new >= old for old, new in zip(before, after, strict=False))


@settings(max_examples=150, deadline=None)
@given(task_sets())
def test_the_breakdown_always_adds_up_to_the_bound(tasks: list[Task]) -> None:
    for r in response_times(tasks, [shared("o", 4, 3, "main")]):
        if r.bound is not None:
            window = r.blocked + r.own + sum(i.time for i in r.interference)
            assert r.task.jitter + window - r.worst_job * r.task.period == r.bound
            assert 0 <= r.worst_job < r.jobs


@settings(max_examples=120, deadline=None)
@given(task_sets(jitter=False))
@example([task("a", 2, 3, 12), task("b", 1, 14, 19, 25)])
def test_synchronous_sets_agree_with_simulation(tasks: list[Task]) -> None:
    assume(len({t.priority for t in tasks}) == len(tasks))
    assume(sum(Fraction(t.budget, t.period) for t in tasks) <= 1)
    simulated = longest_responses(tasks)
    assert {r.task.element: r.bound for r in response_times(tasks)} == simulated


def test_an_analysis_finds_its_tasks_by_name() -> None:
    analysis: Analysis = analyse(system([task("a", 1, 1, 2)]))
    assert analysis.schedulable
    with pytest.raises(KeyError):
        analysis.response("b")
