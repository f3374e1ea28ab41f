# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The variants of a program: targets, CAN drivers and registers.

The options of commands are made of them, and shall not wait for the modules that build programs.
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
"""The kinds of device registers: see the project file of a program."""


def targets() -> tuple[str, ...]:
    """Every target, that of this machine first."""
    found = sorted(path.parent.name for path in RUNTIME.glob("*/target.toml"))
    return (NATIVE, *(name for name in found if name != NATIVE))
