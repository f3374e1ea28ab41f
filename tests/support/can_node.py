"""A program with the CAN driver `bus`, as a process that says how it stands (can_echo.adb)."""

from __future__ import annotations

import os
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

JOINED = "can: joined the bus at 127.0.0.1:"
LIMIT = 20.0
"""Seconds within which something must have happened."""


@dataclass(frozen=True, slots=True)
class Standing:
    """State and counters of a node."""

    state: str = "STOPPED"
    sent: int = 0
    received: int = 0
    lost_out: int = 0
    lost_in: int = 0
    rejected: int = 0
    tec: int = 0
    rec: int = 0


class CanNode:
    """A node in a process; what it has said is kept."""

    def __init__(self, program: Path, number: int, channel: str, **environment: str) -> None:
        """Start it under its ``number`` at the bus server of ``channel``."""
        names = {"RAVENCHART_BUS_PORT": channel.rpartition(":")[2], **environment}
        self._process = subprocess.Popen(
            [program, str(number)],
            env={**os.environ, **names},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.standings = [Standing()]
        self.said: list[str] = []
        """Other lines of its output, and its errors."""
        for stream in (self._process.stdout, self._process.stderr):
            assert stream is not None
            threading.Thread(target=self._read, args=(stream,), daemon=True).start()

    @property
    def now(self) -> Standing:
        """How it stands, as it said last."""
        return self.standings[-1]

    def wait(self, condition: Callable[[Standing], bool]) -> Standing:
        """Wait until ``condition`` holds of how it stands."""
        end = time.monotonic() + LIMIT
        while not condition(now := self.now):
            assert self._process.poll() is None, f"it ended: {self.said}"
            assert time.monotonic() < end, f"{now} {self.said}"
            time.sleep(0.005)
        return now

    def wait_for(self, state: str) -> Standing:
        """Wait until it is in this state."""
        return self.wait(lambda now: now.state == state)

    def kill(self) -> None:
        """End it at once."""
        self._process.kill()
        self._process.wait()

    def _read(self, stream: IO[str]) -> None:
        for line in stream:
            state, _, counts = line.replace("= ", "=").strip().partition(" ")
            if "sent=" in counts:
                pairs = (pair.split("=") for pair in counts.split())
                self.standings.append(Standing(state, **{k: int(v) for k, v in pairs}))
            else:
                self.said.append(line.strip())


@contextmanager
def node(program: Path, number: int, channel: str, **environment: str) -> Iterator[CanNode]:
    """Such a node, which ends with the block."""
    one = CanNode(program, number, channel, **environment)
    try:
        yield one
    finally:
        one.kill()
