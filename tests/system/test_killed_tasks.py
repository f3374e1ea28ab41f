# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tasks of a running robot that a signal of the processor ends: named, answered by its chart."""

from __future__ import annotations

import json
import os
import random
import re
import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from tests.support.faults import shows
from tests.support.stopped import raise_in

pytestmark = [pytest.mark.live, pytest.mark.slow]

LONG = "RAVENCHART_LONG_TESTS" in os.environ


def _by_priority(process: int) -> list[int]:
    """The threads of a process with a real-time priority, the most urgent first."""
    threads = [int(one.name) for one in Path(f"/proc/{process}/task").iterdir()]
    urgency = {one: os.sched_getparam(one).sched_priority for one in threads}
    return sorted((one for one in threads if urgency[one]), key=lambda one: -urgency[one])


TASKS = (
    (0, "controller.probe"),
    (1, "controller.supervisor"),
    (2, "a task without a name (a driver's or a user's)"),
    (4, "reception"),
)
"""Tasks of the Cartesian robot by urgency: behind the supervisor the two of the bus's driver."""


@dataclass(frozen=True)
class Hit:
    """How the Cartesian robot ended after a signal of the processor in one of its threads."""

    status: int
    reasons: tuple[str, ...]
    trace: str


def _hit(mode: str, place: int, folder: Path, after: float = 0.5) -> Hit:
    """An exception in the thread with that place by urgency, as a division by zero gives it."""
    checked = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml")
    generation.write_program(checked)
    program = programs.programs_of(checked)[0].build(mode)
    trace = folder / "trace"
    trace.unlink(missing_ok=True)
    told = {"RAVENCHART_CAN_PORT": "0", "RAVENCHART_TRACE": str(trace)}
    process = subprocess.Popen(
        [program], env=os.environ | told, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        until = time.monotonic() + 5
        while not trace.exists() and time.monotonic() < until:
            time.sleep(0.01)
        time.sleep(after)
        threads = _by_priority(process.pid)
        if not threads:
            pytest.skip("needs real-time priorities, which tell the tasks apart")
        raise_in(process.pid, threads[place % len(threads)])
        _, said = process.communicate(timeout=5)
    finally:
        process.kill()
        process.wait()
    reasons = tuple(line for line in said.splitlines() if line.startswith("error: "))
    return Hit(process.returncode, reasons, trace.read_text() if trace.exists() else "")


@pytest.mark.slow
@shows(
    "an exception in the task of the probe, the supervisor, a driver or a processor",
    found_by="the fallback handler of task termination",
    reaction="shutdown of the model, its event in the chart, exit status 1",
    within="5 s",
)
@pytest.mark.parametrize(("place", "name"), TASKS)
@pytest.mark.parametrize("mode", ["checks", "release"])
def test_whatever_task_is_hit_by_an_exception_the_controller_shuts_down(
    tmp_path: Path, place: int, name: str, mode: str
) -> None:
    found = _hit(mode, place, tmp_path)
    assert found.status == 1
    assert found.reasons[0].startswith(f"error: {name} has ended by CONSTRAINT_ERROR: ")
    assert found.trace.endswith("END\n")
    #  the shutdown of the model was carried out: its chart has taken the event
    generated = ROOT / "examples" / "cartesian_robot" / "generated"
    elements = json.loads((generated / "trace.json").read_text())["elements"]
    shutdown = next(e["id"] for e in elements if e["element"] == "coordinator.Shutdown")
    assert re.search(rf"^T \d+ Raised {shutdown} ", found.trace, re.M)


@shows(
    "a soak in which a random task of the robot is killed at a random time",
    found_by="the fallback handler of task termination; the last-chance handler",
    reaction="shutdown of the model where the main program lives, exit status 1 with the reason",
    within="5 s",
)
def test_a_soak_of_killed_tasks_always_ends_in_the_shutdown(tmp_path: Path) -> None:
    chosen = random.Random(18)
    for _ in range(300 if LONG else 6):
        mode = chosen.choice(("checks", "release"))
        found = _hit(mode, chosen.randrange(64), tmp_path, chosen.uniform(0.0, 0.5))
        assert found.status == 1
        assert "has ended by CONSTRAINT_ERROR: " in found.reasons[0]
        if "the main program" not in found.reasons[0]:
            assert found.trace.endswith("END\n")


@shows(
    "an exception in the main program",
    found_by="the action for unhandled exceptions",
    reaction="exit status 1, with the reason",
)
@pytest.mark.parametrize("mode", ["checks", "release"])
def test_an_exception_in_the_main_program_ends_the_process(tmp_path: Path, mode: str) -> None:
    found = _hit(mode, -1, tmp_path)
    assert found.status == 1
    (reason,) = found.reasons
    assert reason.startswith("error: the main program has ended by CONSTRAINT_ERROR: ")
