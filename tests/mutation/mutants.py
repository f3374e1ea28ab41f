# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a mutant is, and how a few of many are chosen."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from random import Random
from typing import Literal, TypeVar

from ravenchart.gen.emit.ada.declarations import Unit
from ravenchart.gen.emit.ada.text import print_unit

from .nodes import Put, written
from .texts import Edit, edited

Part = Literal["code", "declared", "model"]
"""What is broken: generated code, the chart as it is declared there, or the model."""

Source = Unit | str
"""A generated unit, or the text of a file that people wrote."""
Files = Mapping[str, Source]
"""A program: its units and the files of its model, by their names."""
Units = Mapping[str, Unit]

T = TypeVar("T")


@lru_cache(maxsize=256)
def _printed(unit: Unit) -> str:
    return print_unit(unit)


def text_of(source: Source) -> str:
    """The text of a file."""
    return source if isinstance(source, str) else _printed(source)


@dataclass(frozen=True, slots=True)
class Mutant:
    """One small break: its kind, its part, and what is another in one file.

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
    changes: tuple[Put, ...] | tuple[Edit, ...]

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

    @property
    def puts(self) -> tuple[Put, ...]:
        """The other nodes of a unit."""
        return tuple(one for one in self.changes if isinstance(one, Put))

    def broken(self, source: Source) -> Source:
        """The broken file."""
        if isinstance(source, str):
            return edited(source, tuple(one for one in self.changes if isinstance(one, Edit)))
        return written(source, self.puts)

    def applied(self, source: Source) -> str:
        """Its text."""
        found = self.broken(source)
        return found if isinstance(found, str) else print_unit(found)

    def diff(self, source: Source) -> str:
        """What changed, without line numbers."""
        rows = difflib.unified_diff(
            text_of(source).splitlines(), self.applied(source).splitlines(), n=2, lineterm=""
        )
        return "\n".join(r for r in rows if not r.startswith(("---", "+++", "@@")))


Broken = tuple[str, str, tuple[Put, ...]]
"""What a rule over nodes yields: place, rule and changes."""
UnitRule = Callable[[str, Units], Iterator[Broken]]
"""Finds its places in the unit of that name; same unit, same order."""
Found = tuple[str, str, tuple[Edit, ...]]
"""What a rule over texts yields."""
TextRule = Callable[[str, Mapping[str, str]], Iterator[Found]]
"""Finds its places in the file of that name."""


def numbered(
    kind: str, part: Part, file: str, found: Iterator[Broken] | Iterator[Found]
) -> list[Mutant]:
    """Mutants of what a rule found, counted by place and rule."""
    counts: dict[tuple[str, str], int] = {}
    made = []
    for place, rule, changes in found:
        ordinal = counts.get((place, rule), 0) + 1
        counts[(place, rule)] = ordinal
        made.append(Mutant(kind, part, file, place, rule, ordinal, changes))
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
