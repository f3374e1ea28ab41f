# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks outside the regions: ceilings, the timing certificate, codecs, frames."""

from __future__ import annotations

import re
from collections.abc import Iterator

from ravenchart.gen.model.signals import FD_SIZES

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


def frame_in_code(file: str, files: Files) -> Iterator[Found]:
    """A frame that is sent or expected with another identifier, format, length or bit rate."""
    text = files[file]
    made = [s.name for s in subprograms(text) if s.name.startswith("Frame_Of_")]
    for one in subprograms(text):
        if one.name.startswith("Send_") and len(made) > 1:
            for match in re.compile(r"\bFrame_Of_\w+").finditer(
                text, one.whole.start, one.whole.end
            ):
                new = made[(made.index(match.group()) + 1) % len(made)]
                yield one.name, "message", replaced(Span(*match.span()), new)
        if re.search(r"\w+_Frame\s+\(Id =>", one.inner.of(text)):
            yield from _frames(files, file, one.name, one.inner, *_IN_AGGREGATE)
        elif one.name == "Run_Receive":
            expected = r"\.Id \(Frame\)\s+= ([\w.]+)", r"Carries\s+\(Frame,\s+[\w.]+,\s+([\w.]+)\)"
            yield from _frames(files, file, one.name, one.inner, *expected)
        elif one.name == "Accepts":
            yield from _identifiers(files, file, one.name, one.inner, r"\bId\s+in\s+([\w.]+)")


_IN_AGGREGATE = r"\bId => ([\w.]+)", r"\bLength => ([\w.]+)"


def frame_declared(file: str, files: Files) -> Iterator[Found]:
    """A row of the layout table that says so of a frame."""
    for match in matches(files[file], r"^   (Frame_\w+) : constant Row_Of_Frame :=[^;]*;"):
        yield from _frames(files, file, match.group(1), Span(*match.span()), *_IN_AGGREGATE)


def _number(files: Files, shown: str) -> int:
    """A literal's value, or that of a fact of the certificate."""
    if not shown[0].isdigit():
        named = rf"\b{shown.rpartition('.')[2]} : constant := ([\w#]+);"
        stated = (re.search(named, text) for text in files.values())
        shown = next(found.group(1) for found in stated if found is not None)
    plain = shown.replace("_", "")
    return int(plain[3:-1], 16) if plain.startswith("16#") else int(plain)


def _frames(
    files: Files, file: str, place: str, where: Span, identifier: str, length: str
) -> Iterator[Found]:
    text = files[file]
    yield from _identifiers(files, file, place, where, identifier)
    for match in re.compile(length).finditer(text, where.start, where.end):
        at = FD_SIZES.index(_number(files, match.group(1)))
        if at > 0:
            yield place, "short", replaced(Span(*match.span(1)), str(FD_SIZES[at - 1]))
        if at + 1 < len(FD_SIZES):
            yield place, "long", replaced(Span(*match.span(1)), str(FD_SIZES[at + 1]))
    for what, one, other in (
        ("format", "Can.Standard", "Can.Extended"),
        ("family", "Any_Frames.Classic", "Any_Frames.Flexible"),
        ("rate", "Fd_Frames.Constant_Rate", "Fd_Frames.Switched_Rate"),
    ):
        both = re.compile(rf"\b(?:{re.escape(one)}|{re.escape(other)})\b")
        for match in both.finditer(text, where.start, where.end):
            new = other if match.group() == one else one
            yield place, what, replaced(Span(*match.span()), new)


def _identifiers(files: Files, file: str, place: str, where: Span, pattern: str) -> Iterator[Found]:
    text = files[file]
    for match in re.compile(pattern).finditer(text, where.start, where.end):
        other = _number(files, match.group(1)) ^ 1
        yield place, "identifier", replaced(Span(*match.span(1)), str(other))
