# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A bus server that does what a right one never does: it harms, refuses, says garbage.

It is no bus and knows no bit times, arbitration, acknowledgement or error counters: a frame
is over the moment it is read, and errors and states are those that a test injects.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace

from ravenchart.hw_can.bench.bus_records import (
    MARK,
    RECORD_BYTES,
    VERSION,
    BusRecord,
    Flag,
    Greeting,
    RecordKind,
    Status,
    decode,
    encode,
    greeting_data,
)

from .listening import Listener

NAME = "stand-in"


class BusServer(Listener):
    """A stand-in for the bus server."""

    def __init__(self, *, fd: bool = True, version: int = VERSION, first: bytes = b"") -> None:
        """``first`` is said in place of a welcome."""
        super().__init__()
        self._flags = int(Flag.FD) if fd else 0
        self._version, self.first = version, first
        self.channel = self.address
        self.confirms = True
        self.silent = False
        """Nobody is welcomed, nor refused: behind ``first`` there is nothing."""
        self.calls = 0
        """So many have said hello."""
        self.refuses: Status | None = None
        """With what the next frames are refused."""
        self.harm: Callable[[BusRecord], BusRecord | None] = lambda record: record
        """What a frame becomes on its way; None for nothing."""
        self.clients: dict[int, tuple[socket.socket, bool]] = {}
        self._lock = threading.Lock()
        self._start = time.time_ns()
        self._joined = 0
        self.listen()

    @property
    def now(self) -> int:
        """Bus time in ns."""
        return time.time_ns() - self._start

    def inject(self, record: BusRecord) -> None:
        """Send ``record`` to every client, as of now."""
        with self._lock:
            self._to_all(replace(record, time=self.now))

    def inject_bytes(self, octets: bytes) -> None:
        """Send any bytes to every client."""
        with self._lock:
            for link, _ in self.clients.values():
                link.sendall(octets)

    def _links(self) -> list[socket.socket]:
        with self._lock:
            return [link for link, _ in self.clients.values()]

    def _serve(self, link: socket.socket) -> None:
        node = 0
        with link, suppress(OSError):
            hello = _read(link)
            if hello is None or hello.kind is not RecordKind.HELLO:
                return
            self.calls += 1
            if self.silent:
                link.sendall(self.first)
                link.recv(1)
                return
            if hello.code != self._version and not self.first:
                link.sendall(encode(BusRecord(RecordKind.STATUS, code=Status.WRONG_VERSION)))
                return
            with self._lock:
                self._joined = node = self._joined + 1
                link.sendall(self.first or self._welcome(node))
                self.clients[node] = (link, bool(hello.flags & Flag.FD))
            while (record := _read(link)) is not None:
                with self._lock:
                    self._answer(node, record)
        with self._lock:
            self.clients.pop(node, None)

    def _welcome(self, node: int) -> bytes:
        return encode(
            BusRecord(
                RecordKind.WELCOME,
                flags=self._flags,
                length=len(NAME),
                code=VERSION,
                identifier=MARK,
                time=self.now,
                number=node,
                data=greeting_data(Greeting(NAME, start=self._start)),
            )
        ) + encode(BusRecord(RecordKind.STATE, time=self.now))

    def _answer(self, node: int, record: BusRecord) -> None:
        if record.kind is RecordKind.RECOVERY:
            self._to_all(BusRecord(RecordKind.STATE, time=self.now), only=node)
        elif self.refuses is not None:
            refusal = BusRecord(RecordKind.STATUS, code=self.refuses, number=record.number)
            self._to_all(refusal, only=node)
        else:
            now = self.now
            arriving = self.harm(replace(record, time=now, number=0))
            if arriving is not None:
                self._to_all(arriving, but=node)
            if self.confirms:
                confirmation = BusRecord(RecordKind.CONFIRMATION, time=now, number=record.number)
                self._to_all(confirmation, only=node)

    def _to_all(self, record: BusRecord, *, but: int = 0, only: int = 0) -> None:
        """To each client but one, or to one only; FD frames to those that take them."""
        octets = encode(record)
        for node, (link, fd) in self.clients.items():
            if node != but and only in (0, node) and (fd or not record.flags & Flag.FD):
                with suppress(OSError):
                    link.sendall(octets)


def _read(link: socket.socket) -> BusRecord | None:
    """The next record; None at the end."""
    octets = link.recv(RECORD_BYTES, socket.MSG_WAITALL)
    return decode(octets) if len(octets) == RECORD_BYTES else None
