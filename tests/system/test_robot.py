# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The Cartesian robot against the bench, as `make demo` runs it, and when things go wrong."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import time
from functools import partial
from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.running.process import ControllerProcess
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import run_controller
from tests.support import live
from tests.support.faults import shows

pytestmark = [pytest.mark.alone, pytest.mark.slow]

HERE = Path("examples/cartesian_robot")


def _run(robot: tuple[checking.Checked, Path], scenario: str, folder: Path) -> RunOutcome:
    checked, executable = robot
    generated = checked.folder / "generated"
    play = partial(
        run_controller,
        executable,
        generated / "trace.json",
        generated / "robot_bus.dbc",
        checked.folder / scenario,
        None,
        folder,
        lambda _text: None,
        analysis=checked.analysis,
    )
    return live.played(play)


def test_it_homes_reaches_its_targets_and_fails_safe_on_a_limit_switch(
    robot: tuple[checking.Checked, Path], tmp_path: Path
) -> None:
    outcome = _run(robot, "scenario.yaml", tmp_path)
    assert outcome.failures == ()
    seen = outcome.observation
    assert seen is not None
    visited = seen.states_visited()
    assert {"Idle", "Seeking", "Backing_Off", "Cruising", "Braking"} <= set(
        visited["joint_z.Motion"]
    )
    assert visited["joint_x.Motion"][-1] == "Limit"
    assert seen.faults["Queue_Overflow"] == 0


@shows(
    "the bench disappears in mid-travel",
    found_by="stale input of each joint",
    reaction="every joint and the coordinator are in their safe states; clean exit",
    within="200 ms from the last arrival",
)
def test_a_bench_that_disappears_leads_to_the_safe_state_and_a_clean_exit(
    robot: tuple[checking.Checked, Path], tmp_path: Path
) -> None:
    outcome = _run(robot, "lost_bench.yaml", tmp_path)
    assert outcome.failures == ()
    seen = outcome.observation
    assert seen is not None
    assert seen.faults["Stale_Input"] >= 3
    assert seen.states_visited()["coordinator.Mission"][-1] == "Shut_Down"


def test_sigterm_without_any_bench_ends_it_cleanly_within_its_grace(
    robot: tuple[checking.Checked, Path], tmp_path: Path
) -> None:
    process = ControllerProcess(robot[1], tmp_path / "trace", 0)
    time.sleep(0.6)
    began = time.monotonic()
    ended = process.stop(0.5)
    assert (ended.exit_code, ended.killed) == (0, False)
    assert time.monotonic() - began < 2.0
    assert (tmp_path / "trace").read_text().endswith("END\n")


@pytest.mark.skipif(os.getuid() != 0, reason="needs root to become an ordinary user")
def test_an_ordinary_user_is_told_that_there_are_no_real_time_priorities(
    robot: tuple[checking.Checked, Path], tmp_path: Path
) -> None:
    program = tmp_path / "controller"
    shutil.copy(robot[1], program)
    for folder in (tmp_path, *tmp_path.parents[:-1]):
        if folder.stat().st_uid == os.getuid() and "pytest" in folder.name:
            folder.chmod(0o755)
    place = Path("/tmp") / f"ravenchart-{os.getpid()}"
    place.mkdir()
    try:
        shutil.copy(program, place)
        place.chmod(0o777)
        process = subprocess.Popen(
            [place / "controller"],
            env={"RAVENCHART_TRACE": str(place / "trace")},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            user=65534,
        )
        time.sleep(0.8)
        process.send_signal(signal.SIGTERM)
        _, said = process.communicate(timeout=5)
        assert process.returncode == 0
        assert "real-time priorities are not available" in said
        assert (place / "trace").read_text().endswith("END\n")
    finally:
        shutil.rmtree(place)


@pytest.mark.skipif(os.getuid() != 0, reason="needs root for real-time priorities")
@pytest.mark.parametrize("allowed", [True, False])
def test_its_memory_is_locked_or_it_says_that_it_cannot(
    robot: tuple[checking.Checked, Path], tmp_path: Path, *, allowed: bool
) -> None:
    without = ["setpriv", "--inh-caps=-ipc_lock", "--bounding-set=-ipc_lock"]
    process = subprocess.Popen(
        [*([] if allowed else without), robot[1].absolute()],
        env={**os.environ, "RAVENCHART_TRACE": str(tmp_path / "trace")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    time.sleep(0.8)
    status = Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=5)
    assert process.returncode == 0
    assert ("VmLck:\t       0 kB" not in status) is allowed
    assert ("the memory cannot be locked" not in said) is allowed
