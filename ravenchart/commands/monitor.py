# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart monitor`: a running controller watched, without a word to it."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import asdict

from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.live import Live
from rich.segment import Segment

from ravenchart import terminal
from ravenchart.building.checking import Checked
from ravenchart.failures import OK, WRONG, Unusable
from ravenchart.running import monitor_text, monitoring
from ravenchart.running.monitoring import WatchedController
from ravenchart.running.snapshots import VARIABLE

from . import common
from .answer import say
from .run_results import MonitorResult

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
    if options.file:
        files = monitoring.given(checked, options.file)
    else:
        files = monitoring.found(checked, lambda text: say(options.answer, text))
        if not files:
            raise Unusable(
                f"{monitoring.none_runs(checked)}; start one, or name with --file the file that "
                f"{VARIABLE} gave it"
            )
    with monitoring.watching(checked, files) as watched, ExitStack() as stack:
        if options.once:
            options.answer.result = _result(checked, watched)
            terminal.console().print(_tables(checked, watched))
            return _status(options, watched)
        show = _way_to_show(options, checked, watched, stack)
        while True:
            show()
            if all(one.node.process is None for one in watched):
                break
            time.sleep(monitoring.PERIOD)
            for one in watched:
                one.look()
    if options.json:
        options.answer.write = None  # there was a line for each snapshot
    return _status(options, watched)


def _result(checked: Checked, watched: Sequence[WatchedController]) -> MonitorResult:
    return MonitorResult(checked.system.name, [one.node for one in watched])


def _way_to_show(
    options: argparse.Namespace,
    checked: Checked,
    watched: Sequence[WatchedController],
    stack: ExitStack,
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

    def __init__(self, watched: Sequence[WatchedController]) -> None:
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


def _tables(checked: Checked, watched: Sequence[WatchedController]) -> RenderableType:
    return Group(
        *(
            monitor_text.tables(
                f"{checked.system.name} on {one.name}", one.node, tuple(one.last), one.age
            )
            for one in watched
        )
    )


def _status(options: argparse.Namespace, watched: Sequence[WatchedController]) -> int:
    """WRONG where a controller has ended without its report."""
    killed = [one for one in watched if one.node.process is None and not one.node.ended]
    for one in killed:
        text = f"the controller of {one.name} has ended without its report"
        say(options.answer, f"ravenchart: error: {text}")
    return WRONG if killed else OK
