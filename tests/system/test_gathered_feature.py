# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Three joints behind one interface: simulated, run, and over a bus that is cut."""

from __future__ import annotations

import shutil
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.observed import read_map, read_trace
from ravenchart.behaviour.interpreter.traces import Played
from ravenchart.building import checking, generation, programs
from ravenchart.commands.simulate import simulated_by_program
from ravenchart.paths import ROOT
from ravenchart.running.controllers import controller
from ravenchart.running.runs import run_nodes
from tests.support.interpreted import stimuli_of
from tests.support.short_runs import observed

WAY = ["start", "closed", "homed", "arrived"]


def _checked(kind: str, name: str, to: Path) -> checking.Checked:
    folder = to / name
    shutil.copytree(ROOT / "tests" / kind / name, folder)
    checked = checking.check(folder / "model.yaml")
    assert not checked.warnings
    generation.write_program(checked)
    return checked


def _fired(played: Played) -> list[str]:
    """The transitions of the arm."""
    done = (name for step in played.steps if step.region == "Plan" for name in step.behaviours)
    return [name.removesuffix(".effect") for name in done if name.endswith(".effect")]


def test_a_simulation_splits_arguments_and_gathers_replies(tmp_path: Path) -> None:
    checked = _checked("feature", "gathered", tmp_path)
    played = simulated_by_program(checked, stimuli_of("- {until: 400 ms}", checked.system))
    goals = {
        n: list(dict.fromkeys(v.value for v in played.values if v.element == f"joint_{n}.Goal"))
        for n in (1, 2, 3)
    }
    #  at home each joint is where its parameter says, then each has its axis of the argument
    assert _fired(played) == WAY
    assert goals == {1: [1, 100], 2: [2, 200], 3: [3, -300]}
    seen = [int(v.value) for v in played.values if v.element == "arm_1.seen.axis_3"]
    #  the limit that all get is 40 in 5 ms, and the arm looks every 10 ms
    moved = {after - before for before, after in pairwise(seen)}
    assert -80 in moved and min(moved) == -80
    assert seen[-1] == -300


def test_a_simulation_of_several_nodes_is_one_of_all_joints(tmp_path: Path) -> None:
    checked = _checked("nodes", "axes", tmp_path)
    played = simulated_by_program(checked, stimuli_of("- {until: 400 ms}", checked.system))
    assert _fired(played)[:4] == ["homed", "arrived", "again", "homed"]


@pytest.mark.slow
@pytest.mark.live
def test_a_run_takes_the_same_way(tmp_path: Path) -> None:
    checked = _checked("feature", "gathered", tmp_path)
    seen = observed(checked, tmp_path / "gathered", 1, waits=False)
    assert [record.text for record in seen.of("transition", "arm_1.Plan")] == WAY
    assert not any(seen.faults.values())
    #  a call counts from the release of its caller, and not from the one before
    calls = [one for one in journeys(checked.analysis, seen) if one.chain == "arm_1_Home_3"]
    assert len(calls) == 1 and min(calls[0].times) < 20_000_000


@pytest.mark.slow
@pytest.mark.alone
def test_a_late_element_ends_the_call_of_all(tmp_path: Path) -> None:
    checked = _checked("nodes", "axes", tmp_path)
    folder = tmp_path / "axes"
    outcome = run_nodes(
        tuple(controller(made) for made in programs.programs_of(checked)),
        checked.analysis,
        folder / "generated",
        folder / "cut_bus.yaml",
        0.0,
        folder / "report",
    )
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
    assert (outcome.ended.exit_code, outcome.ended.killed) == (0, False)
    names = read_map((folder / "generated" / "panel" / "trace.json").read_text())
    trace = (folder / "report" / "trace-panel.txt").read_text()
    seen = read_trace(trace.splitlines(), names)
    fired = [record.text for record in seen.of("transition", "arm_1.Plan")]
    assert "arrived again" in " ".join(fired)
    #  the bus is cut: the joint beside the client has replied, and the others are late, once
    times = [(r.time / 1e6, r.text) for r in seen.of("transition", "arm_1.Plan")]
    assert "hasty" in fired and "alone" in fired
    at = next(time for time, name in times if name == "hasty")
    assert [name for time, name in times if at <= time < at + 60] == ["hasty", "alone"]
    assert seen.faults["Stale_Input"] >= 2
    #  it is mended: calls are answered again
    assert "homed" in fired[len(fired) - fired[::-1].index("alone") :]
