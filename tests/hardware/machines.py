# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Machines to run Ada programs on: this one, and others by cross compiler and emulation.

What is built for another machine is linked statically and runs in QEMU's user mode: its
processor is emulated, and the kernel is this machine's.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from ravenchart.failures import ToolFailed
from tests.support import compiler

SWITCHES = ("-gnat2012", "-gnata", "-O1")


@dataclass(frozen=True, slots=True)
class Machine:
    """A machine; without an emulator it is this one."""

    name: str
    about: str
    compiler: str
    emulator: str | None = None

    def missing(self) -> Iterator[str]:
        """Why nothing can run there: nothing when something can."""
        for tool in (self.compiler, self.emulator):
            if tool is not None and shutil.which(tool) is None:
                hint = "`scripts/setup.sh guest` installs it" if self.emulator else "`make setup`"
                yield f"{self.about}: {tool} is not on PATH ({hint})"

    def build(
        self, mains: Sequence[Path], sources: Sequence[Path], folder: Path, *switches: str
    ) -> None:
        """Programs from ``mains``, with every contract executed, in ``folder``."""
        command = [self.compiler, "-q", *SWITCHES, *switches, *map(str, mains)]
        command += [f"-aI{place}" for place in sources]
        if self.emulator is None:
            command += compiler.options()
        else:
            command += ["-bargs", "-static", "-largs", "-static"]
        done = subprocess.run(
            command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
            check=False,
        )  # fmt: skip
        if done.returncode != 0:
            raise ToolFailed(done.stdout)

    def command(self, program: Path) -> tuple[str, ...]:
        """What runs a program that was built for it."""
        return (str(program),) if self.emulator is None else (self.emulator, str(program))


HERE = Machine("here", "this machine", "gnatmake")
OTHERS = (
    Machine("s390x", "s390x, big-endian", "s390x-linux-gnu-gnatmake", "qemu-s390x-static"),
    Machine("armhf", "Arm, 32 bits", "arm-linux-gnueabihf-gnatmake", "qemu-arm-static"),
)
