# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The records of the bus protocol: exact both ways, and total on any bytes."""

from __future__ import annotations

import random

import can
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ravenchart.hw_can.bench.bus_records import (
    MARK,
    RECORD_BYTES,
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
    record_of,
    request_of,
    split_records,
    state_of,
)
from tests.support.can_frames import mixed_frames

ANY_BYTES = 4_000


def valid() -> list[bytes]:
    """One record of each kind."""
    greeting = greeting_data(Greeting("bench", 500_000, 2_000_000))
    return [
        encode(BusRecord(RecordKind.HELLO, Flag.FD, 5, 1, MARK, data=greeting)),
        encode(BusRecord(RecordKind.WELCOME, Flag.FD, 5, 1, MARK, 7, 2, data=greeting)),
        encode(record_of(can.Message(arbitration_id=0x123, data=b"abc"), 1)),
        encode(BusRecord(RecordKind.ERROR_FRAME, Flag.EXTENDED, 8, identifier=0x88, time=5)),
        encode(BusRecord(RecordKind.STATE, code=1, transmit_errors=128)),
        encode(BusRecord(RecordKind.CONFIRMATION, time=9, number=3)),
        encode(BusRecord(RecordKind.STATUS, code=Status.NO_ROOM, number=3)),
        encode(BusRecord(RecordKind.RECOVERY)),
    ]


def accepted(octets: bytes) -> bool:
    """Whether the bytes are a record, which then is written as the same bytes."""
    try:
        record = decode(octets)
    except can.CanOperationError:
        return False
    assert encode(record) == octets
    return True


def test_the_layout_is_that_of_the_page() -> None:
    octets = encode(
        BusRecord(
            RecordKind.FRAME,
            1,
            2,
            0,
            0x1234_5678,
            0x0102,
            0x0A0B,
            data=b"\x55\xaa".ljust(64, b"\0"),
        )
    )
    assert octets[:26] == bytes.fromhex(
        "03 01 02 00 78563412 0201000000000000 0b0a0000 0000 0000 55aa"
    )
    assert len(octets) == RECORD_BYTES == 88
    assert (
        encode(BusRecord(RecordKind.STATE, 0, 0, 2, 0, 0, 0, 256, 0))[20:24] == b"\x00\x01\x00\x00"
    )


def test_a_thousand_frames_come_back_as_they_were() -> None:
    for number, frame in enumerate(mixed_frames(1_000), 1):
        record = decode(encode(record_of(frame, number)))
        assert record.number == number
        assert can_message(record, 0).equals(frame, check_channel=False, timestamp_delta=None)


@given(st.binary(max_size=2 * RECORD_BYTES))
def test_any_bytes_are_a_record_or_refused(octets: bytes) -> None:
    accepted(octets)


def quick(octets: bytes) -> BusRecord | can.Message | int | None:
    """What the ways without a `BusRecord` make of it."""
    (fields,) = split_records(octets)
    return frame_in(fields, 0, "x") or confirmed_in(fields) or None


@settings(max_examples=300)
@example(1, b"\1", b",", 0)  # a flag that there is not
@given(st.integers(0, 3), st.binary(max_size=3), st.binary(max_size=3), st.integers(0, 99))
def test_the_quick_ways_accept_what_is_sound_and_nothing_else(
    kind: int, at: bytes, to: bytes, seed: int
) -> None:
    """A frame or confirmation with up to three bytes changed: as `decode` says, or not at all."""
    octets = bytearray(
        encode(record_of(mixed_frames(1, seed=seed)[0], 7))
        if kind
        else encode(BusRecord(RecordKind.CONFIRMATION, time=9, number=3))
    )
    for place, value in zip(at, to, strict=False):
        octets[place % RECORD_BYTES] = value
    found = quick(bytes(octets))
    try:
        record = decode(bytes(octets))
    except can.CanOperationError:
        assert found is None
        return
    if record.kind is RecordKind.FRAME:
        assert isinstance(found, can.Message)
        assert found.equals(can_message(record, 0), check_channel=False, timestamp_delta=0)
    elif record.kind is RecordKind.CONFIRMATION:
        assert found == record.number
    else:
        assert found is None


def test_the_quick_request_is_the_record() -> None:
    for number, frame in enumerate(mixed_frames(500), 1):
        assert request_of(frame, number) == encode(record_of(frame, number))


def test_changed_records_are_refused_or_mean_what_they_say() -> None:
    chance, kept = random.Random(5), 0
    for _ in range(ANY_BYTES):
        octets = bytearray(chance.choice(valid()))
        for _ in range(chance.randint(1, 3)):
            octets[chance.randrange(len(octets))] = chance.choice((0, 1, 8, 0x7F, 0x80, 0xFF))
        kept += accepted(bytes(octets))
    assert 0 < kept < ANY_BYTES


def test_every_kind_flag_length_and_code() -> None:
    for octets in valid():
        for offset in range(4):
            for value in range(256):
                accepted(octets[:offset] + bytes([value]) + octets[offset + 1 :])


@pytest.mark.parametrize(
    ("record", "words"),
    [
        (BusRecord(RecordKind.FRAME, identifier=0x800), "standard identifier 0x800"),
        (BusRecord(RecordKind.FRAME, Flag.FD | Flag.REMOTE), "a remote frame in the FD format"),
        (BusRecord(RecordKind.FRAME, Flag.FD, 9), "length 9 in the FD format"),
        (BusRecord(RecordKind.FRAME, 0, 9), "length 9 in the classic format"),
        (BusRecord(RecordKind.FRAME, Flag.BRS), "BRS or ESI in the classic format"),
        (BusRecord(RecordKind.FRAME, data=b"\1".ljust(64, b"\0")), "data beyond the length"),
        (BusRecord(RecordKind.FRAME, code=1), "code 1 in frame"),
        (BusRecord(RecordKind.FRAME, time=2**63), f"time {2**63} in frame"),
        (BusRecord(RecordKind.ERROR_FRAME, Flag.FD), "flags 4 in error frame"),
        (BusRecord(RecordKind.STATE, code=0, transmit_errors=128), "state 0 with counters 128, 0"),
        (BusRecord(RecordKind.STATUS, code=0), "code 0 in status"),
        (BusRecord(RecordKind.CONFIRMATION), "number 0 in confirmation"),
        (BusRecord(RecordKind.RECOVERY, data=b"\1" * 64), "data in recovery"),
        (
            BusRecord(RecordKind.HELLO, 0, 1, 1, MARK),
            "a name has a character that is not from ! to ~",
        ),
        (BusRecord(RecordKind.HELLO, 0, 1, 1, 5), "identifier 5 in hello"),
    ],
)
def test_each_rule_is_said_in_words(record: BusRecord, words: str) -> None:
    with pytest.raises(can.CanOperationError, match=f"bus protocol: {words}"):
        encode(record)


def test_a_message_that_is_no_frame_is_refused() -> None:
    for message in (
        can.Message(arbitration_id=0x800, is_extended_id=False),
        can.Message(dlc=9, data=bytes(9)),
        can.Message(dlc=3, data=b"12345"),
        can.Message(is_fd=True, dlc=11, data=bytes(11)),
        can.Message(arbitration_id=-1),
    ):
        with pytest.raises(can.CanOperationError):
            request_of(message, 1)


def test_the_state_goes_with_the_counters() -> None:
    assert state_of(127, 127) is MemberState.ERROR_ACTIVE
    assert state_of(128, 0) is state_of(0, 128) is state_of(255, 0) is MemberState.ERROR_PASSIVE
    assert state_of(256, 0) is MemberState.BUS_OFF


def test_a_greeting_comes_back() -> None:
    greeting = Greeting("bench", 500_000, 2_000_000, 0)
    record = decode(
        encode(BusRecord(RecordKind.HELLO, 0, 5, 1, MARK, data=greeting_data(greeting)))
    )
    assert greeting_of(record) == greeting
