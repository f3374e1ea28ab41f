# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What programs can be built for: targets, CAN drivers and registers.

Apart from what builds them: the options of commands are made of it, and shall not wait for that.
"""

from __future__ import annotations

from ravenchart.paths import ROOT

RUNTIME = ROOT / "spark_runtime"
NATIVE = "native"
"""The target of this machine."""
RTS_VARIABLE = "RAVENCHART_RTS"
"""Names the run-time library where a command is not given one."""

DRIVER_FOLDERS = {
    "loopback": ("drivers/loopback",),
    "slcan": ("drivers/slcan", "drivers/serial", "drivers/tcp", "drivers/sockets"),
    "bus": ("drivers/bus", "drivers/tcp", "drivers/sockets"),
    "socketcan": ("drivers/socketcan", "drivers/sockets"),
    "ctucanfd": ("drivers/ctucanfd",),
    "xilinx": ("drivers/xilinx",),
}
"""The folders of hw_can/ that ravenchart.gpr adds for each driver."""


DRIVERS = tuple(DRIVER_FOLDERS)
REGISTERS = ("simulated", "hardware")
"""What the registers of devices can be: see the project file of a program."""


def targets() -> tuple[str, ...]:
    """Every target, that of this machine first."""
    found = sorted(path.parent.name for path in RUNTIME.glob("*/target.toml"))
    return (NATIVE, *(name for name in found if name != NATIVE))
