# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One run of a controller on an emulated board: nothing but the program disturbs its time."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import replace
from functools import partial
from pathlib import Path

from ravenchart.analysis.system.observed import Observation, merged, read_map
from ravenchart.building.targets import Board, Emulator
from ravenchart.failures import Unusable
from ravenchart.hw_can.bench.peer import BenchError, Codec
from ravenchart.hw_can.bench.runner import Progress, ScenarioResult, run_scenario
from ravenchart.hw_can.bench.scenario import Scenario, ScenarioError, load_scenario
from ravenchart.tools import children

from . import board_bus, bus_log, runs
from .controllers import Controller
from .process import STOP_MARGIN, Ended
from .result import RunOutcome
from .traces.reports import BEGIN, SAID

SERIAL = "serial.txt"

LONGEST = 1e9
"""A run that its bench ends, in s."""

Process = subprocess.Popen[str]

PATIENCE = 60.0
"""How long a second of a run may take, and the start of the emulator, in s."""


def run_board(board: Board, request: runs.RunRequest, progress: Progress) -> RunOutcome:
    """Run a program on the emulator of its board; Unusable where it has none.

    Virtual time depends on the instructions alone, so no bound on one core has an excuse. The bench
    of a scenario is in that time too.
    """
    emulator = board.target.facts.emulator
    cores = request.analysis.system.most_cores
    if emulator is not None and cores > 1 and "{cores}" not in emulator.command:
        raise Unusable(
            f"the emulator of {board.target.name} starts one core only, and the model has tasks on "
            "several: run it without `--target`"
        )
    if len(request.analysis.system.buses) > 1:
        raise Unusable(
            f"the emulator of {board.target.name} joins one bus only, and the model has several: "
            "run it without `--target`"
        )
    if emulator is None or shutil.which(emulator.command[0]) is None:
        hint = emulator.hint if emulator else "run the program on the board itself"
        raise Unusable(f"the target {board.target.name} has no emulator on PATH; {hint}")
    if request.scenario is not None or len(request.controllers) > 1:
        return _joined(board, emulator, request, progress)
    seconds = request.seconds
    image = request.controllers[0].executable
    words = command(board, emulator, image, _report(request), seconds, cores)
    progress(f"emulate {seconds:g} s")
    with _started(words, request.folder) as process:
        ended, problems = _ended(process, PATIENCE * (1.0 + seconds))
    title = f"{seconds:g} s on {board.target.name}"
    return _concluded(title, None, None, request, ended, problems)


def _home(request: runs.RunRequest, controller: Controller) -> Path:
    """The folder that the board of a node writes to: its own where there are several."""
    several = len(request.controllers) > 1
    folder = request.folder.absolute() / controller.node if several else request.folder.absolute()
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _report(request: runs.RunRequest, controller: Controller | None = None) -> Path:
    """The file of the serial line of a board, which is not there yet."""
    report = _home(request, controller or request.controllers[0]) / SERIAL
    report.unlink(missing_ok=True)
    return report


def _joined(
    board: Board, emulator: Emulator, request: runs.RunRequest, progress: Progress
) -> RunOutcome:
    """Run boards on one bus with the bench. Raises as `runs.run_controller`."""
    plan = None if request.scenario is None else load_scenario(request.scenario)
    if plan is not None and plan.bus_events:
        raise ScenarioError(f"{plan.title}: error: the bus of boards takes no `bus`")
    dbc = runs.dbc_of(request)
    codec = Codec.from_file(dbc)
    grace = request.analysis.system.shutdown.grace / 1e9 + STOP_MARGIN
    cores = {node.name: node.cores for node in request.analysis.system.nodes}
    played: ScenarioResult | None = None
    with ExitStack() as stack:
        record = stack.enter_context(bus_log.recorded(request.log, dbc.stem))
        processes, links = [], []
        for one in request.controllers:
            ends = stack.enter_context(board_bus.pipes(_home(request, one)))
            report = _report(request, one)
            words = command(board, emulator, one.executable, report, LONGEST, cores[one.node])
            process = stack.enter_context(_started(words, report.parent))
            processes.append(process)
            links.append(board_bus.BoardLink(ends, partial(_lives, process)))
        try:
            peer = board_bus.BoardPeer(links, codec, record)
            asked: list[float] = []

            def is_over() -> bool:
                """Asks the boards to end. Their end ends the bench, and so does a time limit."""
                if not asked:
                    asked.append(peer.clock())
                    peer.end()
                return peer.clock() > asked[0] + grace

            if plan is None:
                peer.sleep(request.seconds)
                with suppress(BenchError):
                    while not is_over():
                        peer.sleep(board_bus.LOOK)
            else:
                played = run_scenario(plan, peer, progress=progress, ended=is_over)
            found = [_ended(process, PATIENCE) for process in processes]
        except BenchError as fault:
            for process in processes:
                process.kill()  # it waits for the bench, and hears no other signal
            found = [(Ended(0, False, True, ()), [str(fault)])]
    title = plan.title if plan else f"{request.seconds:g} s without a scenario"
    return _concluded(
        f"{title}, on {board.target.name}",
        plan,
        played,
        request,
        runs.all_ended([ended for ended, _ in found]),
        [text for _, problems in found for text in problems],
    )


def _concluded(
    title: str,
    plan: Scenario | None,
    played: ScenarioResult | None,
    request: runs.RunRequest,
    ended: Ended,
    problems: list[str],
) -> RunOutcome:
    """The outcome of a run by its reports on the serial lines."""
    parts: dict[str, Observation] = {}
    for one in request.controllers:
        several = len(request.controllers) > 1
        name = f"trace-{one.node}.txt" if several else "trace.txt"
        trace = request.folder.absolute() / name
        said = write_trace(_home(request, one) / SERIAL, trace, together=several)
        ended = replace(ended, warnings=(*ended.warnings, *said))
        seen = runs.read(trace, read_map(*_map(one)), problems)
        if seen is not None:
            if request.analysis.system.node(one.node).cores == 1:
                seen.host_latency = None  # of several, one has the emulator at a time
            parts[one.node] = seen
    whole = next(iter(parts.values()), None)
    if len(request.controllers) > 1 and whole is not None:
        whole = merged(parts) if len(parts) == len(request.controllers) else None
    chains = len(request.controllers) == 1
    return runs.concluded(
        title, plan, played, whole, ended, problems, request.analysis, chains=chains
    )


def write_trace(serial: Path, trace: Path, *, together: bool) -> tuple[str, ...]:
    """Write the trace of a board from its serial line; the other lines of the controller.

    ``together``: with other boards. Their looks begin together, whatever the clock of each says.
    """
    lines = serial.read_text("ascii", "replace").splitlines() if serial.is_file() else []
    kept = [line for line in lines if not line.startswith(SAID)]
    if together:
        kept = ["E 0" if BEGIN.fullmatch(line) else line for line in kept]
    trace.write_text("".join(f"{line}\n" for line in kept), encoding="ascii", errors="replace")
    return tuple(line for line in lines if line.startswith(SAID))


def command(
    board: Board, emulator: Emulator, image: Path, report: Path, seconds: float, cores: int = 1
) -> list[str]:
    """The words that run an image for that long, with its serial line written to a file."""
    told = {
        "image": image.absolute(),
        "report": report.absolute(),
        "clock": board.clock_rate,
        "run_time": round(seconds * 1e9),
        "cores": cores,
    }
    return [part.format(**told) for part in emulator.command]


def _map(controller: Controller) -> tuple[str, str]:
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


def _lives(process: Process) -> bool:
    return process.poll() is None


def _ended(process: Process, limit: float) -> tuple[Ended, list[str]]:
    """Wait for the end of an emulator for ``limit`` seconds, and what went wrong."""
    try:
        _, errors = process.communicate(timeout=limit)
    except subprocess.TimeoutExpired:
        return Ended(1, True, True, ()), [f"the emulator did not end within {limit:g} s"]
    own = [line for line in errors.splitlines() if "error" in line.lower()]
    return Ended(process.returncode, False, True, ()), own
