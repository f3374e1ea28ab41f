# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Flash and RAM of a program, by its parts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from .symbols import Symbol

FLASH, BOTH, RAM = "tTrRwWvVuin", "dDgG", "bBsScC"
"""The kinds of nm: code and constants; variables with initial values; cleared ones."""
LIBRARY = "run-time library"
RUNTIME = "runtime"
BINDER = "elaboration and secondary stacks"
REST = "tables of the linker, padding"


@dataclass(frozen=True, slots=True)
class UsedMemory:
    """A part of the program and its bytes."""

    name: str
    flash: int
    ram: int


def parts(
    symbols: Iterable[Symbol], owners: Mapping[str, str], sections: Mapping[str, int]
) -> tuple[UsedMemory, ...]:
    """Each part with its bytes, and the rest of the sections.

    ``owners``: prefix of symbols to the part they belong to; the longest prefix decides.
    """
    prefixes = sorted(owners, key=len, reverse=True)
    sums: dict[str, list[int]] = {name: [0, 0] for name in dict.fromkeys(owners.values())}
    seen: set[int] = set()
    for one in sorted(symbols, key=lambda s: (s.at, -s.size)):
        if one.at in seen or one.size == 0:
            continue  # another name of the same bytes
        seen.add(one.at)
        name = one.name.removeprefix("_ada_")
        part = next((owners[p] for p in prefixes if name.startswith(p)), LIBRARY)
        count = sums.setdefault(part, [0, 0])
        count[0] += one.size if one.kind in FLASH or one.kind in BOTH else 0
        count[1] += one.size if one.kind in RAM or one.kind in BOTH else 0
    flash, ram = totals(sections)
    rest = flash - sum(f for f, _ in sums.values()), ram - sum(r for _, r in sums.values())
    found = [UsedMemory(name, *count) for name, count in sums.items() if any(count)]
    return (*found, UsedMemory(REST, max(rest[0], 0), max(rest[1], 0)))


UNLOADED = (".comment", ".debug", ".note.GNU", ".symtab", ".strtab", ".gnu_debug")
CLEARED = (".bss", ".tbss", ".noinit", "COMMON")
WRITTEN = (".data", ".tdata", ".got", ".init_array", ".fini_array", ".dynamic")


def totals(sections: Mapping[str, int]) -> tuple[int, int]:
    """Bytes of flash and of RAM of sections by ``size -A``."""
    flash = ram = 0
    for name, size in sections.items():
        if name.startswith(UNLOADED):
            continue
        if name.startswith(CLEARED):
            ram += size
        elif name.startswith(WRITTEN) and not name.startswith(".data.rel.ro"):
            flash += size
            ram += size
        else:
            flash += size
    return flash, ram


def sections(listing: str) -> dict[str, int]:
    """Section to bytes, of a listing by ``size -A``."""
    found: dict[str, int] = {}
    for line in listing.splitlines():
        words: Sequence[str] = line.split()
        if len(words) == 3 and words[1].isdigit() and words[2].isdigit():
            found[words[0]] = int(words[1])
    return found
