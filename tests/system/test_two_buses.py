# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The example on two simulated buses: values over both, one of them cut, and both watched."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.building import checking, programs
from ravenchart.paths import ROOT
from ravenchart.running.controllers import bus_servers, controller, joining
from ravenchart.running.process import ControllerProcess
from ravenchart.running.remote import connect
from ravenchart.running.runs import run_nodes

pytestmark = [pytest.mark.live, pytest.mark.alone]

FOLDER = ROOT / "examples" / "two_buses"
MODEL = FOLDER / "model.yaml"


@pytest.mark.parametrize("scenario", ["scenario", "cut_chassis"])
def test_the_scenario_passes(scenario: str, tmp_path: Path) -> None:
    checked = checking.check(MODEL)
    controllers = tuple(controller(made) for made in programs.programs_of(checked))
    outcome = run_nodes(
        controllers,
        checked.analysis,
        FOLDER / "generated",
        FOLDER / f"{scenario}.yaml",
        0.0,
        tmp_path,
        log=tmp_path / "run.blf",
    )
    #  how long a response takes is for runs on a machine of their own to say
    assert [(step.text, step.outcome) for step in outcome.steps if not step.passed] == []
    assert (outcome.ended.exit_code, outcome.ended.killed) == (0, False)
    for bus, own, other in (("chassis", 0x100, 0x200), ("cabin", 0x200, 0x300)):
        with can.LogReader(tmp_path / f"run-{bus}.blf") as frames:
            seen = {frame.arbitration_id for frame in frames if not frame.is_error_frame}
        assert own in seen and other not in seen
    if scenario == "scenario":
        assert {journey.chain for journey in outcome.journeys} == {"by_chassis", "by_cabin"}


@pytest.fixture
def running(tmp_path: Path) -> Iterator[dict[str, str]]:
    """The channel of each bus, while all nodes run."""
    checked = checking.check(MODEL)
    controllers = tuple(controller(made) for made in programs.programs_of(checked))
    traces = [tmp_path / one.node for one in controllers]
    processes: list[ControllerProcess] = []
    with bus_servers(checked.system, controllers, None, None) as channels:
        try:
            for one, joined in joining(checked.system, controllers, traces, channels, [0, 1]):
                processes.append(one)
                one.wait_until_joined(joined)
            yield channels
        finally:
            for one in processes:
                one.stop(0.1)


def test_a_python_program_speaks_on_both_buses(running: dict[str, str]) -> None:
    channels = [f"{bus}={channel}" for bus, channel in running.items()]
    with connect(MODEL, interface="ravenchart", channel=channels) as car:
        car.send("pedal", pressed=True)
        car.wait_for("advice.value", "Slow_Down", timeout=6.0)


def test_the_monitor_finds_both_buses_of_a_run(running: dict[str, str]) -> None:
    time.sleep(1.0)
    call = [sys.executable, "-P", "-m", "ravenchart", "monitor", str(MODEL), "--once", "--json"]
    said = subprocess.run(call, capture_output=True, text=True, check=True, timeout=60)
    buses = {bus["bus"]: bus for bus in json.loads(said.stdout)["result"]["buses"]}
    assert buses.keys() == {"chassis", "cabin"}
    for bus in buses.values():
        assert bus["frames"] > 20 and bus["unknown"] == 0
        assert 0 < bus["load"] <= bus["bound"]
