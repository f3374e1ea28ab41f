# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The observed responses of activities as text: a table in 80 columns, or lines for a pipe."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction

from rich.console import Console, ConsoleOptions, RenderResult
from rich.text import Text

from ravenchart import rounded
from ravenchart.analysis.system.row_responses import BINS, RowHistogram

from .summary import columns

GAP = 2
"""Columns between two cells."""

MARK = "|"
"""Stands behind the bin that ends at R."""

BINS_OF_A_CHARACTER = (1, 2, 4)
"""The first of these is taken with which a histogram has room."""

UNICODE = "▁▂▃▄▅▆▇█", "░▒▓"
PLAIN = ".:+#", ",;oO"
"""The characters for exact responses and for upper estimates, each by the height of the bar."""


@dataclass(frozen=True, slots=True)
class ResponseTable:
    """Each activity with C, R, its responses, and their histogram where the terminal has room."""

    rows: Sequence[RowHistogram]
    note: str

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        if not self.rows:
            return
        unit = rounded.unit_of(
            time
            for one in self.rows
            for time in (one.bound, one.wcet, one.longest, one.longest_at_most)
        )
        heads = ["activity", f"C {unit.name}", f"R {unit.name}", "longest", "at most", "sampled"]
        cells = [_cells(one, unit) for one in self.rows]
        taken = sum(max(map(len, column)) + GAP for column in zip(heads, *cells, strict=True))
        of_each = _bins_of_a_character(options.max_width - taken)
        if of_each is not None:
            heads.append("responses, R: |" if of_each == 1 else "R: |")
            signs = PLAIN if options.ascii_only else UNICODE
            for found, one in zip(cells, self.rows, strict=True):
                found.append(_histogram(one, of_each, signs))
        table = columns(heads[0], *(f"{head}>" for head in heads[1:6]), *heads[6:])
        for found in cells:
            table.add_row(*found)
        yield table
        if self.note:
            yield Text(self.note, style="dim")


def response_lines(rows: Sequence[RowHistogram]) -> Iterator[str]:
    """A line for each activity that was executed."""
    for one in rows:
        if not one.executions:
            continue
        longest, at_most, bound = (
            "-" if time is None else rounded.up(time)
            for time in (one.longest, one.longest_at_most, one.bound)
        )
        if one.longest is not None and one.bound is not None:
            longest, bound = rounded.beside(one.longest, one.bound)
        yield (
            f"{one.name} activity longest {longest} at most {at_most} R {bound} "
            f"sampled {_samples(one)} of {one.executions}"
        )


def _samples(of: RowHistogram) -> int:
    return sum(of.exact) + sum(of.at_most)


def _cells(of: RowHistogram, unit: rounded.TimeUnit) -> list[str]:
    longest, bound = unit.beside(of.longest, of.bound)
    share = rounded.room(Fraction(_samples(of), of.executions)) if of.executions else "-"
    return [of.name, unit.up(of.wcet), bound, longest, unit.up(of.longest_at_most), share]


def _bins_of_a_character(room: int) -> int | None:
    """How many bins one character stands for in so many columns; None where no bar has room."""
    for one in BINS_OF_A_CHARACTER:
        if BINS // one + len(MARK) <= room:
            return one
    return None


def _histogram(of: RowHistogram, bins: int, signs: tuple[str, str]) -> str:
    """The bars with the mark; a character is of the kind that has more samples in its bins."""
    counts = [
        (sum(of.exact[first : first + bins]), sum(of.at_most[first : first + bins]))
        for first in range(0, BINS, bins)
    ]
    highest = max(map(sum, counts))
    bars = [_bar(exact + at_most, highest, signs[at_most > exact]) for exact, at_most in counts]
    if of.bound is not None:
        bars.insert(-(-of.bound // (of.width * bins)), MARK)
    return "".join(bars)


def _bar(count: int, highest: int, levels: str) -> str:
    """The lowest character where there is one response at least."""
    return levels[-(-count * len(levels) // highest) - 1] if count else " "
