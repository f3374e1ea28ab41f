# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Scenario files: what they say, and what is refused with which words."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.hw_can.bench.forms import Hold, LetGo
from ravenchart.hw_can.bench.scenario import ScenarioError, load_scenario, parse_scenario
from ravenchart.hw_can.bench.steps import STEPS, Expect, SendStep, WaitFor
from tests.support.bench_files import scenario_text

ROBOT = Path(__file__).parents[3] / "examples" / "cartesian_robot"
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


def test_every_step_reads_as_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "field.log").write_text("(0.0) can0 123#00\n")
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
  - replay: field.log
  - {set: tank.door, to: 1}
  - {expect_output: tank.level, at_least: 2, at_most: 3}
"""
    plants = "plants: {tank: {class: tank.py:Tank}}\n"
    scenario = parse_scenario(plants + scenario_text(steps), str(tmp_path / "scenario.yaml"))
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
        "replay field.log",
        "set tank.door to 1",
        "expect 2 <= tank.level <= 3",
    ]
    assert {type(step) for step in scenario.steps} == set(STEPS.values())
    assert isinstance(scenario.steps[0], SendStep)
    assert isinstance(scenario.steps[1], WaitFor)
    first = scenario.lines[0]
    assert scenario.lines == tuple(range(first, first + len(steps.splitlines())))


FIRST_STEP = len(scenario_text("").splitlines()) + 1


STEP_KINDS = (
    "`send`, `replay`, `wait_for`, `expect`, `expect_stop`, `set`, "
    "`expect_output`, `wait`, `pull`, `release`, `stop_feedback`, `kill_bench`"
)
NO_DRIVE = "there is no drive `q` [RV-1304]"


@pytest.mark.parametrize(
    ("step", "caret", "message"),
    [
        (
            "{wait: 5}", "5}",
            "`wait` must be a number and one of us, ms, s, such as `5 ms`, not `5` [RV-1303]",
        ),
        (
            "{wait: 5 mm}", "5 mm",
            "`wait` must be a number and one of us, ms, s, such as `5 ms`, not `5 mm` [RV-1303]",
        ),
        ("{wait: -5 ms}", "-5", "`wait` must be at least 0, not `-5 ms` [RV-1303]"),
        (
            "{pull: x, switch: left}", "left",
            "`switch` must be `low` or `high`, not `left` [RV-1303]",
        ),
        ("{pull: q, switch: low}", "q,", NO_DRIVE),
        ("{expect: {q: 1 mm}, tolerance: 1 mm}", "q:", NO_DRIVE),
        ("{stop_feedback: q}", "q}", "there is no drive or plant `q` [RV-1304]"),
        ("{kill_bench: false}", "false", "`kill_bench` must be `true`, not `false` [RV-1303]"),
        ("{wait: 1 s, hurry: 1}", "hurry", "`hurry` has no place here [RV-1302]"),
        ("{send: m}", "{send", "the key `with` is missing [RV-1302]"),
        ("{send: m, with: 5}", "5", "`with` must be a mapping, `{key: value}`, not `5` [RV-1303]"),
        (
            "{wait_for: m, is: 5, within: 1 s}", "m,",
            "`wait_for` must be `owner.name`, not `m` [RV-1303]",
        ),
        ("dance", "dance", "this must be a mapping, `{key: value}` [RV-1303]"),
        (
            "{dance: 1}", "{dance",
            f"must have exactly one of {STEP_KINDS}; found none of them [RV-1302]",
        ),
        ("{wait: 1 s, release: x}", "{wait",
         f"must have exactly one of {STEP_KINDS}; found `wait` and `release` [RV-1302]"),
    ],
)  # fmt: skip
def test_a_wrong_step_is_named_with_its_place(step: str, caret: str, message: str) -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(scenario_text(f"  - {step}\n"))
    head, line, pointer = str(caught.value).splitlines()[:3]
    shown = line.partition("| ")[2]
    column = shown.index(caret) + 1
    assert head == f"scenario.yaml:{FIRST_STEP}:{column}: error: {message}"
    assert pointer.partition("| ")[2] == " " * (column - 1) + "^"


def test_hints_list_what_there_is() -> None:
    hints = {
        "{pull: q, switch: low}": "the drives are x",
        "{wait: 1 s, hurry: 1}": "the keys here are `wait`",
        "{send: m}": "the keys are `send`, `with`, `wrong`",
    }
    for step, hint in hints.items():
        with pytest.raises(ScenarioError) as caught:
            parse_scenario(scenario_text(f"  - {step}\n"))
        assert str(caught.value).splitlines()[-1].endswith(f"hint: {hint}")


@pytest.mark.parametrize(
    ("step", "hint"),
    [
        ("{sent: m, with: {}}", "did you mean `send`?"),
        ("{wait: 1 s, release: x}", "write an entry for each"),
        ("{wait_for: m.f, iss: 5, within: 1 s}", "did you mean `is`?"),
        ("{wait_for: m.f, is: 5, wihtin: 1 s}", "did you mean `within`?"),
    ],
)
def test_a_misspelt_key_is_one_error_with_a_hint(step: str, hint: str) -> None:
    """The key that is missing because of it is not an error of its own."""
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(scenario_text(f"  - {step}\n"))
    told = str(caught.value)
    assert told.count(": error: ") == 1
    assert told.splitlines()[-1].endswith(f"hint: {hint}")


def test_all_mistakes_are_told_at_once_in_the_files_order() -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_scenario(scenario_text("  - {wait: 1}\n  - {jump: 1}\n  - {wait: 2}\n"))
    lines = [line for line in str(caught.value).splitlines() if ": error: " in line]
    places = [line.split(":")[1] for line in lines]
    assert places == [str(FIRST_STEP + n) for n in range(3)]


def test_an_axis_that_cannot_be_is_refused_at_its_drive() -> None:
    text = scenario_text(ONE_STEP).replace("start: 10 mm", "start: 10 m")
    with pytest.raises(
        ScenarioError, match=r"^scenario.yaml:3:3: error: the drive x cannot be: start lies"
    ):
        parse_scenario(text)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("a: [", r"scenario.yaml:\d+:\d+: error: .*RV-0106"),
        ("[1]", "scenario.yaml:1:1: error: a scenario is a mapping"),
        ("", "scenario.yaml:1:1: error: a scenario is a mapping"),
        ("scenario: x\ndrives: 1\nsteps: [{wait: 1 s}]\n", ":2:9: error: `drives` must be a map"),
        (
            "scenario: x\nbus: [{at: 2 s, cut: b}, {at: 2 s, mend: true}]\nsteps: [{wait: 1 s}]\n",
            ":2:31: error: 2 s is not after 2 s of the event above",
        ),
        (
            "scenario: x\nbus: [{at: 2 s}]\nsteps: [{wait: 1 s}]\n",
            ":2:7: error: must have exactly one",
        ),
        (scenario_text(" []\n"), "`steps` must be at least one item"),
    ],
)
def test_a_file_that_is_no_scenario_is_refused(text: str, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        parse_scenario(text)


def test_a_time_limit_of_the_trace_needs_what_it_counts_from() -> None:
    checks = "expect_trace:\n  - {region: a.B, reaches: C, within: 1 s}\n"
    with pytest.raises(
        ScenarioError, match="`within` needs one of `after_last` and `after_silence`"
    ):
        parse_scenario(scenario_text(ONE_STEP, checks))


def test_a_missing_file_is_an_error_in_words(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"none.yaml:1:1: error: cannot read .*: no such file"):
        load_scenario(tmp_path / "none.yaml")


def test_a_bus_can_be_held_at_either_level_and_let_go() -> None:
    bus = "bus: [{at: 1 s, hold: LEVEL}, {at: 2 s, let_go: true}]\n"
    text = f"scenario: x\n{bus}steps: [{{wait: 1 s}}]\n"
    for level in ("dominant", "recessive"):
        held, let_go = parse_scenario(text.replace("LEVEL", level)).bus_events
        assert isinstance(held, Hold) and (held.at, held.hold) == (1.0, level)
        assert isinstance(let_go, LetGo)
    with pytest.raises(ScenarioError, match="dominant"):
        parse_scenario(text.replace("LEVEL", "high"))
