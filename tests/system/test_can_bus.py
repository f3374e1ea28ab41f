# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bus server: several processes on one simulated bus, with faults on demand."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import can
import pytest

from ravenchart.command_line import main
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.hw_can.bench.bus_records import (
    MARK,
    RECORD_BYTES,
    BusRecord,
    RecordKind,
    Status,
    encode,
)
from tests.support.can_bus import Start, started, starter
from tests.support.can_frames import WAIT, taken
from tests.support.raw_client import RawClient

pytestmark = pytest.mark.clock

ROOT = Path(__file__).parents[2]


@pytest.fixture
def start() -> Iterator[Start]:
    with starter() as one:
        yield one


def test_the_loopback_suite_passes_on_it(
    start: Start, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    junit, page = tmp_path / "loopback.xml", tmp_path / "loopback.html"
    status = main(
        ["loopback", "--interface", "ravenchart", "--channel", start(), "--fd",
         "--junit", str(junit), "--html", str(page)]
    )  # fmt: skip
    printed = capsys.readouterr().out
    assert status == 0, printed
    assert "PASS: 20 passed, 0 failed, 0 skipped" in printed
    assert max(map(len, printed.splitlines())) <= 80
    suite = ElementTree.parse(junit).getroot().find("testsuite")
    assert suite is not None
    assert (suite.get("tests"), suite.get("failures"), suite.get("skipped")) == ("20", "0", "0")
    html = page.read_text()
    assert "<strong>PASS</strong>" in html and "Latency" in html
    assert not any(word in html for word in ("http:", "https:", "src=", "<link"))


def test_an_echo_that_nobody_acknowledges_is_said_at_once(
    start: Start, capsys: pytest.CaptureFixture[str]
) -> None:
    channel, began = start(), time.monotonic()
    assert main(["loopback", "--interface", "ravenchart", "--channel", channel, "--echo"]) == 1
    assert time.monotonic() - began < 1.9, "it waits no 2 s for a frame that cannot come"
    said = " ".join(capsys.readouterr().out.split())
    assert "no other node acknowledges a frame: connect one, or check the cable" in said


def test_bus_time_is_that_of_the_bits(start: Start) -> None:
    """500 frames of 111 bits and stuff bits, at 500 kbit/s, back to back."""
    channel = start("time=virtual")
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
        for number in range(500):
            a.send(can.Message(arbitration_id=number, data=bytes(8), is_extended_id=False))
        times = [message.timestamp for message in taken(b, 500)]
    spent = [round(1e9 * (late - early)) for early, late in pairwise(times)]
    assert all(111 * 2_000 <= one <= 135 * 2_000 and one % 2_000 == 0 for one in spent)


def test_alone_a_node_becomes_passive_and_is_heard_once_it_is_not(start: Start) -> None:
    channel = start()
    with RavenchartBus(channel) as a:
        with pytest.raises(can.CanTimeoutError):
            a.send(can.Message(arbitration_id=1), timeout=0.2)
        assert a.state is can.BusState.PASSIVE
        assert a.error_counters == (128, 0)
        with RavenchartBus(channel) as b:
            message = b.recv(WAIT)
            assert message is not None and message.arbitration_id == 1


def test_a_bus_held_recessive_drives_the_sender_off_and_it_comes_back(start: Start) -> None:
    channel = start("time=virtual", "event=0:hold_recessive", "event=2500000:let_go")
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
        with pytest.raises(can.CanOperationError, match="bus off"):
            a.send(can.Message(arbitration_id=1), timeout=WAIT)
        with pytest.raises(can.CanOperationError, match="bus off"):
            a.send(can.Message(arbitration_id=2), timeout=WAIT)
        assert a.state is can.BusState.ERROR
        assert b.state is can.BusState.ACTIVE
        a.state = can.BusState.ACTIVE
        becomes_active(a)
        a.send(can.Message(arbitration_id=3), timeout=WAIT)
        message = b.recv(WAIT)
        assert message is not None and message.arbitration_id == 3


BIT = 2e-6
"""Seconds, at the default bit rate."""


@pytest.mark.parametrize(("words", "own"), [((), 100), (("restart_ms=100",), 0)])
def test_a_node_with_a_restart_delay_comes_back_by_itself(
    start: Start, words: tuple[str, ...], own: int
) -> None:
    """Not before the delay and 128 times 11 recessive bits have passed."""
    channel = start("time=virtual", "event=0:hold_recessive", "event=2500000:let_go", *words)
    with RavenchartBus(channel, restart_ms=own) as a, RavenchartBus(channel) as b:
        with pytest.raises(can.CanOperationError, match="bus off"):
            a.send(can.Message(arbitration_id=1), timeout=WAIT)
        becomes_active(a)
        a.send(can.Message(arbitration_id=2), timeout=WAIT)
        message = b.recv(WAIT)
        assert message is not None and message.arbitration_id == 2
        assert 0.1 + 1408 * BIT < message.timestamp < 0.1 + 0.0025 + 1600 * BIT


def test_recovery_counts_from_its_request_and_not_from_an_idle_bus_before(start: Start) -> None:
    """Bus time goes by the clock here: the bus is idle for longer than a recovery takes."""
    channel = start("event=0:hold_recessive", "event=300000000:let_go")
    with RavenchartBus(channel, fd=True) as a, RavenchartBus(channel) as b:
        with pytest.raises(can.CanOperationError, match="bus off"):
            a.send(can.Message(arbitration_id=1), timeout=WAIT)
        time.sleep(0.4)
        asked = time.time()
        a.state = can.BusState.ACTIVE
        becomes_active(a)
        a.send(can.Message(arbitration_id=2), timeout=WAIT)
        message = b.recv(WAIT)
        assert message is not None and message.timestamp >= asked + 1408 * BIT


def becomes_active(bus: RavenchartBus) -> None:
    """Wait until the node is error-active."""
    end = time.monotonic() + WAIT
    while bus.state is not can.BusState.ACTIVE:
        assert time.monotonic() < end
        time.sleep(0.001)


def test_a_bus_that_is_cut_and_mended(start: Start) -> None:
    channel = start("time=virtual", "event=0:cut:2", "event=1000000000:mend")
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
        a.send(can.Message(arbitration_id=1), timeout=WAIT)
        end = time.monotonic() + WAIT
        while a.error_counters != (127, 0) and time.monotonic() < end:
            time.sleep(0.01)  # the state follows the confirmation
        assert a.error_counters == (127, 0)
        message = b.recv(WAIT)
        assert message is not None and 1.0 <= message.timestamp < 1.001


def test_faults_of_a_list_come_with_the_frames_they_name(start: Start) -> None:
    channel = start(
        "time=virtual",
        "fault=1:dropped:2",
        "fault=2:duplicated:2",
        "fault=3:corrupted:2:0:255",
        "fault=4:delayed:2:5000000",
        "fault=5:disturbed_bit:0:30",
        "fault=7:lost_acknowledgement",
    )
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
        for number in range(6):
            a.send(can.Message(arbitration_id=number, data=b"\1"), timeout=WAIT)
        got = taken(b, 8)
    plain = [m for m in got if not m.is_error_frame]
    assert [(m.arbitration_id, m.data[0]) for m in plain] == [
        (1, 1), (1, 1), (2, 254), (3, 1), (4, 1), (5, 1),
    ]  # fmt: skip
    assert plain[3].timestamp - plain[2].timestamp >= 5e-3
    assert [m.arbitration_id for m in got if m.is_error_frame] == [8, 0x20]


def test_the_end_of_a_frame_is_disturbed_on_demand(start: Start) -> None:
    """Node 2 loses frame 1 and node 3 has it twice; overload frames follow frames 3 and 4."""
    channel = start(
        "time=virtual", "fault=1:disturbed_end:2:6", "fault=3:disturbed_end:2:7",
        "fault=4:overload:2:2",
    )  # fmt: skip
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b, RavenchartBus(channel) as c:
        for _ in range(4):
            a.send(can.Message(arbitration_id=0x155, is_extended_id=False), timeout=WAIT)
        at_b, at_c = taken(b, 5), taken(c, 5)
    assert [m.is_error_frame for m in at_b] == [True, False, False, False, False]
    assert not any(m.is_error_frame for m in at_c)
    spent = [round((late.timestamp - early.timestamp) / BIT) for early, late in pairwise(at_c[1:])]
    assert [bits - spent[0] for bits in spent] == [0, 15, 30]


def test_a_fault_that_cannot_be_placed_is_refused(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["bus", "--port", "0", "--fault", "1:disturbed_end:2:10"]) == 2
    assert "the bus does not accept fault=1:disturbed_end:2:10" in capfd.readouterr().err


def test_chance_is_the_same_again(start: Start) -> None:
    runs = []
    for _ in range(2):
        channel = start("time=virtual", "seed=7:2000000")
        with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
            for number in range(100):
                a.send(can.Message(arbitration_id=number, data=bytes(8)), timeout=WAIT)
            runs.append([(m.timestamp, m.arbitration_id, m.is_error_frame) for m in taken(b, 100)])
    assert runs[0] == runs[1]
    assert any(is_error for _, _, is_error in runs[0])


SENDER = """
import can, sys
from hw_can.bench.bus_client import RavenchartBus
from tests.support.can_frames import WAIT, taken
with RavenchartBus(sys.argv[1], fd=True) as bus:
    for number in range(100):
        frame = can.Message(arbitration_id=int(sys.argv[2]), data=bytes([number]))
        bus.send(frame, timeout=60)
"""


def test_three_processes_share_one_bus(start: Start) -> None:
    channel = start()
    with RavenchartBus(channel) as listener:
        senders = [
            subprocess.Popen([sys.executable, "-c", SENDER, channel, str(number)], cwd=ROOT)
            for number in range(3)
        ]
        got = [message for _ in range(300) if (message := listener.recv(60)) is not None]
        assert [sender.wait(60) for sender in senders] == [0, 0, 0]
    for number in range(3):
        assert [m.data[0] for m in got if m.arbitration_id == number] == list(range(100))
    assert [m.timestamp for m in got] == sorted(m.timestamp for m in got)


def test_a_malformed_record_ends_the_connection_and_disturbs_nobody(start: Start) -> None:
    channel = start()
    good = encode(BusRecord(RecordKind.FRAME, identifier=1, number=1))
    for wrong in (bytes(RECORD_BYTES), b"GET / HTTP/1.1\r\n".ljust(RECORD_BYTES), good[:-1] + b"x"):
        with RawClient(channel) as raw:
            raw.greet()
            raw.send(wrong)
            assert raw.last() == BusRecord(RecordKind.STATUS, code=Status.MALFORMED_RECORD)
    with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
        a.send(can.Message(arbitration_id=1), timeout=WAIT)
        assert b.recv(WAIT) is not None


def test_who_may_not_join_is_told_why(start: Start) -> None:
    channel = start("data_bitrate=0")
    with RawClient(channel) as raw:
        name = b"x".ljust(64, b"\0")
        raw.send(encode(BusRecord(RecordKind.HELLO, length=1, code=2, identifier=MARK, data=name)))
        assert raw.last() == BusRecord(RecordKind.STATUS, code=Status.WRONG_VERSION)
    with pytest.raises(can.CanInitializationError, match="the bus carries no FD frames"):
        RavenchartBus(channel, fd=True)
    with pytest.raises(can.CanInitializationError, match="wrong bit rate"):
        RavenchartBus(channel, bitrate=250_000)
    nodes = [RavenchartBus(channel) for _ in range(15)]
    with pytest.raises(can.CanInitializationError, match="no room"):
        RavenchartBus(channel)
    for node in nodes:
        node.shutdown()


def test_who_says_no_hello_is_told_so_and_holds_up_nobody(start: Start) -> None:
    """Silent clients take every place, one with half a hello; two seconds later all are free."""
    channel = start()
    with ExitStack() as stack:
        silent = [stack.enter_context(RawClient(channel)) for _ in range(13)]
        silent[0].send(b"\1" * 40)
        began = time.monotonic()
        with RavenchartBus(channel) as a, RavenchartBus(channel) as b:
            a.send(can.Message(arbitration_id=1), timeout=1)
            assert b.recv(1) is not None
        assert time.monotonic() - began < 1
        for one in silent:
            assert one.last() == BusRecord(RecordKind.STATUS, code=Status.NO_HELLO_IN_TIME)
        assert 1.5 < time.monotonic() - began < 4
        nodes = [stack.enter_context(RavenchartBus(channel)) for _ in range(15)]
        nodes[0].send(can.Message(arbitration_id=2), timeout=1)


def test_the_end_of_the_server_is_told() -> None:
    with started() as channel:
        bus = RavenchartBus(channel)
    with pytest.raises(can.CanOperationError, match="the bus server ends: closing"):
        bus.recv(WAIT)
    bus.shutdown()


def test_a_client_that_never_reads_is_given_up(start: Start) -> None:
    channel = start("time=virtual")
    with RawClient(channel, room=4096) as lazy, RavenchartBus(channel) as bus:
        lazy.greet()
        sent = 0
        with pytest.raises(can.CanTimeoutError):  # nobody is left to acknowledge
            while sent < 30_000:
                for _ in range(999):
                    bus.send(can.Message(arbitration_id=1))
                bus.send(can.Message(arbitration_id=2), timeout=2)
                sent += 1_000
        # the server keeps 4,096 records for it; what the kernel had room for has come
        assert sent >= 4_000
        assert 1 <= lazy.read_to_end() < 25_000


@pytest.mark.parametrize(
    "arguments",
    [
        ["--bitrate", "300000"],
        ["--port", "70000"],
        ["--name", "a b"],
        ["--fault", "1:nothing"],
        ["--event", "x:mend"],
        ["--restart-ms", "600001"],
        ["--sample-point", "101"],
        ["--disturb", "1"],
    ],
)
def test_what_the_bus_cannot_be_told_is_refused(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["bus", *arguments])
    assert ended.value.code == 2
    assert f"argument {arguments[0]}: " in capsys.readouterr().err


def test_a_port_that_is_taken_is_said(start: Start, capfd: pytest.CaptureFixture[str]) -> None:
    port = start().rpartition(":")[2]
    assert main(["bus", "--port", port]) == 2
    assert f"port {port} of this machine is not free" in capfd.readouterr().err
