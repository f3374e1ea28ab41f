# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of the facts that the timing certificate states and the code takes from it.

A fact is edited where the code uses it: a priority, a period, a row's divisor, an identifier.
In the certificate, terms are taken out of its sums, and what they suppose is edited.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import pairwise

from .mutants import Edit, Files, Found, matches, replaced, swapped
from .source import Span, subprograms

OTHER_ID = "16#7E0#"
"""An identifier that no message of the subjects has."""

_FACT = r"Timing_Certificate\s*\.\s*\w+"


def _edited(text: str, name: str, new: str) -> Iterator[tuple[Edit, ...]]:
    """Each actual parameter of that name with ``new`` in its place; {} is what was there."""
    for match in matches(text, rf"\b{name} =>\s*({_FACT}|\d[\d_]*)"):
        yield replaced(Span(*match.span(1)), new.format(match.group(1)))


def _priorities(files: Files) -> dict[str, int]:
    """The priorities that tasks of this program are given, and their levels."""
    used = {m.group(2) for text in files.values() for m in matches(text, _PRIORITY)}
    return {
        match.group(1): int(match.group(2))
        for name in sorted(files)
        if name.endswith("-timing_certificate.ads")
        for match in matches(files[name], _LEVEL)
        if match.group(1) in used
    }


_LEVEL = r"^   (\w+_Priority) : constant :=\s+System\.Default_Priority \+ (\d+);"
_PRIORITY = r"\b(Task|Driver|Probe)_Priority =>\s*Timing_Certificate\.(\w+)"


def task(file: str, files: Files) -> Iterator[Found]:
    """A task with another priority, period, deadline, separation or offset."""
    text = files[file]
    levels = _priorities(files)
    for match in matches(text, _PRIORITY):
        span, own = Span(*match.span(2)), match.group(2)
        for rule, new in (("higher", f"{own} + 1"), ("lower", f"{own} - 1")):
            yield "priority", rule, replaced(span, new)
        for other in levels:
            if levels[other] != levels[own]:
                yield "priority", f"of {other}", replaced(span, other)
        bottom = Span(match.start(2) - len("Timing_Certificate."), match.end(2))
        yield "priority", "bottom", replaced(bottom, "1")
    for name in ("Period", "Deadline", "Minimum_Separation"):
        for new in ("1_234_567", "2 * {}"):
            for edits in _edited(text, name, new):
                yield name.lower(), new.format(name), edits
    for edits in _edited(text, "Offset", "1_000_000"):
        yield "offset", "later", edits


def table(file: str, files: Files) -> Iterator[Found]:
    """A row of a table in other releases."""
    for name in ("Divisor", "Phase"):
        for edits in _edited(files[file], name, "{} + 1"):
            yield "table", name.lower(), edits
    for match in matches(files[file], r"\bCycle => ([2-9]|\d\d+)"):
        yield "table", "cycle", replaced(Span(*match.span(1)), f"{match.group(1)} + 1")


def bus(file: str, files: Files) -> Iterator[Found]:
    """Another bit rate, or another identifier or length that is sent or expected."""
    text = files[file]
    for edits in _edited(text, "Bit_Rate", "{} / 2"):
        yield "bus", "bit rate", edits
    for edits in _edited(text, "Id", OTHER_ID):
        yield "bus", "id sent", edits
    for edits in _edited(text, "Length", "{} + 1"):
        yield "bus", "length sent", edits
    for match in matches(text, r"(?:\bin|=)\s+(Timing_Certificate\.\w+_Id)\b"):
        yield "bus", "id expected", replaced(Span(*match.span(1)), OTHER_ID)
    for match in matches(text, r"(Timing_Certificate\.\w+_Length)\)"):
        yield "bus", "length expected", replaced(Span(*match.span(1)), f"{match.group(1)} + 1")


def calls(file: str, files: Files) -> Iterator[Found]:
    """A row that is executed twice, not at all, or in place of another one."""
    text = files[file]
    for one in subprograms(text):
        if one.name != "Execute":
            continue
        calling = re.compile(r"[\w.]+\.Run_\w+ \(Executed\);")
        found = calling.finditer(text, one.inner.start, one.inner.end)
        rows = [Span(*match.span()) for match in found]
        for row in rows:
            yield "Execute", "twice", replaced(row, f"{row.of(text)} {row.of(text)}")
            yield "Execute", "not at all", replaced(row, "null;")
        for row, other in pairwise(rows):
            yield "Execute", "other row", replaced(row, other.of(text))


def sums(file: str, files: Files) -> Iterator[Found]:
    """A term less in a sum of the certificate."""
    text = files[file]
    for match in matches(text, r"^   (\w+)_B : constant :=\s+(\w+_Critical_Section);"):
        yield match.group(1), "blocking", replaced(Span(*match.span(2)), "0")
    for match in matches(text, r"^   (\w+)_Needs(?:_\w+)? : constant :=([^;]*?\n     \+[^;]*);"):
        term = match.group(2).rindex("\n     + ")
        yield (
            match.group(1),
            "interference",
            replaced(Span(match.start(2) + term, match.end(2)), ""),
        )
    for match in matches(text, r"^   function (\w+) \(W : Window\)[^;]*?(,\s+\w+ \(W\))\)+\s"):
        yield match.group(1), "interference", replaced(Span(*match.span(2)), "")
    for match in matches(text, r"^   (\w+)_C(?:_\d+)? : constant :=\s+(\w+_Budget\s+\+ )"):
        yield match.group(1), "budget", replaced(Span(*match.span(2)), "")


def supposed(file: str, files: Files) -> Iterator[Found]:
    """What the sums of the certificate suppose is edited: order, divisor, length, bit rate."""
    text = files[file]
    used = _priorities(files)
    found = [m for m in matches(text, _LEVEL) if m.group(1) in used]
    found.sort(key=lambda match: int(match.group(2)))
    for one, other in pairwise(found):
        if one.group(2) != other.group(2):
            spans = Span(*one.span(2)), Span(*other.span(2))
            yield one.group(1), "swapped", swapped(text, *spans)
            yield one.group(1), "level", replaced(spans[0], other.group(2))
    for what in ("Divisor", "Length"):
        for match in matches(text, rf"^   (\w+)_{what} : constant := (\d+);"):
            more = str(int(match.group(2)) + 1)
            yield match.group(1), what.lower(), replaced(Span(*match.span(2)), more)
    for match in matches(text, r"^   (\w+)_Bit_Rate : constant := ([\d_]+);"):
        yield match.group(1), "bit rate", replaced(Span(*match.span(2)), f"{match.group(2)} / 2")
    identifiers = list(matches(text, r"^   (\w+)_Id : constant := (16#\w+#);"))
    for first, second in pairwise(identifiers):
        spans = Span(*first.span(2)), Span(*second.span(2))
        yield first.group(1), "identifiers", swapped(text, *spans)
