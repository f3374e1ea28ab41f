# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Processors that queued ports release: generated code against interpreter, and a run."""

from __future__ import annotations

import random
import shutil
from pathlib import Path

import pytest

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.command_line import main
from ravenchart.commands.simulate import build_simulation, run_simulation
from ravenchart.paths import ROOT
from tests.support.interpreted import stimuli_of, system_of

MODEL = ROOT / "tests" / "feature" / "releases" / "model.yaml"


def _events(chance: random.Random) -> str:
    """Values from outside, several at once among them, besides those of the sender."""
    times = sorted(chance.randrange(600) for _ in range(chance.randint(10, 40)))
    puts = [
        f"- {{at: {at} ms, put: drive.level, value: {chance.choice((0, 1, 9))}}}" for at in times
    ]
    return "\n".join([*puts, "- {until: 1 s}"])


def test_code_and_interpreter_do_the_same(tmp_path: Path) -> None:
    text = MODEL.read_text(encoding="utf-8").replace("depth: 2}", "depth: 8}")
    system = system_of(text)
    program = build_simulation(system, tmp_path, tmp_path / "simulation")
    chance = random.Random(1)
    moves = 0
    for _ in range(20):
        stimuli = stimuli_of(_events(chance), system)
        wanted = list(Machine(system).run(stimuli))
        assert list(run_simulation(system, program, stimuli)) == wanted
        moves += len(wanted)
    assert moves > 40  # more than each start and first change


@pytest.mark.slow
@pytest.mark.live
def test_a_run_keeps_the_bounds(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "releases"
    shutil.copytree(MODEL.parent, folder)
    assert main(["run", str(folder / "model.yaml"), "--seconds", "3"]) == 0
    text = capsys.readouterr().out
    assert "driving" in text and "follow" in text
