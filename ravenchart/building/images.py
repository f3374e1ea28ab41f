# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Images of boards: the memory that they take, by the headers of an ELF file."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

from ravenchart.failures import ToolFailed

from .targets import Target

LOADED = 1
"""PT_LOAD."""


def check(image: Path, target: Target) -> None:
    """ToolFailed where a part of an image is not within one region of the target's memory."""
    for first, size in parts(image.read_bytes()):
        if not any(
            region.at <= first and first + size <= region.at + region.size
            for region in target.facts.memory.values()
        ):
            raise ToolFailed(
                f"{image}: error: {size} bytes at {first:#x} are outside the memory of "
                f"{target.name}, or the loader of its run-time library has another map"
            )


def parts(image: bytes) -> Iterator[tuple[int, int]]:
    """First address and size of each part that is loaded, cleared memory included."""
    wide = image[4] == 2
    order = "<" if image[5] == 1 else ">"
    at = struct.unpack_from(f"{order}{'Q' if wide else 'I'}", image, 32 if wide else 28)[0]
    size, count = struct.unpack_from(f"{order}HH", image, 54 if wide else 42)
    for number in range(count):
        place = at + number * size
        kind = struct.unpack_from(f"{order}I", image, place)[0]
        if wide:
            address, _, taken = struct.unpack_from(f"{order}QQQ", image, place + 24)
        else:
            address, _, taken = struct.unpack_from(f"{order}III", image, place + 12)
        if kind == LOADED and taken:
            yield address, taken
