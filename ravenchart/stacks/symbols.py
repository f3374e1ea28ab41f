# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The symbols of a linked program, by ``nm -S``, and the values of its constants."""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Symbol:
    """A symbol: where it is, its bytes, and its kind in the letters of nm."""

    name: str
    at: int
    size: int
    kind: str


def read(listing: str) -> list[Symbol]:
    """The symbols of a listing by ``nm -S``; one without a size has 0 bytes."""
    found = []
    for line in listing.splitlines():
        parts = line.split()
        if len(parts) == 4:
            found.append(Symbol(parts[3], int(parts[0], 16), int(parts[1], 16), parts[2]))
        elif len(parts) == 3:
            found.append(Symbol(parts[2], int(parts[0], 16), 0, parts[1]))
    return found


class Values:
    """The initial values of what a program holds."""

    def __init__(self, image: Path, symbols: Mapping[str, Symbol]) -> None:
        self._data = image.read_bytes()
        self._symbols = symbols
        self._wide = self._data[4] == 2
        self._order = "<" if self._data[5] == 1 else ">"

    def number(self, name: str) -> int | None:
        """The value of a constant of 4 or 8 bytes; None where the program has none of that name."""
        symbol = self._symbols.get(name)
        if symbol is None or symbol.size not in (4, 8):
            return None
        offset = self._offset(symbol.at)
        if offset is None:
            return None
        form = "i" if symbol.size == 4 else "q"
        return int(struct.unpack_from(f"{self._order}{form}", self._data, offset)[0])

    def _offset(self, address: int) -> int | None:
        """Where in the file the byte at an address is."""
        head = self._order + ("Q" if self._wide else "I")
        at = struct.unpack_from(head, self._data, 32 if self._wide else 28)[0]
        size, count = struct.unpack_from(f"{self._order}HH", self._data, 54 if self._wide else 42)
        for number in range(count):
            place = at + number * size
            if self._wide:
                start, first, _, filled = struct.unpack_from(
                    f"{self._order}QQQQ", self._data, place + 8
                )
            else:
                start, first, _, filled = struct.unpack_from(
                    f"{self._order}IIII", self._data, place + 4
                )
            kind = struct.unpack_from(f"{self._order}I", self._data, place)[0]
            if kind == 1 and first <= address < first + filled:
                return int(start + address - first)
        return None
