# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The Ada tests on machines of another byte order or word length, in QEMU's user mode."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.hardware.machines import OTHERS, Machine
from tests.support.elsewhere import needed

COMMON = (
    *("spark_runtime/src", "spark_runtime/native"),
    *("hw_can/hal", "hw_can/drivers/serial", "hw_can/protocol", "hw_can/simulator"),
    *("tests/ada", "proofs/instances"),
)
MAINS = {
    "hw_can/drivers/loopback": (
        "test_queues",
        "test_store",
        "test_calls",
        "test_regions",
        "test_clocks",
        "test_records",
        "test_frames",
        "test_slcan",
        "test_fault_confinement",
        "test_controller",
    ),
    "hw_can/drivers/socketcan": ("test_socket_frames",),
    "hw_can/drivers/ctucanfd": ("test_ctu_frames",),
    "hw_can/drivers/xilinx": ("test_xcan_frames",),
}
"""The programs, by the driver they need. Left out are the simulator's, which emulated take many
minutes; that of Hosts, whose body has the numbers of this machine's Linux; and that of the
processors, as GNAT for s390x has no Ada.Execution_Time."""


@dataclass(frozen=True, slots=True)
class Programs:
    """All programs, built for one machine."""

    machine: Machine
    folder: Path


@pytest.fixture(scope="module", params=OTHERS, ids=[machine.name for machine in OTHERS])
def programs(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Programs:
    machine: Machine = needed(request.param)
    folder = tmp_path_factory.mktemp(machine.name)
    profile = f"-gnatec={ROOT / 'spark_runtime' / 'ravenscar.adc'}"
    for driver, mains in MAINS.items():
        (folder / driver).mkdir(parents=True)
        machine.build(
            [ROOT / "tests" / "ada" / f"{main}.adb" for main in mains],
            [ROOT / place for place in (*COMMON, driver)],
            folder / driver,
            profile,
        )
    return Programs(machine, folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("driver", "main"), [(driver, main) for driver, mains in MAINS.items() for main in mains]
)
def test_every_fact_holds_there_too(programs: Programs, driver: str, main: str) -> None:
    done = subprocess.run(
        programs.machine.command(programs.folder / driver / main),
        capture_output=True, text=True, timeout=300, check=False,
    )  # fmt: skip
    facts = [line for line in done.stdout.splitlines() if line.startswith(("ok ", "not ok "))]
    assert facts, done.stdout + done.stderr
    assert [f for f in facts if f.startswith("not ok")] == []
    assert done.returncode == 0
