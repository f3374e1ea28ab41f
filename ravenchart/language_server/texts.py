# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The text of a model file: its characters, the places of diagnostics, the positions of LSP.

A diagnostic counts lines where YAML breaks them, and characters. A position of the protocol counts
lines that end with CR, LF or both, and UTF-16 code units.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from functools import cached_property

from lsprotocol.types import Position, Range

from ravenchart.gen.files import spans
from ravenchart.gen.files.located import LINE_BREAK
from ravenchart.gen.files.spans import YamlMapping, YamlNode, YamlScalar
from ravenchart.gen.origins import Origin

_LINE_END = re.compile(r"\r\n|\r|\n")
_WORD = re.compile(r"\w+")

TextRange = tuple[int, int]
"""The first character, and the one behind the last."""


class FileText:
    """The text of one file."""

    def __init__(self, text: str) -> None:
        """That of a file, without a byte order mark."""
        self.text = text

    @cached_property
    def root(self) -> YamlMapping | None:
        """Its tree; None where it is not YAML, or not one mapping."""
        return spans.spans(self.text)

    @cached_property
    def scalars(self) -> list[YamlScalar]:
        """Keys and values, in order."""
        found = [] if self.root is None else list(_scalars(self.root))
        return sorted(found, key=lambda one: one.start)

    def scalar_at(self, offset: int) -> YamlScalar | None:
        """The key or value that holds a character, or ends before it."""
        index = bisect_right(self.scalars, offset, key=lambda one: one.start) - 1
        found = self.scalars[index] if index >= 0 else None
        return found if found is not None and offset <= found.end else None

    # --- Positions

    @cached_property
    def _yaml_lines(self) -> list[int]:
        return [0, *(found.end() for found in LINE_BREAK.finditer(self.text))]

    @cached_property
    def _lines(self) -> list[int]:
        return [0, *(found.end() for found in _LINE_END.finditer(self.text))]

    def offset(self, origin: Origin) -> int:
        """The character at which something begins."""
        lines = self._yaml_lines
        start = lines[min(origin.line, len(lines)) - 1]
        return min(start + origin.column - 1, len(self.text))

    def offset_of(self, position: Position) -> int:
        """The character at a position."""
        lines = self._lines
        if position.line >= len(lines):
            return len(self.text)
        start = lines[position.line]
        units = position.character
        for index, char in enumerate(self.text[start:]):
            if units <= 0 or char in "\r\n":
                return start + index
            units -= 1 + (ord(char) > 0xFFFF)
        return len(self.text)

    def position(self, offset: int) -> Position:
        """The position of a character."""
        line = bisect_right(self._lines, offset) - 1
        before = self.text[self._lines[line] : offset]
        return Position(line, len(before) + sum(ord(char) > 0xFFFF for char in before))

    def range(self, span: TextRange) -> Range:
        """The range of characters."""
        return Range(self.position(span[0]), self.position(span[1]))

    def marked(self, origin: Origin) -> Range:
        """The range that a diagnostic marks: its key or value, at least a word or character."""
        start = self.offset(origin)
        scalar = self.scalar_at(start)
        if scalar is not None and scalar.start <= start < scalar.end:
            first = self.text[start : scalar.end].splitlines()[0]
            return self.range((start, start + len(first)))
        word = _WORD.match(self.text, start)
        return self.range((start, word.end() if word else min(start + 1, len(self.text))))

    # --- Names

    def word(self, name: str, start: int, end: int) -> TextRange | None:
        """The first place of a name between two characters, without regard to case."""
        found = re.compile(rf"(?<!\w){re.escape(name)}(?!\w)", re.IGNORECASE).search(
            self.text, start
        )
        return None if found is None or found.end() > end else found.span()

    def array(self, name: str, start: int, end: int) -> TextRange | None:
        """The same for the name of an array, behind which stand `_` and a number or a star."""
        pattern = rf"(?<!\w){re.escape(name)}(?=_(?:\*|[0-9]+(?!\w)))"
        found = re.compile(pattern, re.IGNORECASE).search(self.text, start)
        return None if found is None or found.end() > end else found.span()


def _scalars(node: YamlNode) -> Iterator[YamlScalar]:
    match node:
        case YamlScalar():
            yield node
        case YamlMapping():
            for key, value in node.entries:
                yield key
                yield from _scalars(value)
        case spans.Sequence():
            for item in node.items:
                yield from _scalars(item)


def path_to(node: YamlNode, offset: int) -> list[tuple[YamlMapping, YamlScalar]]:
    """The mappings around a character, outermost first, each with the key that leads on."""
    match node:
        case YamlMapping():
            for key, value in node.entries:
                inside = path_to(value, offset)
                if inside:
                    return [(node, key), *inside]
                if key.start <= offset <= key.end or value.start <= offset <= value.end:
                    return [(node, key)]
        case spans.Sequence():
            for item in node.items:
                inside = path_to(item, offset)
                if inside:
                    return inside
    return []
