# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How deep the stacks of a controller on an emulated board have been, by its memory."""

from __future__ import annotations

import struct
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path

from ravenchart.stacks import graph, symbols

WORD, UNUSED = 8, 256
"""Bytes of a word, and how many words of zeros are below a stack that has not been deeper."""


def memory_after(words: Sequence[str], seconds: float, size: int, folder: Path) -> bytes:
    """The memory from address 0 of what that command emulates, after a time of this machine."""
    told = list(words)
    told[told.index("-monitor") + 1] = "stdio"
    file = folder / "memory"
    process = subprocess.Popen(
        told, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, text=True
    )
    try:
        time.sleep(seconds)
        process.communicate(f'stop\npmemsave 0 {size} "{file}"\nquit\n', timeout=60)
    finally:
        process.kill()
        process.wait()
    return file.read_bytes()


def depths(memory: bytes, found: Sequence[symbols.Symbol]) -> dict[str, int]:
    """Body of a task to the bytes of its stack below the frame of the body."""
    by_name = {one.name: one for one in found}
    used = {}
    for name in (one for one in by_name if graph.is_task(one)):
        body, task = by_name[name], by_name[name.replace("TKB", "")]
        count = task.size // WORD
        words = struct.unpack_from(f"<{count}Q", memory, task.at)
        inside = range(body.at, body.at + body.size)
        first = max((n for n, word in enumerate(words) if word in inside), default=None)
        if first is None:
            continue
        lowest, zeros, place = first, 0, first
        while place > 0 and zeros < UNUSED:
            place -= 1
            lowest, zeros = (place, 0) if words[place] else (lowest, zeros + 1)
        used[name] = (first + 1 - lowest) * WORD
    return used
