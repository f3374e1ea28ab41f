# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The autopilot: a run with a stuck gyro and a cut bus, and its program in virtual time."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from ravenchart.analysis.system.journeys import journeys
from ravenchart.building import checking, programs
from ravenchart.commands.simulate import build_simulation, executed, interpreted
from ravenchart.gen.model.logical import logical_links
from ravenchart.paths import ROOT
from ravenchart.running.controllers import controller
from ravenchart.running.runs import run_nodes
from tests.support.interpreted import stimuli_of

FOLDER = ROOT / "examples" / "autopilot"
MODEL = FOLDER / "model.yaml"
AXES = "roll", "pitch", "yaw"


@pytest.mark.live
@pytest.mark.alone
def test_the_scenario_passes(tmp_path: Path) -> None:
    checked = checking.check(MODEL)
    controllers = tuple(controller(made) for made in programs.programs_of(checked))
    outcome = run_nodes(
        controllers,
        checked.analysis,
        FOLDER / "generated",
        FOLDER / "scenario.yaml",
        0.0,
        tmp_path,
        log=tmp_path / "run.blf",
    )
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
    assert (outcome.ended.exit_code, outcome.ended.killed) == (0, False)
    assert outcome.observation is not None
    took = {one.chain: one for one in journeys(checked.analysis, outcome.observation)}
    assert took.keys() == {"inner", "outer", "stick"}
    #  the way of a gyro has more steps with logical execution times than that of the stick
    assert took["outer"].observed > took["stick"].observed


def test_values_between_processors_of_the_control_path_have_known_instants() -> None:
    system = checking.check(MODEL).system
    linked = {str(link.connection.target) for link in logical_links(system)}
    assert {"estimator.turn", "angle_1.attitude", "guide.attitude", "rate_1.wanted"} <= linked
    assert {"mix.thrust", "way.speed", "guide.course"} <= linked
    assert "gyro_vote.rates_1" not in linked, "both ends are on one processor"


@pytest.mark.slow
def test_in_virtual_time_the_program_does_the_same_as_the_interpreter(tmp_path: Path) -> None:
    system = checking.check(MODEL).system
    program = build_simulation(system, tmp_path, tmp_path / "simulation")
    chance = random.Random(3)
    events = []
    for at in range(0, 900, 5):
        for gyro in (1, 2, 3):
            if chance.random() < 0.8:
                fields = ", ".join(f"{axis}: {chance.randint(-30000, 30000)}" for axis in AXES)
                events.append(f"- {{at: {at} ms, put: gyro_{gyro}.raw, value: {{{fields}}}}}")
        if at % 100 == 50:
            order = chance.choice(("Hold", "Cruise", "Go_Home", "Disarm"))
            events.append(f"- {{at: {at} ms, put: guide.order, value: {order}}}")
    stimuli = stimuli_of("\n".join([*events, "- {until: 1 s}"]), system)
    played = executed(system, program, stimuli)
    assert played == interpreted(system, stimuli)
    assert len({one.value for one in played.values if one.element == "estimator.roll"}) > 50
