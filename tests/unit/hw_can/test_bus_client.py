# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The python-can backend, over a server that does what the real one never does."""

from __future__ import annotations

import select
import socket
import threading
from collections.abc import Iterator
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.bus_records import BusRecord, Flag, RecordKind, Status, encode
from tests.support.bus_server import BusServer
from tests.support.can_frames import WAIT, taken, within

pytestmark = pytest.mark.clock

ROOT = Path(__file__).parents[3]


@pytest.fixture
def pair(server: BusServer) -> Iterator[tuple[RavenchartBus, RavenchartBus]]:
    with RavenchartBus(server.channel, fd=True) as a, RavenchartBus(server.channel, fd=True) as b:
        yield a, b


def test_filters_are_for_frames_and_not_for_errors(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    a, b = pair
    b.set_filters([{"can_id": 0x100, "can_mask": 0x700, "extended": False}])
    for identifier, extended in ((0x0FF, False), (0x123, False), (0x100, True), (0x200, False)):
        a.send(can.Message(arbitration_id=identifier, is_extended_id=extended), timeout=WAIT)
    server.inject(
        BusRecord(
            RecordKind.ERROR_FRAME, Flag.EXTENDED, 8, identifier=8, data=b"\1".ljust(64, b"\0")
        )
    )
    got = taken(b, 2)
    assert [(m.arbitration_id, m.is_error_frame) for m in got] == [(0x123, False), (8, True)]
    assert b.recv(0) is None


def test_the_bus_state_follows_the_node(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    bus, _ = pair

    def becomes(state: can.BusState) -> bool:
        return within(lambda: bus.state is state)

    assert becomes(can.BusState.ACTIVE)
    server.inject(BusRecord(RecordKind.STATE, code=1, transmit_errors=130, receive_errors=3))
    assert becomes(can.BusState.PASSIVE)
    assert bus.error_counters == (130, 3)
    server.inject(BusRecord(RecordKind.STATE, code=2, transmit_errors=256))
    assert becomes(can.BusState.ERROR)
    bus.state = can.BusState.ACTIVE
    assert becomes(can.BusState.ACTIVE)
    with pytest.raises(NotImplementedError):
        bus.state = can.BusState.PASSIVE


def test_a_refusal_is_raised_at_once_or_by_the_next_send(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    bus, frame = pair[0], can.Message(arbitration_id=1)
    server.refuses = Status.NO_ROOM
    with pytest.raises(can.CanOperationError, match="the frame was refused: no room"):
        bus.send(frame, timeout=WAIT)
    bus.send(frame)
    assert bus.recv(0.1) is None
    server.refuses = None
    with pytest.raises(can.CanOperationError, match="an earlier frame was refused: no room"):
        bus.send(frame)
    bus.send(frame, timeout=WAIT)


def test_each_refusal_is_counted_by_the_next_send(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    bus, _ = pair
    server.refuses = Status.NO_ROOM
    asked = refused = 0

    def send() -> None:
        nonlocal asked, refused
        try:
            bus.send(can.Message(arbitration_id=1))
            asked += 1
        except can.CanOperationError as fault:
            count = str(fault).split(" earlier frame")[0]
            refused += 1 if count == "an" else int(count)

    for _ in range(200):
        send()
    assert within(lambda: bus.state is can.BusState.ACTIVE and not bus._open)
    before = asked
    send()
    assert refused == before > 0


@pytest.mark.slow
def test_who_only_sends_need_not_receive(server: BusServer) -> None:
    with RavenchartBus(server.channel) as bus:
        for number in range(20_000):
            bus.send(can.Message(arbitration_id=number % 0x7FF))
        assert within(lambda: bus.state is can.BusState.ACTIVE and not bus._open)


def test_a_frame_that_a_send_has_read_is_signalled(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    a, b = pair
    assert within(lambda: b.state is can.BusState.ACTIVE and not readable(b))
    for number in (1, 2):
        a.send(can.Message(arbitration_id=number), timeout=WAIT)
    b.send(can.Message(arbitration_id=3), timeout=WAIT)
    for number in (1, 2):
        assert readable(b)
        got = b.recv(0)
        assert got is not None
        assert (got.arbitration_id, got.channel) == (number, server.channel)
    assert not readable(b)


def readable(bus: RavenchartBus) -> bool:
    """Whether an event loop would call `recv` now."""
    return bool(select.select([bus.fileno()], [], [], 0)[0])


def test_without_acknowledgement_a_send_ends_in_time(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    a, b = pair
    server.confirms = False
    for _ in range(3):
        b.send(can.Message(arbitration_id=3))
    with pytest.raises(can.CanTimeoutError, match=r"not transmitted within 0\.1 s"):
        a.send(can.Message(arbitration_id=1), timeout=0.1)
    server.confirms = True
    a.send(can.Message(arbitration_id=2), timeout=WAIT)
    assert len(taken(a, 3)) == 3


def test_a_server_that_is_gone_is_said_at_once_and_ever_after(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    bus = pair[0]
    threading.Timer(0.1, server.close).start()
    with pytest.raises(can.CanOperationError, match="the bus server closed the connection"):
        bus.recv(WAIT)
    for call in (lambda: bus.recv(0), lambda: bus.send(can.Message()), lambda: bus.state):
        with pytest.raises(can.CanOperationError, match="closed the connection"):
            call()


def test_the_notifier_hands_on_that_the_server_is_gone(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    told: list[Exception] = []

    class Listener(can.Listener):
        def on_message_received(self, msg: can.Message) -> None:
            """Not looked at."""

        def on_error(self, exc: Exception) -> None:
            told.append(exc)

    notifier = can.Notifier(pair[0], [Listener()], timeout=0.1)
    server.close()
    assert within(lambda: told)
    notifier.stop()
    assert isinstance(told[0], can.CanOperationError)


@pytest.mark.parametrize(
    ("octets", "words"),
    [
        (bytes(88), "bus protocol: there is no kind 0"),
        (b"HTTP/1.1 400 Bad Request\r\n" * 5, "bus protocol: there is no kind 72"),
        (encode(BusRecord(RecordKind.RECOVERY)), "bus protocol: a recovery came"),
        (
            encode(BusRecord(RecordKind.CONFIRMATION, number=7)),
            "bus protocol: no request 7 is open",
        ),
        (encode(BusRecord(RecordKind.STATUS, code=Status.CLOSING)), "the bus server ends: closing"),
    ],
)
def test_garbage_ends_the_connection_in_words(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus], octets: bytes, words: str
) -> None:
    server.inject_bytes(octets)
    for _ in range(2):
        with pytest.raises(can.CanOperationError, match=words):
            pair[0].recv(WAIT)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"version": 2}, "refused: wrong version"),
        ({"first": b"SSH-2.0-OpenSSH\r\n".ljust(88)}, "there is no kind 83"),
        ({"first": encode(BusRecord(RecordKind.STATE))}, "STATE is no welcome"),
        ({"fd": False}, "the bus carries no FD frames"),
    ],
)
def test_a_bus_that_cannot_be_joined_says_why(settings: dict[str, object], words: str) -> None:
    server = BusServer(**settings)  # type: ignore[arg-type]
    with pytest.raises(can.CanInitializationError, match=words):
        RavenchartBus(server.channel, fd=True)
    server.close()


def test_no_server_and_no_channel() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        channel = f"127.0.0.1:{free.getsockname()[1]}"
    with pytest.raises(can.CanInitializationError, match="no bus server at 127"):
        RavenchartBus(channel)
    for wrong in ("can0", "127.0.0.1:", ":1", "h:0", "h:99999", "h:-1", ""):
        with pytest.raises(ValueError, match="is no HOST:PORT"):
            RavenchartBus(wrong)
    for settings in (
        {"name": ""},
        {"name": "a b"},
        {"name": "x" * 17},
        {"bitrate": 2_000_000},
        {"bitrate": -1},
        {"restart_ms": 600_001},
    ):
        with pytest.raises(ValueError, match=r"bus protocol|restart_ms is 600001"):
            RavenchartBus(channel, **settings)
