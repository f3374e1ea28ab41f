# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The python-can backend `interface="ravenchart"`: a node of the bus behind a bus server.

It speaks the protocol of docs/bus-protocol.md over TCP; the channel is "HOST:PORT".
"""

from __future__ import annotations

import copy
import os
import select
import socket
import threading
import time
from collections import deque
from contextlib import suppress
from typing import Any

import can

from .bus_records import (
    MARK,
    NUMBER_LAST,
    RECORD_BYTES,
    RESTART_LAST,
    VERSION,
    BusRecord,
    Flag,
    Greeting,
    MemberState,
    RecordKind,
    Status,
    can_message,
    confirmed_in,
    decode,
    encode,
    frame_in,
    greeting_data,
    greeting_of,
    record_in,
    request_of,
    split_records,
)

PATIENCE = 5.0
"""Seconds for the greeting, and for the server to take a record."""

SLICE = 0.01
"""Seconds for which a sender reads before it lets another thread read."""

CHUNK = 512 * RECORD_BYTES
"""Bytes that are read at once."""

READING = 0.001
"""Seconds after which a sender looks whether its frames were confirmed or refused."""

MOST_OPEN = 1_000
"""Requests that may be open: the server has room for 1,024 of each node."""

LINGER = 0.5
"""Seconds for which the end of a bus waits for frames that are still to be transmitted."""

_STATES = {
    MemberState.ERROR_ACTIVE: can.BusState.ACTIVE,
    MemberState.ERROR_PASSIVE: can.BusState.PASSIVE,
    MemberState.BUS_OFF: can.BusState.ERROR,
}


class RavenchartBus(can.BusABC):
    """One node. Any thread may send, and any may receive; a frame goes to one of them."""

    def __init__(
        self,
        channel: str,
        can_filters: can.typechecking.CanFilters | None = None,
        *,
        receive_own_messages: bool = False,
        fd: bool = False,
        bitrate: int = 0,
        data_bitrate: int = 0,
        restart_ms: int = 0,
        name: str = "python-can",
        **kwargs: Any,
    ) -> None:
        """Join the bus at ``channel``, "HOST:PORT".

        ``fd``: send and receive FD frames; the bus must carry them. ``bitrate`` and
        ``data_bitrate`` in bit/s, 0 for those of the bus. ``restart_ms``: milliseconds from
        bus-off to the request for recovery, 0 .. 600,000; 0 for that of the bus, which
        requests none by default. ``name`` is shown by the server.
        Raises ValueError for an argument of another form or range, CanInitializationError
        when there is no such server or it refuses.
        """
        address = _address(channel)
        if not 0 <= restart_ms <= RESTART_LAST:
            raise ValueError(f"restart_ms is {restart_ms}, not 0 .. {RESTART_LAST}")
        greeting = Greeting(name, bitrate, data_bitrate)
        try:
            hello = encode(
                BusRecord(
                    RecordKind.HELLO,
                    flags=int(Flag.FD) if fd else 0,
                    length=len(name),
                    code=VERSION,
                    identifier=MARK,
                    number=restart_ms,
                    data=greeting_data(greeting),
                )
            )
        except can.CanOperationError as fault:
            raise ValueError(f"{name!r} at {bitrate}, {data_bitrate} bit/s: {fault}") from None
        self._echo = receive_own_messages
        self._writing = threading.Lock()
        self._reading = threading.Lock()
        self._settled = threading.Condition()
        self._signalling = threading.Lock()
        self._is_signalled = False
        self._arrived: deque[can.Message] = deque()
        self._open: dict[int, can.Message | None] = {}
        """Requests that are neither confirmed nor refused; with their frame for an echo."""
        self._looked = 0.0
        self._awaited: dict[int, str | None] = {}
        self._refusals: list[str] = []
        self._broken: str | None = None
        self._unread = b""
        self._number = 0
        self._start = 0
        self._errors = (0, 0)
        self._state = can.BusState.ACTIVE
        self._link = _connected(channel, address)
        self._channel = channel
        self._input = self._link.dup()
        self._input.setblocking(False)
        self._poll = select.poll()
        self._poll.register(self._input, select.POLLIN)
        self._ready: select.epoll | None = None
        self._signal = -1
        try:
            self._greet(channel, hello, fd)
        except BaseException:
            self._release()
            raise
        self._can_protocol = can.CanProtocol.CAN_FD if fd else can.CanProtocol.CAN_20
        super().__init__(channel, can_filters, **kwargs)

    def fileno(self) -> int:
        """Readable while a frame waits for `recv`, or while received bytes are unread."""
        with self._signalling:
            if self._ready is None:
                self._signal = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
                self._ready = select.epoll()
                for descriptor in (self._input.fileno(), self._signal):
                    self._ready.register(descriptor, select.EPOLLIN)
        self._signal_frames()
        return self._ready.fileno()

    @property
    def state(self) -> can.BusState:
        """ACTIVE, PASSIVE or ERROR (bus-off), as the server reported last."""
        self._take_all()
        return self._state

    @state.setter
    def state(self, new_state: can.BusState) -> None:
        """ACTIVE requests recovery from bus-off; no other state can be requested."""
        if new_state is not can.BusState.ACTIVE:
            raise NotImplementedError("a node of this bus only becomes active by request")
        self._write(encode(BusRecord(RecordKind.RECOVERY)))

    @property
    def error_counters(self) -> tuple[int, int]:
        """Transmit and receive error counter, each 0 .. 256, as the server reported last."""
        self._take_all()
        return self._errors

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Ask for ``msg`` to be transmitted; with a ``timeout`` > 0 s, wait until it was.

        Raises CanOperationError when it is no frame, was refused, or the bus is gone, and
        CanTimeoutError after ``timeout``. Without one, a later send raises for all frames that
        were refused by then. Confirmations are read here: a sender need not call `recv`. With
        MOST_OPEN frames still to be transmitted, a send without ``timeout`` waits for the first
        of them, at most PATIENCE s.
        """
        waits = timeout is not None and timeout > 0
        now = time.monotonic()
        if now - self._looked > READING or len(self._open) >= MOST_OPEN:
            self._looked = now
            self._take_all()
            if timeout is None and len(self._open) >= MOST_OPEN:
                self._await_room(now + PATIENCE)
        with self._writing:
            refusals, self._refusals = self._refusals, []
            if refusals:
                raise can.CanOperationError(_refused(refusals))
            if msg.is_fd and self._can_protocol is not can.CanProtocol.CAN_FD:
                raise can.CanOperationError("the bus was not opened for FD frames")
            number = self._number % NUMBER_LAST + 1
            octets = request_of(msg, number)
            self._number = number
            self._open[number] = copy.deepcopy(msg) if self._echo else None
            if waits:
                self._awaited[number] = None
            self._send(octets)
        if waits:
            assert timeout is not None
            self._await(number, timeout)

    def shutdown(self) -> None:
        """Leave the bus, once all is transmitted or a moment later; a second call does nothing."""
        if not self._is_shutdown:
            super().shutdown()
            self._linger()
            self._broken = self._broken or "the bus was shut down"
            self._release()

    def _recv_internal(self, timeout: float | None) -> tuple[can.Message | None, bool]:
        """The next frame, and whether filters do not apply to it: to error frames they do not."""
        end = None if timeout is None else time.monotonic() + timeout
        while True:
            if self._arrived:
                message = self._arrived.popleft()
                self._signal_frames()
                return message, message.is_error_frame
            rest = None if end is None else max(0.0, end - time.monotonic())
            if not self._take(rest, receiving=True) and rest == 0 and not self._arrived:
                return None, False

    def _await_room(self, end: float) -> None:
        """Wait until fewer requests are open; CanOperationError at ``end``."""
        while len(self._open) >= MOST_OPEN:
            rest = end - time.monotonic()
            if rest <= 0:
                raise can.CanOperationError(
                    f"no room: {len(self._open)} frames were not transmitted within {PATIENCE:g} s"
                )
            self._take(min(rest, SLICE))

    def _await(self, number: int, timeout: float) -> None:
        """Wait until request ``number`` is settled; other threads may read meanwhile."""
        end = time.monotonic() + timeout
        try:
            while (outcome := self._awaited[number]) is None:
                rest = end - time.monotonic()
                if rest <= 0:
                    raise can.CanTimeoutError(f"not transmitted within {timeout:g} s")
                if self._reading.locked():
                    with self._settled:
                        self._settled.wait(min(rest, SLICE))
                    self._check_usable()
                else:
                    self._take(min(rest, SLICE))
        finally:
            del self._awaited[number]
        if outcome:
            raise can.CanOperationError(f"the frame was refused: {outcome}")

    def _take_all(self) -> None:
        """Read all that has come, unless another thread reads."""
        while self._take(0):
            pass

    def _take(self, timeout: float | None, *, receiving: bool = False) -> bool:
        """Read bytes that come within ``timeout`` s and act on them; whether bytes came.

        With ``receiving`` nothing is read when a frame has arrived already.
        """
        if not self._reading.acquire(timeout=-1 if timeout is None else timeout):
            return False
        try:
            self._check_usable()
            if receiving and self._arrived:
                return False
            octets = self._bytes(timeout, CHUNK)
            if octets is None:
                return False
            if self._unread:
                octets = self._unread + octets
            part = len(octets) % RECORD_BYTES
            self._unread = octets[-part:] if part else b""
            for fields in split_records(octets[:-part] if part else octets):
                frame = frame_in(fields, self._start, self._channel)
                if frame is not None:
                    self._arrived.append(frame)
                elif self._echo or self._awaited or not self._confirm(confirmed_in(fields)):
                    self._act_on(record_in(fields))
            return True
        except can.CanOperationError as fault:
            self._broken = self._broken or str(fault)
            raise
        finally:
            self._signal_frames()
            self._reading.release()
            if self._awaited:
                with self._settled:
                    self._settled.notify_all()

    def _confirm(self, number: int) -> bool:
        """Close the open request of this number; False when there is none."""
        return number != 0 and self._open.pop(number, self) is None

    def _signal_frames(self) -> None:
        """Let `fileno` be readable while frames wait, once it was asked for."""
        if self._ready is None:
            return
        with self._signalling:
            if self._is_signalled == bool(self._arrived):
                return
            self._is_signalled = not self._is_signalled
            if self._is_signalled:
                os.eventfd_write(self._signal, 1)
            else:
                os.eventfd_read(self._signal)

    def _bytes(self, timeout: float | None, most: int) -> bytes | None:
        """At most so many of the bytes that come; None after ``timeout`` s."""
        try:
            if timeout != 0 and not self._poll.poll(None if timeout is None else 1e3 * timeout):
                return None
            octets = self._input.recv(most)
        except BlockingIOError:
            return None
        except (OSError, ValueError) as fault:
            raise can.CanOperationError(f"the bus server is gone: {fault}") from None
        if not octets:
            raise can.CanOperationError("the bus server closed the connection")
        return octets

    def _act_on(self, record: BusRecord) -> None:
        """Act on a record from the server."""
        match record.kind:
            case RecordKind.FRAME | RecordKind.ERROR_FRAME:
                arrived = can_message(record, self._start)
                arrived.channel = self._channel
                self._arrived.append(arrived)
            case RecordKind.STATE:
                self._state = _STATES[MemberState(record.code)]
                self._errors = (record.transmit_errors, record.receive_errors)
            case RecordKind.CONFIRMATION:
                message = self._close(record.number)
                if message is not None:
                    message.timestamp = (self._start + record.time) / 1e9
                    message.is_rx = False
                    message.channel = self._channel
                    self._arrived.append(message)
                if record.number in self._awaited:
                    self._awaited[record.number] = ""
            case RecordKind.STATUS if record.number == 0:
                raise can.CanOperationError(f"the bus server ends: {Status(record.code).words}")
            case RecordKind.STATUS:
                self._close(record.number)
                words = Status(record.code).words
                if record.number in self._awaited:
                    self._awaited[record.number] = words
                else:
                    self._refusals.append(words)
            case _:
                raise can.CanOperationError(f"bus protocol: a {record.kind.name.lower()} came")

    def _close(self, number: int) -> can.Message | None:
        """Close the open request of this number; its frame for an echo."""
        if number not in self._open:
            raise can.CanOperationError(f"bus protocol: no request {number} is open")
        return self._open.pop(number)

    def _greet(self, channel: str, hello: bytes, fd: bool) -> None:
        """Say hello and take the welcome; CanInitializationError when there is none."""
        try:
            self._send(hello)
            welcome = self._welcome()
            if fd and not Flag.FD & welcome.flags:
                raise can.CanOperationError("the bus carries no FD frames")
        except can.CanOperationError as fault:
            raise can.CanInitializationError(f"{channel}: {fault}") from None
        greeting = greeting_of(welcome)
        self._start = greeting.start
        self.channel_info = f"ravenchart bus {greeting.name} at {channel}, node {welcome.number}"

    def _welcome(self) -> BusRecord:
        end = time.monotonic() + PATIENCE
        octets = b""
        while len(octets) < RECORD_BYTES:
            part = self._bytes(max(0.0, end - time.monotonic()), RECORD_BYTES - len(octets))
            if part is None and time.monotonic() >= end:
                raise can.CanOperationError(f"no welcome within {PATIENCE:g} s")
            octets += part or b""
        record = decode(octets)
        if record.kind is RecordKind.STATUS:
            raise can.CanOperationError(f"refused: {Status(record.code).words}")
        if record.kind is not RecordKind.WELCOME:
            raise can.CanOperationError(f"bus protocol: {record.kind.name} is no welcome")
        if record.code != VERSION:
            raise can.CanOperationError(
                f"the server has protocol {record.code}, this client {VERSION}"
            )
        return record

    def _check_usable(self) -> None:
        if self._broken is not None:
            raise can.CanOperationError(self._broken)

    def _write(self, octets: bytes) -> None:
        with self._writing:
            self._send(octets)

    def _send(self, octets: bytes) -> None:
        """Send all of ``octets``, or raise CanOperationError, then and ever after."""
        self._check_usable()
        try:
            self._link.sendall(octets)
        except OSError as fault:
            self._broken = f"the bus server is gone: {fault}"
            raise can.CanOperationError(self._broken) from None

    def _linger(self) -> None:
        """Wait a moment for open requests: a node that leaves cancels them."""
        end = time.monotonic() + LINGER
        with suppress(can.CanOperationError):
            while self._open and (rest := end - time.monotonic()) > 0:
                self._take(rest)

    def _release(self) -> None:
        """Close everything; a thread that waits for a record is woken first."""
        with suppress(OSError):  # the server may have been faster
            self._link.shutdown(socket.SHUT_RDWR)
        with self._reading:
            if self._ready is not None:
                self._ready.close()
                os.close(self._signal)
            self._input.close()
            self._link.close()


def _refused(reasons: list[str]) -> str:
    if len(reasons) == 1:
        return f"an earlier frame was refused: {reasons[0]}"
    return f"{len(reasons)} earlier frames were refused, the last: {reasons[-1]}"


def _address(channel: str) -> tuple[str, int]:
    """Host and port of "HOST:PORT"; ValueError when it is not like that."""
    host, colon, port = str(channel).rpartition(":")
    if not (colon and host and port.isascii() and port.isdigit() and 0 < int(port) < 65536):
        raise ValueError(f"{channel!r} is no HOST:PORT")
    return host.strip("[]"), int(port)


def _connected(channel: str, address: tuple[str, int]) -> socket.socket:
    try:
        link = socket.create_connection(address, PATIENCE)
    except OSError as fault:
        raise can.CanInitializationError(f"no bus server at {channel}: {fault}") from None
    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    link.settimeout(PATIENCE)
    return link
