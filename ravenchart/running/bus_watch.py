# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus while controllers use it: its load, and its messages with their last values.

The watch sends nothing: at an interface it is one more node, which only receives. An adapter that
takes part in the bus still acknowledges frames, unless its driver is set to listen only. On the bus
of a run it is no node at all.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import can

from ravenchart.analysis.core.frames import FD_SIZES, classic_bits, fd_bits
from ravenchart.analysis.system.timing import Analysis
from ravenchart.described import Described
from ravenchart.failures import Unusable
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.hw_can.bench.interfaces import BusEnd, fault_text, opened_bus
from ravenchart.hw_can.bench.peer import BenchError, MalformedFrameError, Value

from .bus_ring import RUN_ENDED, RingReader, RunEndedError
from .vocabulary import BusVocabulary

WINDOW = 1.0
"""Over so many seconds the load is counted."""

SECOND = 10**9
"""In ns."""

WAIT = 0.05
"""Seconds after which the thread sees that it is to end."""

OF_A_RUN = "bus of a run"
"""In the place of an interface."""

PATIENCE = 1.0
"""Seconds after which a driver that does not return is left alone."""


@dataclass(slots=True)
class WatchedMessage(Described):
    """A message of the bus, since the watch started."""

    name: str
    """Its name."""
    identifier: str
    """Its identifier, hexadecimal; with 8 digits where it is extended."""
    frames: int
    """How many frames came."""
    last: int | None
    """When the last one came, in ns; null before the first."""
    shortest: int | None
    """The shortest time between two frames, in ns; null before the second."""
    period: int | None
    """The least time between two of its events by the model, in ns; null where it says nothing.
    Frames may be closer by up to the response-time bound."""
    fields: dict[str, Value]
    """The values of the last frame, by the names of the model."""
    units: dict[str, str]
    """The units of those fields that have one."""


@dataclass(slots=True)
class WatchedBus(Described):
    """A bus. Times count from the start of the watch."""

    bus: str
    """Its name in the model."""
    interface: str
    """Interface and channel of python-can; `bus of a run` for that of `run` or `shell`."""
    now: int
    """The time, in ns."""
    load: float
    """The share of the last second that its frames took: each counts with its most stuff bits.
    In the first second it is too low."""
    bound: float | None
    """The most that it can be by the analysis; null where a message has no bound."""
    frames: int
    """How many frames came."""
    unknown: int
    """Frames that are no message of the model."""
    malformed: int
    """Frames whose data are no value of their message."""
    errors: int
    """How many error frames the interface has reported."""
    missed: int
    """How many frames of the bus of a run were gone before the watch read them."""
    messages: list[WatchedMessage]
    """In the order of the model."""
    gone: str | None
    """Why nothing comes any more; null while the interface works, and while the run goes on."""
    ended: bool
    """Whether nothing comes because the run has ended."""


@dataclass(slots=True)
class _Seen:
    """The counts and the last values of a message."""

    frames: int = 0
    last: float | None = None
    stamp: float = 0.0
    """The time of the last frame, by the clock of the interface."""
    shortest: float | None = None
    fields: Mapping[str, Value] = field(default_factory=dict)


class BusWatch:
    """Takes the frames of a bus in a thread of its own; anybody may look."""

    def __init__(self, analysis: Analysis, end: BusEnd | Path, bus: Bus | None = None) -> None:
        """The bus at that interface, or in the ring of a run; Unusable without it.

        ``bus`` is that of the model, its first one unless given.
        """
        self._bus = bus or analysis.system.buses[0]
        self._words = BusVocabulary.of(analysis.system, (self._bus,))
        known = [m for m in analysis.system.frames if m.bus == self._bus.name]
        self._known = {(m.identifier, m.extended): m for m in known}
        self._name = str(end) if isinstance(end, BusEnd) else OF_A_RUN
        self._bound = most_in_a_second(analysis, self._bus)
        self._seen = {m.name: _Seen() for m in known}
        self._frames = self._unknown = self._malformed = self._errors = 0
        self._gone: str | None = None
        self._taken: deque[tuple[float, int]] = deque()
        self._lock = threading.Lock()
        self._ends = threading.Event()
        self._source: can.BusABC | RingReader
        try:
            self._source = opened_bus(end) if isinstance(end, BusEnd) else RingReader(end)
        except BenchError as fault:
            raise Unusable(str(fault)) from None
        except OSError as fault:
            raise Unusable(f"{end}: {fault.strerror}") from None
        self._begin = time.monotonic()
        self._thread = threading.Thread(target=self._receive, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Leave the bus."""
        self._ends.set()
        self._thread.join(PATIENCE)
        with suppress(can.CanError, OSError):
            self._source.shutdown()

    def look(self) -> WatchedBus:
        """The bus as it is now."""
        with self._lock:
            now = time.monotonic()
            self._forget(now)
            return WatchedBus(
                bus=self._bus.name,
                interface=self._name,
                now=self._since(now),
                load=sum(length for _, length in self._taken) / (WINDOW * SECOND),
                bound=self._bound,
                frames=self._frames,
                unknown=self._unknown,
                malformed=self._malformed,
                errors=self._errors,
                missed=self._source.missed if isinstance(self._source, RingReader) else 0,
                messages=[self._message(m, self._seen[m.name]) for m in self._known.values()],
                gone=self._gone,
                ended=self._gone == RUN_ENDED,
            )

    def _message(self, message: Message, seen: _Seen) -> WatchedMessage:
        has_fields = message.name in self._words.messages
        signals = self._words.fields(message.name) if has_fields else {}
        return WatchedMessage(
            name=message.name,
            identifier=message.shown_identifier,
            frames=seen.frames,
            last=None if seen.last is None else self._since(seen.last),
            shortest=None if seen.shortest is None else round(seen.shortest * SECOND),
            period=message.period or None,
            fields=dict(seen.fields),
            units={one: s.unit for one, s in signals.items() if s.unit and one in seen.fields},
        )

    def _since(self, instant: float) -> int:
        return round((instant - self._begin) * SECOND)

    def _forget(self, now: float) -> None:
        while self._taken and self._taken[0][0] < now - WINDOW:
            self._taken.popleft()

    def _receive(self) -> None:
        try:
            while not self._ends.is_set():
                frame = self._source.recv(timeout=WAIT)
                if frame is not None:
                    with self._lock:
                        self._take(frame, time.monotonic())
        except RunEndedError:
            with self._lock:
                self._gone = RUN_ENDED
        except Exception as fault:  # drivers raise what they like
            with self._lock:
                self._gone = fault_text(fault)

    def _take(self, frame: can.Message, now: float) -> None:
        if frame.is_error_frame:
            self._errors += 1
            return
        self._frames += 1
        self._taken.append((now, duration(frame, self._bus)))
        self._forget(now)
        message = self._known.get((frame.arbitration_id, frame.is_extended_id))
        if message is None or message.fd != frame.is_fd or frame.is_remote_frame:
            self._unknown += 1
            return
        try:
            values = self._values(message, frame)
        except MalformedFrameError:
            self._malformed += 1
            return
        seen = self._seen[message.name]
        stamp = frame.timestamp or now
        if seen.frames and seen.stamp <= stamp:
            gap = stamp - seen.stamp
            seen.shortest = gap if seen.shortest is None else min(gap, seen.shortest)
        seen.frames, seen.last, seen.stamp = seen.frames + 1, now, stamp
        seen.fields = values

    def _values(self, message: Message, frame: can.Message) -> dict[str, Value]:
        """The fields of a frame; none of one that others send to others."""
        if message.name not in self._words.messages:
            return {}
        found = self._words.codec.decode(frame)
        assert found is not None  # it is known by its identifier and format
        signals = self._words.fields(message.name)
        return {one: value for one, value in found[1].items() if one in signals}


def most_in_a_second(analysis: Analysis, bus: Bus) -> float | None:
    """The largest share of any second that frames of the model take; errors are not counted.

    A frame goes over the bus at most its bound after its event, so as many of one message fall
    into a second as events into a second and that time. None where one has no bound.
    """
    taken = 0
    for found in analysis.frames(bus):
        if found.bound is None:
            return None
        frame = found.frame
        taken += -(-(SECOND + found.bound) // frame.period) * frame.transmission_time
    return taken / SECOND


def duration(frame: can.Message, bus: Bus) -> int:
    """The longest that a frame takes on the bus, in ns: with the most stuff bits."""
    if not frame.is_fd:
        length = 0 if frame.is_remote_frame else min(frame.dlc, 8)
        return classic_bits(length, extended=frame.is_extended_id).time(bus.bit_rate)
    length = next(size for size in FD_SIZES if size >= len(frame.data))
    switched = frame.bitrate_switch and bool(bus.data_rate)
    bits = fd_bits(length, extended=frame.is_extended_id, switched=switched)
    return bits.time(bus.bit_rate, bus.data_rate or 0)
