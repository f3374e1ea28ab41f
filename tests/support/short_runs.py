# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The program of a model with one node, run for some seconds: what its trace shows."""

from __future__ import annotations

import signal
import subprocess
import time
from contextlib import nullcontext
from pathlib import Path

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import generation, programs
from ravenchart.building.checking import Checked

from . import live


def observed(checked: Checked, folder: Path, seconds: float, *, waits: bool = True) -> Observation:
    """Generate, build and run the program of the model in a folder, and stop it.

    It ``waits`` until no other worker runs one; a test marked ``live`` has waited already.
    """
    generation.write_program(checked)
    trace, program = folder / "trace", programs.programs_of(checked)[0].build()
    with live.alone() if waits else nullcontext():
        process = subprocess.Popen([program], env={"RAVENCHART_TRACE": str(trace)})
        time.sleep(seconds)
        process.send_signal(signal.SIGTERM)
        assert process.wait(5) == 0
    names = read_map((folder / "generated" / "trace.json").read_text(encoding="utf-8"))
    return read_trace(trace.read_text(encoding="ascii").splitlines(), names)
