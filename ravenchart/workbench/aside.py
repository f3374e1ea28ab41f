# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Questions that take long, answered by a process of their own (`room`), newest first.

A question that comes while another one is answered ends that process and starts a new one: what
was asked about an earlier state is of no use.
"""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
from base64 import b64encode
from collections.abc import AsyncIterator
from contextlib import suppress
from pathlib import Path
from signal import SIGKILL
from typing import Any

from ravenchart.editing.evaluation import Texts
from ravenchart.tools import children

WORDS = (sys.executable, "-P", "-m", "ravenchart.workbench.room")


class Aside:
    """One process, started before it is needed: an import takes a second."""

    def __init__(self) -> None:
        """Start it."""
        self._process = _started()
        self._busy = False

    async def ask(self, model: Path, texts: Texts, **more: Any) -> dict[str, Any] | None:
        """The answer about the files of a model; None where a later question took its place."""
        found = [one async for one in self.answers(model, texts, **more)]
        return found[-1] if found else None

    async def answers(
        self, model: Path, texts: Texts, **more: Any
    ) -> AsyncIterator[dict[str, Any]]:
        """The answers, each better than that before; they end where a later question came."""
        if self._busy or self._process.poll() is not None:
            _end(self._process)
            self._process = _started()
        self._busy = True
        process = self._process
        files = {name: b64encode(content).decode() for name, content in texts.items()}
        question = json.dumps({"model": str(model), "texts": files} | more)
        line = await asyncio.to_thread(_exchange, process, question)
        while process is self._process and line:
            answer: dict[str, Any] = json.loads(line)
            if not answer.pop("more", False):
                self._busy = False
                yield answer
                return
            yield answer
            line = await asyncio.to_thread(_next, process)

    def stop(self) -> None:
        """End the process, and what it is asked."""
        _end(self._process)


def _started() -> subprocess.Popen[str]:
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    process: subprocess.Popen[str] = children.popen(WORDS, **pipes)
    return process


def _exchange(process: subprocess.Popen[str], question: str) -> str:
    """One line there, one line back; "" where the process was ended meanwhile."""
    assert process.stdin is not None
    with suppress(OSError, ValueError):
        print(question, file=process.stdin, flush=True)
        return _next(process)
    return ""


def _next(process: subprocess.Popen[str]) -> str:
    """The next line; "" where the process was ended meanwhile."""
    assert process.stdout is not None
    with suppress(OSError, ValueError):
        return process.stdout.readline()
    return ""


def _end(process: subprocess.Popen[str]) -> None:
    """End the process at once: it keeps nothing."""
    if process.poll() is None:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, SIGKILL)
    process.wait()
