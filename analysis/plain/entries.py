# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rows of plain files, as text: the line of each row, and its columns.

A CSV file holds blocks, each a line of column names and the rows under it. An empty line
ends a block, and `#` begins a comment line. A JSON file holds an object of lists of
objects. In both the first column of a row is its kind, with the name of the element.
"""

from __future__ import annotations

import csv
import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

TOO_LONG = 64 * 2**20
"""Characters that a file may have."""


@dataclass(frozen=True, slots=True)
class Problem:
    """An error in a file, at a line from 1 on; 0 where no single line has the error."""

    file: str
    line: int
    text: str

    def __str__(self) -> str:
        """``file:line: error: text``, as editors read it."""
        place = f"{self.file}:{self.line}" if self.line else self.file
        return f"{place}: error: {self.text}"


@dataclass(frozen=True, slots=True)
class Entry:
    """One row: its kind, its line, and its columns; empty ones are left out."""

    kind: str
    line: int
    columns: dict[str, str]


@dataclass(slots=True)
class ReadFile:
    """The rows of a file, and its problems."""

    file: str
    entries: list[Entry]
    problems: list[Problem]

    def complain(self, line: int, text: str) -> None:
        """Report one more problem."""
        self.problems.append(Problem(self.file, line, text))


def read_rows(text: str, file: str) -> ReadFile:
    """The rows of a file whose name ends in ``.json``, else of a CSV file."""
    reading = ReadFile(file, [], [])
    if len(text) > TOO_LONG:
        reading.complain(0, f"the file must have at most {TOO_LONG} characters, not {len(text)}")
    elif file.lower().endswith(".json"):
        _read_json(text, reading)
    else:
        _read_csv(text, reading)
    return reading


def _read_csv(text: str, reading: ReadFile) -> None:
    header: list[str] = []
    lines = csv.reader(text.removeprefix("\ufeff").splitlines(), strict=True)
    try:
        for row in lines:
            cells = [cell.strip() for cell in row]
            if not any(cells):
                header = []
            elif cells[0].startswith("#"):
                continue
            elif not header:
                header = cells
                _check_header(header, lines.line_num, reading)
            elif len(cells) > len(header):
                reading.complain(
                    lines.line_num,
                    f"the row has {len(cells)} columns, and the line of names {len(header)}",
                )
            else:
                columns = {n: cell for n, cell in zip(header, cells, strict=False) if cell and n}
                reading.entries.append(Entry(header[0], lines.line_num, columns))
    except csv.Error as fault:
        reading.complain(lines.line_num, f"not CSV: {fault}")


def _check_header(header: list[str], line: int, reading: ReadFile) -> None:
    named = [name for name in header if name]
    for name in sorted({name for name in named if named.count(name) > 1}):
        reading.complain(line, f"there are two columns {name}")


class _UnusableError(Exception):
    """A key that an object has twice, or a number that is none."""


def _read_json(text: str, reading: ReadFile) -> None:
    try:
        whole: Any = json.loads(
            text, object_pairs_hook=_once, parse_int=str, parse_float=str, parse_constant=_no_number
        )
    except json.JSONDecodeError as fault:
        reading.complain(fault.lineno, f"not JSON: {fault.msg}")
        return
    except (_UnusableError, ValueError) as fault:
        reading.complain(0, f"not JSON that can be used: {fault}")
        return
    except RecursionError:
        reading.complain(0, "lists and objects are nested too deeply")
        return
    if not isinstance(whole, dict):
        reading.complain(1, 'the file must hold an object such as {"task": [{"task": "a", ...}]}')
        return
    lines = _lines(text)
    for kind, rows in whole.items():
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            reading.complain(0, f"{kind} must be a list of objects")
            continue
        for number, row in enumerate(rows):
            line = lines.get((kind, number), 0)
            columns = {}
            for name, value in row.items():
                if isinstance(value, bool):
                    columns[name] = "yes" if value else "no"
                elif isinstance(value, str):
                    columns[name] = value.strip()
                elif value is not None:
                    reading.complain(line, f"{name} must be text, a number, true or false")
            reading.entries.append(Entry(kind, line, {n: v for n, v in columns.items() if v}))


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        names = [name for name, _ in pairs]
        raise _UnusableError(
            f"{next(n for n in names if names.count(n) > 1)} is given twice in one object"
        )
    return found


def _no_number(word: str) -> Any:
    raise _UnusableError(f"{word} is no number")


_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[{}\[\]]')


def _lines(text: str) -> dict[tuple[str, int], int]:
    """The line on which each object of each list of a well-formed file begins."""
    found: dict[tuple[str, int], int] = {}
    line, at, depth, number = 1, 0, 0, 0
    key = ""
    for token in _tokens(text):
        word = token.group()
        line += text.count("\n", at, token.start())
        at = token.start()
        if word[0] == '"':
            key = str(json.loads(word)) if depth == 1 else key
        elif word in "{[":
            if depth == 2:
                found[key, number] = line
                number += 1
            depth += 1
        else:
            depth -= 1
            number = 0 if depth == 1 else number
    return found


def _tokens(text: str) -> Iterator[re.Match[str]]:
    return _TOKEN.finditer(text)
