# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The text form of MAST models (1.7): read into objects, and printed from them.

A model is a sequence of ``Kind ( Attribute => Value, ... );``. A value is a word, an
object ``( Attribute => Value, ... )`` or a list ``( Value, ... )``. Case does not count;
``--`` begins a comment.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

Value: TypeAlias = "str | tuple[Value, ...] | Attributes"

WIDTH = 100
"""Longer lines are broken; MAST reads up to 1,000 characters."""

DEPTH = 50
"""Parentheses may be nested as deep."""


@dataclass(frozen=True, slots=True)
class Attributes:
    """Attributes with their values, in order."""

    pairs: tuple[tuple[str, Value], ...]

    def get(self, name: str) -> Value | None:
        """The value of an attribute; None where there is none."""
        return next((value for key, value in self.pairs if key.lower() == name.lower()), None)

    def word(self, name: str) -> str:
        """An attribute that is a word; KeyError where there is none."""
        found = self.get(name)
        if not isinstance(found, str):
            raise KeyError(name)
        return found


@dataclass(frozen=True, slots=True)
class MastObject:
    """One object of a model."""

    kind: str
    attributes: Attributes


_TOKEN = re.compile(r'\s+|--[^\n]*|=>|[(),;]|"[^"\n]*"|[A-Za-z0-9_.%+-]+')


def parse(text: str) -> tuple[MastObject, ...]:
    """The objects of a model; ValueError, with the line, where the text is not one."""
    reader = _Reader(text)
    found = []
    while reader.next is not None:
        kind = reader.word()
        value = reader.value(0)
        if not isinstance(value, Attributes):
            raise reader.wrong("attributes")
        reader.take(";")
        found.append(MastObject(kind, value))
    return tuple(found)


class _Reader:
    """The tokens of a text, one ahead."""

    def __init__(self, text: str) -> None:
        self.line = 1
        self.tokens = self._tokens(text)
        self.next: str | None = next(self.tokens, None)

    def _tokens(self, text: str) -> Iterator[str]:
        at = 0
        while at < len(text):
            match = _TOKEN.match(text, at)
            if match is None:
                raise ValueError(f"line {self.line}: {text[at]!r} has no meaning")
            word = match.group()
            if not word.isspace() and not word.startswith("--"):
                yield word
            self.line += word.count("\n")
            at = match.end()

    def wrong(self, wanted: str) -> ValueError:
        """The error for an unexpected token."""
        return ValueError(f"line {self.line}: {wanted} expected, not {self.next or 'the end'}")

    def take(self, token: str) -> None:
        """Go over this token."""
        if self.next != token:
            raise self.wrong(token)
        self.next = next(self.tokens, None)

    def word(self) -> str:
        """Go over a word, without its quotes."""
        found = self.next
        if found is None or found in ("(", ")", ",", ";", "=>"):
            raise self.wrong("a word")
        self.next = next(self.tokens, None)
        return found.strip('"')

    def value(self, depth: int) -> Value:
        """Go over a value."""
        if self.next != "(":
            return self.word()
        if depth > DEPTH:
            raise ValueError(f"line {self.line}: parentheses are nested too deeply")
        self.take("(")
        pairs: list[tuple[str, Value]] = []
        values: list[Value] = []
        while True:
            first = self.value(depth + 1)
            if isinstance(first, str) and self.next == "=>":
                self.take("=>")
                pairs.append((first, self.value(depth + 1)))
            else:
                values.append(first)
            if self.next != ",":
                break
            self.take(",")
        self.take(")")
        if pairs and values:
            raise ValueError(f"line {self.line}: a list holds attributes and values")
        return Attributes(tuple(pairs)) if pairs else tuple(values)


def printed_model(objects: tuple[MastObject, ...]) -> str:
    """The text of a model."""
    blocks = [f"{one.kind} {_text(one.attributes, 0)};\n" for one in objects]
    return "\n".join(blocks)


def _text(value: Value, indent: int) -> str:
    """A value on one line where it fits, else an element a line."""
    if isinstance(value, str):
        return value
    margin = indent + 3
    if isinstance(value, Attributes):
        parts = [f"{key} => {_text(inner, margin + 3)}" for key, inner in value.pairs]
    else:
        parts = [_text(inner, margin) for inner in value]
    line = f"( {', '.join(parts)} )"
    if "\n" not in line and indent + len(line) <= WIDTH and indent:
        return line
    return "(\n" + ",\n".join(" " * margin + part for part in parts) + " )"
