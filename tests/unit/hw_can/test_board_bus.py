# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bench in the time of an emulated board, with a board of the test behind the pipes."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.bench.peer import BenchError, Codec
from ravenchart.paths import ROOT
from ravenchart.running import board_bus
from ravenchart.running.board_bus import BoardLink, BoardPeer, frame_of, line_of

DBC = ROOT / "examples" / "cartesian_robot" / "generated" / "robot_bus.dbc"
SET_POINT = b"t11030080FF\r"
"""x_set_point with three bytes."""


class Board:
    """Writes ``said`` look by look and keeps each answer, until EOT or the end of either."""

    def __init__(self, folder: Path, said: list[bytes]) -> None:
        self.heard: list[bytes] = []
        self.alive = True
        self._said = said
        self._folder = folder
        self.thread = threading.Thread(target=self._run, daemon=True)

    def _run(self) -> None:
        with (
            open(self._folder / board_bus.FROM_BOARD, "wb", buffering=0) as out,
            open(self._folder / board_bus.TO_BOARD, "rb", buffering=0) as into,
        ):
            for text in self._said:
                out.write(text + b"\n")
                answer = b""
                while not answer.endswith(b"\n"):
                    part = into.read(64)
                    if not part:
                        return
                    answer += part
                self.heard.append(answer.removesuffix(b"\n"))
                if b"\x04" in answer:
                    break
        self.alive = False


@pytest.fixture
def started(tmp_path: Path) -> Iterator[Callable[[list[bytes]], tuple[Board, BoardPeer]]]:
    with board_bus.pipes(tmp_path) as ends:

        def start(said: list[bytes]) -> tuple[Board, BoardPeer]:
            board = Board(tmp_path, said)
            board.thread.start()
            return board, BoardPeer([BoardLink(ends, lambda: board.alive)], Codec.from_file(DBC))

        yield start
    assert not (tmp_path / board_bus.TO_BOARD).exists()


Start = Callable[[list[bytes]], tuple[Board, BoardPeer]]


@pytest.mark.parametrize(
    ("line", "frame"),
    [
        (b"t0800", can.Message(arbitration_id=0x80, is_extended_id=False)),
        (b"t12320A0b", can.Message(arbitration_id=0x123, is_extended_id=False, data=b"\x0a\x0b")),
        (b"T1ABCDEF01FF", can.Message(arbitration_id=0x1ABCDEF0, data=b"\xff")),
        (b"r7FF4", can.Message(arbitration_id=0x7FF, is_extended_id=False, dlc=4,
                               is_remote_frame=True)),
        (b"R000000018", can.Message(arbitration_id=1, dlc=8, is_remote_frame=True)),
    ],
)  # fmt: skip
def test_frames_are_lines_of_slcan(line: bytes, frame: can.Message) -> None:
    assert frame_of(line, 1.5).equals(frame, timestamp_delta=None)
    assert frame_of(line, 1.5).timestamp == 1.5
    assert line_of(frame).lower() == line.lower() + b"\r"


@pytest.mark.parametrize(
    "line", [b"x", b"", b"t12", b"t1239", b"t1232FF", b"t800", b"t\xff", b"tF"]
)
def test_other_lines_are_refused(line: bytes) -> None:
    with pytest.raises(BenchError, match="malformed line"):
        frame_of(line, 0.0)


def test_time_goes_on_by_looks_alone(started: Start) -> None:
    board, peer = started([b""] * 11)
    assert peer.clock() == 0.0
    peer.receive_until(0.005, lambda name, values: None)
    assert peer.clock() == pytest.approx(0.005)
    peer.sleep(0.003)
    assert peer.clock() == pytest.approx(0.008)
    assert board.heard == [b""] * 8


def test_nobody_hears_what_comes_while_the_bench_sleeps(started: Start) -> None:
    _, peer = started([b"", SET_POINT, b"", b"", b""])
    peer.sleep(0.002)
    peer.receive_until(0.003, lambda name, values: None)
    assert peer.received == {}


def test_frames_arrive_at_their_look_and_leave_at_the_next_one(started: Start) -> None:
    board, peer = started([b"", b"", SET_POINT, b"", b"", b""])
    came: list[tuple[str, float]] = []
    peer.receive_until(0.003, lambda name, values: came.append((name, peer.clock())))
    ((name, at),) = came
    assert name == "x_set_point" and abs(at - 0.002) < 1e-9
    peer.send("robot_command", {"kind": "Home", "x": 0, "y": 0, "z": 0})
    peer.receive_until(0.004, lambda name, values: None)
    assert board.heard[:3] == [b"", b"", b""]
    assert board.heard[3].startswith(b"t080")
    assert peer.sent == {"robot_command": 1} and peer.received == {"x_set_point": 1}


def test_a_bench_that_is_dropped_hears_and_says_nothing_while_the_board_goes_on(
    started: Start,
) -> None:
    board, peer = started([SET_POINT] * 9)
    peer.send("robot_command", {"kind": "Home", "x": 0, "y": 0, "z": 0})
    peer.drop()
    peer.sleep(0.004)
    assert peer.clock() == pytest.approx(0.004)
    assert board.heard == [b""] * 4
    assert peer.received == {}


def test_the_end_of_the_board_ends_the_bench(started: Start) -> None:
    board, peer = started([b""] * 9)
    peer.end()
    with pytest.raises(BenchError, match="the controller left the bus"):
        peer.sleep(1.0)
    assert board.heard == [b"\x04"]


def test_an_emulator_that_does_not_start_is_noticed(tmp_path: Path) -> None:
    ended = pytest.raises(BenchError, match="the emulator has ended")
    with board_bus.pipes(tmp_path) as ends, ended:
        BoardPeer([BoardLink(ends, lambda: False)], Codec.from_file(DBC))


def test_a_flexible_frame_is_refused() -> None:
    frame = can.Message(arbitration_id=1, is_fd=True)
    with pytest.raises(BenchError, match="has no CAN FD"):
        board_bus.BoardBus().send(frame)


def test_a_log_has_the_time_of_the_board(started: Start, tmp_path: Path) -> None:
    kept: list[can.Message] = []
    _, peer = started([b"", SET_POINT, b"", b""])
    peer._record = kept.append
    peer.sleep(0.001)
    peer.send("robot_command", {"kind": "Home", "x": 0, "y": 0, "z": 0})
    (frame,) = kept
    assert abs(frame.timestamp - 0.001) < 1e-9 and not frame.is_rx


def test_boards_hear_each_other_a_look_later_each_in_order_and_urgent_frames_first(
    tmp_path: Path,
) -> None:
    homes = [tmp_path / name for name in ("left", "right")]
    said = ([b"", b"t2000\rt1000\r", b"", b""], [b"", b"t1500\r", b"", b"", b"t7000\r", b""])
    heard: list[str] = []
    with ExitStack() as stack:
        boards, links = [], []
        for home, texts in zip(homes, said, strict=True):
            home.mkdir()
            ends = stack.enter_context(board_bus.pipes(home))
            boards.append(Board(home, texts))
            links.append(BoardLink(ends, lambda: True))
            boards[-1].thread.start()
        peer = BoardPeer(links, Codec.from_file(DBC), lambda f: heard.append(f"{f}"[33:43].strip()))
        peer.receive_until(0.003, lambda name, values: None)
        assert [name.lstrip("0") for name in heard] == ["150", "200", "100"]
        assert boards[0].heard[1] == b"t1500\r" and boards[1].heard[1] == b"t2000\rt1000\r"
        peer.sleep(0.002)  # the left one ends
        assert [link.is_open for link in links] == [False, True]
        with pytest.raises(BenchError, match="the controller left the bus"):
            peer.sleep(0.005)
    assert boards[1].heard[1:] == [b"t2000\rt1000\r", b"", b"", b"", b""]
