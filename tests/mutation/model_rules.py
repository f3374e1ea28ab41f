# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of the model itself: what the model rules, or its expected steps, must notice."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from .mutants import Found
from .texts import Span, replaced

_MOVE = r"\bfrom: (?P<from>\w+)(?:,|\n)\s*to: (?P<to>\w+)\b(?!\.)"


def _others(text: str, pattern: str, group: str | int, place: str) -> Iterator[Found]:
    """Each match with what stands in the next one instead."""
    found = list(re.finditer(pattern, text))
    names = list(dict.fromkeys(m.group(group) for m in found))
    for match in found:
        new = names[(names.index(match.group(group)) + 1) % len(names)]
        if new != match.group(group):
            yield place, "other", replaced(Span(*match.span(group)), new)


def target(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """Another target of a transition, or another initial state."""
    yield from _others(files[file], _MOVE, "to", "to")
    yield from _others(files[file], r"\binitial: ([A-Z]\w*)", 1, "initial")


def source(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """Another source of a transition."""
    yield from _others(files[file], _MOVE, "from", "from")


def trigger(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """Another event as a trigger."""
    yield from _others(files[file], r"\bon: (\w+)", 1, "on")


def guard(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """A guard that is left out."""
    for match in re.finditer(r", guard: [^,}\n]+", files[file]):
        yield "guard", "drop", replaced(Span(*match.span()), "")


def history(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """Shallow instead of deep history."""
    for match in re.finditer(r"\bkind: (deep_)history", files[file]):
        yield "kind", "shallow", replaced(Span(*match.span(1)), "")


def deferral(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """Nothing is deferred."""
    for match in re.finditer(r"\bdefer: \[(\w+)\]", files[file]):
        yield "defer", "drop", replaced(Span(*match.span(1)), "")


def timeout(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """A time-out that is longer."""
    for match in re.finditer(r"\b(?:after|every): (\d+) m?s", files[file]):
        yield "after", "later", replaced(Span(*match.span(1)), str(2 * int(match.group(1))))


def period(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """A period that does not fit its table; that of a supervision stands in none."""
    for match in re.finditer(r"(?<!supervision: {)\bperiod: (\d+) ms", files[file]):
        yield "period", "odd", replaced(Span(*match.span(1)), str(int(match.group(1)) + 1))


def certificate(file: str, files: Mapping[str, str]) -> Iterator[Found]:
    """A budget that cannot be met."""
    for match in re.finditer(r"\bwcet: (\d+) us", files[file]):
        yield "wcet", "more", replaced(Span(*match.span(1)), str(200 * int(match.group(1))))
