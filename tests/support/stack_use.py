# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How deep the stacks of a running program have been, read from outside.

The kernel gives a stack as zeros. So the lowest word that is not zero shows how deep it was, and a
return address into the body of a task says whose stack it is, and where the frame of that body is.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator, Mapping
from pathlib import Path

WORD = 8


def depths(process: int, image: Path, bodies: Mapping[str, tuple[int, int]]) -> dict[str, int]:
    """Body of a task to the bytes of stack that it has taken, what it calls included.

    ``bodies``: symbol to (address in the image, size). The frame of the body itself, above the
    return address into it, is not included.
    """
    maps = Path(f"/proc/{process}/maps").read_text()
    base = min(
        int(line.split("-")[0], 16) for line in maps.splitlines() if line.endswith(str(image))
    )
    found: dict[str, int] = {}
    with Path(f"/proc/{process}/mem").open("rb") as memory:
        for first, last in _places(process, maps):
            memory.seek(first)
            words = struct.unpack(f"<{(last - first) // WORD}Q", memory.read(last - first))
            deepest = next((n for n, word in enumerate(words) if word), None)
            if deepest is None:
                continue
            for name, (at, size) in bodies.items():
                inside = range(base + at, base + at + size)
                hits = [n for n, word in enumerate(words) if word in inside and n >= deepest]
                if hits:
                    found[name] = max(found.get(name, 0), (hits[-1] + 1 - deepest) * WORD)
    return found


def _places(process: int, maps: str) -> Iterator[tuple[int, int]]:
    """The memory around the stack pointer of each thread."""
    regions = [
        (int(m[1], 16), int(m[2], 16))
        for m in re.finditer(r"^([0-9a-f]+)-([0-9a-f]+) rw", maps, re.M)
    ]
    for thread in Path(f"/proc/{process}/task").iterdir():
        words = (thread / "syscall").read_text().split()
        pointer = int(words[-2], 16) if len(words) > 2 else 0
        yield from (one for one in regions if one[0] <= pointer < one[1])
