# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart monitor`: a running controller watched, without a word to it."""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import asdict
from pathlib import Path

from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.live import Live
from rich.segment import Segment

from ravenchart import terminal
from ravenchart.building.checking import Checked
from ravenchart.failures import OK, WRONG, Unusable
from ravenchart.hw_can.bench.interfaces import BusEnd
from ravenchart.running import bus_text, monitor_text, monitoring
from ravenchart.running.bus_watch import WINDOW, BusWatch
from ravenchart.running.snapshots import VARIABLE
from ravenchart.running.watched import WatchedController

from . import common
from .answer import say
from .run_results import MonitorResult

SECOND = 1.0
"""Seconds between two lines of the counts of a processor."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument("--once", action="store_true", help="show one snapshot, and end")
    sub.add_argument(
        "--responses", action="store_true",
        help="show only processors, responses of activities, and the bus",
    )  # fmt: skip
    common.add_interface(sub, "watch the bus", builds=False)
    common.add_snapshots(sub, "Without it: those of `run`, `shell` and `measure`")


def execute(options: argparse.Namespace) -> int:
    """Watch it until it ends; the exit status."""
    checked = common.checked(options, deadlines=False)
    interfaces = common.interfaces(options, checked.system)
    if options.file:
        files = monitoring.given(checked, options.file)
    else:
        files = monitoring.found(checked, lambda text: say(options.answer, text))
        if not files and not interfaces:
            raise Unusable(
                f"{monitoring.none_runs(checked)}; start one, name with --file the file that "
                f"{VARIABLE} gave it, or name its bus with --interface and --channel"
            )
    with ExitStack() as stack:
        controllers = stack.enter_context(monitoring.watching(checked, files))
        ends: Mapping[str, BusEnd | Path] = interfaces
        if not interfaces and not options.file:
            ends = monitoring.buses_of_run(checked)
        buses = [
            BusWatch(checked.analysis, end, checked.system.bus(bus)) for bus, end in ends.items()
        ]
        seen = _Seen(checked, controllers, buses, alone=options.responses)
        for bus in seen.buses:
            stack.callback(bus.close)
        if options.once:
            if seen.buses:
                time.sleep(WINDOW)  # until then the load is that of a part of it
                seen.look()
            options.answer.result = seen.result()
            terminal.console().print(seen.tables())
            return _status(options, seen)
        show = _way_to_show(options, seen, stack)
        while True:
            show()
            if seen.is_over():
                break
            time.sleep(monitoring.PERIOD)
            seen.look()
    if options.json:
        options.answer.write = None  # there was a line for each snapshot
    return _status(options, seen)


class _Seen:
    """The controllers and buses that are watched."""

    def __init__(
        self,
        checked: Checked,
        controllers: Sequence[WatchedController],
        buses: Sequence[BusWatch],
        *,
        alone: bool,
    ) -> None:
        """``alone``: of the controllers, processors and responses of activities are shown alone."""
        self._name = checked.system.name
        self._alone = alone
        self.controllers, self.buses = controllers, buses
        self.on_buses = [bus.look() for bus in buses]
        for one in controllers:
            one.add_responses()

    def look(self) -> None:
        """Everything as it is now."""
        for one in self.controllers:
            one.look()
            one.add_responses()
        self.on_buses = [bus.look() for bus in self.buses]

    def is_over(self) -> bool:
        """Will nothing come any more?"""
        ended = all(one.node.process is None for one in self.controllers)
        gone = all(bus.gone is not None for bus in self.on_buses)
        return ended and (gone or bool(self.controllers))

    def result(self) -> MonitorResult:
        """For programs."""
        return MonitorResult(self._name, [one.node for one in self.controllers], self.on_buses)

    def tables(self) -> RenderableType:
        """For a terminal."""
        titles = [f"{self._name} on {one.name}" for one in self.controllers]
        titled = list(zip(titles, self.controllers, strict=True))
        if self._alone:
            nodes = [monitor_text.response_tables([(t, o.node, o.age) for t, o in titled])]
        else:
            nodes = [
                monitor_text.tables(title, one.node, tuple(one.last), one.age, one.overlooked)
                for title, one in titled
            ]
        return Group(*nodes, *map(bus_text.tables, self.on_buses))


def _way_to_show(options: argparse.Namespace, seen: _Seen, stack: ExitStack) -> Callable[[], None]:
    """A function that shows the nodes: objects or lines for a pipe, tables in a terminal."""
    if options.json:
        write = options.answer.write

        def objects() -> None:
            news = any(one.is_new or one.node.process is None for one in seen.controllers)
            if news or not seen.controllers:
                write(json.dumps(asdict(seen.result())) + "\n")

        return objects
    out = terminal.console()
    if not out.is_terminal or out.is_dumb_terminal:
        return _Lines(seen).show
    live = stack.enter_context(Live(console=out, auto_refresh=False))

    def picture() -> None:
        live.update(Cropped(seen.tables()), refresh=True)

    return picture


class _Lines:
    """Lines of text: events as they come, counts once in a second and at the end."""

    def __init__(self, seen: _Seen) -> None:
        self._seen = seen
        self._next = 0.0
        self._gone: set[str] = set()

    def show(self) -> None:
        """Print what is new."""
        now = time.monotonic()
        due = now >= self._next
        if due:
            self._next = now + SECOND
        for one in self._seen.controllers:
            name = one.name if len(self._seen.controllers) > 1 else ""
            ended = one.node.process is None
            for line in monitor_text.lines(one.node, name, counts=due or ended):
                print(line)
        for bus in self._seen.on_buses:
            goes = bus.gone is not None and bus.bus not in self._gone
            if goes:
                self._gone.add(bus.bus)
            for line in bus_text.lines(bus) if due or goes else ():
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


def _status(options: argparse.Namespace, seen: _Seen) -> int:
    """WRONG where a controller has ended without its report, or the bus is gone."""
    wrong = [
        one.end_in_words
        for one in seen.controllers
        if one.node.process is None and not one.node.ended
    ]
    wrong += [
        f"nothing comes from {bus.interface} any more: {bus.gone}"
        for bus in seen.on_buses
        if bus.gone is not None and not bus.ended
    ]
    for text in wrong:
        say(options.answer, f"ravenchart: error: {text}")
    return WRONG if wrong else OK
