# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""From rows to the records of `analysis.core`; each contradiction is reported by line."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from itertools import groupby
from typing import TypeVar

from ravenchart.analysis.core import frames
from ravenchart.analysis.core.blocking import Section, blockers
from ravenchart.analysis.core.bus import ERROR_BITS, Bus, Errors, Frame
from ravenchart.analysis.core.chains import ChainStep, HopKind, TimedChain
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import TableRow, Task

from .columns import RowValues, values
from .entries import Problem, ReadFile, read_rows

SECOND = 10**9

Made = TypeVar("Made")


@dataclass(frozen=True, slots=True)
class PlainSystem:
    """The system in a plain file; all times in ns."""

    network: Network
    chains: tuple[TimedChain, ...]


def load_plain(text: str, file: str) -> PlainSystem | tuple[Problem, ...]:
    """The system in the text of a file, or the problems of the file."""
    reading = read_rows(text, file)
    rows: dict[str, list[RowValues]] = {}
    for entry in reading.entries:
        found = values(entry, reading)
        if found is not None:
            rows.setdefault(entry.kind, []).append(found)
    if not reading.problems and not rows.get("task") and not rows.get("message"):
        reading.complain(0, "there are neither tasks nor messages")
    if not reading.problems:
        _check(rows, reading)
    if not reading.problems:
        system = _system(rows, reading)
        if system is not None and not reading.problems:
            return system
    return tuple(reading.problems)


def _check(rows: dict[str, list[RowValues]], reading: ReadFile) -> None:
    """Report names that are given twice, and names of missing elements."""
    for kinds in (("task", "message"), ("core",), ("bus",), ("object",)):
        seen: dict[str, RowValues] = {}
        for row in (row for kind in kinds for row in rows.get(kind, ())):
            first = seen.setdefault(row.name, row)
            if first is not row:
                reading.complain(
                    row.entry.line,
                    f"the name {row.name} is already given in line {first.entry.line}",
                )
    names = {kind: {row.name for row in some} for kind, some in rows.items()}
    tasks = names.get("task", set())
    items = tasks | names.get("message", set())
    for kind, column, known, what in (
        ("row", "task", tasks, "task"),
        ("section", "task", tasks, "task"),
        ("message", "bus", names.get("bus", set()), "bus"),
        ("chain", "step", items, "task or message"),
        ("task", "released_by", items, "task or message"),
        ("message", "released_by", items, "task or message"),
    ):
        for row in rows.get(kind, ()):
            name = row.word(column)
            if name and name not in known:
                reading.complain(
                    row.entry.line, f"{column} of {kind} {row.name}: there is no {what} {name}"
                )
    used = {task.word("core") for task in rows.get("task", ())}
    for core in rows.get("core", ()):
        if core.name not in used:
            reading.complain(core.entry.line, f"no task is on core {core.name}")


def _system(rows: dict[str, list[RowValues]], reading: ReadFile) -> PlainSystem | None:
    tables: dict[str, list[TableRow]] = {}
    for row in rows.get("row", ()):
        made = _made(row, reading, _row)
        if made is not None:
            tables.setdefault(row.word("task"), []).append(made)
    tasks = [
        _made(row, reading, lambda row: _task(row, tables.get(row.name, [])))
        for row in rows.get("task", ())
    ]
    sections = [
        Section(row.name, row.word("task"), row.number("length")) for row in rows.get("section", ())
    ]
    buses = {row.name: row for row in rows.get("bus", ())}
    on: dict[str, list[Frame]] = {}
    highest = max((row.number("priority") for row in rows.get("message", ())), default=0)
    for row in rows.get("message", ()):
        frame = _made(row, reading, lambda row: _frame(row, buses[row.word("bus")], highest))
        if frame is not None:
            on.setdefault(row.word("bus"), []).append(frame)
    platforms = {row.name: _made(row, reading, _platform) for row in rows.get("core", ())}
    chains = [
        _chain(list(steps), reading)
        for _, steps in groupby(rows.get("chain", ()), key=lambda row: row.name)
    ]
    for name, count in Counter(chain.name for chain in chains if chain).items():
        if count > 1:
            reading.complain(0, f"the steps of chain {name} must stand together")
    _ranks(rows, on, reading)
    if reading.problems:
        return None
    ceilings = {row.name: row.number("ceiling") for row in rows.get("object", ())}
    try:
        network = Network(
            tuple(task for task in tasks if task is not None),
            {bus: tuple(some) for bus, some in on.items()},
            {name: _bus(row) for name, row in buses.items()},
            {
                row.name: row.word("released_by")
                for kind in ("task", "message")
                for row in rows.get(kind, ())
                if row.word("released_by")
            },
            tuple(sections),
            {name: made for name, made in platforms.items() if made is not None},
            ceilings,
            together=True,
        )
        blockers(network.tasks, network.sections, network.ceilings)
    except ValueError as fault:
        reading.complain(_line_of(str(fault), rows), str(fault))
        return None
    return PlainSystem(network, tuple(chain for chain in chains if chain is not None))


def _line_of(text: str, rows: dict[str, list[RowValues]]) -> int:
    """The line of the first row whose name comes first in the text."""
    lines = {row.name: row.entry.line for some in reversed(rows.values()) for row in reversed(some)}
    return next((lines[word] for word in text.replace(",", "").split() if word in lines), 0)


def _made(row: RowValues, reading: ReadFile, make: Callable[[RowValues], Made]) -> Made | None:
    """The record of a row; None, and a problem, where its numbers do not fit together."""
    try:
        return make(row)
    except ValueError as fault:
        reading.complain(row.entry.line, str(fault))
        return None


def _row(row: RowValues) -> TableRow:
    return TableRow(row.name, row.number("wcet"), row.number("every", 1), row.number("phase"))


def _task(row: RowValues, table: list[TableRow]) -> Task:
    if not table and not row.number("wcet"):
        raise ValueError(f"wcet_us of task {row.name} is missing, and it has no rows")
    period = row.number("period")
    for column in ("offset", "period") if "offset" in row.numbers else ():
        if not row.exact(column):
            raise ValueError(f"{column} of task {row.name} must be whole ns: it has an offset")
    return Task(
        row.name,
        row.number("priority"),
        period,
        row.number("deadline", period),
        row.number("wcet"),
        row.number("jitter"),
        row.word("core"),
        tuple(table),
        bool(row.number("timed")),
        bool(row.number("sporadic")),
        row.number("best"),
        row.number("blocking"),
        offset=row.numbers.get("offset"),
        epoch=row.word("epoch"),
    )


def _platform(row: RowValues) -> Platform:
    return Platform(
        row.number("context_switch"),
        row.number("release"),
        row.number("tick_period"),
        row.number("tick_cost"),
    )


def _bus(row: RowValues) -> Bus:
    period = row.number("error_period")
    errors = (
        Errors(period, row.number("error_burst", 1), row.number("error_bits", ERROR_BITS))
        if period
        else None
    )
    return Bus(-(-SECOND // row.number("bit_rate")), row.number("unknown"), errors)


def _frame(row: RowValues, bus: RowValues, highest: int) -> Frame:
    """A message; ``highest`` is the most urgent priority that any message has."""
    extended = bool(row.number("extended"))
    if ("identifier" in row.numbers) == ("priority" in row.numbers):
        raise ValueError(f"message {row.name} must have either an identifier or a priority")
    if "priority" in row.numbers:
        rank = highest - row.number("priority")
    else:
        rank = frames.rank(row.number("identifier"), extended=extended)
    longest = row.number("cost")
    if bool(longest) == ("bytes" in row.numbers):
        raise ValueError(f"message {row.name} must have either bytes or cost_us")
    if not longest:
        length = row.number("bytes")
        fd = row.number("fd")
        bits = (frames.fd_bits if fd else frames.classic_bits)(length, extended=extended)
        longest = bits.time(bus.number("bit_rate"), bus.number("data_rate"), SECOND)
    period = row.number("period")
    return Frame(
        row.name,
        rank,
        period,
        row.number("deadline", period),
        longest,
        row.number("jitter"),
        row.word("queue"),
        row.number("best"),
        sporadic=bool(row.number("sporadic")),
    )


def _ranks(rows: dict[str, list[RowValues]], on: dict[str, list[Frame]], reading: ReadFile) -> None:
    """Report messages of one bus with equal identifiers, or with and without an identifier."""
    known = {row.name: row for row in rows.get("message", ())}
    for bus, some in on.items():
        seen: dict[int, str] = {}
        placed = {frame.name: "priority" in known[frame.name].numbers for frame in some}
        for frame in some:
            other = seen.setdefault(frame.rank, frame.name)
            line = known[frame.name].entry.line
            if placed[frame.name] != placed[some[0].name]:
                have, has = ("an identifier", "a priority")[:: -1 if placed[some[0].name] else 1]
                reading.complain(
                    line, f"message {frame.name} has {has} and {some[0].name} {have} on bus {bus}"
                )
            elif other != frame.name and not placed[frame.name]:
                reading.complain(
                    line,
                    f"identifier of message {frame.name} is already that of {other} on bus {bus}",
                )


def _chain(rows: list[RowValues], reading: ReadFile) -> TimedChain | None:
    steps = []
    for row in rows:
        word = row.word("hop")
        if word not in {hop.value for hop in HopKind if hop is not HopKind.WOKEN}:
            reading.complain(
                row.entry.line,
                f"hop of chain {row.name} must be released, sampled or queued, not {word}",
            )
            return None
        steps.append(ChainStep(row.word("step"), HopKind(word), row.number("takes", 1)))
    limits = [max(row.number(name) for row in rows) for name in ("reaction_limit", "age_limit")]
    return TimedChain(rows[0].name, tuple(steps), *limits)
