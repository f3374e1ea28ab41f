# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Records of the bus protocol (docs/bus-protocol.md), to and from their 88 bytes.

Reading is total: any bytes give a record that keeps every rule, or a
`can.CanOperationError` that names the broken rule. Writing the record gives the same bytes.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum, IntFlag

import can

VERSION = 1
MARK = int.from_bytes(b"RAVN", "little")

_LAYOUT = struct.Struct("<BBBBIQIHH64s")
_GREETING = struct.Struct("<16sIIQ32x")
_GREETING_BYTES = 32
"""Bytes of the data that a greeting uses."""
RECORD_BYTES = _LAYOUT.size
DATA_BYTES = 64
NAME_LENGTH = 16

NO_DATA = bytes(DATA_BYTES)
FD_LENGTHS = frozenset((*range(9), 12, 16, 20, 24, 32, 48, 64))
"""Bytes that a frame of the FD format can carry (ISO 11898-1, data length code)."""

RESTART_LAST = 600_000
"""The longest time from bus-off to the request for recovery, in ms."""
TIME_LAST = 2**63 - 1
NUMBER_LAST = 2**32 - 1
ERROR_PASSIVE = 128
BUS_OFF = 256
"""Error counters from which on a node is error-passive, and bus-off (ISO 11898-1)."""


class RecordKind(IntEnum):
    """The kind of a record."""

    HELLO = 1
    WELCOME = 2
    FRAME = 3
    ERROR_FRAME = 4
    STATE = 5
    CONFIRMATION = 6
    STATUS = 7
    RECOVERY = 8


class Flag(IntFlag):
    """Of a frame; FD also in hello and welcome."""

    EXTENDED = 1
    REMOTE = 2
    FD = 4
    BRS = 8
    ESI = 16


class MemberState(IntEnum):
    """Fault confinement (ISO 11898-1)."""

    ERROR_ACTIVE = 0
    ERROR_PASSIVE = 1
    BUS_OFF = 2


class Status(IntEnum):
    """Why a request was refused, or a connection ends."""

    WRONG_VERSION = 1
    MALFORMED_RECORD = 2
    NO_ROOM = 3
    BUS_OFF = 4
    NOT_SUPPORTED = 5
    WRONG_BIT_RATE = 6
    CLOSING = 7
    NO_HELLO_IN_TIME = 8

    @property
    def words(self) -> str:
        """The words for a message."""
        return self.name.lower().replace("_", " ")


@dataclass(frozen=True, slots=True)
class BusRecord:
    """One record; ``time`` in ns since the bus was started, ``data`` always 64 bytes."""

    kind: RecordKind
    flags: int = 0
    length: int = 0
    code: int = 0
    identifier: int = 0
    time: int = 0
    number: int = 0
    transmit_errors: int = 0
    receive_errors: int = 0
    data: bytes = NO_DATA


@dataclass(frozen=True, slots=True)
class Greeting:
    """The data of hello and welcome: bit rates in bit/s, ``start`` in ns since 1970."""

    name: str
    nominal_rate: int = 0
    data_rate: int = 0
    start: int = 0


_IDENTIFIER = (0, 2**29 - 1)
_TIME = (0, TIME_LAST)
_NUMBER = (0, NUMBER_LAST)
_COUNTER = (0, BUS_OFF)

_RANGES: dict[RecordKind, dict[str, tuple[int, int]]] = {
    RecordKind.HELLO: {
        "length": (1, NAME_LENGTH),
        "code": (1, 255),
        "identifier": (MARK, MARK),
        "number": (0, RESTART_LAST),
    },
    RecordKind.WELCOME: {
        "length": (1, NAME_LENGTH),
        "code": (1, 255),
        "identifier": (MARK, MARK),
        "time": _TIME,
        "number": (1, 255),
    },
    RecordKind.FRAME: {
        "length": (0, DATA_BYTES),
        "identifier": _IDENTIFIER,
        "time": _TIME,
        "number": _NUMBER,
    },
    RecordKind.ERROR_FRAME: {
        "length": (0, 8),
        "identifier": _IDENTIFIER,
        "time": _TIME,
        "number": _NUMBER,
    },
    RecordKind.STATE: {
        "code": (0, len(MemberState) - 1),
        "time": _TIME,
        "transmit_errors": _COUNTER,
        "receive_errors": _COUNTER,
    },
    RecordKind.CONFIRMATION: {"time": _TIME, "number": (1, NUMBER_LAST)},
    RecordKind.STATUS: {"code": (1, len(Status)), "number": _NUMBER},
    RecordKind.RECOVERY: {},
}
"""The range of each field that a kind has; the others are 0."""

_FLAGS = {
    RecordKind.HELLO: Flag.FD,
    RecordKind.WELCOME: Flag.FD,
    RecordKind.FRAME: Flag.EXTENDED | Flag.REMOTE | Flag.FD | Flag.BRS | Flag.ESI,
    RecordKind.ERROR_FRAME: Flag.EXTENDED,
}

_NUMBERS = (
    "length", "code", "identifier", "time", "number", "transmit_errors", "receive_errors"
)  # fmt: skip


def encode(record: BusRecord) -> bytes:
    """The 88 bytes of ``record``; CanOperationError when it breaks a rule."""
    _check(record)
    return _LAYOUT.pack(
        record.kind,
        record.flags,
        record.length,
        record.code,
        record.identifier,
        record.time,
        record.number,
        record.transmit_errors,
        record.receive_errors,
        record.data,
    )


def decode(octets: bytes) -> BusRecord:
    """The record in ``octets``; CanOperationError when they are none."""
    if len(octets) != RECORD_BYTES:
        raise _broken(f"{len(octets)} bytes are no record of {RECORD_BYTES}")
    return record_in(_LAYOUT.unpack(octets))


def greeting_data(greeting: Greeting) -> bytes:
    """The data of a hello or welcome; CanOperationError when a figure has no room."""
    name = greeting.name.encode("ascii", "replace")
    try:
        return _GREETING.pack(name, greeting.nominal_rate, greeting.data_rate, greeting.start)
    except struct.error as fault:
        raise _broken(f"{greeting}: {fault}") from None


def greeting_of(record: BusRecord) -> Greeting:
    """The greeting in a hello or welcome."""
    name, nominal, data, start = _GREETING.unpack(record.data)
    return Greeting(name[: record.length].decode("ascii"), nominal, data, start)


def state_of(transmit_errors: int, receive_errors: int) -> MemberState:
    """The state that goes with these error counters (ISO 11898-1, fault confinement)."""
    if transmit_errors >= BUS_OFF:
        return MemberState.BUS_OFF
    passive = max(transmit_errors, receive_errors) >= ERROR_PASSIVE
    return MemberState.ERROR_PASSIVE if passive else MemberState.ERROR_ACTIVE


def record_of(message: can.Message, number: int) -> BusRecord:
    """The request that sends ``message``; CanOperationError when no frame is like that."""
    error, remote = message.is_error_frame, message.is_remote_frame
    flags = Flag(0)
    for flag, is_set in (
        (Flag.EXTENDED, message.is_extended_id),
        (Flag.REMOTE, remote),
        (Flag.FD, message.is_fd),
        (Flag.BRS, message.bitrate_switch),
        (Flag.ESI, message.error_state_indicator),
    ):
        flags |= flag if is_set else Flag(0)
    if len(message.data) != (0 if remote else message.dlc):
        raise _broken(f"a length of {message.dlc} does not fit {len(message.data)} bytes of data")
    record = BusRecord(
        RecordKind.ERROR_FRAME if error else RecordKind.FRAME,
        flags=int(flags),
        length=message.dlc,
        identifier=message.arbitration_id,
        number=number,
        data=bytes(message.data).ljust(DATA_BYTES, b"\0"),
    )
    _check(record)
    return record


def can_message(record: BusRecord, start: int) -> can.Message:
    """The frame or error frame; ``start`` is when bus time 0 was, in ns since 1970."""
    flags = Flag(record.flags)
    remote = Flag.REMOTE in flags
    return can.Message(
        timestamp=(start + record.time) / 1e9,
        arbitration_id=record.identifier,
        is_extended_id=Flag.EXTENDED in flags,
        is_remote_frame=remote,
        is_error_frame=record.kind is RecordKind.ERROR_FRAME,
        dlc=record.length,
        data=None if remote else record.data[: record.length],
        is_fd=Flag.FD in flags,
        bitrate_switch=Flag.BRS in flags,
        error_state_indicator=Flag.ESI in flags,
    )


_Fields = tuple[int, int, int, int, int, int, int, int, int, bytes]
"""The fields of a record as they are packed, before any rule was checked."""

_ZEROS = tuple(bytes(DATA_BYTES - length) for length in range(DATA_BYTES + 1))
"""The zeros after each number of bytes of data."""

_CLASSIC_LENGTHS = frozenset(range(9))
_FORMATS = {
    int(flags | extended): (
        FD_LENGTHS if Flag.FD in flags else _CLASSIC_LENGTHS,
        2**29 - 1 if extended else 0x7FF,
    )
    for extended in (Flag(0), Flag.EXTENDED)
    for flags in (
        Flag(0), Flag.REMOTE, Flag.FD, Flag.FD | Flag.BRS, Flag.FD | Flag.ESI,
        Flag.FD | Flag.BRS | Flag.ESI,
    )
}  # fmt: skip
"""By the flags of a frame: its lengths, and its last identifier."""


def split_records(octets: bytes) -> Iterator[_Fields]:
    """The fields of each record in ``octets``, a multiple of 88 bytes."""
    return _LAYOUT.iter_unpack(octets)


def record_in(fields: _Fields) -> BusRecord:
    """The record with these fields; CanOperationError when it breaks a rule."""
    kind, *rest = fields
    if kind not in _RANGES:
        raise _broken(f"there is no kind {kind}")
    record = BusRecord(RecordKind(kind), *rest)  # type: ignore[arg-type]
    _check(record)
    return record


def frame_in(fields: _Fields, start: int, channel: str) -> can.Message | None:
    """The frame with these fields, the common kind of record, without a `BusRecord` in between.

    None for another kind, and for a frame that breaks a rule: `record_in` distinguishes them.
    """
    kind, flags, length, code, identifier, when, _, transmit, receive, data = fields
    if kind != _FRAME or flags not in _FORMATS or code or transmit or receive:
        return None
    lengths, last = _FORMATS[flags]
    carried = 0 if flags & _REMOTE else length
    if length not in lengths or identifier > last or when > TIME_LAST:
        return None
    if not data.endswith(_ZEROS[carried]):
        return None
    return can.Message(
        (start + when) / 1e9,
        identifier,
        bool(flags & 1),
        bool(flags & 2),
        False,
        channel,
        length,
        bytearray(data[:carried]),
        bool(flags & 4),
        True,
        bool(flags & 8),
        bool(flags & 16),
    )


def confirmed_in(fields: _Fields) -> int:
    """The number of the request that is confirmed; 0 when this is no sound confirmation."""
    kind, flags, length, code, identifier, when, number, transmit, receive, data = fields
    others = flags or length or code or identifier or transmit or receive
    if kind != _CONFIRMATION or others or when > TIME_LAST or data != NO_DATA:
        return 0
    return number


def request_of(message: can.Message, number: int) -> bytes:
    """The 88 bytes that ask for ``message``; CanOperationError when no frame is like that."""
    data, length = message.data, message.dlc
    if (
        message.is_fd
        or message.is_remote_frame
        or message.is_error_frame
        or message.bitrate_switch
        or message.error_state_indicator
        or not 0 <= message.arbitration_id <= (2**29 - 1 if message.is_extended_id else 0x7FF)
        or not len(data) == length <= 8
    ):
        return encode(record_of(message, number))
    flags = 1 if message.is_extended_id else 0
    return _LAYOUT.pack(
        _FRAME, flags, length, 0, message.arbitration_id, 0, number, 0, 0, bytes(data)
    )


_FRAME, _CONFIRMATION = int(RecordKind.FRAME), int(RecordKind.CONFIRMATION)
_REMOTE = int(Flag.REMOTE)


def _broken(rule: str) -> can.CanOperationError:
    return can.CanOperationError(f"bus protocol: {rule}")


def _check(record: BusRecord) -> None:
    """CanOperationError when ``record`` breaks a rule of its kind."""
    kind, name = record.kind, record.kind.name.lower().replace("_", " ")
    if record.flags & ~int(_FLAGS.get(kind, Flag(0))):  # ~ of a Flag keeps to its members
        raise _broken(f"flags {record.flags} in {name}")
    ranges = _RANGES[kind]
    for field in _NUMBERS:
        first, last = ranges.get(field, (0, 0))
        value = getattr(record, field)
        if not first <= value <= last:
            raise _broken(f"{field.replace('_', ' ')} {value} in {name}")
    if len(record.data) != DATA_BYTES:
        raise _broken(f"{len(record.data)} bytes of data")
    if kind in (RecordKind.HELLO, RecordKind.WELCOME):
        _check_greeting(record)
    elif kind in (RecordKind.FRAME, RecordKind.ERROR_FRAME):
        _check_frame(record)
    elif any(record.data):
        raise _broken(f"data in {name}")
    if kind is RecordKind.STATE and record.code != state_of(
        record.transmit_errors, record.receive_errors
    ):
        raise _broken(
            f"state {record.code} with counters {record.transmit_errors}, {record.receive_errors}"
        )


def _check_greeting(record: BusRecord) -> None:
    name, nominal, data, start = _GREETING.unpack(record.data)
    if any(not 0x21 <= octet <= 0x7E for octet in name[: record.length]):
        raise _broken("a name has a character that is not from ! to ~")
    if any(name[record.length :]) or any(record.data[_GREETING_BYTES:]):
        raise _broken("data beyond the greeting")
    if nominal > 1_000_000 or data > 20_000_000:
        raise _broken(f"bit rates {nominal} and {data}")
    if start > (TIME_LAST if record.kind is RecordKind.WELCOME else 0):
        raise _broken(f"start {start}")


def _check_frame(record: BusRecord) -> None:
    flags = Flag(record.flags)
    if Flag.EXTENDED not in flags and record.identifier > 0x7FF:
        raise _broken(f"standard identifier {record.identifier:#x}")
    if Flag.FD in flags:
        if Flag.REMOTE in flags:
            raise _broken("a remote frame in the FD format")
        if record.length not in FD_LENGTHS:
            raise _broken(f"length {record.length} in the FD format")
    elif record.length > 8:
        raise _broken(f"length {record.length} in the classic format")
    elif flags & (Flag.BRS | Flag.ESI):
        raise _broken("BRS or ESI in the classic format")
    carried = 0 if Flag.REMOTE in flags else record.length
    if any(record.data[carried:]):
        raise _broken("data beyond the length")
