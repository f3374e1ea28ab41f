# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The two ends of the bus under test: opening them, and sending frames across."""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import can

from ravenchart.hw_can.bench import interfaces
from ravenchart.hw_can.bench.interfaces import BusEnd
from ravenchart.hw_can.bench.peer import BenchError

PATIENCE = 2.0
"""Seconds without a frame after which no more is waited for."""

UNANSWERED = 0.25
"""The same, when the sender's controller is not error-active: no node acknowledges."""

DRAINED = 100_000
"""Frames that are thrown away at most before a case."""


@dataclass(frozen=True, slots=True)
class Setup:
    """The interfaces under test. ``bitrate`` in bit/s, None for that of the interface."""

    interface: str
    channel: str
    receive_interface: str
    receive_channel: str
    bitrate: int | None = None
    fd: bool = False
    echo: bool = False
    """One bus object that receives its own frames is both ends."""

    @property
    def names(self) -> tuple[str, ...]:
        """The interfaces, each once."""
        return tuple(dict.fromkeys((self.interface, self.receive_interface)))


@dataclass(slots=True)
class Ends:
    """Two ends of one bus; ``far is near`` when there is one with echo."""

    setup: Setup
    near: can.BusABC
    far: can.BusABC
    patience: float = PATIENCE
    latencies: list[int] = field(default_factory=list)
    """Each in ns, from the call of send to the return of recv."""
    rate: float | None = None
    """Frames per second, sent as fast as they can be."""
    errors: list[can.Message] = field(default_factory=list)
    """Error frames that came although none was sent."""

    def across(self, frames: Sequence[can.Message]) -> list[can.Message]:
        """The frames that arrive at the far end when the near one sends ``frames``."""
        return exchange(self, self.near, self.far, frames)

    def back(self, frames: Sequence[can.Message]) -> list[can.Message]:
        """The frames that arrive at the near end when the far one sends ``frames``."""
        return exchange(self, self.far, self.near, frames)

    def drain(self) -> None:
        """Discard the frames that earlier cases left, but keep error frames."""
        for bus in (self.near, self.far):
            for _ in range(DRAINED):
                message = bus.recv(0)
                if message is None:
                    break
                if message.is_error_frame:
                    self.errors.append(message)

    def usable(self) -> bool:
        """Whether both ends can still be read."""
        try:
            self.drain()
        except Exception:
            return False
        return True

    def close(self) -> None:
        """Leave the bus, as far as possible."""
        for bus in (self.near, self.far):
            with suppress(Exception):
                bus.shutdown()


def open_ends(setup: Setup, patience: float = PATIENCE) -> Ends:
    """Both ends; BenchError in words when one cannot be opened."""
    near = opened(setup.interface, setup.channel, setup, echo=setup.echo)
    if setup.echo:
        return Ends(setup, near, near, patience)
    try:
        far = opened(setup.receive_interface, setup.receive_channel, setup)
    except BenchError:
        near.shutdown()
        raise
    return Ends(setup, near, far, patience)


def opened(interface: str, channel: str, setup: Setup, *, echo: bool = False) -> can.BusABC:
    """One bus object; BenchError when that is impossible."""
    return interfaces.opened_bus(BusEnd(interface, channel, setup.bitrate, fd=setup.fd), echo=echo)


def is_faulty(bus: can.BusABC) -> bool:
    """Whether the interface reports that its controller is not error-active."""
    return type(bus).state is not can.BusABC.state and bus.state is not can.BusState.ACTIVE


AHEAD = 200
"""Frames sent before the first of them was received."""


class _Listening(threading.Thread):
    """Receives ``count`` frames, or until none has come for a while."""

    def __init__(
        self, ends: Ends, bus: can.BusABC, sender: can.BusABC, count: int, *, errors: bool
    ) -> None:
        super().__init__(daemon=True)
        self.got: list[can.Message] = []
        self.fault: Exception | None = None
        self.busy_at = time.monotonic()
        """The time at which a frame was sent or received last."""
        self._ends, self._bus, self._count, self._errors = ends, bus, count, errors
        self._sender = sender

    def run(self) -> None:
        """Receive."""
        try:
            while len(self.got) < self._count:
                message = self._bus.recv(0.05)
                if message is not None:
                    self.busy_at = time.monotonic()
                    stray = message.is_error_frame and not self._errors
                    (self._ends.errors if stray else self.got).append(message)
                elif self._is_over(time.monotonic() - self.busy_at):
                    return
        except Exception as fault:
            self.fault = fault

    def _is_over(self, quiet: float) -> bool:
        """Whether no more frame is expected, after none has come for ``quiet`` s."""
        patience = self._ends.patience
        return quiet > patience or (min(UNANSWERED, patience) < quiet and is_faulty(self._sender))


def exchange(
    ends: Ends, sender: can.BusABC, receiver: can.BusABC, frames: Sequence[can.Message]
) -> list[can.Message]:
    """The frames that ``receiver`` gets when ``sender`` sends ``frames`` one after the other.

    At most ``AHEAD`` are on their way: the buffer of a socket holds few more. A lack of
    processor time for the receiver must not count as a fault of the bus.
    """
    errors = any(frame.is_error_frame for frame in frames)
    listening = _Listening(ends, receiver, sender, len(frames), errors=errors)
    listening.start()
    try:
        for number, frame in enumerate(frames):
            sender.send(frame)
            listening.busy_at = time.monotonic()
            while number - len(listening.got) >= AHEAD and listening.is_alive():
                time.sleep(0.0005)
    finally:
        listening.join()
    if listening.fault is not None:
        raise listening.fault
    return listening.got
