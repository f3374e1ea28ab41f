# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bench on the bus: a python-can peer that speaks the generated DBC.

All values are raw integers of the model, or names of enumeration values. The codec
applies the offsets of the DBC.
"""

from __future__ import annotations

import copy
import os
import select
import socket
import time
from collections import Counter
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

import can
import cantools
from cantools.database import Database
from cantools.database.errors import Error as CodecFault

from .naming import as_in_model
from .protection import HEADER, Sender, Wrong, protected_sender

OUTSIDE = "Outside"
"""In a database, the sender of messages that no node of the model sends."""

TRAILER = "SecOC_"
"""The prefix of the signals behind the data of an authenticated message."""

Value = int | float | str
FrameValues = dict[str, Value]


OnFrame = Callable[[can.Message], None]
"""Gets a copy of each frame that goes over the bus, with its time."""


def unrecorded(_frame: can.Message) -> None:
    """Record nothing."""


class BenchError(Exception):
    """The bench cannot go on: the bus is gone, or a message does not fit the DBC."""


class MalformedFrameError(BenchError):
    """A frame has the identifier of a message, but not its data; the bus goes on."""


class Codec:
    """Messages by name, from and to CAN frames."""

    def __init__(self, database: Database) -> None:
        """The messages of ``database``."""
        self._database = database
        self._names = {(m.frame_id, m.is_extended_frame): m.name for m in database.messages}
        self._switched = _switches(database)
        found = ((m.name, m.dbc) for m in database.messages)
        senders = (
            (name, protected_sender(dbc.attributes)) for name, dbc in found if dbc is not None
        )
        self._senders = {name: sender for name, sender in senders if sender is not None}

    @staticmethod
    def from_file(path: Path) -> Codec:
        """The codec of a DBC file, by the names of the model; BenchError when it cannot be read."""
        try:
            database = cantools.database.load_file(path, database_format="dbc")
        except (OSError, ValueError, CodecFault) as fault:
            raise BenchError(f"{path.name} cannot be read: {fault}") from None
        assert isinstance(database, Database)
        return Codec(as_in_model(database))

    @property
    def has_fd(self) -> bool:
        """Whether there are CAN FD frames among the messages."""
        return any(m.is_fd for m in self._database.messages)

    def has(self, name: str) -> bool:
        """Whether the DBC has a message of that name."""
        return name in self._names.values()

    def knows(self, frame: can.Message) -> bool:
        """Whether the DBC has a message with the identifier of a frame."""
        return (frame.arbitration_id, frame.is_extended_id) in self._names

    def fields(self, name: str) -> tuple[str, ...]:
        """The fields of a message; BenchError when the DBC has none of that name."""
        return tuple(s.name for s in self._message(name).signals)

    def encode(self, name: str, values: Mapping[str, Value]) -> can.Message:
        """The frame; BenchError when a field is missing, unknown or out of range.

        A protected message gets its header, unless a field of it is given.
        """
        made = self.faulty(name, values, None)
        assert made is not None
        return made

    def faulty(
        self, name: str, values: Mapping[str, Value], wrong: Wrong | None
    ) -> can.Message | None:
        """The same with a fault that protection finds; None where the fault is loss."""
        message, data, sender = self._encoded(name, values, wrong)
        made = data if sender is None else sender.protect(data, wrong)
        if made is None:
            return None
        return can.Message(
            arbitration_id=message.frame_id,
            is_extended_id=message.is_extended_frame,
            is_fd=message.is_fd,
            bitrate_switch=message.is_fd and self._switched,
            data=made,
        )

    def check(self, name: str, values: Mapping[str, Value], wrong: Wrong | None) -> None:
        """BenchError where `faulty` raises it; nothing is sent, and counters stay unchanged."""
        self._encoded(name, values, wrong)

    def _encoded(
        self, name: str, values: Mapping[str, Value], wrong: Wrong | None
    ) -> tuple[cantools.database.Message, bytes, Sender | None]:
        """The message, its data, and the sender that writes its header."""
        message = self._message(name)
        unknown = sorted(set(values) - {s.name for s in message.signals})
        if unknown:
            raise BenchError(f"{name} has no field {unknown[0]}")
        sender = None if HEADER & set(values) else self._senders.get(name)
        if sender is None and wrong is not None:
            reason = "its header is given" if name in self._senders else "it is not protected"
            raise BenchError(f"{name} cannot be sent with `wrong: {wrong}`: {reason}")
        sealed = [s.name for s in message.signals if s.name.startswith(TRAILER)]
        if not set(sealed) <= set(values):
            raise BenchError(
                f"{name} cannot be sent: the bench has no key for its MAC; "
                f"give {' and '.join(sealed)} in `with`"
            )
        blank = {} if sender is None else {s.name: 0 for s in message.signals if s.name in HEADER}
        try:
            return message, message.encode(blank | dict(values), strict=True), sender
        except (CodecFault, KeyError, ValueError) as fault:
            raise BenchError(f"{name} cannot be sent: {fault}") from None

    def decode(self, frame: can.Message) -> tuple[str, FrameValues] | None:
        """Name and values of a frame; BenchError for bad data.

        None for an unknown identifier, and for a frame of the other format, classic or FD.
        """
        name = self._names.get((frame.arbitration_id, frame.is_extended_id))
        if name is None or frame.is_remote_frame or frame.is_error_frame:
            return None
        message = self._message(name)
        if frame.is_fd != message.is_fd:
            return None
        try:
            decoded = message.decode(bytes(frame.data), decode_choices=True)
        except (CodecFault, ValueError) as fault:
            raise MalformedFrameError(f"{name} cannot be decoded: {fault}") from None
        assert isinstance(decoded, dict)
        return name, {field: _plain(value) for field, value in decoded.items()}

    def from_outside(self, frame: can.Message) -> str | None:
        """The message that the frame is, if no node of the database sends it; else None."""
        name = self._names.get((frame.arbitration_id, frame.is_extended_id))
        if name is None or frame.is_remote_frame or frame.is_error_frame:
            return None
        message = self._message(name)
        sound = frame.is_fd == message.is_fd and frame.dlc == message.length
        return name if sound and message.senders == [OUTSIDE] else None

    def _message(self, name: str) -> cantools.database.Message:
        try:
            return self._database.get_message_by_name(name)
        except KeyError:
            raise BenchError(f"the DBC has no message {name}") from None


class Peer:
    """One end of the bus, with counts of sent and received frames by message."""

    def __init__(
        self,
        bus: can.BusABC,
        codec: Codec,
        link: socket.socket | None = None,
        record: OnFrame = unrecorded,
        gone: str = "the controller left the bus",
    ) -> None:
        """Speak on ``bus``, which is closed together with the peer; ``link`` is its socket.

        ``gone`` is the error text for a failure of the bus.
        """
        self.codec = codec
        self.sent: Counter[str] = Counter()
        self.received: Counter[str] = Counter()
        self.unknown = 0
        """Frames whose identifier the DBC does not know."""
        self._bus = bus
        self._link = link
        self._record = record
        self._gone = gone
        self._open = True
        self._closed = False

    @staticmethod
    def connect(port: int, codec: Codec, record: OnFrame = unrecorded) -> Peer:
        """A peer at the slcan server on this machine's TCP ``port``."""
        try:
            bus = can.Bus(
                interface="slcan", channel=f"socket://127.0.0.1:{port}", sleep_after_open=0
            )
        except (can.CanError, OSError) as fault:
            raise BenchError(f"no slcan server on port {port}: {fault}") from None
        return Peer(bus, codec, link_of(bus), record)

    def clock(self) -> float:
        """The time of the bus, in s."""
        return time.monotonic()

    def sleep(self, seconds: float) -> None:
        """Let so much time of the bus pass."""
        time.sleep(seconds)

    @property
    def is_open(self) -> bool:
        """Whether the peer is neither dropped nor closed."""
        return self._open

    def send(self, name: str, values: Mapping[str, Value], wrong: Wrong | None = None) -> None:
        """Send one message now, perhaps with a fault."""
        frame = self.codec.faulty(name, values, wrong)
        if frame is not None:
            self._send(name, frame)

    def forward(self, frame: can.Message) -> None:
        """Send one frame of a log now."""
        name = self.codec.from_outside(frame)
        assert name is not None
        self._send(name, frame)

    def _send(self, name: str, frame: can.Message) -> None:
        try:
            self._bus.send(frame)
        except (can.CanError, OSError) as fault:
            raise BenchError(f"{self._gone}: {fault}") from None
        self.sent[name] += 1
        copied = copy.copy(frame)
        copied.timestamp, copied.is_rx = self._stamp(), False
        self._record(copied)

    def receive_until(self, deadline: float, take: Callable[[str, FrameValues], None]) -> None:
        """Hand over the messages that arrive until ``deadline``, a time of `clock`."""
        while self._open:
            frame = self._next(deadline)
            if frame is None:
                return
            decoded = self.codec.decode(frame)
            if decoded is None:
                self.unknown += 1
            else:
                self.received[decoded[0]] += 1
                take(*decoded)

    def drop(self) -> None:
        """Cut the connection without notice, as when a cable breaks."""
        self._open = False
        if self._link is not None:
            with suppress(OSError):
                self._link.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        """Leave the bus in order, which takes a moment; a second call does nothing."""
        self._open = False
        if not self._closed:
            self._closed = True
            with suppress(can.CanError, OSError):
                self._bus.shutdown()
            if self._link is not None:
                self._link.close()

    def _stamp(self) -> float:
        """The time for a log."""
        return time.time()

    def _next(self, deadline: float) -> can.Message | None:
        """The next frame, waiting without load; None at the deadline."""
        try:
            while (rest := deadline - time.monotonic()) > 0:
                frame = self._received(rest)
                if frame is not None:
                    self._record(copy.copy(frame))
                    return frame
            return None
        except (can.CanError, OSError) as fault:
            raise BenchError(f"{self._gone}: {fault}") from None
        except (ValueError, IndexError) as fault:
            raise BenchError(f"the controller sent a malformed slcan line: {fault}") from None

    def _received(self, rest: float) -> can.Message | None:
        """A frame within ``rest`` s; None may come earlier. Some drivers have no descriptor."""
        try:
            readable = select.select([self._bus.fileno()], [], [], rest)[0]
        except NotImplementedError:
            return self._bus.recv(timeout=rest)
        return self._bus.recv(timeout=0) if readable else None


def link_of(bus: can.BusABC) -> socket.socket:
    """The TCP connection of an slcan bus, which delays no frame from now on."""
    link = socket.socket(fileno=os.dup(bus.fileno()))
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return link


def _switches(database: Database) -> bool:
    """Whether the CAN FD frames of the database switch the bit rate (BRS)."""
    specifics = database.dbc
    kind = specifics.attribute_definitions.get("CANFD_BRS") if specifics is not None else None
    return kind is not None and kind.default_value == "1"


def _plain(value: object) -> Value:
    """A decoded value without cantools' types, and without the noise of binary fractions."""
    if isinstance(value, int | float):
        return int(value) if value == int(value) else float(f"{value:.12g}")
    return str(value)
