# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Documents, and their layout within a width, after Wadler and Lindig.

A document is text, or parts that stand on one line or break at their soft places.
Each knows its text on one line from the start: where that fits, nothing more is done.
"""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum

STEP = 3
"""Columns of one level of indentation."""


class _Way(Enum):
    AS_AROUND = 0
    ONE_LINE_IF_IT_FITS = 1
    UPRIGHT = 2


#  read by the million in a large program, and a member of an enumeration is found slowly
_AS_AROUND, _ONE_LINE_IF_IT_FITS, _UPRIGHT = _Way


class LaidParts:
    """Documents one after the other; use `cat`, `nest`, `group` and `upright` to make them."""

    __slots__ = ("flat", "has_upright", "parts", "step", "way")

    def __init__(self, parts: tuple[Doc, ...], step: int = 0, way: _Way = _AS_AROUND) -> None:
        """Parts indented by ``step`` columns after each break."""
        self.parts = parts
        self.step = step
        self.way = way
        flat = ""
        has_upright = way is _UPRIGHT
        for part in parts:
            if isinstance(part, str):
                flat += part
            else:
                flat += part.flat
                if part.has_upright:
                    has_upright = True
        self.flat: str = flat
        self.has_upright: bool = has_upright


Doc = str | LaidParts

SOFT = LaidParts((" ",))
"""A blank, or the place where a line ends."""
CUT = LaidParts(("",))
"""Nothing, or the place where a line ends."""


def pad(columns: int) -> Doc:
    """Blanks where the lines around it break, and nothing on one line."""
    doc = LaidParts((" " * columns,))
    doc.flat = ""
    return doc


def cat(*docs: Doc) -> Doc:
    """One after the other."""
    return LaidParts(docs)


def nest(*docs: Doc, by: int = STEP) -> Doc:
    """The same, later lines ``by`` columns further in."""
    return LaidParts(docs, by)


def group(*docs: Doc) -> Doc:
    """On one line where it fits; otherwise every soft place that no inner group holds breaks."""
    return LaidParts(docs, 0, _ONE_LINE_IF_IT_FITS)


def upright(*docs: Doc) -> Doc:
    """Every soft place that no inner group holds breaks."""
    return LaidParts(docs, 0, _UPRIGHT)


def joined(docs: Sequence[Doc], separator: str = "") -> list[Doc]:
    """The documents with a separator and a soft place between them."""
    between = (separator, SOFT) if separator else (SOFT,)
    parts = [part for doc in docs for part in (doc, *between)]
    return parts[: -len(between)]


def stacked(docs: Sequence[Doc]) -> Doc:
    """Each on a line of its own, nested, with a line break before each."""
    return nest(*(part for doc in docs for part in (SOFT, doc)))


def filled(docs: Sequence[Doc], separator: str = ",") -> Doc:
    """The documents with a separator, as many on a line as it holds."""
    *others, last = docs
    first, *rest = [*(cat(doc, separator) for doc in others), last]
    return cat(first, *(group(SOFT, doc) for doc in rest))


def parenthesized(*docs: Doc) -> Doc:
    """Between parentheses, one column in."""
    return group("(", nest(*docs, by=1), ")")


def laid_out(doc: Doc, width: int) -> str:
    """The text of ``doc`` in lines of ``width`` columns, as far as its soft places allow that."""
    out: list[str] = []
    _put(out, LaidParts((group(doc),)), width, 0, 0, True, 0)
    return "".join(out)


MARGIN = 3
"""Columns beyond the width that are there for what closes, such as `);`."""
NEAR = 40
"""So near to the end of a line what stands behind a group is counted with it."""


def _head(doc: Doc) -> tuple[int, bool]:
    """Columns up to the first soft place of a document, and whether it has one."""
    if isinstance(doc, str):
        return len(doc), False
    if doc is SOFT or doc is CUT:
        return 0, True
    columns = 0
    for part in doc.parts:
        more, ends = _head(part)
        columns += more
        if ends:
            return columns, True
    return columns, False


def _behind(parts: tuple[Doc, ...], broken: bool, outside: int) -> int:
    """Columns that stand on the same line in any case; ``outside`` is behind all the parts."""
    columns = 0
    for part in parts:
        if (part is SOFT or part is CUT) and not broken:
            columns += len(part.flat)
            continue
        more, ends = _head(part)
        columns += more
        if ends:
            return columns
    return columns + outside


def _put(
    out: list[str], doc: LaidParts, width: int, column: int, indent: int, broken: bool, outside: int
) -> int:
    """Add a document that begins in ``column``; the column behind it.

    ``outside`` columns of text follow on its last line in any case.
    """
    indent += doc.step
    for index, part in enumerate(doc.parts):
        if isinstance(part, str):
            out.append(part)
            column += len(part)
            continue
        if (part is SOFT or part is CUT) and broken:
            out.append("\n" + " " * indent)
            column = indent
            continue
        on_one_line = not broken
        if part.way is not _AS_AROUND:
            room = width - column - len(part.flat)
            on_one_line = part.way is not _UPRIGHT and (
                on_one_line
                or room >= NEAR
                or (room >= 0 and room + MARGIN >= _behind(doc.parts[index + 1 :], broken, outside))
            )
        if on_one_line and not part.has_upright:
            out.append(part.flat)
            column += len(part.flat)
        else:
            behind = _behind(doc.parts[index + 1 :], broken, outside)
            column = _put(out, part, width, column, indent, not on_one_line, behind)
    return column
