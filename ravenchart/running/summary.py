# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The run in a terminal of 80 columns: verdict last, colour never alone."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from rich.console import Console
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from ravenchart import rounded
from ravenchart.analysis.present.report import Comparison, FrameRow, StepRow
from ravenchart.analysis.system.journeys import Journey

from .measured import WARNING, Measurement


def print_steps(console: Console, steps: Sequence[StepRow]) -> None:
    """The steps, and how each went."""
    table = columns("at s>", "step", "outcome")
    for step in steps:
        outcome = step.outcome if step.passed else f"FAILED: {step.outcome}"
        style = "" if step.passed else "bold red"
        at = rounded.instant(rounded.of_seconds(step.at))
        table.add_row(at, escape(step.text), escape(outcome), style=style)
    _section(console, "steps", table)


def print_states(console: Console, states: dict[str, tuple[str, ...]]) -> None:
    """The states that each region visited."""
    table = columns("region", "states visited, in order of the first visit")
    for region, visited in states.items():
        table.add_row(region, ", ".join(visited) or "none")
    _section(console, "states", table)


def print_frames(console: Console, frames: Sequence[FrameRow]) -> None:
    """The CAN frames both ways."""
    table = columns("message", "to controller>", "from controller>")
    names = dict.fromkeys(f.message for f in frames)
    counts = {(f.message, f.direction): f.count for f in frames}
    for name in names:
        both = (counts.get((name, d), 0) for d in ("to controller", "from controller"))
        table.add_row(name, *(str(count) if count else "-" for count in both))
    _section(console, "CAN frames", table)


def print_comparison(console: Console, compared: Sequence[Comparison], *, comparable: bool) -> None:
    """Observed beside bound."""
    unit = rounded.unit_of(time for row in compared for time in (row.observed, row.bound))
    times = (f"observed {unit.name}>", f"bound {unit.name}>")
    table = columns("processor", "releases>", "misses>", *times, "ratio>", "")
    for row in compared:
        observed, bound = unit.beside(row.observed, row.bound)
        bad = row.word in ("MISS", "ABOVE") and (comparable or row.misses > 0)
        table.add_row(
            row.task,
            str(row.releases),
            str(row.misses),
            observed,
            bound,
            rounded.percent(row.ratio) if row.bound else "-",
            row.word if comparable or bad else "",
            style="bold red" if bad else "",
        )
    _section(console, "longest responses", table)
    if not comparable:
        console.print("not comparable: the controller had no real-time priorities")


def print_journeys(console: Console, took: Sequence[Journey]) -> None:
    """The longest reaction of each chain beside its bound."""
    unit = rounded.unit_of(time for row in took for time in (row.observed, row.bound))
    times = (f"{name} {unit.name}>" for name in ("observed", "bound", "limit"))
    table = columns("chain", "reactions>", *times, "")
    for row in took:
        observed, bound = unit.beside(row.observed, row.bound)
        table.add_row(
            row.chain,
            str(row.count),
            observed,
            bound,
            unit.down(row.limit),
            "ABOVE" if row.exceeded else "ok",
            style="bold red" if row.exceeded else "",
        )
    _section(console, "longest reactions of chains", table)


def print_measurement(console: Console, found: Measurement) -> None:
    """Measured execution times beside the WCETs of the model, and what they leave out."""
    bounded = any(one.bound is not None for one in found.rows)
    unit = rounded.unit_of(time for one in found.rows for time in (one.wcet, one.measured))
    names = ["measured", f"+ {found.margin} %", "wcet", *(["bound"] if bounded else [])]
    table = columns("row", *(f"{name} {unit.name}>" for name in names), "ratio>", "")
    for one in found.rows:
        measured, wcet = unit.beside(one.measured, one.wcet)
        cells = [measured, unit.up(one.proposed), wcet, *([unit.up(one.bound)] if bounded else [])]
        share = None if one.measured is None else Fraction(one.measured, one.wcet)
        ratio = "-" if share is None else rounded.percent(share)
        word = "ABOVE" if one.words else "" if one.measured is None else "ok"
        table.add_row(one.row, *cells, ratio, word, style="bold red" if one.words else "")
    _section(console, f"execution times: {found.run}", table)
    lines = [f"{WARNING[0].upper()}{WARNING[1:]}.", f"Times are {found.clock}."]
    idle = [one.row for one in found.rows if one.measured is None]
    if idle:
        lines.append(f"Not executed: {', '.join(idle)}.")
    if found.coverage:
        taken = sum(one.taken for one in found.coverage)
        lines.append(f"{taken} of {sum(c.transitions for c in found.coverage)} transitions taken.")
    if found.not_measured:
        lines.append(f"Not measured: {', '.join(found.not_measured)}.")
    for line in lines:
        console.print(Text(line))


def print_positions(console: Console, lines: Sequence[str]) -> None:
    """Where the axes ended."""
    if lines:
        console.print(Text("\npositions", style="bold"))
        for line in lines:
            console.print(Text(line))


def print_verdict(console: Console, verdict: str, failures: Sequence[str]) -> None:
    """One line, and the further reasons below it."""
    console.print()
    style = "bold red" if failures else "bold green"
    console.print(Text(verdict, style=style), soft_wrap=True)
    for reason in failures[1:]:
        console.print(Text(f"         also: {reason}", style="red"), soft_wrap=True)


def columns(*names: str) -> Table:
    """A table without lines; a column ending in ``>`` is set to the right."""
    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for column in names:
        right = column.endswith(">")
        table.add_column(
            column.removesuffix(">"),
            justify="right" if right else "left",
            overflow="fold",
            no_wrap=right,
        )
    return table


def _section(console: Console, title: str, table: Table) -> None:
    console.print(Text(f"\n{title}", style="bold"))
    console.print(table)
