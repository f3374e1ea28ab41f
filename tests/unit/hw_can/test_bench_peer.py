# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The codec and the peer on the bus, against a small slcan server."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.bench.drives import Bench
from ravenchart.hw_can.bench.peer import BenchError, Codec, FrameValues, Peer
from ravenchart.hw_can.bench.quantities import PERIOD
from ravenchart.hw_can.bench.scenario import parse_scenario
from tests.support.bench_files import scenario_text
from tests.support.robot_files import dbc

pytestmark = pytest.mark.clock


@pytest.fixture
def codec(tmp_path: Path) -> Codec:
    path = tmp_path / "robot.dbc"
    path.write_text(dbc(["x"]))
    return Codec.from_file(path)


class Server:
    """A TCP server that keeps the lines it gets and sends those it is told."""

    def __init__(self) -> None:
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._socket.getsockname()[1]
        self.received = b""
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._accepted = threading.Event()
        self._thread.start()

    def _run(self) -> None:
        try:
            self._link, _ = self._socket.accept()
            self._accepted.set()
            while data := self._link.recv(4096):
                self.received += data
        except OSError:
            pass

    def send(self, data: bytes) -> None:
        assert self._accepted.wait(2)
        self._link.sendall(data)

    def hang_up(self) -> None:
        assert self._accepted.wait(2)
        self._link.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        with suppress(OSError):
            self._socket.shutdown(socket.SHUT_RDWR)
        self._socket.close()


@pytest.fixture
def server() -> Iterator[Server]:
    one = Server()
    yield one
    one.close()


def collect(peer: Peer, seconds: float) -> list[tuple[str, FrameValues]]:
    got: list[tuple[str, FrameValues]] = []
    peer.receive_until(time.monotonic() + seconds, lambda name, values: got.append((name, values)))
    return got


def test_a_frame_carries_the_offset_and_comes_back_as_the_same_values(codec: Codec) -> None:
    frame = codec.encode("x_set_point", {"mode": "Enabled", "speed": -400_000})
    assert (frame.arbitration_id, frame.data[0]) == (0x110, 1)
    assert codec.decode(frame) == ("x_set_point", {"mode": "Enabled", "speed": -400_000})


@pytest.mark.parametrize(
    ("name", "values", "reason"),
    [
        ("none", {}, "the DBC has no message none"),
        ("x_set_point", {"mode": "Enabled"}, "x_set_point cannot be sent"),
        ("x_set_point", {"mode": "Enabled", "speed": 400_001}, "x_set_point cannot be sent"),
        ("x_set_point", {"mode": "Asleep", "speed": 0}, "x_set_point cannot be sent"),
        ("x_set_point", {"mode": "Enabled", "speed": 0, "q": 1}, "x_set_point has no field q"),
    ],
)
def test_what_does_not_fit_is_refused(
    codec: Codec, name: str, values: dict[str, int | str], reason: str
) -> None:
    with pytest.raises(BenchError, match=reason):
        codec.encode(name, values)


def test_unknown_and_remote_frames_are_no_messages(codec: Codec) -> None:
    assert codec.decode(can.Message(arbitration_id=0x7FF, is_extended_id=False)) is None
    remote = can.Message(arbitration_id=0x110, is_extended_id=False, is_remote_frame=True)
    assert codec.decode(remote) is None


def test_short_frames_are_refused(codec: Codec) -> None:
    short = can.Message(arbitration_id=0x110, is_extended_id=False, data=b"\1")
    with pytest.raises(BenchError, match="x_set_point cannot be decoded"):
        codec.decode(short)


def test_a_file_that_is_no_database_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bad.dbc"
    path.write_text("BO_ nonsense")
    with pytest.raises(BenchError, match=r"bad.dbc cannot be read"):
        Codec.from_file(path)


def test_messages_cross_the_bus_both_ways_and_are_counted(codec: Codec, server: Server) -> None:
    peer = Peer.connect(server.port, codec)
    peer.send("x_set_point", {"mode": "Disabled", "speed": -400_000})
    server.send(b"t1108" + b"0100000000000000" + b"\r" + b"t7FF0\r" + b"\r\a")
    assert collect(peer, 0.5) == [("x_set_point", {"mode": "Enabled", "speed": -400_000})]
    peer.close()
    peer.close()
    assert (peer.sent["x_set_point"], peer.received["x_set_point"], peer.unknown) == (1, 1, 1)
    assert b"t1108" + b"00" * 8 + b"\r" in server.received


def test_a_dropped_peer_is_gone_at_once_and_without_a_word(codec: Codec, server: Server) -> None:
    peer = Peer.connect(server.port, codec)
    collect(peer, 0.05)
    before, began = server.received, time.monotonic()
    peer.drop()
    assert time.monotonic() - began < 0.5
    assert not peer.is_open
    assert collect(peer, 1.0) == []
    peer.close()
    assert server.received == before


def test_a_controller_that_hangs_up_is_noticed(codec: Codec, server: Server) -> None:
    peer = Peer.connect(server.port, codec)
    server.hang_up()
    with pytest.raises(BenchError, match="the controller left the bus"):
        collect(peer, 1.0)
    peer.close()


def test_a_malformed_line_is_an_error_in_words(codec: Codec, server: Server) -> None:
    peer = Peer.connect(server.port, codec)
    server.send(b"tXYZ0\r")
    with pytest.raises(BenchError, match="malformed slcan line"):
        collect(peer, 1.0)
    peer.close()


def test_nobody_listening_is_an_error_in_words(codec: Codec, server: Server) -> None:
    server.close()
    with pytest.raises(BenchError, match="no slcan server on port"):
        Peer.connect(server.port, codec)


def test_feedback_keeps_its_grid_and_does_not_drift(codec: Codec, server: Server) -> None:
    peer = Peer.connect(server.port, codec)
    bench = Bench(peer, parse_scenario(scenario_text("  - wait: 1 s\n")).drives)
    for _ in range(20):
        bench.tick()
    ticks = [t / PERIOD for t in bench.stations["x"].track.time]
    assert ticks == pytest.approx([round(t) for t in ticks])
    assert (len(ticks), round(ticks[-1])) == (20, 20 + bench.skipped)
    time.sleep(6 * PERIOD)
    bench.tick()
    assert bench.skipped >= 4
    assert peer.sent["x_feedback"] == 21
    peer.close()


def test_a_message_with_other_fields_is_no_drives(codec: Codec, server: Server) -> None:
    text = scenario_text("  - wait: 1 s\n").replace(
        "feedback: x_feedback", "feedback: robot_status"
    )
    peer = Peer.connect(server.port, codec)
    with pytest.raises(BenchError, match="robot_status has the fields"):
        Bench(peer, parse_scenario(text).drives)
    peer.close()
