# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Programs with the CAN driver `bus`: each a process, and a node of one simulated bus."""

from __future__ import annotations

import subprocess
import time
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.bus_records import BusRecord, Flag, RecordKind, Status, encode
from ravenchart.running.server import running
from tests.support.ada_programs import built
from tests.support.bus_server import BusServer
from tests.support.can_bus import started
from tests.support.can_frames import FD_LENGTHS, WAIT, taken
from tests.support.can_node import JOINED, LIMIT, node
from tests.support.faults import shows

pytestmark = pytest.mark.clock

MAINS = ("can_echo", "test_bus_members")
MOST_OPEN = 8
DEPTH = 1000
"""Requests that the driver has open, and frames that its transmit queue holds (nodes.ads)."""


@pytest.fixture(scope="module")
def echo() -> Path:
    """The program, with every contract executed."""
    return built("checks", "bus", *MAINS) / "can_echo"


def order_burst(bus: can.BusABC, length: int) -> None:
    """Have node 0 send so many frames, which count from 1."""
    data = length.to_bytes(2, "little")
    bus.send(can.Message(arbitration_id=0x7F0, data=data, is_extended_id=False), timeout=WAIT)


def counted(messages: list[can.Message]) -> list[int]:
    """What the frames of a burst count."""
    return [int.from_bytes(message.data, "little") for message in messages]


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["checks", "release"])
def test_every_fact_of_a_member_holds(mode: str) -> None:
    program = built(mode, "bus", *MAINS) / "test_bus_members"
    done = subprocess.run([program], capture_output=True, text=True, timeout=40, check=False)
    facts = [line for line in done.stdout.splitlines() if line.startswith(("ok ", "not ok "))]
    assert facts, done.stdout + done.stderr
    assert [f for f in facts if f.startswith("not ok")] == []
    assert done.returncode == 0


def test_frames_of_every_kind_go_from_program_to_program(echo: Path) -> None:
    with started() as channel, node(echo, 0, channel) as a, node(echo, 1, channel) as b:
        a.wait_for("ERROR_ACTIVE")
        b.wait_for("ERROR_ACTIVE")
        assert a.said == [JOINED + channel.rpartition(":")[2]]
        sent = [
            can.Message(
                arbitration_id=identifier,
                is_extended_id=extended,
                is_remote_frame=remote,
                dlc=length,
                data=None if remote else bytes(range(1, length + 1)),
            )
            for extended, identifiers in ((False, (0, 0x400, 0x7EC)), (True, (0x7F0, 0x1FFF_FFFC)))
            for identifier in identifiers
            for remote in (False, True)
            for length in range(9)
        ]
        with RavenchartBus(channel) as bus:
            for message in sent:
                bus.send(message)
            found = taken(bus, 2 * len(sent))
        a.wait(lambda now: now.sent == len(sent) and now.received == 2 * len(sent))
        b.wait(lambda now: now.sent == len(sent) and now.received == 2 * len(sent))
    for rest in (1, 2):
        expected = [
            (m.arbitration_id + rest, m.is_extended_id, m.is_remote_frame, m.dlc, bytes(m.data))
            for m in sent
        ]
        assert expected == [
            (m.arbitration_id, m.is_extended_id, m.is_remote_frame, m.dlc, bytes(m.data))
            for m in found
            if m.arbitration_id % 4 == rest
        ]


def test_fd_frames_of_every_length_go_from_program_to_program(echo: Path) -> None:
    sent = [
        can.Message(
            arbitration_id=identifier,
            is_extended_id=extended,
            is_fd=True,
            bitrate_switch=switch,
            data=bytes(range(1, length + 1)),
        )
        for identifier, extended in ((0x400, False), (0x1FFF_FFFC, True))
        for switch in (False, True)
        for length in FD_LENGTHS
    ]
    with started() as channel, node(echo, 0, channel) as a, node(echo, 1, channel) as b:
        a.wait_for("ERROR_ACTIVE")
        b.wait_for("ERROR_ACTIVE")
        with RavenchartBus(channel, fd=True) as bus:
            for message in sent:
                bus.send(message)
            found = taken(bus, 2 * len(sent))
        a.wait(lambda now: now.sent == len(sent) and now.received == 2 * len(sent))
    for rest in (1, 2):
        assert [
            (m.arbitration_id + rest, m.is_extended_id, m.bitrate_switch, bytes(m.data))
            for m in sent
        ] == [
            (m.arbitration_id, m.is_extended_id, m.bitrate_switch, bytes(m.data))
            for m in found
            if m.arbitration_id % 4 == rest and m.is_fd
        ]


@pytest.mark.parametrize(("buffers", "last"), [("fifo", True), ("priority", False)])
def test_a_more_urgent_frame_goes_first_from_buffers_by_priority(
    buffers: str, last: bool, echo: Path
) -> None:
    with started("bitrate=10000", f"buffer={buffers}") as channel, node(echo, 0, channel) as a:
        a.wait_for("ERROR_ACTIVE")
        with RavenchartBus(channel) as bus:
            order_burst(bus, 7)
            bus.send(can.Message(arbitration_id=0x40, is_extended_id=False))
            found = [message.arbitration_id for message in taken(bus, 8)]
    assert sorted(found) == [0x41] + 7 * [0x102]
    assert (found[-1] == 0x41) == last


def test_the_filter_refuses_what_it_does_not_accept(echo: Path) -> None:
    with started() as channel, node(echo, 0, channel) as a:
        a.wait_for("ERROR_ACTIVE")
        with RavenchartBus(channel) as bus:
            bus.send(can.Message(arbitration_id=0x80, is_extended_id=True), timeout=WAIT)
            bus.send(can.Message(arbitration_id=0x200, is_extended_id=True), timeout=WAIT)
            assert [m.arbitration_id for m in taken(bus, 1)] == [0x201]
        assert a.wait(lambda now: now.sent == 1).received == 1


@shows(
    "the bus server is killed",
    found_by="the driver `bus`",
    reaction="state stopped, what is open is counted as lost; it joins the next server",
)
def test_a_server_that_is_killed_and_one_that_comes_in_its_place(echo: Path) -> None:
    with running("port=0") as (server, channel), node(echo, 0, channel) as a:
        a.wait_for("ERROR_ACTIVE")
        with RavenchartBus(channel) as bus:
            order_burst(bus, 100)
        assert a.wait(lambda now: now.tec == 128).state == "ERROR_PASSIVE"
        server.kill()
        now = a.wait(lambda now: now.sent + now.lost_out == 100)
        assert now.state == "STOPPED" and now.lost_out >= MOST_OPEN
        assert (now.rejected, now.tec) == (0, 0)
        port = channel.rpartition(":")[2]
        with running(f"port={port}"):
            a.wait_for("ERROR_ACTIVE")
            with RavenchartBus(channel) as bus:
                bus.send(can.Message(arbitration_id=0x200, is_extended_id=False))
                assert [m.arbitration_id for m in taken(bus, 1)] == [0x201]
        assert a.said.count(JOINED + port) == 1


@pytest.mark.slow
def test_a_node_that_is_cut_off_becomes_passive_and_active_again(echo: Path) -> None:
    with (
        started("bitrate=10000", "event=3000000000:cut:2", "event=4000000000:mend") as channel,
        RavenchartBus(channel) as bus,
        node(echo, 0, channel) as a,
    ):
        a.wait_for("ERROR_ACTIVE")
        order_burst(bus, 300)
        a.wait_for("ERROR_PASSIVE")
        a.wait_for("ERROR_ACTIVE")
        assert counted(taken(bus, 300)) == list(range(1, 301))
        now = a.wait(lambda now: now.sent == 300)
        assert (now.state, now.lost_out, now.rejected) == ("ERROR_ACTIVE", 0, 0)


@pytest.mark.slow
def test_a_node_that_is_bus_off_recovers(echo: Path) -> None:
    with (
        started(
            "bitrate=10000", "event=3000000000:hold_recessive", "event=4000000000:let_go"
        ) as channel,
        RavenchartBus(channel) as bus,
        node(echo, 0, channel) as a,
    ):
        a.wait_for("ERROR_ACTIVE")
        order_burst(bus, 300)
        assert a.wait_for("BUS_OFF").tec == 256
        now = a.wait(lambda now: now.sent + now.lost_out == 300)
        assert now.state == "ERROR_ACTIVE" and now.rejected == 0
        assert 1 <= now.lost_out < 300
        # it may be error-passive when the bus is let go, and return from that
        assert 1 <= now.off <= now.back <= now.passive
        found = counted(taken(bus, now.sent))
        assert found == sorted(found) and found[-1] == 300


HELD = ("bitrate=10000", "event=3000000000:hold_recessive", "event=4000000000:let_go")


@pytest.mark.slow
def test_a_node_that_recovers_on_request_is_bus_off_until_then(echo: Path) -> None:
    with (
        started(*HELD) as channel,
        RavenchartBus(channel) as bus,
        node(echo, 0, channel, CAN_ECHO_ON_REQUEST="300") as a,
    ):
        a.wait_for("ERROR_ACTIVE")
        order_burst(bus, 300)
        assert a.wait_for("BUS_OFF").off == 1
        fell = time.monotonic()
        a.wait(lambda now: now.back == 1)
        # and 128 times 11 bits of 100 us behind the request
        assert time.monotonic() - fell >= 0.3
        now = a.wait(lambda now: now.sent + now.lost_out == 300)
        assert now.state == "ERROR_ACTIVE" and now.off <= now.back <= now.passive


@pytest.mark.slow
@shows(
    "bus-off, with recovery on request only",
    found_by="the driver",
    reaction="the node stays bus-off until recovery is requested",
)
def test_a_node_that_nobody_asks_to_recover_stays_bus_off(echo: Path) -> None:
    with (
        started(*HELD) as channel,
        RavenchartBus(channel) as bus,
        node(echo, 0, channel, CAN_ECHO_ON_REQUEST="0") as a,
    ):
        a.wait_for("ERROR_ACTIVE")
        order_burst(bus, 300)
        a.wait_for("BUS_OFF")
        time.sleep(3)
        assert (a.now.state, a.now.off, a.now.back) == ("BUS_OFF", 1, 0)


@shows(
    "a full transmit queue",
    found_by="the driver",
    reaction="the youngest frames are rejected and counted; none is out of order",
)
def test_a_full_queue_rejects(echo: Path) -> None:
    with started("bitrate=125000") as channel, node(echo, 0, channel) as a:
        a.wait_for("ERROR_ACTIVE")
        with RavenchartBus(channel) as bus:
            order_burst(bus, 3 * DEPTH)
            now = a.wait(lambda now: now.sent + now.lost_out == 3 * DEPTH)
            assert DEPTH <= now.sent < 2 * DEPTH
            found = counted(taken(bus, now.sent))
        assert found[:DEPTH] == list(range(1, DEPTH + 1))
        assert found == sorted(found)


GARBAGE = {
    "nothing known": bytes([255]) * 88,
    "zeroes": bytes(88),
    "no welcome": encode(BusRecord(RecordKind.STATE)),
    "refused": encode(BusRecord(RecordKind.STATUS, code=Status.NO_ROOM)),
    "half a record, and then another": bytes(44) + encode(BusRecord(RecordKind.STATE)) + bytes(44),
}


@shows(
    "garbage in place of frames from the bus server",
    found_by="the driver `bus`",
    reaction="the connection is left and tried again",
)
@pytest.mark.parametrize("first", GARBAGE.values(), ids=GARBAGE.keys())
def test_a_server_that_says_garbage_is_left_and_tried_again(echo: Path, first: bytes) -> None:
    server = BusServer(first=first)
    with node(echo, 0, server.channel) as a:
        assert a.wait(lambda now: now.rejected >= 2).state == "STOPPED"
        server.first = b""
        a.wait_for("ERROR_ACTIVE")
    server.close()


@pytest.mark.slow
@pytest.mark.parametrize(
    "first", [b"", encode(BusRecord(RecordKind.STATE))[:44]], ids=["no", "half"]
)
def test_a_server_that_says_no_record_is_left_and_tried_again(echo: Path, first: bytes) -> None:
    server = BusServer(first=first)
    server.silent = True
    with node(echo, 0, server.channel) as a:
        deadline = time.monotonic() + 30
        while server.calls < 2:
            assert time.monotonic() < deadline, "it waits for the first welcome"
            time.sleep(0.1)
        server.silent, server.first = False, b""
        a.wait_for("ERROR_ACTIVE")
        time.sleep(3)  # longer than it waited for the welcome
        assert (a.standings[-1].state, server.calls) == ("ERROR_ACTIVE", 3)
    server.close()


def test_a_server_of_another_version_is_left_and_tried_again(echo: Path) -> None:
    server = BusServer(version=2)
    with node(echo, 0, server.channel) as a:
        assert a.wait(lambda now: now.rejected >= 2).state == "STOPPED"
    server.close()


@pytest.mark.parametrize(
    "bad",
    [
        BusRecord(RecordKind.CONFIRMATION, number=99),
        BusRecord(RecordKind.STATUS, code=Status.BUS_OFF, number=99),
        BusRecord(RecordKind.RECOVERY),
        BusRecord(RecordKind.FRAME, number=7),
    ],
)
def test_what_a_server_must_not_say_ends_the_connection(echo: Path, bad: BusRecord) -> None:
    server = BusServer()
    with node(echo, 0, server.channel) as a:
        a.wait_for("ERROR_ACTIVE")
        server.inject_bytes(encode(bad))
        a.wait(lambda now: now.rejected == 1)
        assert a.came(lambda: server.calls == 2, LIMIT), server.calls
        a.wait_for("ERROR_ACTIVE")
    server.close()


def test_what_a_classic_node_knows_nothing_of_is_passed_over(echo: Path) -> None:
    server = BusServer()
    with node(echo, 0, server.channel, CAN_ECHO_CLASSIC="1") as a:
        a.wait_for("ERROR_ACTIVE")
        server.inject_bytes(encode(BusRecord(RecordKind.FRAME, flags=int(Flag.FD), length=12)))
        server.inject_bytes(encode(BusRecord(RecordKind.ERROR_FRAME, identifier=8, flags=1)))
        server.inject(BusRecord(RecordKind.FRAME, identifier=1))
        now = a.wait(lambda now: now.received == 1)
        assert (now.state, now.rejected) == ("ERROR_ACTIVE", 0)
    server.close()


def test_what_the_environment_says_wrong_is_told(echo: Path) -> None:
    with started() as channel, node(echo, 0, channel, RAVENCHART_BUS_NAME="a b") as a:
        a.wait_for("ERROR_ACTIVE")
        assert any("RAVENCHART_BUS_NAME must have 1 to 16 characters" in line for line in a.said)
    with node(echo, 0, "127.0.0.1:70000") as a:
        a.wait(lambda _: a.said != [])
        assert a.said == ["error: can: RAVENCHART_BUS_PORT must be a port, 0 to 65535"]
