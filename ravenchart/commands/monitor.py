"""`ravenchart monitor`: a running controller watched, without a word to it."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from pathlib import Path

from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.live import Live
from rich.segment import Segment

from ravenchart import terminal
from ravenchart.analysis.system.observed import TraceError, of_model, read_map
from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import OK, WRONG, Refused, Unusable
from ravenchart.running import monitor_text
from ravenchart.running.monitored import NodeMonitor, WatchedEvent, WatchedNode
from ravenchart.running.snapshots import VARIABLE, SnapshotFile, parsed, written

from . import common
from .answer import say
from .run_results import MonitorResult

PERIOD = 0.1
"""Seconds between two looks, as between two snapshots."""

FIRST = 10.0
"""So long a controller may take to write its first snapshot, in s."""

SECOND = 1.0
"""Seconds between two lines of the counts of a processor."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    sub.add_argument("--once", action="store_true", help="show one snapshot, and end")
    sub.add_argument(
        "--file", action="append", default=[], metavar="[NODE=]FILE",
        help=f"the file that {VARIABLE} named to a controller (default: those of `run`, `shell` "
        "and `measure`); once for each of several nodes, with its name",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Watch it until it ends; the exit status."""
    checked = common.checked(options, deadlines=False)
    with ExitStack() as stack:
        watched = [
            _Watched(checked, program, path, stack) for program, path in _files(options, checked)
        ]
        _wait_for_all(watched)
        if options.once:
            _show_once(options, checked, watched)
            return _status(options, watched)
        show = _way_to_show(options, checked, watched, stack)
        while True:
            show()
            if all(one.node.process is None for one in watched):
                break
            time.sleep(PERIOD)
            for one in watched:
                one.look()
    if options.json:
        options.answer.write = None  # there was a line for each snapshot
    return _status(options, watched)


def _files(options: argparse.Namespace, checked: Checked) -> list[tuple[programs.Program, Path]]:
    """The file of each node that runs; Unusable where none does."""
    made = programs.programs_of(checked)
    if options.file:
        return list(_given(options.file, made))
    found: list[tuple[programs.Program, Path]] = []
    homes = programs.homes_of(options.model)
    for program in made:
        main = f"{checked.stem}_main"
        running = written([home / program.folder for home in homes], main)
        if running:
            found.append((program, running[0]))
        if running[1:]:
            text = f"{len(running)} controllers run on {program.node}: the newest one is watched"
            say(options.answer, f"note: {text}; --file names another", severity="note")
    if not found:
        raise Unusable(
            f"no controller of {checked.system.name} runs that was started by `ravenchart run`, "
            f"`shell` or `measure`; start one, or name the file that {VARIABLE} gave it with --file"
        )
    for missing in {one.node for one in made} - {one.node for one, _ in found}:
        say(options.answer, f"warning: no controller of the node {missing} runs")
    return found


def _given(
    words: Sequence[str], made: Sequence[programs.Program]
) -> Iterator[tuple[programs.Program, Path]]:
    by_name = {one.node.lower(): one for one in made}
    for word in words:
        node, equals, file = word.partition("=")
        if equals and node.lower() in by_name:
            yield by_name[node.lower()], Path(file)
        elif len(made) == 1:
            yield made[0], Path(word)
        else:
            known = ", ".join(f"{one.node}=FILE" for one in made)
            raise Unusable(f"--file {word} names no node: the model has {known}")


class _Watched:
    """One node: its file, and what was last seen there."""

    node: WatchedNode

    def __init__(
        self, checked: Checked, program: programs.Program, path: Path, stack: ExitStack
    ) -> None:
        names = program.generated / programs.TRACE_MAP
        with _readable():
            self._map = read_map(names.read_text("utf-8"), str(names))
        self._digest = checked.system.digest
        self._monitor = NodeMonitor(checked.analysis, program.node)
        self._file = SnapshotFile(path)
        stack.callback(self._file.close)
        self._sequence = 0
        self._came = time.monotonic()
        self.name = program.node
        self.last: deque[WatchedEvent] = deque(maxlen=monitor_text.KEPT)
        self.is_new = False
        if self._file.owner() is None:
            raise Unusable(f"{path}: no controller writes this file now")

    @property
    def age(self) -> float:
        """Since when there was no other snapshot, in s."""
        return time.monotonic() - self._came

    def look(self) -> bool:
        """Look for another snapshot, once; whether there is any now."""
        process = self._file.owner()  # first: what it wrote before its end is seen then
        text = self._file.text()
        if text is None:
            return process is None and self._sequence > 0
        with _readable():
            snapshot = parsed(text, self._map, str(self._file.path))
            if not self._sequence:
                for digest in (self._digest, self._map.digest):
                    of_model(snapshot.seen, digest, str(self._file.path))
        self.is_new = snapshot.sequence != self._sequence
        if self.is_new:
            self._sequence, self._came = snapshot.sequence, time.monotonic()
        self.node = self._monitor.shown(snapshot, process)
        self.last.extend(self.node.events)
        return True

    @property
    def has_ended(self) -> bool:
        """Whether its controller is gone."""
        return self._file.owner() is None


@contextmanager
def _readable() -> Iterator[None]:
    """Refused where what is read in the block cannot be read."""
    try:
        yield
    except TraceError as fault:
        raise Refused(str(fault)) from None


def _wait_for_all(watched: Sequence[_Watched]) -> None:
    """Until each node has a snapshot; Refused where one does not come."""
    limit = time.monotonic() + FIRST
    for one in watched:
        while not one.look():
            if one.has_ended:
                raise Refused(f"ravenchart: error: the controller of {one.name} ended at once")
            if time.monotonic() > limit:
                raise Refused(
                    f"ravenchart: error: the controller of {one.name} has written no snapshot in "
                    f"{FIRST:g} s: its main program, which has the lowest priority, does not run"
                )
            time.sleep(PERIOD / 4)


def _result(checked: Checked, watched: Sequence[_Watched]) -> MonitorResult:
    return MonitorResult(checked.system.name, [one.node for one in watched])


def _show_once(options: argparse.Namespace, checked: Checked, watched: Sequence[_Watched]) -> None:
    options.answer.result = _result(checked, watched)
    terminal.console().print(_tables(checked, watched))


def _way_to_show(
    options: argparse.Namespace, checked: Checked, watched: Sequence[_Watched], stack: ExitStack
) -> Callable[[], None]:
    """What shows the nodes as they are now: objects or lines for a pipe, tables in a terminal."""
    if options.json:
        write = options.answer.write

        def objects() -> None:
            if any(one.is_new or one.node.process is None for one in watched):
                write(json.dumps(asdict(_result(checked, watched))) + "\n")

        return objects
    out = terminal.console()
    if not out.is_terminal or out.is_dumb_terminal:
        return _Lines(watched).show
    live = stack.enter_context(Live(console=out, auto_refresh=False))

    def picture() -> None:
        live.update(Cropped(_tables(checked, watched)), refresh=True)

    return picture


class _Lines:
    """Lines of text: events as they come, counts once in a second and at the end."""

    def __init__(self, watched: Sequence[_Watched]) -> None:
        self._watched = watched
        self._next = 0.0

    def show(self) -> None:
        """Print what is new."""
        now = time.monotonic()
        due = now >= self._next
        if due:
            self._next = now + SECOND
        for one in self._watched:
            name = one.name if len(self._watched) > 1 else ""
            ended = one.node.process is None
            for line in monitor_text.lines(one.node, name, counts=due or ended):
                print(line)
        sys.stdout.flush()


class Cropped:
    """As much as a terminal has lines for; the last one says what is missing."""

    def __init__(self, whole: RenderableType) -> None:
        self._whole = whole

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        height = console.size.height - 1
        lines = console.render_lines(self._whole, options.update(height=None), pad=False)
        missing = len(lines) - height
        if missing > 0:
            lines = lines[: height - 1]
            lines.append([Segment(f"... {missing + 1} more lines: --once prints all")])
        for line in lines:
            yield from line
            yield Segment.line()


def _tables(checked: Checked, watched: Sequence[_Watched]) -> RenderableType:
    return Group(
        *(
            monitor_text.tables(
                f"{checked.system.name} on {one.name}", one.node, tuple(one.last), one.age
            )
            for one in watched
        )
    )


def _status(options: argparse.Namespace, watched: Sequence[_Watched]) -> int:
    """WRONG where a controller has ended without its report."""
    killed = [one for one in watched if one.node.process is None and not one.node.ended]
    for one in killed:
        text = f"the controller of {one.name} has ended without its report"
        say(options.answer, f"ravenchart: error: {text}")
    return WRONG if killed else OK
