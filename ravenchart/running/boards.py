"""One run of a controller on an emulated board: nothing but the program disturbs its time."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path

from ravenchart.analysis.system.observed import read_map
from ravenchart.building.targets import Board, Emulator
from ravenchart.failures import Unusable
from ravenchart.tools import children

from . import runs
from .process import Ended
from .result import RunResult

PATIENCE = 60.0
"""How long a second of a run may take, and the start of the emulator, in s."""

SAID = ("error: ", "warning: ")
"""How lines begin that a controller says besides its report."""


def run_board(board: Board, request: runs.RunRequest, progress: runs.Progress) -> RunResult:
    """Run a program on the emulator of its board; Unusable where it has none.

    Virtual time depends on the instructions alone, so no bound has an excuse.
    """
    controller, seconds, out_dir = request.controllers[0], request.seconds, request.folder
    emulator = board.target.facts.emulator
    if emulator is None or shutil.which(emulator.command[0]) is None:
        hint = emulator.hint if emulator else "run the program on the board itself"
        raise Unusable(f"the target {board.target.name} has no emulator on PATH; {hint}")
    out_dir.mkdir(parents=True, exist_ok=True)
    report = (out_dir / "serial.txt").absolute()
    report.unlink(missing_ok=True)
    words = command(board, emulator, controller.executable, report, seconds)
    progress(f"emulate {seconds:g} s")
    ended, problems = _emulated(words, PATIENCE * (1.0 + seconds))
    lines = report.read_text("ascii", "replace").splitlines() if report.is_file() else []
    said = tuple(line for line in lines if line.startswith(SAID))
    ended = Ended(ended.exit_code, ended.killed, True, (*ended.warnings, *said))
    trace = out_dir / "trace.txt"
    kept = [f"{line}\n" for line in lines if not line.startswith(SAID)]
    trace.write_text("".join(kept), encoding="ascii")
    seen = runs.read(trace, read_map(*_map(controller)), problems)
    if seen is not None:
        seen.host_latency = None
    title = f"{seconds:g} s on {board.target.name}"
    return runs.concluded(title, None, None, seen, ended, problems, request.analysis)


def command(
    board: Board, emulator: Emulator, image: Path, report: Path, seconds: float
) -> list[str]:
    """The words that run an image for that long, with its serial line written to a file."""
    told = {
        "image": image.absolute(),
        "report": report.absolute(),
        "clock": board.clock_rate,
        "run_time": round(seconds * 1e9),
    }
    return [part.format(**told) for part in emulator.command]


def _map(controller: runs.Controller) -> tuple[str, str]:
    return controller.trace_json.read_text(encoding="utf-8"), controller.trace_json.name


def _emulated(words: Sequence[str], limit: float) -> tuple[Ended, list[str]]:
    """Run an emulator to its end, or for ``limit`` seconds, and what went wrong."""
    quiet = {**os.environ, "QEMU_AUDIO_DRV": "none"}
    with children.running(
        words,
        stdin=subprocess.DEVNULL,
        env=quiet,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            _, errors = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            told = f"the emulator did not end within {limit:g} s"
            return Ended(1, True, True, ()), [told]
    own = [line for line in errors.splitlines() if "error" in line.lower()]
    return Ended(process.returncode, False, True, ()), own
