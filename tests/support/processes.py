# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The processes of a run of the command line, found by a mark in their environment."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import IO
from uuid import uuid4

ROOT = Path(__file__).resolve().parents[2]
LAUNCHER = ROOT / ".venv" / "bin" / "ravenchart"
PYTHON = sys.executable
Stream = IO[str] | int


def _heeding_hang_up() -> None:
    """A test that is itself run by nohup lets its programs be ended by HUP all the same."""
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


class Marked:
    """A started command; whatever it starts inherits its mark."""

    def __init__(
        self,
        words: Sequence[str | Path],
        where: Path = ROOT,
        *,
        given: Stream = subprocess.DEVNULL,
        printed: Stream = subprocess.PIPE,
        errors: Stream = subprocess.PIPE,
        names: Mapping[str, str] | None = None,
    ) -> None:
        """``names`` are more of its environment."""
        self._mark = f"MARK_OF_A_TEST={uuid4()}"
        name, _, value = self._mark.partition("=")
        self.process = subprocess.Popen(
            words, cwd=where, env={**os.environ, **(names or {}), name: value}, text=True,
            stdin=given, stdout=printed, stderr=errors,
            start_new_session=True, preexec_fn=_heeding_hang_up,
        )  # fmt: skip

    def alive(self) -> dict[int, str]:
        """Number and program of every process with the mark, zombies apart."""
        found = {}
        for folder in Path("/proc").iterdir():
            with suppress(OSError):
                if not folder.name.isdigit():
                    continue
                if self._mark.encode() in (folder / "environ").read_bytes().split(b"\0"):
                    found[int(folder.name)] = (folder / "comm").read_text().strip()
        return found

    def runs(self, programs: set[str], seconds: float) -> bool:
        """Wait until each of these programs runs; whether they do."""
        return self._comes(lambda: programs <= set(self.alive().values()), seconds)

    def gone(self, seconds: float) -> bool:
        """Wait until nothing with the mark is left; whether it is so."""
        return self._comes(lambda: not self.alive(), seconds)

    def kill(self) -> None:
        """End all that is left."""
        for number in self.alive():
            with suppress(OSError):
                os.kill(number, 9)

    @staticmethod
    def _comes(condition: object, seconds: float) -> bool:
        assert callable(condition)
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return True
            time.sleep(0.02)
        return bool(condition())
