# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands of another node: two programs on one bus, with it and without."""

from __future__ import annotations

import shutil
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.running.controllers import controller
from ravenchart.running.runs import run_nodes

pytestmark = pytest.mark.alone


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A copy of the model."""
    copy: Path = tmp_path / "commands"
    shutil.copytree(ROOT / "tests" / "nodes" / "commands", copy)
    return copy


@pytest.mark.slow
def test_calls_are_executed_on_the_other_node_and_a_missing_reply_is_told(folder: Path) -> None:
    checked = checking.check(folder / "model.yaml")
    assert not checked.warnings
    generation.write_program(checked)
    controllers = tuple(controller(made) for made in programs.programs_of(checked))
    outcome = run_nodes(
        controllers,
        checked.analysis,
        folder / "generated",
        folder / "cut_bus.yaml",
        0.0,
        folder / "report",
    )
    #  how long a response takes is for runs on a machine of their own to say
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
    assert (outcome.ended.exit_code, outcome.ended.killed) == (0, False)
    names = read_map((folder / "generated" / "panel" / "trace.json").read_text())
    trace = (folder / "report" / "trace-panel.txt").read_text()
    seen = read_trace(trace.splitlines(), names)
    fired = [record.text for record in seen.of("transition", "boss_1.Plan")]
    #  a reply by event, one by polling, and what the other node was told, read back
    #  (`check` fires once what the other node publishes is its new goal)
    assert " ".join(["homed", "known", "check", "there"]) in " ".join(fired)
    #  the bus is cut: a second call finds the first under way, which is given up in time
    times = [(r.time / 1e6, r.text) for r in seen.of("transition", "boss_1.Plan")]
    cut = [time for time, name in times if name == "back" and time > 1500]
    after = [(time - cut[0], name) for time, name in times if cut[0] < time <= cut[0] + 95]
    assert [name for _, name in after] == ["insist", "hasty", "alone"]
    #  three executions of 20 ms, and one that takes the event behind the other
    assert round(after[-1][0] / 20) == 4
    assert seen.faults["Stale_Input"] >= 3
    #  what is read grows too old meanwhile: that is told, once
    came = [record.time / 1e6 for record in seen.of("arrived", "mover_1_Get_Place")]
    ((last, first),) = [pair for pair in pairwise(came) if pair[1] - pair[0] > 500]
    view = [(r.time / 1e6, r.text) for r in seen.of("transition", "boss_1.View")]
    assert [name for time, name in view if last < time < first].count("darkened") == 1
    #  it is mended: calls are answered again
    assert "homed" in fired[len(fired) - fired[::-1].index("alone") :]


@pytest.mark.slow
def test_a_region_publishes_and_events_are_brought_without_a_warning(tmp_path: Path) -> None:
    copy = tmp_path / "gripper"
    shutil.copytree(ROOT / "tests" / "nodes" / "gripper", copy)
    checked = checking.check(copy / "model.yaml")
    assert not checked.warnings
    assert generation.write_program(checked).untouched == ()
    for made in programs.programs_of(checked):
        made.build()
    grasp = (copy / "generated" / "board" / "gripper_cell-grasp_1.adb").read_text()
    assert "Link.Send_Grasp_1_Get_Heat (Life_Region.Data.Heat_Now);" in grasp
    #  the only callers are far: their numbers are the first
    assert "if Asked.Caller <= 255 then" in grasp


@pytest.mark.slow
def test_a_device_is_called_from_two_nodes(tmp_path: Path) -> None:
    """From one directly, from the other through the task that forwards."""
    copy = tmp_path / "forwarded"
    shutil.copytree(ROOT / "tests" / "nodes" / "forwarded", copy)
    checked = checking.check(copy / "model.yaml")
    assert not checked.warnings
    assert generation.write_program(checked).untouched == ()
    controllers = tuple(controller(made) for made in programs.programs_of(checked))
    ways = (copy / "generated", copy / "goes.yaml", 0.0, copy / "report")
    outcome = run_nodes(controllers, checked.analysis, *ways)
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
    names = read_map((copy / "generated" / "panel" / "trace.json").read_text())
    trace = (copy / "report" / "trace-panel.txt").read_text()
    fired = [
        one.text for one in read_trace(trace.splitlines(), names).of("transition", "boss_1.Plan")
    ]
    #  900 mm is too far for the guardian: the place that the boss waits for is its 800 mm
    assert fired == ["start", "loose", "told", "arrived"]
