# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The frames on the bus of a run, shown to others on this machine while it goes on.

The run writes each frame to a file, a ring of the last 4,095 frames, and waits for nobody. Any
number of processes may read it. One that reads too seldom misses frames, and knows how many.

The file is a header and then a ring of records of the bus protocol (docs/bus-protocol.md). The
header is the mark, when bus time 0 was in ns since 1970, and twice how many records were written.
A record is written before it is counted.
"""

from __future__ import annotations

import os
import struct
import time
from collections import deque
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import can

from ravenchart.hw_can.bench.bus_records import (
    RECORD_BYTES,
    can_message,
    decode,
    encode,
    record_of,
)

from . import held_files

MARK = ".bus-"
"""In the name of the file, behind the name of the first program on the bus."""

SLOTS = 4096
"""Records in the ring. That of the oldest may be the one that is written now."""

PAUSE = 0.01
"""Seconds between two looks for a new frame."""

RUN_ENDED = "the run has ended"

_HEADER = struct.Struct("<8sQQQ")
_FILE_MARK = b"RVN-BUS1"
_SECOND = 10**9


class RunEndedError(Exception):
    """No frame will come any more: the run has ended, in whatever way."""

    def __init__(self) -> None:
        super().__init__(RUN_ENDED)


class BusRing:
    """The ring of a run, which writes it."""

    def __init__(self, path: Path) -> None:
        """OSError where it cannot be written, or another one holds the file."""
        self._file = os.open(path, os.O_RDWR | os.O_CLOEXEC)
        try:
            held_files.hold(self._file)
            os.posix_fallocate(self._file, 0, (SLOTS + 1) * RECORD_BYTES)
        except OSError:
            os.close(self._file)
            raise
        self._start = self._count = 0
        self._write_header()

    def close(self) -> None:
        """End it; readers hear of it."""
        os.close(self._file)

    def begin(self, start: int) -> None:
        """Say when bus time 0 was, in ns since 1970; before the first record."""
        self._start = start
        self._write_header()

    def take(self, frame: can.Message) -> None:
        """Add a frame, with its time."""
        stamp = frame.timestamp or time.time()
        self.put(encode(replace(record_of(frame, 0), time=round(stamp * _SECOND) - self._start)))

    def put(self, octets: bytes) -> None:
        """Add a record."""
        os.pwrite(self._file, octets, _place(self._count))
        self._count += 1
        self._write_header()

    def _write_header(self) -> None:
        told = _HEADER.pack(_FILE_MARK, self._start, self._count, self._count)
        os.pwrite(self._file, told, 0)


def mark_of(bus: str) -> str:
    """That of the file of one of several buses; of the only one without a name."""
    return f"{MARK}{bus}-" if bus else MARK


@contextmanager
def shown(beside: Path | None, bus: str = "") -> Iterator[BusRing | None]:
    """A ring beside a program, for the time of a block; None where none can be there.

    ``bus`` is its bus, where there are several.
    """
    path = None if beside is None else held_files.new_file(beside, mark_of(bus))
    if path is None:
        yield None
        return
    try:
        ring = BusRing(path)
    except OSError:  # a full disk, for example
        path.unlink(missing_ok=True)
        yield None
        return
    try:
        yield ring
    finally:
        ring.close()
        path.unlink(missing_ok=True)


class RingReader:
    """The frames of a ring from now on, taken as from a bus of python-can."""

    def __init__(self, path: Path) -> None:
        """OSError where it cannot be read."""
        self._file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
        self._waiting: deque[can.Message] = deque()
        self.missed = 0
        """How many frames were gone before they were read."""
        _, self._next = self._header()

    def shutdown(self) -> None:
        """Read no longer."""
        os.close(self._file)

    def recv(self, timeout: float) -> can.Message | None:
        """The next frame; None where none comes in that time, in s. RunEndedError."""
        limit = time.monotonic() + timeout
        while not self._waiting:
            ended = held_files.holder(self._file) is None  # first: its last frames are seen then
            self._fetch()
            if self._waiting:
                break
            if ended:
                raise RunEndedError
            left = limit - time.monotonic()
            if left <= 0:
                return None
            time.sleep(min(left, PAUSE))
        return self._waiting.popleft()

    def _fetch(self) -> None:
        start, count = self._header()
        first = max(self._next, count - SLOTS + 1)
        read = [os.pread(self._file, RECORD_BYTES, _place(n)) for n in range(first, count)]
        _, now = self._header()
        whole = max(first, now - SLOTS + 1)  # what was written over meanwhile may be torn
        self.missed += whole - self._next
        self._next = max(whole, count)
        self._waiting += [can_message(decode(octets), start) for octets in read[whole - first :]]

    def _header(self) -> tuple[int, int]:
        """When bus time 0 was, and how many records were written."""
        while True:
            octets = os.pread(self._file, _HEADER.size, 0)
            if len(octets) < _HEADER.size:
                return 0, 0
            _, start, count, again = _HEADER.unpack(octets)
            if count == again:
                return start, count


def _place(number: int) -> int:
    """Where in the file a record is."""
    return (1 + number % SLOTS) * RECORD_BYTES
