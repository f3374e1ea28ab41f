# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The kinds of rows, their columns, and how the text in them becomes exact integers."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction

from .entries import Entry, ReadFile

UNITS: Mapping[str, int] = {"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9}
"""The ending of the name of a column of times, and its unit in ns."""

LARGEST = 2**63 - 1
"""No number is larger: in ns these are 292 years."""

_NUMBER = re.compile(r"-?[0-9]{1,40}(?:\.[0-9]{0,40})?(?:[eE][-+]?[0-9]{1,2})?")
_WHOLE = re.compile(r"-?[0-9]{1,40}|0[xX][0-9a-fA-F]{1,30}")
_FLAGS = {"yes": True, "true": True, "1": True, "no": False, "false": False, "0": False}


class Form(Enum):
    """The contents of a column; times name the side to which they are rounded to whole ns."""

    WORD = "word"
    NUMBER = "whole number"
    FLAG = "yes or no"
    TIME_UP = "time, rounded up"
    TIME_DOWN = "time, rounded down"

    @property
    def timed(self) -> bool:
        """Whether its name ends in a unit."""
        return self in (Form.TIME_UP, Form.TIME_DOWN)


@dataclass(frozen=True, slots=True)
class Column:
    """A column; a ``required`` one has no default. Numbers and times are at least ``least``.

    Files of earlier versions have it under the name ``former``.
    """

    form: Form
    required: bool = False
    least: int = 0
    former: str = ""


_TEXT = Column(Form.WORD)
NEEDED = Column(Form.WORD, required=True)
"""A word that must be given."""
_COUNT = Column(Form.NUMBER, least=1)
_FLAG = Column(Form.FLAG)
_LATE = Column(Form.TIME_UP)
LONG = Column(Form.TIME_UP, required=True, least=1)
"""A time that must be given, rounded up."""
_PERIOD = Column(Form.TIME_DOWN, required=True, least=1)
_DEADLINE = Column(Form.TIME_DOWN, least=1)
_BEST = Column(Form.TIME_DOWN)
_ANY = -LARGEST

Kinds = Mapping[str, Mapping[str, Column]]

KINDS: Kinds = {
    "core": {
        "context_switch": _LATE,
        "release": _LATE,
        "tick_period": Column(Form.TIME_DOWN),
        "tick_cost": _LATE,
    },
    "task": {
        "core": _TEXT,
        "priority": Column(Form.NUMBER, required=True, least=_ANY),
        "period": _PERIOD,
        "deadline": _DEADLINE,
        "wcet": Column(Form.TIME_UP, least=1, former="cost"),
        "jitter": _LATE,
        "best": _BEST,
        "blocking": _LATE,
        "offset": Column(Form.TIME_DOWN),
        "epoch": _TEXT,
        "timed": _FLAG,
        "sporadic": _FLAG,
        "released_by": _TEXT,
    },
    "row": {
        "task": NEEDED,
        "wcet": replace(LONG, former="cost"),
        "every": _COUNT,
        "phase": Column(Form.NUMBER),
    },
    "section": {"task": NEEDED, "length": LONG},
    "object": {"ceiling": Column(Form.NUMBER, required=True, least=_ANY)},
    "bus": {
        "bit_rate": Column(Form.NUMBER, required=True, least=1),
        "data_rate": _COUNT,
        "unknown": _LATE,
        "error_period": Column(Form.TIME_DOWN, least=1),
        "error_burst": _COUNT,
        "error_bits": _COUNT,
    },
    "message": {
        "bus": NEEDED,
        "identifier": Column(Form.NUMBER),
        "priority": Column(Form.NUMBER, least=_ANY),
        "extended": _FLAG,
        "fd": _FLAG,
        "bytes": Column(Form.NUMBER),
        "cost": Column(Form.TIME_UP, least=1),
        "period": _PERIOD,
        "deadline": _DEADLINE,
        "jitter": _LATE,
        "best": _BEST,
        "queue": _TEXT,
        "sporadic": _FLAG,
        "released_by": _TEXT,
    },
    "chain": {
        "step": NEEDED,
        "hop": NEEDED,
        "takes": _COUNT,
        "reaction_limit": Column(Form.TIME_DOWN, least=1),
        "age_limit": Column(Form.TIME_DOWN, least=1),
    },
}
"""The columns of each kind of row besides the one that is named like the kind."""


@dataclass(frozen=True, slots=True)
class RowValues:
    """A row with its values by column; times in ns and without the unit in the name."""

    entry: Entry
    name: str
    words: Mapping[str, str]
    numbers: Mapping[str, int]

    def number(self, column: str, default: int = 0) -> int:
        """A number, a time in ns, or 1 for yes; the default where the column is empty."""
        return self.numbers.get(column, default)

    def exact(self, column: str) -> bool:
        """Whether the time in a column is whole ns, so that it was not rounded."""
        for title, text in self.entry.columns.items():
            name, unit = _split(title, KINDS[self.entry.kind])
            if name == column:
                return (_fraction(text) * unit).denominator == 1
        return True

    def word(self, column: str) -> str:
        """A word; none where the column is empty."""
        return self.words.get(column, "")


def values(entry: Entry, reading: ReadFile, kinds: Kinds = KINDS) -> RowValues | None:
    """The values of a row; None, and problems, where it cannot be used."""
    before = len(reading.problems)
    columns = kinds.get(entry.kind)
    if columns is None:
        known = ", ".join(kinds)
        reading.complain(
            entry.line, f"{entry.kind or 'a column without a name'} is none of {known}"
        )
        return None
    words: dict[str, str] = {}
    numbers: dict[str, int] = {}
    for title, text in entry.columns.items():
        if title == entry.kind:
            continue
        name, unit = _split(title, columns)
        column = columns.get(name)
        if column is None:
            reading.complain(entry.line, _unknown(title, entry.kind, columns))
        elif name in words or name in numbers:
            reading.complain(entry.line, f"{name} is given twice")
        elif column.form is Form.WORD:
            words[name] = text
        else:
            found = _converted(text, column.form, unit)
            if isinstance(found, int):
                found = _in_range(found, column, text)
            if isinstance(found, int):
                numbers[name] = found
            else:
                reading.complain(entry.line, f"{title} of {_owner(entry)} {found}")
    if not entry.columns.get(entry.kind):
        reading.complain(entry.line, f"{entry.kind} needs a name in the column {entry.kind}")
    for name, column in columns.items():
        given = any(_split(title, columns)[0] == name for title in entry.columns)
        if column.required and not given:
            suffix = "_us" if column.form.timed else ""
            reading.complain(entry.line, f"{name}{suffix} of {_owner(entry)} is missing")
    if len(reading.problems) > before:
        return None
    return RowValues(entry, entry.columns[entry.kind], words, numbers)


def _owner(entry: Entry) -> str:
    return f"{entry.kind} {entry.columns.get(entry.kind, '')}".strip()


def _split(title: str, columns: Mapping[str, Column]) -> tuple[str, int]:
    """The column that a title names, and its unit in ns."""
    name, _, unit = title.rpartition("_")
    name = next((n for n, c in columns.items() if c.former and c.former == name), name)
    if unit in UNITS and name in columns and columns[name].form.timed:
        return name, UNITS[unit]
    if title in columns and not columns[title].form.timed:
        return title, 1
    return "", 1


def _unknown(title: str, kind: str, columns: Mapping[str, Column]) -> str:
    if title in columns:
        return f"column {title} of {kind} must say its unit: {title}_ns, _us, _ms or _s"
    names = [f"{n}_us" if c.form.timed else n for n, c in columns.items()]
    return f"{kind} has no column {title}, only {', '.join(names)}"


def _converted(text: str, form: Form, unit: int) -> int | str:
    """The exact number, a time rounded to the safe side; or the text of its error."""
    if form is Form.FLAG:
        flag = _FLAGS.get(text.lower())
        return f"must be yes or no, not {text[:40]}" if flag is None else int(flag)
    if form is Form.NUMBER:
        if _WHOLE.fullmatch(text) is None:
            return f"must be a whole number, not {text[:40]}"
        return int(text, 16) if text[:2] in ("0x", "0X") else int(text)
    if _NUMBER.fullmatch(text) is None:
        return f"must be a number such as 12.5, not {text[:40]}"
    exact = _fraction(text) * unit
    if form is Form.TIME_UP:
        return -(-exact.numerator // exact.denominator)
    return exact.numerator // exact.denominator


def _fraction(text: str) -> Fraction:
    return Fraction(text.rstrip(".") if text.endswith(".") else text)


def _in_range(number: int, column: Column, text: str) -> int | str:
    if number < column.least:
        if column.form.timed and column.least and not text.startswith("-") and text.strip("0."):
            return f"must be at least 1 ns, not {text}"
        above = "above 0" if column.least == 1 else "at least 0"
        return f"must be {above}, not {text[:40]}"
    if number > LARGEST:
        what = "ns, 292 years" if column.form.timed else "(63 bits)"
        return f"must be at most {LARGEST} {what}, not {text[:40]}"
    return number
