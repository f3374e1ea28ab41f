"""One run of a controller on an emulated board: nothing but the program disturbs its time."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from ravenchart.analysis.system.observed import read_map
from ravenchart.building.targets import Board, Emulator
from ravenchart.failures import Unusable
from ravenchart.hw_can.bench.peer import BenchError, Codec
from ravenchart.hw_can.bench.runner import ScenarioResult, run_scenario
from ravenchart.hw_can.bench.scenario import Scenario, ScenarioError, load_scenario
from ravenchart.tools import children

from . import board_bus, bus_log, runs
from .process import Ended
from .result import RunResult

LONGEST = 1e9
"""A run that its bench ends, in s."""

Process = subprocess.Popen[str]

PATIENCE = 60.0
"""How long a second of a run may take, and the start of the emulator, in s."""

SAID = ("error: ", "warning: ")
"""How lines begin that a controller says besides its report."""


def run_board(board: Board, request: runs.RunRequest, progress: runs.Progress) -> RunResult:
    """Run a program on the emulator of its board; Unusable where it has none.

    Virtual time depends on the instructions alone, so no bound has an excuse. The bench of a
    scenario is in that time too.
    """
    emulator = board.target.facts.emulator
    if emulator is None or shutil.which(emulator.command[0]) is None:
        hint = emulator.hint if emulator else "run the program on the board itself"
        raise Unusable(f"the target {board.target.name} has no emulator on PATH; {hint}")
    folder = request.folder.absolute()
    folder.mkdir(parents=True, exist_ok=True)
    report = folder / "serial.txt"
    report.unlink(missing_ok=True)
    seconds = LONGEST if request.scenario else request.seconds
    image = request.controllers[0].executable
    words = command(board, emulator, image, report, seconds)
    if request.scenario is not None:
        return _played(board, request, request.scenario, words, progress)
    progress(f"emulate {seconds:g} s")
    with _started(words, folder) as process:
        ended, problems = _ended(process, PATIENCE * (1.0 + seconds))
    title = f"{seconds:g} s on {board.target.name}"
    return _concluded(title, None, None, request, ended, problems)


def _played(
    board: Board,
    request: runs.RunRequest,
    scenario: Path,
    words: Sequence[str],
    progress: runs.Progress,
) -> RunResult:
    """Play a scenario by the gateway of the board. Raises as `runs.run_controller`."""
    plan = load_scenario(scenario)
    if plan.bus_events:
        raise ScenarioError(f"{scenario.name}: error: `bus` is for a system with several nodes")
    dbc = runs.dbc_of(request)
    codec = Codec.from_file(dbc)
    played: ScenarioResult | None = None
    folder = request.folder.absolute()
    with (
        bus_log.recorded(request.log, dbc.stem) as record,
        board_bus.pipes(folder) as ends,
        _started(words, folder) as process,
    ):
        try:
            peer = board_bus.BoardPeer(ends, lambda: process.poll() is None, codec, record)
            asked: list[bool] = []

            def is_over() -> bool:
                if not asked:
                    asked.append(True)
                    peer.end()
                return False  # the end of the board ends the bench

            played = run_scenario(plan, peer, progress=progress, ended=is_over)
            ended, told = _ended(process, PATIENCE)
        except BenchError as fault:
            process.kill()  # it waits for the bench, and hears no other signal
            ended, told = Ended(0, False, True, ()), [str(fault)]
    title = f"{plan.title}, on {board.target.name}"
    return _concluded(title, plan, played, request, ended, told)


def _concluded(
    title: str,
    plan: Scenario | None,
    played: ScenarioResult | None,
    request: runs.RunRequest,
    ended: Ended,
    problems: list[str],
) -> RunResult:
    """What a run showed by the serial line of its report."""
    report = request.folder / "serial.txt"
    lines = report.read_text("ascii", "replace").splitlines() if report.is_file() else []
    said = tuple(line for line in lines if line.startswith(SAID))
    ended = replace(ended, warnings=(*ended.warnings, *said))
    trace = request.folder / "trace.txt"
    kept = [f"{line}\n" for line in lines if not line.startswith(SAID)]
    trace.write_text("".join(kept), encoding="ascii")
    seen = runs.read(trace, read_map(*_map(request.controllers[0])), problems)
    if seen is not None:
        seen.host_latency = None
    return runs.concluded(title, plan, played, seen, ended, problems, request.analysis)


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


@contextmanager
def _started(words: Sequence[str], folder: Path) -> Iterator[Process]:
    """The emulator in a folder, for the time of a block."""
    with children.running(
        words,
        cwd=folder,
        stdin=subprocess.DEVNULL,
        env={**os.environ, "QEMU_AUDIO_DRV": "none"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        yield process


def _ended(process: Process, limit: float) -> tuple[Ended, list[str]]:
    """Wait for the end of an emulator for ``limit`` seconds, and what went wrong."""
    try:
        _, errors = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        return Ended(1, True, True, ()), [f"the emulator did not end within {limit:g} s"]
    own = [line for line in errors.splitlines() if "error" in line.lower()]
    return Ended(process.returncode, False, True, ()), own
