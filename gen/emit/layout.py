"""Documents, and their layout within a width, after Wadler and Lindig.

A document is text, or parts that stand on one line or break at their soft places.
Each knows its text on one line from the start: where that fits, nothing more is done.
"""

from __future__ import annotations

from enum import Enum

STEP = 3
"""Columns of one level of indentation."""


class _Way(Enum):
    AS_AROUND = 0
    ONE_LINE_IF_IT_FITS = 1
    UPRIGHT = 2


#  read by the million in a large program, and a member of an enumeration is found slowly
_AS_AROUND, _ONE_LINE_IF_IT_FITS, _UPRIGHT = _Way


class Parts:
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


Doc = str | Parts

SOFT = Parts((" ",))
"""A blank, or the place where a line ends."""


def cat(*docs: Doc) -> Doc:
    """One after the other."""
    return Parts(docs)


def nest(*docs: Doc, by: int = STEP) -> Doc:
    """The same, later lines ``by`` columns further in."""
    return Parts(docs, by)


def group(*docs: Doc) -> Doc:
    """On one line where it fits; otherwise every soft place that no inner group holds breaks."""
    return Parts(docs, 0, _ONE_LINE_IF_IT_FITS)


def upright(*docs: Doc) -> Doc:
    """Every soft place that no inner group holds breaks."""
    return Parts(docs, 0, _UPRIGHT)


def laid_out(doc: Doc, width: int) -> str:
    """The text of ``doc`` in lines of ``width`` columns, as far as its soft places allow that."""
    out: list[str] = []
    _put(out, Parts((group(doc),)), width, 0, 0, True)
    return "".join(out)


def _put(out: list[str], doc: Parts, width: int, column: int, indent: int, broken: bool) -> int:
    """Add a document that begins in ``column``; the column behind it."""
    indent += doc.step
    for part in doc.parts:
        if isinstance(part, str):
            out.append(part)
            column += len(part)
            continue
        if part is SOFT and broken:
            out.append("\n" + " " * indent)
            column = indent
            continue
        on_one_line = not broken
        if part.way is not _AS_AROUND:
            on_one_line = part.way is not _UPRIGHT and (
                on_one_line or len(part.flat) <= width - column
            )
        if on_one_line and not part.has_upright:
            out.append(part.flat)
            column += len(part.flat)
        else:
            column = _put(out, part, width, column, indent, not on_one_line)
    return column
