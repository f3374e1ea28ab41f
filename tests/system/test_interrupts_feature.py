# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Interrupts that release processors: in virtual time, and as signals to a running program."""

from __future__ import annotations

import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.observed import read_map, read_trace
from ravenchart.analysis.system.timing import analyse
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.building import checking, generation, programs
from ravenchart.commands.simulate import simulated_by_program
from ravenchart.paths import ROOT
from tests.support.interpreted import stimuli_of

FOLDER = ROOT / "tests" / "feature" / "interrupts"
EVENTS = """
- {at: 30 ms, interrupt: board.limit}
- {at: 30 ms, interrupt: board.turn}
- {at: 40 ms, interrupt: board.limit}
- {at: 100 ms, interrupt: board.limit}
- {until: 200 ms}
"""


@pytest.fixture
def checked(tmp_path: Path) -> checking.Checked:
    folder = tmp_path / "interrupts"
    shutil.copytree(FOLDER, folder)
    found = checking.check(folder / "model.yaml")
    generation.write_program(found)
    return found


def test_program_and_interpreter_agree_and_ignore_what_comes_too_soon(
    checked: checking.Checked,
) -> None:
    given = stimuli_of(EVENTS, checked.system)
    played = simulated_by_program(checked, given)
    machine = Machine(checked.system)
    assert list(machine.run(given)) == played.steps
    assert machine.values == played.values
    hits = [(one.at, one.value) for one in played.values if one.element == "guard.hit"]
    assert hits == [(30_000_000, 1), (100_000_000, 2)]


@pytest.mark.slow
@pytest.mark.live
def test_each_signal_releases_its_processor_once_and_one_that_is_too_soon_is_counted(
    checked: checking.Checked,
) -> None:
    trace = checked.folder / "trace"
    program = programs.programs_of(checked)[0].build()
    process = subprocess.Popen([program], env={"RAVENCHART_TRACE": str(trace)})
    time.sleep(0.5)
    for _ in range(3):
        process.send_signal(signal.SIGUSR1)
        time.sleep(0.05)
    for pause in (0.002, 0.002, 0.05, 0.05):  # the second and the third are too soon
        process.send_signal(signal.SIGUSR1)
        time.sleep(pause)
    for _ in range(5):
        process.send_signal(signal.SIGUSR2)
        time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    assert process.wait(5) == 0
    names = read_map((checked.folder / "generated" / "trace.json").read_text(encoding="utf-8"))
    seen = read_trace(trace.read_text(encoding="ascii").splitlines(), names)
    assert seen.processors["limiting"].releases == 5
    assert seen.processors["turning"].releases == 5
    assert seen.faults["Queue_Overflow"] == 1
    assert [r.text for r in seen.of("transition", "guard.Watch")] == ["hold", "free"] * 2 + ["hold"]
    (stopped,) = journeys(analyse(checked.system), seen)
    assert stopped.count == 5
    assert stopped.observed < 40_000_000  # from its own signal, and not from the one before


def test_an_interrupt_counts_above_all_tasks_with_the_separation_of_its_processor(
    checked: checking.Checked,
) -> None:
    analysis = analyse(checked.system)
    tasks = {task.name: task for task in analysis.network.tasks}
    line = tasks["board.limit"]
    assert (line.period, line.wcet, line.sporadic) == (20_000_000, 20_000, True)
    assert line.priority == max(task.priority for task in tasks.values())
    chain = analysis.limited[0][1]
    names = [hop.step.name for hop in chain.hops]
    assert names == ["board.limit", "guard.on_limit", "motor.ports", "motor.stop"]
    taken, limited = (analysis.found.responses[name].bound for name in ("board.limit", "limiting"))
    assert taken is not None and limited is not None and chain.reaction is not None
    assert taken + 2 * limited < chain.reaction <= 15_000_000
