# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Ada that people wrote as text with places: subprograms, and what they consist of.

Only the layout of the project's own style is understood: three spaces a level, one
statement after another, `end Name;` below its subprogram.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Span:
    """A piece of a text, by its offsets."""

    start: int
    end: int

    def of(self, text: str) -> str:
        """What stands there."""
        return text[self.start : self.end]


@dataclass(frozen=True, slots=True)
class Edit:
    """Text in place of a span."""

    span: Span
    text: str


def replaced(span: Span, text: str) -> tuple[Edit, ...]:
    """One edit."""
    return (Edit(span, text),)


def edited(text: str, edits: tuple[Edit, ...]) -> str:
    """The text with its edits."""
    for edit in sorted(edits, key=lambda e: -e.span.start):
        text = text[: edit.span.start] + edit.text + text[edit.span.end :]
    return text


@dataclass(frozen=True, slots=True)
class WrittenBody:
    """One subprogram with a body: its statements, or the expression in its parentheses."""

    name: str
    whole: Span
    inner: Span
    is_expression: bool


def written_bodies(text: str) -> list[WrittenBody]:
    """Every subprogram that has a body in this text, in order."""
    found = []
    for match in re.finditer(r"^( *)(?:procedure|function) ([\w.]+)", text, re.M):
        one = _block(text, match) or _expression(text, match)
        if one is not None:
            found.append(one)
    return found


def _block(text: str, match: re.Match[str]) -> WrittenBody | None:
    indent, name = match.group(1), match.group(2)
    stop = re.compile(rf"^{indent}(?:procedure|function|package|end)\b.*$", re.M)
    end = stop.search(text, match.end())
    if end is None or end.group(0) != f"{indent}end {name};":
        return None
    begin = re.compile(rf"^{indent}begin\n", re.M).search(text, match.end(), end.start())
    if begin is None:
        return None
    inner = Span(begin.end(), end.start())
    return WrittenBody(name, Span(match.start(), end.end()), inner, False)


def _expression(text: str, match: re.Match[str]) -> WrittenBody | None:
    stop = _end_of_declaration(text, match.end())
    opening = re.compile(r"\bis\s+\(").search(text, match.end(), stop)
    if opening is None:
        return None
    inner = Span(opening.end(), _closing(text, opening.end() - 1))
    return WrittenBody(match.group(2), Span(match.start(), stop), inner, True)


def _end_of_declaration(text: str, start: int) -> int:
    depth = 0
    for offset in range(start, len(text)):
        if text[offset] == ";" and depth == 0:
            return offset + 1
        depth += (text[offset] == "(") - (text[offset] == ")")
    return len(text)


def _closing(text: str, opening: int) -> int:
    """The offset of the parenthesis that closes the one at ``opening``."""
    depth = 0
    for offset in range(opening, len(text)):
        depth += (text[offset] == "(") - (text[offset] == ")")
        if depth == 0:
            return offset
    raise ValueError("unbalanced parentheses")
