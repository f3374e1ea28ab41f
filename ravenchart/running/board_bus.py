# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bench on the bus of emulated boards, in the time of the boards.

Each millisecond of a board its gateway writes the frames of the bus to a pipe, and waits for
those of the bench and of other boards on another one. The time of the board stands still
meanwhile, so runs are the same.
"""

from __future__ import annotations

import os
import select
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

import can

from ravenchart.hw_can.bench.peer import BenchError, Codec, OnFrame, Peer, unrecorded

LOOK = 1e-3
"""From one look of the gateway to the next, in s."""

PATIENCE = 60.0
"""How long a look may take on this machine, in s."""

END = b"\x04"
"""EOT: the run ends."""

FEED = b"\n"
FROM_BOARD, TO_BOARD = "from_board", "to_board"


class BoardBus(can.BusABC):
    """The frames of the bench that wait for the next look."""

    def __init__(self) -> None:
        """A bus without frames."""
        super().__init__(channel=TO_BOARD)
        self.waiting = b""

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Let a classic frame be sent at the next look."""
        if msg.is_fd:
            raise BenchError("the gateway of a board has no CAN FD")
        self.waiting += line_of(msg)


class BoardLink:
    """The two pipes of a board; ``lives``: whether its emulator still runs."""

    def __init__(self, ends: tuple[int, int], lives: Callable[[], bool]) -> None:
        """Nothing waits for the board."""
        self._reading, self._writing = ends
        self._lives = lives
        self.waiting = b""
        """Lines of other boards, for the next answer."""
        self.is_open = True

    def answer(self, text: bytes) -> None:
        """Answer the last look: with what waits, and a text behind it."""
        try:
            os.write(self._writing, self.waiting + text + FEED)
        except OSError:
            self.is_open = False
        self.waiting = b""

    def take(self) -> list[bytes]:
        """The lines of the next look; none where the board has ended. BenchError."""
        text = b""
        while not text.endswith(FEED):
            self._wait()
            part = os.read(self._reading, 65_536)
            if not part:
                self.is_open = False
                return []
            text += part
        return [line for line in text.removesuffix(FEED).split(b"\r") if line]

    def _wait(self) -> None:
        """Until there is something to read: the end of the pipe, too."""
        began = time.monotonic()
        while not select.select([self._reading], [], [], 0.2)[0]:
            if not self._lives():
                raise BenchError("the emulator has ended")
            if time.monotonic() > began + PATIENCE:
                raise BenchError(f"the board said nothing for {PATIENCE:g} s")


def _urgency(frame: can.Message) -> tuple[int, bool, int]:
    """The lowest wins the arbitration."""
    extended = frame.is_extended_id
    base = frame.arbitration_id >> 18 if extended else frame.arbitration_id
    return base, extended, frame.arbitration_id


def line_of(frame: can.Message) -> bytes:
    """A classic frame as a line of slcan."""
    letter = ("tr" if not frame.is_extended_id else "TR")[int(frame.is_remote_frame)]
    digits = 8 if frame.is_extended_id else 3
    data = "" if frame.is_remote_frame else frame.data.hex().upper()
    return f"{letter}{frame.arbitration_id:0{digits}X}{frame.dlc}{data}\r".encode("ascii")


def frame_of(line: bytes, at: float) -> can.Message:
    """The frame of a line of slcan; BenchError where it is none."""
    try:
        text = line.decode("ascii")
        digits = {"t": 3, "r": 3, "T": 8, "R": 8}[text[0]]
        remote, length = text[0] in "rR", int(text[1 + digits])
        return can.Message(
            timestamp=at,
            arbitration_id=int(text[1 : 1 + digits], 16),
            is_extended_id=digits == 8,
            is_remote_frame=remote,
            dlc=length,
            data=None if remote else bytes.fromhex(text[2 + digits :]),
            check=True,
        )
    except (KeyError, IndexError, ValueError) as fault:
        raise BenchError(f"the board sent a malformed line: {fault}") from None


class BoardPeer(Peer):
    """One end of a bus with boards, which go on as the bench does."""

    def __init__(
        self, links: Sequence[BoardLink], codec: Codec, record: OnFrame = unrecorded
    ) -> None:
        """On the bus from the first look of all boards on. BenchError where one is missing."""
        self._board = BoardBus()
        super().__init__(self._board, codec, record=record)
        self._links = links
        self._looks = -1
        self._came: deque[can.Message] = deque()
        self._take()

    def clock(self) -> float:
        """The time of the boards at their last look, in s."""
        return self._looks * LOOK

    def sleep(self, seconds: float) -> None:
        """Let the boards go on; frames that come meanwhile are dropped."""
        deadline = self.clock() + seconds
        while self._is_before(deadline):
            self._look()
        self._came.clear()

    def end(self) -> None:
        """Ask the controllers to end, at the next look."""
        self._board.waiting += END

    def drop(self) -> None:
        """Neither send nor receive any more: the boards go on alone."""
        self._open = False
        self._board.waiting = b""

    def _stamp(self) -> float:
        return self.clock()

    def _next(self, deadline: float) -> can.Message | None:
        while not self._came and self._is_before(deadline):
            self._look()
        if not self._came:
            return None
        frame = self._came.popleft()
        self._record(frame)
        return frame

    def _is_before(self, deadline: float) -> bool:
        return self.clock() < deadline - LOOK / 2

    def _look(self) -> None:
        """Answer the last look, and wait for the next one."""
        for link in self._links:
            if link.is_open:
                link.answer(self._board.waiting)
        self._board.waiting = b""
        self._take()

    def _take(self) -> None:
        """Pass the frames of each board to all others: in the order of the board, urgent first."""
        said = {link: deque(link.take()) for link in self._links if link.is_open}
        if not any(link.is_open for link in self._links):
            raise BenchError("the controller left the bus")
        self._looks += 1
        heads = {link: frame_of(lines[0], self.clock()) for link, lines in said.items() if lines}
        while heads:
            sender = min(heads, key=lambda link: _urgency(heads[link]))
            self._came.append(heads.pop(sender))
            line = said[sender].popleft()
            for link in self._links:
                if link is not sender:
                    link.waiting += line + b"\r"
            if said[sender]:
                heads[sender] = frame_of(said[sender][0], self.clock())


@contextmanager
def pipes(folder: Path) -> Iterator[tuple[int, int]]:
    """The two pipes in a folder, for the time of a block: to be read and to be written."""
    paths = [folder / name for name in (FROM_BOARD, TO_BOARD)]
    for path in paths:
        path.unlink(missing_ok=True)
        os.mkfifo(path)
    reading = os.open(paths[0], os.O_RDONLY | os.O_NONBLOCK)
    writing = os.open(paths[1], os.O_RDWR)  # does not wait for a reader
    try:
        yield reading, writing
    finally:
        os.close(reading)
        os.close(writing)
        for path in paths:
            path.unlink(missing_ok=True)
