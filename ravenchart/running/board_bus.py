"""The bench on the bus of an emulated board, in the time of the board.

Each millisecond of the board its gateway writes the frames of the bus to a pipe, and waits for
those of the bench on another one. The time of the board stands still meanwhile, so runs are the
same.
"""

from __future__ import annotations

import os
import select
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import can

from ravenchart.hw_can.bench.peer import BenchError, Codec, Peer, Record, unrecorded

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
    """One end of the bus of a board, which goes on as the bench does."""

    def __init__(
        self,
        ends: tuple[int, int],
        lives: Callable[[], bool],
        codec: Codec,
        record: Record = unrecorded,
    ) -> None:
        """At the two pipes of a board, from its first look on. BenchError where none comes.

        ``lives``: whether its emulator still runs.
        """
        self._board = BoardBus()
        super().__init__(self._board, codec, record=record)
        self._reading, self._writing = ends
        self._lives = lives
        self._looks = -1
        self._came: deque[can.Message] = deque()
        self._take()

    def clock(self) -> float:
        """The time of the board at its last look, in s."""
        return self._looks * LOOK

    def sleep(self, seconds: float) -> None:
        """Let the board go on."""
        self._go_on(self.clock() + seconds)

    def end(self) -> None:
        """Ask the controller to end, at the next look."""
        self._board.waiting += END

    def drop(self) -> None:
        """Neither send nor receive any more: the board goes on alone."""
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

    def _go_on(self, deadline: float) -> None:
        """Let the board go on to a time; what comes meanwhile nobody hears."""
        while self._is_before(deadline):
            self._look()
        self._came.clear()

    def _look(self) -> None:
        """Answer the last look, and wait for the next one."""
        try:
            os.write(self._writing, self._board.waiting + FEED)
        except OSError as fault:
            raise BenchError(f"the controller left the bus: {fault}") from None
        self._board.waiting = b""
        self._take()

    def _take(self) -> None:
        text = b""
        while not text.endswith(FEED):
            self._wait()
            part = os.read(self._reading, 65_536)
            if not part:
                raise BenchError("the controller left the bus")
            text += part
        self._looks += 1
        lines = text.removesuffix(FEED).split(b"\r")
        self._came.extend(frame_of(line, self.clock()) for line in lines if line)

    def _wait(self) -> None:
        """Until there is something to read: the end of the pipe, too."""
        began = time.monotonic()
        while not select.select([self._reading], [], [], 0.2)[0]:
            if not self._lives():
                raise BenchError("the emulator has ended")
            if time.monotonic() > began + PATIENCE:
                raise BenchError(f"the board said nothing for {PATIENCE:g} s")


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
