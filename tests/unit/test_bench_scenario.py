"""Scenario files: what they say, and what is refused with which words."""

from __future__ import annotations

from pathlib import Path

import pytest

from hw_can.bench.scenario import (
    STEPS,
    Expect,
    ScenarioError,
    Send,
    WaitFor,
    load_scenario,
    parse_scenario,
)
from tests.support.bench_files import scenario_text

ROBOT = Path(__file__).parents[2] / "examples" / "cartesian_robot"
ONE_STEP = "  - wait: 1 s\n"


@pytest.mark.parametrize("name", ["scenario.yaml", "lost_bench.yaml"])
def test_the_robots_scenarios_are_valid(name: str) -> None:
    scenario = load_scenario(ROBOT / name)
    assert [*scenario.drives] == ["x", "y", "z"]
    assert len(scenario.steps) == len(scenario.lines) > 10
    assert scenario.trace_checks


def test_quantities_are_read_in_base_units() -> None:
    scenario = parse_scenario(scenario_text("  - {expect: {x: -5 mm}, tolerance: 500 um}\n"))
    assert scenario.drives["x"].stroke == pytest.approx(0.1)
    step = scenario.steps[0]
    assert isinstance(step, Expect)
    assert [step.expect["x"], step.tolerance, step.within] == pytest.approx([-0.005, 0.0005, 0.0])


def test_every_step_reads_as_a_sentence() -> None:
    steps = """\
  - {send: robot_command, with: {kind: Move, x: 5}}
  - {wait_for: robot_status.condition, is: Ready, within: 8 s}
  - {expect: {x: 5 mm}, tolerance: 500 um}
  - {expect_stop: x, below: 1 mm/s, within: 500 ms}
  - wait: 250 ms
  - {pull: x, switch: low}
  - release: x
  - stop_feedback: all
  - kill_bench: true
"""
    scenario = parse_scenario(scenario_text(steps))
    assert [str(step) for step in scenario.steps] == [
        "send robot_command: kind Move, x 5",
        "wait for robot_status.condition = Ready",
        "expect x 5 mm",
        "expect x to stop within 0.5 s",
        "wait 0.25 s",
        "pull the low limit switch of x",
        "release the limit switch of x",
        "stop the feedback of all",
        "kill the bench",
    ]
    assert {type(step) for step in scenario.steps} == set(STEPS.values())
    assert isinstance(scenario.steps[0], Send)
    assert isinstance(scenario.steps[1], WaitFor)
    first = scenario.lines[0]
    assert scenario.lines == tuple(range(first, first + len(steps.splitlines())))


FIRST_STEP = len(scenario_text("").splitlines()) + 1


@pytest.mark.parametrize(
    ("step", "message"),
    [
        ("{wait: 5}", "steps.0.wait: expected a number and one of us, ms, s, such as 5 ms"),
        ("{wait: 5 mm}", "steps.0.wait: expected a number and one of us, ms, s, such as 5 ms"),
        (
            "{wait: -5 ms}",
            "steps.0.wait: Input should be greater than or equal to 0",
        ),
        ("{pull: x, switch: left}", "steps.0.switch: Input should be 'low' or 'high'"),
        ("{pull: q, switch: low}", "steps.0: there is no drive q"),
        ("{expect: {q: 1 mm}, tolerance: 1 mm}", "steps.0: there is no drive q"),
        ("{stop_feedback: q}", "steps.0: there is no drive q"),
        ("{kill_bench: false}", "steps.0.kill_bench: Input should be True"),
        ("{wait: 1 s, hurry: 1}", "steps.0.hurry: Extra inputs are not permitted"),
        ("{send: m}", "steps.0.with: Field required"),
        (
            "{dance: 1}",
            "steps.0: exactly one of send, wait_for, expect, expect_stop, wait, pull, release, "
            "stop_feedback, kill_bench is wanted",
        ),
    ],
)
def test_a_wrong_step_is_named_with_its_line(step: str, message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(scenario_text(f"  - {step}\n"))
    assert str(caught.value) == f"scenario.yaml:{FIRST_STEP}: error: {message}"


def test_all_mistakes_are_told_at_once_in_the_files_order() -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(scenario_text("  - {wait: 1}\n  - {jump: 1}\n  - {wait: 2}\n"))
    lines = str(caught.value).splitlines()
    places = [line.split(":")[1] for line in lines]
    assert places == [str(FIRST_STEP + n) for n in range(3)]


def test_an_axis_that_cannot_be_is_refused_at_its_drive() -> None:
    text = scenario_text(ONE_STEP).replace("start: 10 mm", "start: 10 m")
    with pytest.raises(ScenarioError, match=r"^scenario.yaml:3: error: drives.x: start lies"):
        parse_scenario(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: [", r"scenario.yaml:\d+: error: "),
        ("[1]", "scenario.yaml:1: error: a scenario is a mapping"),
        ("", "scenario.yaml:1: error: a scenario is a mapping"),
        ("scenario: x\ndrives: 1\nsteps: [{wait: 1 s}]\n", ":2: error: drives: "),
        (
            "scenario: x\nbus: [{at: 2 s, cut: b}, {at: 2 s, mend: true}]\nsteps: [{wait: 1 s}]\n",
            ":2: error: bus.1: comes no later than the event before it",
        ),
        ("scenario: x\nbus: [{at: 2 s}]\nsteps: [{wait: 1 s}]\n", ":2: error: bus.0"),
        (scenario_text(" []\n"), "steps: List should have at least 1 item"),
    ],
)
def test_a_file_that_is_no_scenario_is_refused(text: str, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        parse_scenario(text)


def test_a_time_limit_of_the_trace_needs_what_it_counts_from() -> None:
    checks = "expect_trace:\n  - {region: a.B, reaches: C, within: 1 s}\n"
    with pytest.raises(ScenarioError, match="within and after_last or after_silence go together"):
        parse_scenario(scenario_text(ONE_STEP, checks))


def test_a_missing_file_is_an_error_in_words(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="cannot be read"):
        load_scenario(tmp_path / "none.yaml")
