# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded values in their units: literals by name, and what one count of an integer stands for."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Decimal
from itertools import pairwise
from operator import itemgetter

from ravenchart.analysis.system.observed import VALUE, Observation
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.language.units import count_of

Point = tuple[Ns, int]
"""A value as the program holds it, and when it was recorded."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """The meaning of the numbers of a recorded value."""

    literals: tuple[str, ...]
    """Of an enumeration; the number is a position among them."""
    count: Decimal
    """The size of one count of an integer, in the ``unit``."""
    unit: str

    @staticmethod
    def of(literals: Sequence[str], unit: str | None) -> Quantity:
        """By the literals of its type, or the unit."""
        count, base = count_of(unit)
        return Quantity(tuple(literals), count, base or "")

    def text(self, number: int) -> str:
        """The literal, or the exact value in the unit."""
        return self.literals[number] if self.literals else f"{self.count * number:f}"

    def number(self, text: str) -> int:
        """The number of a ``text``, as above."""
        return self.literals.index(text) if self.literals else round(Decimal(text) / self.count)

    def value(self, number: int) -> int | float:
        """The value in the unit: an integer where that is exact."""
        found = self.count * number
        return int(found) if found == found.to_integral_value() else float(found)


@dataclass(frozen=True, slots=True)
class Series:
    """All values of one element in a trace, in order of time."""

    process: str
    name: str
    quantity: Quantity
    points: tuple[Point, ...]


def spans(points: Sequence[Point], end: Ns) -> Iterator[tuple[int, Ns, Ns, bool]]:
    """How long each value was the last one recorded; the last span is open, until ``end``."""
    changes = list(_changes(points))
    for (start, number), (stop, _) in pairwise(changes):
        yield number, start, stop, False
    if changes:
        start, number = changes[-1]
        yield number, start, max(start, end), True


def _changes(points: Iterable[Point]) -> Iterator[Point]:
    last: int | None = None
    for at, number in points:
        if number != last:
            yield at, number
            last = number


def series_of(seen: Observation, process: str, late: int = 0) -> Iterator[Series]:
    """All recorded values of a run, ``late`` ns after the times in its trace."""
    points: defaultdict[int, list[Point]] = defaultdict(list)
    for one in seen.values:
        points[one.element.number].append((Ns(one.time + late), one.value))
    for element in seen.map.of_kind(VALUE):
        quantity = Quantity.of(element.literals, element.unit)
        yield Series(process, element.name, quantity, tuple(points[element.number]))


def extremes(points: Sequence[Point]) -> list[Point]:
    """The first, last, least and greatest of some points, in order of time."""
    least, greatest = min(points, key=itemgetter(1)), max(points, key=itemgetter(1))
    return sorted({points[0], least, greatest, points[-1]})
