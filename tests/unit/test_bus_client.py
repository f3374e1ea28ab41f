"""The python-can backend, over a stand-in for the bus server."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import threading
import time
import tomllib
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can
import pytest

from hw_can.bench.bus_client import RavenchartBus
from hw_can.bench.bus_records import Flag, Kind, Record, Status, encode
from tests.support.bus_server import BusServer
from tests.support.can_frames import mixed_frames

ROOT = Path(__file__).parents[2]
WAIT = 10.0


@pytest.fixture
def server() -> Iterator[BusServer]:
    one = BusServer()
    yield one
    one.close()


@pytest.fixture
def pair(server: BusServer) -> Iterator[tuple[RavenchartBus, RavenchartBus]]:
    with RavenchartBus(server.channel, fd=True) as a, RavenchartBus(server.channel, fd=True) as b:
        yield a, b


def taken(bus: can.BusABC, count: int) -> list[can.Message]:
    """The next ``count`` frames, or fewer when none came for long."""
    found: list[can.Message] = []
    while len(found) < count and (message := bus.recv(WAIT)) is not None:
        found.append(message)
    return found


def same(sent: list[can.Message], received: list[can.Message], *, direction: bool = True) -> bool:
    return len(sent) == len(received) and all(
        a.equals(b, timestamp_delta=None, check_channel=False, check_direction=direction)
        for a, b in zip(sent, received, strict=True)
    )


def test_a_thousand_mixed_frames_are_exact_both_ways(
    pair: tuple[RavenchartBus, RavenchartBus],
) -> None:
    frames = mixed_frames(1_000)
    for sender, receiver in (pair, pair[::-1]):
        feeding = threading.Thread(target=lambda s=sender: [s.send(frame) for frame in frames])
        feeding.start()
        got = taken(receiver, len(frames))
        feeding.join()
        assert same(frames, got)
        assert [m.timestamp for m in got] == sorted(m.timestamp for m in got)
        assert abs(got[-1].timestamp - time.time()) < 60


def test_three_nodes_hear_each_other_and_not_themselves(server: BusServer) -> None:
    with (
        RavenchartBus(server.channel, receive_own_messages=True) as a,
        RavenchartBus(server.channel) as b,
        RavenchartBus(server.channel) as c,
    ):
        frame = can.Message(arbitration_id=5, data=b"x")
        a.send(frame, timeout=WAIT)
        others = [b.recv(WAIT), c.recv(WAIT)]
        own = a.recv(WAIT)
        assert own is not None and not own.is_rx and own.data == b"x"
        for other in others:
            assert other is not None and other.is_rx and other.timestamp == own.timestamp
        b.send(frame, timeout=WAIT)
        assert b.recv(0.05) is None
        assert len({bus.channel_info for bus in (a, b, c)}) == 3


def test_an_fd_frame_needs_an_fd_bus_and_spares_the_classic_node(server: BusServer) -> None:
    frame = can.Message(arbitration_id=1, is_fd=True, data=bytes(64))
    with RavenchartBus(server.channel, fd=True) as a, RavenchartBus(server.channel) as b:
        assert (a.protocol, b.protocol) == (can.CanProtocol.CAN_FD, can.CanProtocol.CAN_20)
        a.send(frame, timeout=WAIT)
        assert b.recv(0.05) is None
        with pytest.raises(can.CanOperationError, match="not opened for FD"):
            b.send(frame)


def test_the_notifier_and_periodic_sending(pair: tuple[RavenchartBus, RavenchartBus]) -> None:
    a, b = pair
    reader = can.BufferedReader()
    notifier = can.Notifier(b, [reader], timeout=0.1)
    task = a.send_periodic(can.Message(arbitration_id=0x55, data=b"p"), 0.01)
    got = [reader.get_message(WAIT) for _ in range(10)]
    task.stop()
    b.send(can.Message(arbitration_id=7), timeout=WAIT)
    notifier.stop()
    assert all(message is not None and message.arbitration_id == 0x55 for message in got)


def test_filters_are_for_frames_and_not_for_errors(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus]
) -> None:
    a, b = pair
    b.set_filters([{"can_id": 0x100, "can_mask": 0x700, "extended": False}])
    for identifier, extended in ((0x0FF, False), (0x123, False), (0x100, True), (0x200, False)):
        a.send(can.Message(arbitration_id=identifier, is_extended_id=extended), timeout=WAIT)
    server.inject(
        Record(Kind.ERROR_FRAME, Flag.EXTENDED, 8, identifier=8, data=b"\1".ljust(64, b"\0"))
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
    server.inject(Record(Kind.STATE, code=1, transmit_errors=130, receive_errors=3))
    assert becomes(can.BusState.PASSIVE)
    assert bus.error_counters == (130, 3)
    server.inject(Record(Kind.STATE, code=2, transmit_errors=256))
    assert becomes(can.BusState.ERROR)
    bus.state = can.BusState.ACTIVE
    assert becomes(can.BusState.ACTIVE)
    with pytest.raises(NotImplementedError):
        bus.state = can.BusState.PASSIVE


def within(look: Callable[[], object]) -> bool:
    """Whether ``look()`` becomes true in time."""
    end = time.monotonic() + WAIT
    while time.monotonic() < end:
        if look():
            return True
        time.sleep(0.01)
    return False


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


def test_a_waiting_sender_and_a_receiver_in_another_thread(
    pair: tuple[RavenchartBus, RavenchartBus],
) -> None:
    a, b = pair
    got: list[can.Message] = []
    receiving = threading.Thread(target=lambda: got.extend(taken(a, 100)))
    receiving.start()
    for number in range(100):
        b.send(can.Message(arbitration_id=number))
        a.send(can.Message(arbitration_id=number), timeout=WAIT)
    receiving.join()
    assert [m.arbitration_id for m in got] == list(range(100))


def test_a_log_in_blf_is_played_back_exactly(
    server: BusServer, pair: tuple[RavenchartBus, RavenchartBus], tmp_path: Path
) -> None:
    a, b = pair
    frames = mixed_frames(200, seed=3)
    path = tmp_path / "bus.blf"
    with can.Logger(path) as logger:
        for frame in frames:
            a.send(frame)
        logged = taken(b, len(frames))
        for message in logged:
            logger(message)
    with can.LogReader(path) as reader:
        read = list(reader)
    assert same(logged, read)
    for message in can.MessageSync(read, timestamps=False):
        b.send(message)
    assert same(frames, taken(a, len(frames)))


def tool_environment(folder: Path) -> dict[str, str]:
    """Where python-can finds the entry points of pyproject.toml, installed or not."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    (target,) = project["entry-points"]["can.interface"].items()
    info = folder / "backend-1.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: backend\nVersion: 1\n")
    (info / "entry_points.txt").write_text("[can.interface]\n{} = {}\n".format(*target))
    return {**os.environ, "PYTHONPATH": f"{folder}{os.pathsep}{ROOT}"}


def heed_interrupts() -> None:
    """What runs in the background may have inherited that they are ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@contextmanager
def ended(process: subprocess.Popen[bytes]) -> Iterator[None]:
    """Whatever happens, the process does not go on."""
    try:
        yield
    finally:
        process.kill()


def test_the_tools_of_python_can_log_and_play(server: BusServer, tmp_path: Path) -> None:
    environment, log = tool_environment(tmp_path), tmp_path / "tool.blf"
    common = ["-i", "ravenchart", "-c", server.channel, "--fd"]
    frames = mixed_frames(40, seed=4, errors=False)
    with (
        RavenchartBus(server.channel, fd=True) as bus,
        subprocess.Popen(
            [sys.executable, "-m", "can.logger", *common, "-f", str(log)],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            preexec_fn=heed_interrupts,
        ) as logger,
        ended(logger),
    ):
        assert within(lambda: len(server.clients) == 2)
        for frame in frames:
            bus.send(frame, timeout=WAIT)
        time.sleep(0.5)
        logger.send_signal(signal.SIGINT)
        logger.communicate(timeout=30)
        with can.LogReader(log) as reader:
            assert same(frames, list(reader))
        played = subprocess.run(
            [sys.executable, "-m", "can.player", *common, "--ignore-timestamps", str(log)],
            env=environment, capture_output=True, timeout=60,
        )  # fmt: skip
        assert played.returncode == 0, played.stderr
        assert same(frames, taken(bus, len(frames)))


KILLED = """
import can, sys
from hw_can.bench.bus_client import RavenchartBus
bus = RavenchartBus(sys.argv[1])
while True:
    bus.send(can.Message(arbitration_id=9, data=bytes(8)))
"""


def test_a_client_killed_in_the_middle_leaves_the_others_alone(server: BusServer) -> None:
    with RavenchartBus(server.channel) as a, RavenchartBus(server.channel) as b:
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        with subprocess.Popen([sys.executable, "-c", KILLED, server.channel], env=environment) as p:
            assert a.recv(30) is not None
            p.kill()
        assert within(lambda: len(server.clients) == 2)
        a.send(can.Message(arbitration_id=1), timeout=WAIT)
        assert any(m.arbitration_id == 1 for m in iter(lambda: b.recv(WAIT), None))


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
        (encode(Record(Kind.RECOVERY)), "bus protocol: a recovery came"),
        (encode(Record(Kind.CONFIRMATION, number=7)), "bus protocol: no request 7 is open"),
        (encode(Record(Kind.STATUS, code=Status.CLOSING)), "the bus server ends: closing"),
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
        ({"first": encode(Record(Kind.STATE))}, "STATE is no welcome"),
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
    ):
        with pytest.raises(ValueError, match="bus protocol"):
            RavenchartBus(channel, **settings)
