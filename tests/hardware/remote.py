# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The shell and a scenario over SocketCAN, with the crossing's controller in a process beside them.

Run as ``python -P -m tests.hardware.remote PROGRAM INTERFACE``; the program is built with the
driver `socketcan`. It prints "ok" and "not ok" lines, as the programs of tests/ada do. The guest
is slow; the crossing has periods of 100 ms.
"""

from __future__ import annotations

import argparse
import io
import os
import subprocess
import sys
import tempfile
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

from ravenchart.command_line import main as command
from ravenchart.paths import ROOT

MODEL = ROOT / "examples" / "crossing" / "model.yaml"
SCRIPT = "wait_for walk_lamp.value Dark 60 s\nsend Work\nwait_for walk_lamp.value Wait 60 s\n"
SCENARIO = """\
scenario: Out of service
steps:
  - {wait_for: walk_lamp.value, is: Wait, within: 60 s}
  - {send: order, with: {value: Blink}}
  - {wait_for: walk_lamp.value, is: Dark, within: 60 s}
expect_trace:
  - {region: school.Lights, reaches: Blinking}
"""
SEEN = "verdict: PASS (timing, expect_trace not judged: only the frames on the bus are seen)"


def _called(*words: str) -> tuple[int, str]:
    """The exit status of a command, and what it prints."""
    out = io.StringIO()
    with redirect_stdout(out), redirect_stderr(out):
        status = command(words)
    print(out.getvalue(), flush=True)
    return status, out.getvalue()


def tried(interface: str, folder: Path) -> bool:
    """Print what holds of the two commands on that interface; whether all does."""
    bus = ("--interface", "socketcan", "--channel", interface)
    sys.stdin = io.StringIO(SCRIPT)
    status, said = _called("shell", str(MODEL), *bus)
    led = status == 0 and "walk_lamp.value is Wait after" in said
    plan = folder / "scenario.yaml"
    plan.write_text(SCENARIO, encoding="utf-8")
    report = ("--report", str(folder / "report"))
    status, said = _called("run", str(MODEL), "--scenario", str(plan), *bus, *report)
    played = status == 0 and SEEN in said
    print(f"{_holds(led)} the shell sends a command, and the controller answers")
    print(f"{_holds(played)} the scenario is played and passes")
    return led and played


def _holds(fact: bool) -> str:
    return "ok" if fact else "not ok"


def main() -> int:
    """0 when every fact holds, else 1."""
    parser = argparse.ArgumentParser(prog="remote")
    parser.add_argument("program", type=Path, metavar="PROGRAM")
    parser.add_argument("interface", metavar="INTERFACE")
    told = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        named = {"RAVENCHART_CAN_INTERFACE": told.interface}
        with subprocess.Popen(
            [told.program],
            env={**os.environ, **named, "RAVENCHART_TRACE": f"{folder}/trace.txt"},
            stdin=subprocess.DEVNULL,
        ) as process:
            try:
                return 0 if tried(told.interface, Path(folder)) else 1
            finally:
                process.terminate()


if __name__ == "__main__":
    raise SystemExit(main())
