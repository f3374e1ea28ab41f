"""Breaks outside the regions: ceilings, the timing certificate, codecs."""

from __future__ import annotations

import re
from collections.abc import Iterator

from .mutants import Files, Found, matches, replaced
from .source import Span, Subprogram, subprograms


def ceiling(file: str, files: Files) -> Iterator[Found]:
    """A protected object whose ceiling is one too low."""
    text = files[file]
    for match in matches(text, r"Ceiling => System\.Default_Priority \+ (\d+)"):
        package = re.findall(r"package (\w+) is new", text[: match.start()])[-1]
        lower = int(match.group(1)) - 1
        yield package, "lower", replaced(Span(*match.span(1)), str(lower))


def certificate(file: str, files: Files) -> Iterator[Found]:
    """A claimed response time, a budget or a deadline that does not hold."""
    text = files[file]
    for match in matches(text, r"^   (\w+)_(R|D|Budget) : constant :=\s+([\d_]+);"):
        name, what, value = match.group(1), match.group(2), int(match.group(3).replace("_", ""))
        if what == "R":
            yield name, "bound", replaced(Span(*match.span(3)), str(value - 1))
        elif what == "D":
            claimed = re.search(rf"^   {name}_R : constant :=\s+([\d_]+);", text, re.M)
            if claimed:
                least = int(claimed.group(1).replace("_", ""))
                yield name, "deadline", replaced(Span(*match.span(3)), str(least - 1))
        else:
            yield name, "budget", replaced(Span(*match.span(3)), str(value + 1))


def codec_in_code(file: str, files: Files) -> Iterator[Found]:
    """A field at another bit, a value by another offset, one field for another."""
    text = files[file]
    for one in subprograms(text):
        if one.is_expression:
            for match in re.compile(r"Shift_Left \([^;]*?, (\d+)\)").finditer(
                text, one.inner.start, one.inner.end
            ):
                new = str(int(match.group(1)) + 1)
                yield one.name, "bit", replaced(Span(*match.span(1)), new)
        if one.name.startswith("Bits_Of_"):
            yield from _offsets(text, one)


def _offsets(text: str, one: Subprogram) -> Iterator[Found]:
    """What is added to or taken from a value is one more."""
    offset = re.compile(r" [-+] (\d[\d_]*)")
    for match in offset.finditer(text, one.whole.start, one.whole.end):
        more = int(match.group(1).replace("_", "")) + 1
        yield one.name, "offset", replaced(Span(*match.span(1)), str(more))


def codec_declared(file: str, files: Files) -> Iterator[Found]:
    """A field that is declared at another bit or of another width."""
    text = files[file]
    for one in subprograms(text):
        if not one.is_expression:
            continue
        if one.name.endswith("_Of_Bits"):
            yield from _offsets(text, one)
        inner = one.inner
        for match in re.compile(r"Shift_Right \(Word, (\d+)\)").finditer(
            text, inner.start, inner.end
        ):
            new = str(int(match.group(1)) + 1)
            yield one.name, "bit", replaced(Span(*match.span(1)), new)
        for match in re.compile(r"and 16#([0-9A-F_]+)#").finditer(text, inner.start, inner.end):
            new = f"{int(match.group(1).replace('_', ''), 16) >> 1:X}"
            yield one.name, "width", replaced(Span(*match.span(1)), new)
