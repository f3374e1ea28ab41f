# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Servers that calls release: each call is executed once, in order, within its bound."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.analysis.system.commands import command_times
from ravenchart.analysis.system.depths import depths
from ravenchart.analysis.system.timing import Analysis, analyse
from ravenchart.building import checking, generation
from ravenchart.commands.simulate import simulated_by_program
from ravenchart.paths import ROOT
from tests.support.interpreted import stimuli_of
from tests.support.pump import loaded
from tests.support.short_runs import observed

FOLDER = ROOT / "tests" / "feature" / "called"
TEXT = (FOLDER / "model.yaml").read_text(encoding="utf-8")
PERIODIC = TEXT.replace("    released_by: mover_2.Motion\n", "")
MS = 1_000_000


def _analysed(text: str) -> Analysis:
    found = loaded(text)
    assert found.system is not None, found.diagnostics
    return analyse(found.system)


def _executed(text: str) -> int | None:
    """The bound of the time until the call of the pusher is executed."""
    times = command_times(_analysed(text))
    return next(one.executed for one in times if one.caller == "pusher_1.Push")


def test_a_call_waits_for_a_response_and_not_for_a_period() -> None:
    woken, sampled = _executed(TEXT), _executed(PERIODIC)
    assert woken is not None and sampled is not None
    assert woken < 2 * MS
    assert sampled > 5 * MS


def test_calls_that_come_faster_than_they_are_served_have_no_bound() -> None:
    slow = "        period: 10 ms\n        wcet: 50 us"
    assert slow in TEXT
    analysis = _analysed(TEXT.replace(slow, slow.replace("10 ms", "4 ms")))
    needed = {one.what: one.needed for one in depths(analysis)}
    assert needed["requests may wait in mover_2.Motion"] is None
    assert needed["requests may wait in mover_1.Motion"] == 4
    assert analysis.limited[0][1].reaction is None


def test_a_simulation_executes_each_call_at_its_instant(tmp_path: Path) -> None:
    folder = tmp_path / "called"
    shutil.copytree(FOLDER, folder)
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    played = simulated_by_program(checked, stimuli_of("- {until: 200 ms}", checked.system))
    goals = [(one.at, one.value) for one in played.values if one.element == "mover_2.Goal"]
    assert goals == [(10 * MS * (n - 1), n) for n in range(1, 22)]


@pytest.mark.slow
@pytest.mark.live
def test_a_run_executes_each_call_once(tmp_path: Path) -> None:
    folder = tmp_path / "called"
    shutil.copytree(FOLDER, folder)
    checked = checking.check(folder / "model.yaml")
    seen = observed(checked, folder, 1, waits=False)
    goals = [one.value for one in seen.values if one.element.name == "mover_2.Goal"]
    assert len(goals) > 50 and goals == list(range(1, len(goals) + 1))
    assert seen.processors["following"].releases == len(goals)
    assert seen.faults.get("Queue_Overflow", 0) == 0
