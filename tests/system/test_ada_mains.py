# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The Ada tests: the same output with all contracts executed and with all checks off."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support.ada_programs import built
from tests.support.modes import MODES

pytestmark = pytest.mark.clock

MAINS = (
    "test_queues",
    "test_store",
    "test_calls",
    "test_regions",
    "test_clocks",
    "test_records",
    "test_frames",
    "test_slcan",
    "test_arbitration",
    "test_wire",
    "test_fault_confinement",
    "test_fault_notices",
    "test_data_crcs",
    "test_protection",
    "test_cmac",
    "test_authentication",
    "test_transmissions",
    "test_iso_tp",
    "test_bus",
    "test_bus_faults",
    "test_frame_ends",
    "test_processors",
    "test_releases",
    "test_supervision",
    "test_host",
    "test_controller",
)


SLOW = {"test_calls", "test_cmac", "test_protection", "test_store", "test_wire"}
OF_DRIVERS = (
    ("socketcan", "test_socket_frames"),
    ("ctucanfd", "test_ctu_frames"),
    ("xilinx", "test_xcan_frames"),
)
"""Programs that need the sources of a driver."""
LIMIT = 300.0
"""Seconds after which a program hangs, however busy the machine is."""


@pytest.fixture(scope="module", params=MODES)
def mode(request: pytest.FixtureRequest) -> str:
    """Both builds of the tests."""
    chosen: str = request.param
    built(chosen, "loopback")
    return chosen


@pytest.mark.parametrize(
    "main", [pytest.param(m, marks=pytest.mark.slow if m in SLOW else ()) for m in MAINS]
)
def test_every_fact_holds(mode: str, main: str) -> None:
    _holds(ROOT / "obj" / f"tests-{mode}-loopback" / "bin" / main)


def test_the_supervisor_ends_a_program_whose_main_program_does_not(mode: str) -> None:
    program = ROOT / "obj" / f"tests-{mode}-loopback" / "bin" / "test_supervision"
    done = subprocess.run([program, "wait"], capture_output=True, text=True, timeout=LIMIT)
    assert done.returncode == 1
    lines = done.stderr.splitlines()
    silent = "is silent: a release has not completed by its deadline and the margin of its"
    reasons = [line for line in lines if line.startswith("error: ")]
    assert {line.split()[1] for line in reasons if silent in line} == {"stuck", "served"}
    assert reasons[-1] == (
        "error: the main program did not end the controller in time: its report is missing"
    )


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("driver", "main"), OF_DRIVERS)
def test_every_fact_of_a_driver_holds(mode: str, driver: str, main: str) -> None:
    _holds(built(mode, driver, main) / main)


def _holds(program: Path) -> None:
    """It prints facts, all of them ok."""
    done = subprocess.run([program], capture_output=True, text=True, timeout=LIMIT, check=False)
    facts = [line for line in done.stdout.splitlines() if line.startswith(("ok ", "not ok "))]
    assert facts, done.stdout + done.stderr
    assert [f for f in facts if f.startswith("not ok")] == []
    assert done.returncode == 0
