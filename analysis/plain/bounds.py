# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Bounds of execution times from a static WCET tool, as plain rows.

Each row names a row of a processor's table, or the function that runs it, with its bound: a
time, or cycles and the rate of their clock.
"""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.names import path_name
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import Slot, System, Work

from .columns import LARGEST, Column, Form, Kinds, RowValues, values
from .entries import Problem, ReadFile, read_rows

_COUNT = Column(Form.NUMBER, least=1)
_COLUMNS = {"wcet": Column(Form.TIME_UP, least=1), "cycles": _COUNT, "clock_hz": _COUNT}
KINDS: Kinds = {"row": _COLUMNS, "function": _COLUMNS}
"""The kinds of rows."""
SECOND = 10**9
"""In ns."""


@dataclass(frozen=True, slots=True)
class Bound:
    """The bound of a row in ns, and its location in the file."""

    row: str
    wcet: Ns
    place: str


def read_bounds(text: str, file: str, system: System) -> dict[str, Bound] | tuple[Problem, ...]:
    """The bound of each row of a table that the file lists, or the problems of the file."""
    reading = read_rows(text, file)
    known: dict[tuple[str, str], list[Slot]] = {}
    for slot in system.slots:
        known.setdefault(("row", slot.element.lower()), []).append(slot)
        known.setdefault(("function", function_of(slot, system)), []).append(slot)
    found: dict[str, Bound] = {}
    for entry in reading.entries:
        one = values(entry, reading, KINDS)
        wcet = None if one is None else _wcet(one, reading)
        if one is None or wcet is None:
            continue
        named = known.get((entry.kind, one.name.lower()), [])
        place = f"{file}:{entry.line}"
        if not named:
            reading.complain(entry.line, f"there is no {entry.kind} {one.name}")
        elif len(named) > 1:  # the program of each node has a function of that name
            rows = " and ".join(slot.element for slot in named)
            reading.complain(entry.line, f"{one.name} runs {rows}: use the column `row`")
        elif named[0].element in found:
            first = found[named[0].element].place
            reading.complain(entry.line, f"{named[0].element} has a bound already, at {first}")
        else:
            found[named[0].element] = Bound(named[0].element, wcet, place)
    if not reading.problems and not found:
        reading.complain(0, "the file has no bound")
    return tuple(reading.problems) or found


def function_of(slot: Slot, system: System) -> str:
    """The linker symbol of the procedure that runs a row."""
    package, name = {
        Work.BUS_RECEIVE: (f"{slot.owner}__receiver", "receive"),
        Work.BUS_WATCH: (f"{slot.owner}__watch", "watch"),
    }.get(slot.work, (slot.owner, slot.name))
    return f"{system.name}__{path_name(package)}__run_{name}".lower()


def _wcet(one: RowValues, reading: ReadFile) -> Ns | None:
    """The time of a row, rounded up; None, and a problem, where the row has none or two."""
    has = tuple(name for name in _COLUMNS if one.number(name))
    if has == ("wcet",):
        return Ns(one.number("wcet"))
    if has == ("cycles", "clock_hz"):
        wcet = -(-one.number("cycles") * SECOND // one.number("clock_hz"))
        if wcet <= LARGEST:
            return Ns(wcet)
    line, name = one.entry.line, one.name
    reading.complain(line, f"{name} needs `wcet_us`, or `cycles` and `clock_hz`")
    return None
