# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The controller of a board while it runs, by what it writes on its serial line.

A board writes each record of its trace at once. So this module makes the counts that a controller
on this machine has in its snapshots. They begin with the start of the board, or with the next line
that names its model. A board repeats that line each second. Nothing is shown before it.
"""

from __future__ import annotations

import re
import stat
import threading
import time
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import serial

from ravenchart import rounded
from ravenchart.analysis.system.observed import (
    TRACE,
    Observation,
    TraceMap,
    TraceRecord,
    of_model,
    take_line,
)
from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import Unusable
from ravenchart.gen.language.terms import NO_TIME, Ns

from .live_responses import LiveResponses, LiveRows
from .monitored import LISTED, NO_COUNTS
from .snapshots import KINDS, RECENT, Snapshot, Tally
from .traces.reports import BEGIN, SAID
from .watched import WatchedController, readable

RATE = 115_200
"""Bits in a second, where a line is named without them."""

MOST_WAITING = 200_000
"""The most lines that are kept between two looks."""

LINE_BYTES = 4_096
"""A longer line is no line."""

AGAIN = 1.0
"""Seconds between two attempts to open a line that is gone."""

LOOK = 0.2
"""Seconds in which the end of the watching is noticed."""

UNREADABLE = f"serial line.{TRACE}"
"""The name of the count of lines that were lost, or could not be read."""

NOT_NAMED = (
    "all of it until the board names its model, as it does when it starts and each second; reset "
    "the board where the program is of an older Ravenchart"
)
NAMED = re.compile(r"M [0-9a-f]{64}")
"""The line that names a model."""
NO_COUNTS_YET = (
    "processors, queues of charts, and faults that a CAN controller counts: a board reports them "
    "each second, that of an older Ravenchart at the end of a run only"
)


@dataclass(frozen=True, slots=True)
class SerialLine:
    """A serial line: a device or a URL of pySerial, and its bits in a second."""

    port: str
    rate: int = RATE

    def opened(self) -> serial.Serial:
        """It, for this process alone; Unusable where there is none."""
        alone: dict[str, Any] = {}
        if "://" not in self.port:
            alone["exclusive"] = True  # of two readers each would get a half
        try:
            return serial.serial_for_url(self.port, baudrate=self.rate, timeout=LOOK, **alone)
        except (OSError, ValueError) as fault:  # SerialException is an OSError
            raise Unusable(f"cannot read the serial line {self.port}: {fault}") from None


def line_of(text: str) -> SerialLine | None:
    """The serial line that is named so, ``PORT[@RATE]``; None for a file that is none.

    Unusable for a rate that is no number.
    """
    port, at, rate = text.rpartition("@")
    if not at or _is_device(text):
        port, rate = text, str(RATE)
    if "://" not in port and not _is_device(port) and not _is_named_so(port):
        return None
    if not rate.isascii() or not rate.isdigit() or int(rate) == 0:
        raise Unusable(f"{text}: {rate!r} is no number of bits in a second")
    return SerialLine(port, int(rate))


def _is_device(port: str) -> bool:
    with suppress(OSError):
        return stat.S_ISCHR(Path(port).stat().st_mode)
    return False


def _is_named_so(port: str) -> bool:
    """Whether it would be a device if it were there: an adapter that is not plugged in."""
    path = Path(port)
    return not path.exists() and path.is_relative_to("/dev") and not path.is_relative_to("/dev/shm")


class _Reader:
    """A thread that keeps the lines of a serial line until they are looked at."""

    def __init__(self, line: SerialLine) -> None:
        """Unusable where it cannot be opened."""
        self._port = line.opened()
        self._lock = threading.Lock()
        self._lines: deque[str] = deque()
        self._dropped = 0
        self._closed = False
        self.gone: str | None = None
        """Why nothing will come any more."""
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Give the line back."""
        self._closed = True
        self._thread.join()
        self._port.close()

    def taken(self) -> tuple[list[str], int]:
        """The lines since the last call, and how many more found no room."""
        with self._lock:
            lines, self._lines = list(self._lines), deque()
            dropped, self._dropped = self._dropped, 0
        return lines, dropped

    def _read(self) -> None:
        rest = b""
        while not self._closed:
            try:
                rest += self._port.read(max(1, self._port.in_waiting))
            except (OSError, TypeError) as fault:  # of a port that goes meanwhile, too
                self._port.close()  # so that it can be opened again
                self.gone = str(fault)
                return
            *whole, rest = rest.split(b"\n")
            with self._lock:
                if len(rest) > LINE_BYTES:
                    rest = b""
                    self._dropped += 1
                room = MOST_WAITING - len(self._lines)
                self._dropped += max(0, len(whole) - room)
                self._lines.extend(line.decode("ascii", "replace") for line in whole[:room])


@dataclass(slots=True)
class _Counted:
    """The counts of a board since its start, or since it was first read."""

    map: TraceMap
    responses: LiveResponses
    partial: bool
    """Whether it ran already then."""
    seen: Observation = field(init=False)
    last: Ns = NO_TIME
    """The time of its last record."""
    tallies: dict[tuple[int, int], Tally] = field(default_factory=dict)
    listed: deque[TraceRecord] = field(default_factory=lambda: deque(maxlen=RECENT))
    said: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.seen = Observation(self.map)

    def take(self, line: str) -> None:
        """Count one line more; ValueError says what is wrong with it."""
        if line.startswith(SAID):
            self.said.append(line)
            return
        take_line(line, self.seen)
        self.responses.observe(self.seen)
        self.seen.reports.clear()
        for records in (self.seen.records, self.seen.values):
            if records:
                record = records.pop()
                key = record.element.number, KINDS.index(record.kind)
                before = self.tallies.get(key)
                self.tallies[key] = Tally(1 + (before.count if before else 0), record)
                self.last = max(self.last, record.time)
                if record.kind in LISTED:
                    self.listed.append(record)
                fault = record.fault
                if fault is not None and not self.seen.processors:  # else its reports count it
                    self.seen.faults[fault] = 1 + self.seen.faults.get(fault, 0)

    def snapshot(self, number: int) -> Snapshot:
        """As a controller on this machine would write it."""
        now = max(self.last, self.seen.now or NO_TIME)
        seen = replace(self.seen, records=list(self.listed), now=now)
        tallies = tuple(one for _, one in sorted(self.tallies.items()))
        return Snapshot(number, seen, tallies, self.partial)


class WatchedBoard(WatchedController):
    """The controller of a board."""

    def __init__(self, checked: Checked, program: programs.Program, line: SerialLine) -> None:
        """Unusable where the line cannot be opened."""
        super().__init__(checked, program)
        self._counted: _Counted | None = None
        self._responses = self._no_responses(whole=False)
        self._line = line
        self._reader = _Reader(line)
        self._next = float("inf")
        """When a line that is gone is opened again; not before that was shown."""

    def close(self) -> None:
        """Give the line back."""
        self._reader.close()

    def responses(self) -> LiveRows:
        """From its lines, up to the report before the last one."""
        until = rounded.instant(self._responses.until)
        note = f"From the reports of the board, one each second, up to {until} s."
        return LiveRows(self._responses.shown(), note)

    def _no_responses(self, *, whole: bool) -> LiveResponses:
        return LiveResponses(self.checked.analysis, self.map, whole=whole)

    @property
    def has_ended(self) -> bool:
        return self._reader.gone is not None

    @property
    def end_in_words(self) -> str:
        return f"nothing comes from {self._line.port} any more: {self._reader.gone}"

    def look(self) -> bool:
        """Count what came. There is always something to show."""
        self._open_again()
        process = None if self.has_ended else 0  # first: what came before its end is seen then
        if process is None:
            self._next = min(self._next, time.monotonic() + AGAIN)
        lines, dropped = self._reader.taken()
        for line in lines:
            self._take(line.strip())
        if self._counted is not None:
            self._lose(dropped)
        self.is_new = bool(lines)
        if lines:
            self.made = self.came = time.monotonic()
            self.sequence += self._counted is not None  # what is of no run is not shown
        counted = self._counted or _Counted(self.map, self._responses, partial=False)
        self.show(counted.snapshot(self.sequence), process)
        self.node.said = list(counted.said)
        self._say_what_is_missing()
        return True

    def _open_again(self) -> None:
        """Where the line was gone at the look before: what comes then may be of another start."""
        now = time.monotonic()
        if now >= self._next:
            self._next = now + AGAIN
            with suppress(Unusable):
                self._reader, self._counted = _Reader(self._line), None
                self._next = float("inf")

    def _take(self, line: str) -> None:
        starts = BEGIN.fullmatch(line) is not None
        if starts or (self._counted is None and NAMED.fullmatch(line)):
            self.begin(Ns(time.monotonic_ns()), listed=0)
            self._responses = self._no_responses(whole=starts)
            self._counted = _Counted(self.map, self._responses, partial=not starts)
        if self._counted is None or not line:
            return
        try:
            self._counted.take(line)
        except ValueError:
            self._lose(1)
            return
        if line.startswith("M "):
            seen, self._counted = self._counted, None
            with readable():
                for digest in (self.checked.system.digest, self.map.digest):
                    of_model(seen.seen, digest, self._line.port)
            self._counted = seen

    def _lose(self, number: int) -> None:
        assert self._counted is not None
        counts = self._counted.seen.counts
        if number:
            counts[UNREADABLE] = counts.get(UNREADABLE, 0) + number

    def _say_what_is_missing(self) -> None:
        if self._counted is None:
            self.node.not_seen = [NOT_NAMED]
            return
        self.node.not_seen = [
            NO_COUNTS_YET if text == NO_COUNTS else text for text in self.node.not_seen
        ]
