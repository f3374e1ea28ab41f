# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Regions that events release: program and interpreter agree, and a run keeps its bounds."""

from __future__ import annotations

import shutil
from itertools import pairwise
from pathlib import Path

import pytest

from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.timing import analyse
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.building import checking, generation
from ravenchart.commands.simulate import simulated_by_program
from ravenchart.paths import ROOT
from tests.support.interpreted import stimuli_of
from tests.support.short_runs import observed

FOLDER = ROOT / "tests" / "feature" / "raised"
EVENTS = """
- {at: 30 ms, raise: keys.Struck, with: Start}
- {at: 90 ms, raise: guard.Normal}
- {at: 90 ms, raise: guard.Normal}
- {until: 2 s}
"""
MS = 1_000_000


def test_program_and_interpreter_agree(tmp_path: Path) -> None:
    folder = tmp_path / "raised"
    shutil.copytree(FOLDER, folder)
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    given = stimuli_of(EVENTS, checked.system)
    played = simulated_by_program(checked, given)
    machine = Machine(checked.system)
    steps = list(machine.run(given))
    assert played.steps == steps
    assert played.values == machine.values
    assert len(steps) > 100


@pytest.mark.slow
@pytest.mark.live
def test_a_run_takes_each_event_within_its_bound(tmp_path: Path) -> None:
    folder = tmp_path / "raised"
    shutil.copytree(FOLDER, folder)
    checked = checking.check(folder / "model.yaml")
    seen = observed(checked, folder, 2, waits=False)
    raised = [r.time for e in ("High", "Normal") for r in seen.of("raised", f"guard.{e}")]
    assert seen.processors["tripping"].releases == len(raised) > 5
    ran = [r.time for r in seen.of("activity", "keys.Work")]
    assert min(later - before for before, later in pairwise(ran)) > 9 * MS
    assert seen.faults.get("Queue_Overflow", 0) == 0
    found = {one.chain: one for one in journeys(analyse(checked.system), seen)}
    assert found["tripped"].count > 1 and found["switched"].count > 10
    assert not any(one.exceeded for one in found.values())
