# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Scenarios are held against their model before anything is built; the page of both files."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from ravenchart.behaviour.interpreter.stimuli import FORMS
from ravenchart.building import checking
from ravenchart.command_line import main
from ravenchart.hw_can.bench.forms import BUS_EVENTS, DriveForm, TraceCheck
from ravenchart.hw_can.bench.scenario import parse_scenario
from ravenchart.hw_can.bench.steps import STEPS
from ravenchart.running import scenarios
from ravenchart.tools import toolchain
from tests.support.processes import ROOT

ROBOT = ROOT / "examples" / "cartesian_robot"
TWO_BUSES = ROOT / "examples" / "two_buses"
TWO_NODES = ROOT / "examples" / "two_nodes"
PAGE = (ROOT / "docs" / "scenarios.md").read_text(encoding="utf-8")

MISTAKES = [
    ("joint_x.Motion, reaches: Limit}", "joint_x.Motion, reaches: Limitt}",
     "Limitt}", "joint_x.Motion has no state `Limitt` [RV-1304]"),
    ("joint_x.Motion, reaches: Limit}", "joint_x.Motion, reaches: Operational}",
     "Operational}", "`Operational` has states inside; a trace records those [RV-1304]"),
    ("region: coordinator.Mission", "region: coordinator.Missing",
     "coordinator.Missing", "coordinator has no region `Missing` [RV-1304]"),
    ("region: coordinator.Mission", "region: boss.Mission",
     "boss.Mission", "there is no instance `boss` [RV-1304]"),
    ("reaches: Failed}", "reaches: Failed, within: 1 s, after_last: joint_x.feed}",
     "joint_x.feed}", "joint_x has no input port `feed` [RV-1304]"),
    ("kind: Home, x: 0, y: 0, z: 0", "kind: Homee, x: 0, y: 0, z: 0",
     "Homee", "`kind` must be one of Halt, Home, Move, Reset, not `Homee` [RV-1305]"),
    ("kind: Home, x: 0, y: 0, z: 0", "kind: Home, x: 900000, y: 0, z: 0",
     "900000", "`x` must be a number from -20000 to 500000, in um, not `900000` [RV-1305]"),
    ("kind: Home, x: 0, y: 0, z: 0", "kind: Home, x: 0, y: 0, q: 0",
     "q:", "robot_command has no field `q` [RV-1304]"),
    ("{kind: Home, x: 0, y: 0, z: 0}", "{kind: Home, x: 0, y: 0}", "{kind: Home, x: 0, y: 0}",
     'robot_command cannot be sent: The signal "z" is required for encoding. [RV-1305]'),
    ("send: robot_command, with: {kind: Home", "send: robot, with: {kind: Home",
     "robot,", "there is no message `robot` on robot_bus [RV-1304]"),
    ("condition, is: Homing", "condition, is: 1", "1,",
     "`condition` must be one of Waiting, Homing, Ready, Moving, Failed, Stopped, not `1` "
     "[RV-1305]"),
    ("robot_status.condition, is: Homing", "robot_status.mode, is: Homing",
     "robot_status.mode", "robot_status has no field `mode` [RV-1304]"),
    ("feedback: y_feedback", "feedback: robot_status", "robot_status",
     "robot_status has no field `count`, which a simulated drive needs [RV-1304]"),
    ("states: joint_z.Motion", "states: joint_z.Emotion", "joint_z.Emotion",
     "joint_z has no region `Emotion` [RV-1304]"),
    ("\nsteps:", "\nbus: [{at: 1 s, cut: controller}]\nsteps:", "bus:",
     "`bus` is for a system with several nodes, and Cartesian_Robot has one [RV-1306]"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "caret", "message"), MISTAKES)
def test_what_the_model_does_not_have_is_told_before_anything_is_built(
    old: str,
    new: str,
    caret: str,
    message: str,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(toolchain, "run", lambda *_: pytest.fail("something is built"))
    text = (ROBOT / "scenario.yaml").read_text(encoding="utf-8")
    assert old in text
    text = text.replace(old, new, 1)
    plan = tmp_path / "scenario.yaml"
    plan.write_text(text)
    at = text.index(caret, text.index(new))
    line, column = text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)
    assert main(["run", str(ROBOT / "model.yaml"), "--scenario", str(plan)]) == 1
    said = capsys.readouterr().err.splitlines()
    assert said[0] == f"{plan}:{line}:{column}: error: {message}"
    assert said[1].startswith(f"{line:5} | ") and said[2].endswith("^")


@pytest.mark.parametrize(
    ("folder", "name"),
    [(ROBOT, "scenario"), (ROBOT, "lost_bench"), (TWO_NODES, "scenario"), (TWO_NODES, "cut_bus")],
)
def test_the_scenarios_of_the_examples_fit_their_models(folder: Path, name: str) -> None:
    system = checking.check(folder / "model.yaml", deadlines=False).system
    assert scenarios.checked(folder / f"{name}.yaml", system).steps


def test_only_nodes_behind_the_first_are_cut_off() -> None:
    system = checking.check(TWO_NODES / "model.yaml", deadlines=False).system
    text = "scenario: x\nbus: [{at: 1 s, cut: panel}]\nsteps: [{wait: 1 s}]\n"
    (one,) = scenarios.problems(parse_scenario(text), system)
    assert one.message == "`panel` cannot be cut off"
    assert one.hint == "name one of drive: it and those behind it are cut off"


def test_an_event_of_one_of_several_buses_says_which() -> None:
    system = checking.check(TWO_BUSES / "model.yaml", deadlines=False).system
    events = (
        "{at: 1 s, mend: true}, {at: 2 s, mend: true, on: spare}, {at: 3 s, cut: axle, on: cabin}"
    )
    text = f"scenario: x\nbus: [{events}]\nsteps: [{{wait: 1 s}}]\n"
    nameless, unknown, first = scenarios.problems(parse_scenario(text), system)
    assert nameless.message == "Two_Buses has 2 buses, and the event names none"
    assert nameless.hint == "add `on: chassis` or `on: cabin`"
    assert unknown.hint == "write `on: chassis` or `on: cabin`"
    assert unknown.message == "there is no bus `spare`"
    assert first.message == "`axle` cannot be cut off"
    assert first.hint == "name one of gate, dash: it and those behind it are cut off"


def test_a_loss_is_expected_where_a_node_is_on_the_bus() -> None:
    system = checking.check(TWO_BUSES / "model.yaml", deadlines=False).system
    expected = "{lost: dash.chassis.lost_out, at_most: 1, because: x}"
    text = f"scenario: x\nsteps: [{{wait: 1 s}}]\nexpect: [{expected}]\n"
    (one,) = scenarios.problems(parse_scenario(text), system)
    assert one.message == "there is no `dash.chassis.lost_out` among the counts of losses"
    assert one.hint is not None and "dash.cabin.lost_out" in one.hint


# --- The interpreter says what it leaves out -----------------------------------------------


def test_the_interpreter_says_which_bodies_it_leaves_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    events = tmp_path / "events.yaml"
    events.write_text("- {until: 100 ms}\n")
    call = ["simulate", str(ROBOT / "model.yaml"), "--events", str(events), "--interpreter"]
    assert main(call) == 0
    said = capsys.readouterr().err
    assert "warning: the interpreter leaves out what the user writes: joint_x." in said
    assert "[RV-1009]" in said and "leave out `--interpreter`" in said
    pump = ROOT / "examples" / "qhsmtst"
    call[1:4] = [str(pump / "model.yaml"), "--events", str(pump / "events.yaml")]
    assert main(call) == 0
    assert capsys.readouterr().err == ""


# --- The reference page ---------------------------------------------------------------------


def test_every_key_of_scenarios_and_events_is_on_the_page() -> None:
    forms = [*STEPS.values(), *BUS_EVENTS.values(), DriveForm, TraceCheck]
    keys = {one.alias or name for form in forms for name, one in form.model_fields.items()}
    keys |= {"scenario", "drives", "bus", "steps", "expect_trace"}
    keys |= set(re.findall(r"\w+", re.sub("or, at the end", "", FORMS)))
    missing = {key for key in keys if f"`{key}`" not in PAGE}
    assert missing == set()


def test_the_codes_of_the_page_are_those_of_scenarios_and_events() -> None:
    schema = json.loads((ROOT / "docs" / "model.schema.json").read_text(encoding="utf-8"))
    assert schema  # the page is about other files than the model's
    assert set(re.findall(r"RV-\d{4}", PAGE)) <= {
        *(f"RV-100{n}" for n in range(1, 10)),
        *(f"RV-130{n}" for n in range(1, 7)),
    }


@pytest.mark.parametrize("name", ["canopen_device", "j1939_node"])
def test_the_scenario_of_an_example_fits_its_model(name: str) -> None:
    folder = ROOT / "examples" / name
    system = checking.check(folder / "model.yaml").system
    assert scenarios.checked(folder / "scenario.yaml", system).steps
