# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`replay` of a scenario: a log as input, at its times, and only what comes from outside."""

from __future__ import annotations

from pathlib import Path

import can
import pytest

from ravenchart.building import checking
from ravenchart.hw_can.bench.peer import Codec
from ravenchart.hw_can.bench.scenario import ScenarioError, load_scenario, parse_scenario
from ravenchart.running import scenarios
from tests.support.bench_files import scenario_text, write_files
from tests.support.processes import ROOT
from tests.unit.hw_can.test_bench_run import run

STEPS = """\
  - wait: 50 ms
  - {{replay: {name}}}
  - {{wait_for: robot_status.condition, is: Ready, within: 4 s}}
"""
LATER = 0.3
"""Seconds between the first and the last frame of the log."""


def write_log(path: Path, codec: Codec) -> None:
    """A command, then frames that nobody may replay, and the command again."""
    home = codec.encode("robot_command", {"kind": "Home", "x": 0})
    own = codec.encode("robot_status", {"condition": "Ready", "x": 0})
    drive = codec.encode(
        "x_feedback", {"count": 0, "speed": 0, "limit": "Clear", "condition": "Faulted"}
    )
    unknown = can.Message(arbitration_id=0x7A0, is_extended_id=False, data=b"1")
    short = can.Message(arbitration_id=home.arbitration_id, is_extended_id=False, data=b"1")
    failed = can.Message(is_error_frame=True, arbitration_id=8, data=bytes(8))
    with can.Logger(path) as logger:
        for number, frame in enumerate((home, own, drive, unknown, short, failed)):
            frame.timestamp = 1_000.0 + 0.01 * number
            logger(frame)
        home.timestamp = 1_000.0 + LATER
        logger(home)


@pytest.mark.parametrize("suffix", [".blf", ".asc", ".log"])
def test_a_log_is_sent_at_its_times_and_only_what_comes_from_outside(
    tmp_path: Path, suffix: str
) -> None:
    name = f"field{suffix}"
    files = write_files(tmp_path, scenario_text(STEPS.format(name=name)))
    write_log(tmp_path / name, Codec.from_file(files.dbc))
    result = run(files)
    assert result.failures == ()
    bench = result.scenario_result
    assert bench is not None
    step = bench.steps[1]
    assert (step.text, step.outcome) == (f"replay {name}", "2 of 6 frames sent")
    assert LATER <= step.ended - step.began < LATER + 0.2
    assert bench.sent["robot_command"] == 2
    assert "robot_status" not in bench.sent


@pytest.mark.parametrize(
    ("name", "octets", "message"),
    [
        ("absent.blf", None, "cannot read"),
        ("notes.txt", b"", "notes.txt has no suffix of .asc, .blf, .log"),
        ("broken.blf", b"no log" * 40, "broken.blf is no log of this format"),
        ("empty.log", b"", "empty.log has no frame"),
    ],
)
def test_a_log_that_cannot_be_read_is_told_at_its_name(
    tmp_path: Path, name: str, octets: bytes | None, message: str
) -> None:
    if octets is not None:
        (tmp_path / name).write_bytes(octets)
    plan = tmp_path / "scenario.yaml"
    plan.write_text(f"scenario: x\nsteps:\n  - {{replay: {name}}}\n")
    with pytest.raises(ScenarioError) as caught:
        load_scenario(plan)
    head, line, pointer = str(caught.value).splitlines()[:3]
    assert head.startswith(f"{plan}:3:14: error: ") and message in head
    assert pointer.index("^") == line.index(name)


def test_a_log_without_a_message_of_the_model_is_told(tmp_path: Path) -> None:
    with can.Logger(tmp_path / "other.log") as logger:
        logger(can.Message(arbitration_id=0x7A0, is_extended_id=False, timestamp=1.0))
    system = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    text = "scenario: x\nsteps: [{replay: other.log}]\n"
    (one,) = scenarios.problems(parse_scenario(text, str(tmp_path / "scenario.yaml")), system)
    assert one.message == "no frame of other.log is a message that comes from outside the model"
    assert one.hint is not None and "robot_command" in one.hint
