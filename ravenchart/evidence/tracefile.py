# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Counts of the lines and branches that test cases execute: an LCOV tracefile (geninfo(1), FILES).

`ravenchart tests --coverage FILE` writes one. The version of a source there, its record VER, is the
SHA-256 of the text that was counted.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ravenchart.failures import Refused


@dataclass(slots=True)
class CountedBody:
    """The counts of one source."""

    path: Path
    version: str = ""
    """The SHA-256 of its text; "" where the tracefile says none."""
    lines: dict[int, int] = field(default_factory=dict)
    branches: list[tuple[int, int]] = field(default_factory=list)
    """The line of each branch, and how often it was taken."""


def read(path: Path) -> tuple[CountedBody, ...]:
    """The sources of a tracefile; Refused where it is none."""
    found: list[CountedBody] = []
    is_open = False
    try:
        for line in path.read_text(encoding="utf-8").splitlines():
            what, _, rest = line.partition(":")
            if what == "SF":
                found.append(CountedBody(Path(rest)))
                is_open = True
            elif what == "end_of_record":
                is_open = False
            elif what in ("VER", "DA", "BRDA"):
                _take(found[-1], what, rest)
    except (UnicodeDecodeError, ValueError, IndexError):
        is_open = True
    if is_open or not found:
        raise Refused(
            f"{path}: error: not an LCOV tracefile\n"
            f"{path}: hint: `ravenchart tests MODEL --coverage FILE` writes one"
        )
    return tuple(found)


def _take(body: CountedBody, what: str, rest: str) -> None:
    match what:
        case "VER":
            body.version = rest
        case "DA":
            line, count, *_ = rest.split(",")
            body.lines[int(line)] = body.lines.get(int(line), 0) + int(count)
        case _:
            line, _block, _branch, taken = rest.split(",")
            body.branches.append((int(line), 0 if taken == "-" else int(taken)))
