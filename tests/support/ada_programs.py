# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The programs of tests/ada, built with a driver."""

from __future__ import annotations

import subprocess
from pathlib import Path

from ravenchart.paths import ROOT
from ravenchart.tools import toolchain


def built(mode: str, driver: str, *mains: str) -> Path:
    """The folder of the programs ``mains``, or of all without any, built in that mode."""
    options = ["-p", "-q", "-j0", "-P", "tests.gpr", *(f"{main}.adb" for main in mains)]
    scenario = {"MODE": mode, "CAN_DRIVER": driver}
    toolchain.run("gprbuild", options, ROOT / "tests" / "ada", scenario)
    return ROOT / "obj" / f"tests-{mode}-{driver}" / "bin"


def ran(
    main: str, *arguments: str, timeout: float | None = None
) -> subprocess.CompletedProcess[str]:
    """The program ``main``, run as it is released, without a driver's hardware."""
    program = built("release", "loopback", main) / main
    return subprocess.run(
        [program, *arguments], capture_output=True, text=True, timeout=timeout, check=False
    )
