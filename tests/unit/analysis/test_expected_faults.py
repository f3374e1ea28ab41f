# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a run lost, missed or overran fails it, unless the scenario or the host accounts for it."""

from __future__ import annotations

from dataclasses import replace

import pytest

from ravenchart.analysis.present.report import Comparison, Execution
from ravenchart.analysis.system.journeys import Journey
from ravenchart.analysis.system.observed import Observation, Releases, TraceMap
from ravenchart.gen.language.terms import Ns
from ravenchart.hw_can.bench.scenario import Scenario, ScenarioError, parse_scenario
from ravenchart.running import expected, judge
from ravenchart.running.process import Ended, stolen_time
from tests.support.faults import shows

ENDED = Ended(0, killed=False, real_time=True, warnings=())
HEAD = "scenario: S\nsteps: [{wait: 1 s}]\n"


def plan(*entries: str) -> Scenario:
    return parse_scenario(HEAD + "expect:\n" + "".join(f"  - {{{one}}}\n" for one in entries))


def seen(**found: dict[str, int]) -> Observation:
    made = Observation(TraceMap("", "", {}), complete=True)
    made.counts |= found.get("counts", {})
    made.faults |= found.get("faults", {})
    for name, misses in found.get("missed", {}).items():
        made.processors[name] = Releases(100, misses, Ns(5))
    return made


def judged(scenario: Scenario, shown: Observation) -> list[str]:
    return list(expected.judged(scenario, None, expected.counted(shown, (), (), ENDED)))


LOST = {"counts": {"bus.lost_out": 4, "bus.sent": 100, "bus.received": 3, "trace": 0}}


@shows(
    "frames are lost, and the scenario does not expect it",
    found_by="the verdict of a run",
    reaction="the run fails, with the count",
)
def test_a_loss_that_nobody_expects_fails_the_run() -> None:
    nothing = parse_scenario(HEAD)
    assert judged(nothing, seen(**LOST)) == [
        "lost: bus.lost_out, 4 times; the scenario does not expect it"
    ]
    assert judged(nothing, seen(counts={"bus.lost_out": 0})) == []


@pytest.mark.parametrize(
    ("entry", "said"),
    [
        ("lost: bus.lost_out, times: 4", []),
        ("lost: Bus.Lost_Out, at_most: 4", []),
        (
            "lost: bus.lost_out, times: 5",
            ["lost: bus.lost_out, 4 times; the scenario expects 5"],
        ),
        (
            "lost: bus.lost_out, at_most: 3",
            ["lost: bus.lost_out, 4 times; the scenario expects at most 3"],
        ),
    ],
)
def test_a_loss_is_held_against_its_number(entry: str, said: list[str]) -> None:
    assert judged(plan(f"{entry}, because: a reason"), seen(**LOST)) == said


def test_what_must_come_and_does_not_fails_the_run() -> None:
    scenario = plan(
        "fault: Stale_Input, times: 2, because: a reason",
        "fault: Can_Bus_Off, at_most: 2, because: a reason",
        "missed: control, times: 0, because: a reason",
    )
    assert judged(scenario, seen()) == ["fault: Stale_Input, 0 times; the scenario expects 2"]


@shows(
    "a missed deadline or a full queue of events, not expected",
    found_by="the verdict of a run",
    reaction="the run fails, with the count",
)
def test_faults_and_missed_deadlines_are_expected_by_name() -> None:
    shown = seen(faults={"DEADLINE_MISS": 2, "QUEUE_OVERFLOW": 1}, missed={"control": 2})
    assert judged(parse_scenario(HEAD), shown) == [
        "fault: QUEUE_OVERFLOW, once; the scenario does not expect it",
        "control missed 2 deadlines; the scenario does not expect it",
    ]
    declared = plan(
        "missed: control, times: 2, because: a reason",
        "fault: Queue_Overflow, times: 1, because: a reason",
    )
    assert judged(declared, shown) == []
    told = list(expected.told(declared, expected.counted(shown, (), (), ENDED)))
    assert told == [
        "fault: QUEUE_OVERFLOW, once: a reason",
        "control missed 2 deadlines: a reason",
    ]


@shows(
    "a time above its bound by more than the host withheld",
    found_by="the probe of the node",
    reaction="the run fails; by no more, `PASS (timing not judged: ...)`",
)
def test_only_what_the_host_withheld_is_excused() -> None:
    shown = seen(missed={"control": 2})
    late = Comparison("control", 100, 2, observed=900, bound=500, withheld=400)
    long = Execution("arm.move", observed=1_400, wcet=1_000)
    assert expected.counted(shown, (late,), (long,), ENDED) == {}
    assert expected.not_judged((late,), (long,), (), ENDED) == (
        "the host withheld the core for up to 0.4 us"
    )
    less = replace(late, withheld=399)
    assert expected.counted(shown, (less,), (long,), ENDED) == {
        ("missed", "control"): 2,
        ("overran", "arm.move"): 1,
    }
    assert expected.not_judged((less,), (long,), (), ENDED) is None


def test_a_reaction_is_excused_for_what_the_host_withheld_at_each_place() -> None:
    delayed = Comparison("control", 100, 0, observed=400, bound=500, withheld=100)
    slow = Journey("flow", 9, observed=1_300, bound=1_000, limit=2_000, places=3)
    slower = replace(slow, observed=1_301)
    ended = "the host withheld the core for up to 0.1 us"
    assert list(judge.failures(ENDED, None, None, (), (delayed,), (slow,))) == []
    assert expected.not_judged((delayed,), (), (slow,), ENDED) == ended
    (why,) = judge.failures(ENDED, None, None, (), (delayed,), (slower,))
    assert why.startswith("the chain flow was observed to react after ")
    assert expected.not_judged((delayed,), (), (slower,), ENDED) is None


def test_without_priorities_the_times_of_executions_say_nothing() -> None:
    ended = replace(ENDED, real_time=False)
    long = Execution("arm.move", observed=9_000, wcet=1_000)
    assert expected.counted(seen(), (), (long,), ended) == {}
    assert (
        expected.not_judged((), (long,), (), ended) == "the controller had no real-time priorities"
    )


@pytest.mark.parametrize(
    "entry",
    [
        "lost: bus.lost_out, times: 1, at_most: 2, because: a reason",
        "lost: bus.lost_out, because: a reason",
        "lost: bus.lost_out, times: 1",
        "lost: bus.lost_out, fault: Silence, times: 1, because: a reason",
        "fault: Deadline_Miss, times: 1, because: a reason",
        "lost: bus.lost_out, times: -1, because: a reason",
    ],
)
def test_an_expectation_that_says_nothing_is_refused(entry: str) -> None:
    with pytest.raises(ScenarioError):
        plan(entry)


@pytest.mark.parametrize(
    ("before", "after", "longest"),
    [(0, 0, 0), (7, 7, 10_000_000), (7, 9, 30_000_000)],
)
def test_a_count_of_stolen_ticks_may_be_a_tick_behind(
    monkeypatch: pytest.MonkeyPatch, before: int, after: int, longest: int
) -> None:
    monkeypatch.setattr("os.sysconf", {"SC_CLK_TCK": 100}.__getitem__)
    assert stolen_time(before, after) == longest
