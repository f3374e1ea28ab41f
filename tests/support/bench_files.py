# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a run of the stand-in controller needs, written to a directory."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

from ravenchart.analysis.system.timing import Analysis, analyse
from tests.support.robot_files import dbc, trace_map
from tests.support.systems import bus, message, system, task

STAND_IN = Path(__file__).with_name("stand_in.py")

DRIVE = """\
  x:
    set_point: x_set_point
    feedback: x_feedback
    target: robot_command.x
    states: joint_x.Motion
    stroke: 100 mm
    start: 10 mm
    low_switch: 8 mm
    high_switch: 90 mm
    count_at_start: 4711
"""


@dataclass(frozen=True, slots=True)
class Files:
    """One axis: executable, map, database, scenario, and the bounds of its one task."""

    executable: Path
    trace_json: Path
    dbc: Path
    scenario: Path
    out: Path
    analysis: Analysis


def scenario_text(steps: str, checks: str = "") -> str:
    """A scenario with one short axis."""
    return f"scenario: A test\ndrives:\n{DRIVE}steps:\n{steps}{checks}"


def write_files(directory: Path, scenario: str, *options: str) -> Files:
    """Everything for one run; ``options`` are the stand-in's."""
    executable, database = directory / "controller", directory / "robot.dbc"
    trace_json, plan = directory / "trace.json", directory / "scenario.yaml"
    database.write_text(dbc(["x"]))
    trace_json.write_text(trace_map(["x"]))
    plan.write_text(scenario)
    words = [sys.executable, STAND_IN, database, trace_json, *options]
    executable.write_text("#!/bin/sh\nexec " + " ".join(f"'{w}'" for w in words) + "\n")
    executable.chmod(0o755)
    messages = [message("robot_command", 0x080, target="coordinator.command")]
    one = system([task("control", 1, 500_000, 10_000_000)], (), [bus()], messages)
    return Files(executable, trace_json, database, plan, directory / "out", analyse(one))
