# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A client of the bus server that says whatever a test wants."""

from __future__ import annotations

import socket
from types import TracebackType

from ravenchart.hw_can.bench.bus_records import (
    MARK,
    RECORD_BYTES,
    VERSION,
    BusRecord,
    Flag,
    Greeting,
    RecordKind,
    decode,
    encode,
    greeting_data,
)


class RawClient:
    """A connection, and records by hand."""

    def __init__(self, channel: str, room: int | None = None) -> None:
        """Connect, with that much ``room`` in the kernel; nothing is said yet."""
        host, _, port = channel.rpartition(":")
        self._link = socket.socket()
        if room is not None:
            self._link.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
        self._link.settimeout(30)
        self._link.connect((host, int(port)))

    def __enter__(self) -> RawClient:
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self._link.close()

    def send(self, octets: bytes) -> None:
        """Say this."""
        self._link.sendall(octets)

    def greet(self) -> None:
        """Say hello, and hear welcome and state."""
        self.send(
            encode(
                BusRecord(
                    RecordKind.HELLO,
                    flags=int(Flag.FD),
                    length=3,
                    code=VERSION,
                    identifier=MARK,
                    data=greeting_data(Greeting("raw")),
                )
            )
        )
        assert [self._read().kind, self._read().kind] == [RecordKind.WELCOME, RecordKind.STATE]

    def last(self) -> BusRecord:
        """The last record before the server closes."""
        record = self._read()
        while (octets := self._link.recv(RECORD_BYTES, socket.MSG_WAITALL)) != b"":
            record = decode(octets)
        return record

    def read_to_end(self) -> int:
        """How many records come before the server closes."""
        count = 0
        while (octets := self._link.recv(1 << 16)) != b"":
            count += len(octets)
        return count // RECORD_BYTES

    def _read(self) -> BusRecord:
        return decode(self._link.recv(RECORD_BYTES, socket.MSG_WAITALL))
