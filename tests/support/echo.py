# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A program with a driver of the CAN HAL that echoes (tests/ada/can_echo.adb), as a process."""

from __future__ import annotations

import os
import subprocess
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO


@dataclass(frozen=True, slots=True)
class Standing:
    """State and counters of its controller, as the HAL names them."""

    state: str = "STOPPED"
    sent: int = 0
    received: int = 0
    lost_out: int = 0
    lost_in: int = 0
    rejected: int = 0
    tec: int = 0
    rec: int = 0
    passive: int = 0
    off: int = 0
    back: int = 0


class Echo:
    """Sends back, with the next identifier, what has an identifier divisible by four.

    The standard frame ORDER asks for as many frames BURST as its first two bytes say.
    """

    ORDER = 0x7F0
    BURST = 0x102

    def __init__(self, program: Path, environment: dict[str, str], number: int = 0) -> None:
        """Start it under its ``number``; ``environment`` tells the driver where its bus is."""
        self._process = subprocess.Popen(
            [program, str(number)],
            env={**os.environ, **environment},
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.standings = [Standing()]
        """How it stood, each time it said so."""
        self.said: list[str] = []
        """Other lines of its output, and its errors."""
        for stream in (self._process.stdout, self._process.stderr):
            assert stream is not None
            threading.Thread(target=self._read, args=(stream,), daemon=True).start()

    @property
    def now(self) -> Standing:
        """How it stands, as it said last."""
        return self.standings[-1]

    @property
    def is_running(self) -> bool:
        """Whether its process has not ended."""
        return self._process.poll() is None

    def came(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Wait until ``condition`` holds, not longer than ``seconds``; whether it does."""
        end = time.monotonic() + seconds
        while not (held := condition()) and time.monotonic() < end:
            if not self.is_running:
                return False
            time.sleep(0.005)
        return held

    def close(self) -> None:
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
