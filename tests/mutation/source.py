# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Generated Ada as text with places: subprograms, statements, arms of a case, branches of an if.

Only the layout of the project's own printer is understood: three spaces a level, one
statement after another, `end Name;` below its subprogram.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_CLOSERS = ("then", "else", "elsif", "end", "when", "loop", "is", "begin")


@dataclass(frozen=True, slots=True)
class Span:
    """A piece of a text, by its offsets."""

    start: int
    end: int

    def of(self, text: str) -> str:
        """What stands there."""
        return text[self.start : self.end]


@dataclass(frozen=True, slots=True)
class Subprogram:
    """One subprogram with a body: its statements, or the expression in its parentheses."""

    name: str
    line: int
    whole: Span
    inner: Span
    is_expression: bool

    @property
    def fires(self) -> bool:
        """Is it Fire, or one of the procedures that do a part of it in a large region?"""
        return self.name == "Fire" or self.name.startswith("Fire_From_")


@dataclass(frozen=True, slots=True)
class Branch:
    """A condition (empty for the last) and the value or choice behind it."""

    head: Span
    body: Span


def subprograms(text: str) -> list[Subprogram]:
    """Every subprogram that has a body in this file, in order."""
    found = []
    for match in re.finditer(r"^( *)(?:procedure|function) (\w+)", text, re.M):
        one = _block(text, match) or _expression(text, match)
        if one is not None:
            found.append(one)
    return found


def subprogram(text: str, name: str) -> Subprogram | None:
    """The one of that name, or None."""
    return next((s for s in subprograms(text) if s.name == name), None)


def _line(text: str, offset: int) -> int:
    return text.count("\n", 0, offset) + 1


def _block(text: str, match: re.Match[str]) -> Subprogram | None:
    indent, name = match.group(1), match.group(2)
    stop = re.compile(rf"^{indent}(?:procedure|function|package|end)\b.*$", re.M)
    end = stop.search(text, match.end())
    if end is None or end.group(0) != f"{indent}end {name};":
        return None
    begin = re.compile(rf"^{indent}begin\n", re.M).search(text, match.end(), end.start())
    if begin is None:
        return None
    inner = Span(begin.end(), end.start())
    whole = Span(match.start(), end.end())
    return Subprogram(name, _line(text, match.start()), whole, inner, False)


def _expression(text: str, match: re.Match[str]) -> Subprogram | None:
    stop = _end_of_declaration(text, match.end())
    opening = re.compile(r"\bis\s+\(").search(text, match.end(), stop)
    if opening is None:
        return None
    inner = Span(opening.end(), _closing(text, opening.end() - 1))
    return Subprogram(
        match.group(2), _line(text, match.start()), Span(match.start(), stop), inner, True
    )


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


def statements(text: str, inner: Span) -> list[Span]:
    """The statements that stand directly in a list of statements."""
    found: list[Span] = []
    indent: str | None = None
    for start, line in _lines(text, inner):
        word = line.strip()
        if not word or word.startswith("--"):
            continue
        here = line[: len(line) - len(line.lstrip())]
        if indent is None:
            indent = here
        opens = here == indent and not word.startswith(_CLOSERS)
        if opens:
            found.append(Span(start + len(here), start + len(line)))
        elif found:
            found[-1] = Span(found[-1].start, start + len(line))
    return found


def _lines(text: str, inner: Span) -> Iterator[tuple[int, str]]:
    offset = inner.start
    for line in inner.of(text).splitlines():
        yield offset, line
        offset += len(line) + 1


def arms(text: str, statement: Span) -> list[Branch]:
    """The arms of the case statement that starts there: their choices, their statements."""
    start = text.rfind("\n", 0, statement.start) + 1
    indent = " " * (statement.start - start)
    last = text.find(f"\n{indent}end case;", statement.start) + 1
    mark = re.compile(rf"^{indent}   when ([^=]*?)\s=>\n", re.M)
    marks = list(mark.finditer(text, statement.start, last))
    ends = [*(m.start() for m in marks[1:]), last]
    return [Branch(Span(*m.span(1)), Span(m.end(), e)) for m, e in zip(marks, ends, strict=True)]


def _tokens(text: str, inner: Span) -> list[tuple[str, Span]]:
    """The words of conditional expressions and separators at the outermost depth."""
    depth = 0
    found = []
    word = re.compile(r"[()]|\b(?:and\s+then|or\s+else|if|then|elsif|else|when|case)\b|=>|,")
    for match in word.finditer(text, inner.start, inner.end):
        what = match.group(0)
        if what in "()":
            depth += 1 if what == "(" else -1
        elif depth == 0:
            found.append((" ".join(what.split()), Span(*match.span())))
    return found


def _trimmed(text: str, start: int, end: int) -> Span:
    piece = text[start:end]
    return Span(start + len(piece) - len(piece.lstrip()), start + len(piece.rstrip()))


def branches(text: str, inner: Span) -> list[Branch]:
    """The branches of an if expression, `else` last with an empty head; none of another."""
    keys = [t for t in _tokens(text, inner) if t[0] in ("if", "then", "elsif", "else")]
    if not keys or keys[0][0] != "if" or keys[0][1].start != _trimmed(text, *_pair(inner)).start:
        return []
    found: list[Branch] = []
    head = Span(inner.start, inner.start)
    for (what, at), following in zip(keys, [*keys[1:], None], strict=True):
        end = following[1].start if following else inner.end
        piece = _trimmed(text, at.end, end)
        if what in ("if", "elsif"):
            head = piece
        else:
            found.append(Branch(head if what == "then" else Span(at.start, at.start), piece))
    return found


def choices(text: str, inner: Span) -> list[Branch]:
    """The alternatives of a case expression."""
    keys = [t for t in _tokens(text, inner) if t[0] in ("when", "=>", ",")]
    found: list[Branch] = []
    head = Span(inner.start, inner.start)
    for (what, at), following in zip(keys, [*keys[1:], None], strict=True):
        end = following[1].start if following else inner.end
        if what == "when":
            head = _trimmed(text, at.end, end)
        elif what == "=>":
            found.append(Branch(head, _trimmed(text, at.end, end)))
    return found


def declared_rows(text: str, function: str) -> list[Branch]:
    """The alternatives of the case of an expression function, whatever stands before it."""
    one = subprogram(text, function)
    if one is None:
        return []
    case = text.find("(case ", one.inner.start, one.inner.end)
    return choices(text, one.inner if case < 0 else Span(case + 1, one.inner.end - 1))


def conjuncts(text: str, inner: Span) -> list[Span]:
    """The parts of a condition, joined by `and then`."""
    keys = _tokens(text, inner)
    if any(what == "or else" for what, _ in keys):
        return [_trimmed(text, *_pair(inner))]
    cuts = [at for what, at in keys if what == "and then"]
    starts = [inner.start, *(at.end for at in cuts)]
    ends = [*(at.start for at in cuts), inner.end]
    return [_trimmed(text, s, e) for s, e in zip(starts, ends, strict=True)]


def _pair(span: Span) -> tuple[int, int]:
    return span.start, span.end
