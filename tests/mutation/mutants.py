# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a mutant is, and how a few of many are chosen."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random
from typing import Literal

from .source import Span

Part = Literal["code", "declared", "model"]
"""What is broken: generated code, the chart as it is declared there, or the model."""

Files = Mapping[str, str]
"""File name to text: the generated program."""

NOTE = "Ravenchart.Steps.Note"
"""Only programs for simulation say what they execute; no rule changes that."""


@dataclass(frozen=True, slots=True)
class Edit:
    """Text in place of a span."""

    span: Span
    text: str


@dataclass(frozen=True, slots=True)
class Mutant:
    """One small break: its kind, its part, and the edits of one file.

    ``place`` names the subprogram or declaration; ``ordinal`` counts the mutants that
    one rule makes of one place, so that the same break is found in the program for
    simulation.
    """

    kind: str
    part: Part
    file: str
    place: str
    rule: str
    ordinal: int
    edits: tuple[Edit, ...]

    @property
    def key(self) -> tuple[str, str, str, str, int]:
        """What tells it from the others."""
        return (self.kind, self.file, self.place, self.rule, self.ordinal)

    @property
    def row(self) -> str:
        """Kind and part, as the report has them."""
        return self.kind if self.part == "code" else f"{self.kind}, {self.part}"

    @property
    def name(self) -> str:
        """For people."""
        return f"{self.place}: {self.rule} {self.ordinal}"

    def applied(self, text: str) -> str:
        """The broken text."""
        for edit in sorted(self.edits, key=lambda e: -e.span.start):
            text = text[: edit.span.start] + edit.text + text[edit.span.end :]
        return text

    def diff(self, text: str) -> str:
        """What changed, without line numbers."""
        rows = difflib.unified_diff(
            text.splitlines(), self.applied(text).splitlines(), n=2, lineterm=""
        )
        return "\n".join(r for r in rows if not r.startswith(("---", "+++", "@@")))


Found = tuple[str, str, tuple[Edit, ...]]
"""What a rule yields: place, rule and edits."""
Rule = Callable[[str, Files], Iterator[Found]]
"""Finds its places in the file of that name; same text, same order."""


def numbered(kind: str, part: Part, file: str, found: Iterator[Found]) -> list[Mutant]:
    """Mutants of what a rule found, counted by place and rule."""
    counts: dict[tuple[str, str], int] = {}
    made = []
    for place, rule, edits in found:
        ordinal = counts.get((place, rule), 0) + 1
        counts[(place, rule)] = ordinal
        made.append(Mutant(kind, part, file, place, rule, ordinal, edits))
    return made


def sampled(mutants: Sequence[Mutant], limit: int | None, seed: int) -> list[Mutant]:
    """At most ``limit`` of each kind and part, always the same for a seed, in order."""
    if limit is None:
        return list(mutants)
    groups: dict[str, list[int]] = {}
    for index, mutant in enumerate(mutants):
        groups.setdefault(mutant.row, []).append(index)
    chosen: list[int] = []
    for row, group in sorted(groups.items()):
        rng = Random(f"{seed} {row}")
        chosen += rng.sample(group, min(limit, len(group)))
    return [mutants[i] for i in sorted(chosen)]


def matches(text: str, pattern: str) -> Iterator[re.Match[str]]:
    """Where a pattern is in a text; ^ and $ are the ends of lines."""
    return re.compile(pattern, re.M).finditer(text)


def replaced(span: Span, text: str) -> tuple[Edit, ...]:
    """One edit."""
    return (Edit(span, text),)


def swapped(text: str, one: Span, other: Span) -> tuple[Edit, ...]:
    """Two spans that change places."""
    return Edit(one, other.of(text)), Edit(other, one.of(text))
