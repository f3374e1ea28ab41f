# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The coverage of a program's sources by its runs in virtual time, as gcov counts it.

The program is compiled without optimisation, without checks and without contracts, so the counted
code is that of the release. A function of a spec counts once it was called. The declared form of
a chart has functions that the body executes, such as `Enabled` and `Target`, and others that only
contracts name. A body that should call a function and does not has a line that was not executed.
"""

from __future__ import annotations

import json
from bisect import bisect_right
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise
from pathlib import Path
from typing import Any

from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from ravenchart.tools.kept import file_digest

GCOV = "gcov"
"""The tool that reads the counts; it belongs to the compiler."""

_ELABORATION = "___elabs"
"""How the name of what elaborates a spec ends."""

_NO_CONTRACTS = "pragma Assertion_Policy (Ignore);\n"


class SourceOwner(Enum):
    """Whose sources they are; the value names them in a report."""

    GENERATED = "generated"
    USER = "user"
    RUNTIME = "runtime"


@dataclass(slots=True)
class SourceCoverage:
    """How often the lines and branches of a body or spec were executed."""

    path: Path
    origin: SourceOwner
    lines: dict[int, int] = field(default_factory=dict)
    """Executions by line number; only lines with code."""
    branches: dict[tuple[int, int], int] = field(default_factory=dict)
    """How often each was taken, by line and number of the branch there."""

    def executed(self) -> int:
        """Lines that were executed."""
        return sum(count > 0 for count in self.lines.values())

    def taken(self) -> int:
        """Branches that were taken."""
        return sum(count > 0 for count in self.branches.values())

    def left(self) -> list[int]:
        """Lines that were not executed, in order."""
        return sorted(line for line, count in self.lines.items() if not count)


def switches(home: Path) -> tuple[list[str], dict[str, str]]:
    """Arguments of gprbuild for a program that counts, and its scenario; both for this folder."""
    policy = home / "coverage.adc"
    policy.write_text(_NO_CONTRACTS, encoding="utf-8")
    #  a line that is inlined has its branches once for each call, where inlining precedes counting
    inlined_late = ["-fno-inline", "-fdisable-tree-einline"]
    compiler = ["-O0", *inlined_late, "-gnatp", "--coverage", f"-gnatec={policy}"]
    words = ["-cargs:Ada", *compiler, "-largs", "--coverage", "-margs"]
    return words, {"MODE": "release", "RAVENCHART_OBJECTS": str(home / "runtime")}


def forget(home: Path) -> None:
    """Delete the counts of earlier runs."""
    for path in home.rglob("*.gcda"):
        path.unlink()


def measured(home: Path, user: Sequence[Path]) -> list[SourceCoverage]:
    """The coverage of the sources by all runs since `forget`; ``user``: the user's folders.

    ToolMissing without gcov, ToolFailed where it cannot read what the compiler left.
    """
    counts = sorted(str(path) for path in home.rglob("*.gcda"))
    given = ["--branch-probabilities", "--branch-counts", "--json-format", "--stdout"]
    said = toolchain.filtered(GCOV, [*given, *counts], "")
    places = {
        (home / "source").resolve(): SourceOwner.GENERATED,
        **{folder.resolve(): SourceOwner.USER for folder in user},
        (ROOT / "spark_runtime" / "src").resolve(): SourceOwner.RUNTIME,
    }
    return read(said, places)


def read(said: str, places: Mapping[Path, SourceOwner]) -> list[SourceCoverage]:
    """The output of gcov for the sources in some folders, in the order of folder and name.

    A line of a generic counts for all of its instances together.
    """
    found: dict[Path, SourceCoverage] = {}
    for line in said.splitlines():
        for one in json.loads(line)["files"]:
            path = Path(one["file"])
            origin = places.get(path.parent)
            if origin is None or path.stem.endswith("_simulation"):
                continue
            idle = _uncalled(one) if path.suffix == ".ads" else lambda number: False
            coverage = found.setdefault(path, SourceCoverage(path, origin))
            for entry in one["lines"]:
                number = entry["line_number"]
                if idle(number):
                    continue
                coverage.lines[number] = coverage.lines.get(number, 0) + entry["count"]
                kept = (branch for branch in entry["branches"] if not branch["throw"])
                for index, branch in enumerate(kept):
                    key = number, index
                    coverage.branches[key] = coverage.branches.get(key, 0) + branch["count"]
    order = list(SourceOwner)
    named = [one for one in found.values() if one.lines or one.path.suffix == ".adb"]
    return sorted(named, key=lambda one: (order.index(one.origin), one.path.name))


def _uncalled(file: Mapping[str, Any]) -> Callable[[int], bool]:
    """Is a line of a spec in a function that nothing calls?

    Of an expression function gcov knows the first line alone: it goes on to that of the next one.
    """
    calls: dict[int, int] = {}
    for one in file["functions"]:
        if not one["name"].endswith(_ELABORATION):
            start = one["start_line"]
            calls[start] = calls.get(start, 0) + one["execution_count"]
    starts = sorted(calls)

    def idle(line: int) -> bool:
        place = bisect_right(starts, line)
        return place > 0 and not calls[starts[place - 1]]

    return idle


def tracefile(coverage: Sequence[SourceCoverage]) -> str:
    """The counts as an LCOV tracefile, which editors and genhtml show (geninfo(1), FILES).

    The version of a source is the SHA-256 of its text.
    """
    return "".join(f"{line}\n" for one in coverage for line in _records(one))


def _records(one: SourceCoverage) -> Iterator[str]:
    yield "TN:"
    yield f"SF:{one.path}"
    yield f"VER:{file_digest(one.path)}"
    for (line, index), count in sorted(one.branches.items()):
        yield f"BRDA:{line},0,{index},{count if one.lines.get(line) else '-'}"
    yield f"BRF:{len(one.branches)}"
    yield f"BRH:{one.taken()}"
    for line, count in sorted(one.lines.items()):
        yield f"DA:{line},{count}"
    yield f"LF:{len(one.lines)}"
    yield f"LH:{one.executed()}"
    yield "end_of_record"


def number_ranges(numbers: Sequence[int]) -> str:
    """Numbers in order, those that follow each other together: ``3, 7-9``."""
    starts = [n for n, one in enumerate(numbers) if not n or one != numbers[n - 1] + 1]
    parts = (numbers[a:b] for a, b in pairwise([*starts, len(numbers)]))
    return ", ".join(f"{p[0]}-{p[-1]}" if len(p) > 1 else f"{p[0]}" for p in parts)
