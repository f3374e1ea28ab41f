# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Invariants that are contracts of the generated code, with the facts that make them inductive.

`behaviour.rules.inductive` finds them, and the emitter of charts writes them: an invariant over
the states and data of one region, and the facts without which a transition might break it.
"""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    Expression,
    Literal,
    Name,
    Operation,
    Reading,
    RecordType,
    ScalarType,
    Type,
    all_joined,
    named,
)

from .component import Component
from .statechart import Region, RegionId

ValueRange = tuple[int, int]
"""First and last value; literals of an enumeration count by their position."""


@dataclass(frozen=True, slots=True)
class Fact:
    """While ``vertex``, a leaf or a choice or history, is active, a data item is in a span."""

    vertex: str
    data: str
    field: str | None
    spans: tuple[ValueRange, ...]
    """In ascending order; none where the vertex is never active."""

    def condition(self, component: Component) -> Expression:
        """The condition that holds of the data."""
        item = Name(Reading.DATA, self.data, self.field, named(component.data, self.data).type)
        of_type = item.type if self.field is None else _record(item.type).field(self.field).type
        assert not isinstance(of_type, RecordType)
        parts = [_within(item, of_type, span) for span in self.spans]
        return all_joined("or", parts) if parts else Literal("False", BOOLEAN)


@dataclass(frozen=True, slots=True)
class SafeRegion:
    """The invariants that each step of a region keeps, by proof of its code."""

    component: str
    region: str
    invariants: tuple[str, ...]
    """Their names, in model order."""
    facts: tuple[Fact, ...]
    alone: tuple[str, ...] = ()
    """Transitions with a guard that are selected only where no region before theirs selects one."""


def _record(of_type: Type) -> RecordType:
    assert isinstance(of_type, RecordType)
    return of_type


def knows_guards(chart: Region, region: RegionId) -> bool:
    """Whether the guards of a region's transitions hold when these are taken.

    All guards of a step are read before any transition is taken. They still hold where none was
    taken before in the same step. That is so in the first region, and in one whose transitions
    are taken only when none is in the regions before it, which are inside it.
    """
    regions = chart.concurrent_regions()
    return all(_is_inside(chart, one, region) for one in regions[: regions.index(region)])


def _is_inside(chart: Region, region: RegionId, outer: RegionId) -> bool:
    while region.owner is not None:
        region = chart.concurrent_region(region.owner)
        if region == outer:
            return True
    return False


def _within(item: Name, of_type: ScalarType, span: ValueRange) -> Expression:
    first, last = span
    if of_type == BOOLEAN:
        return item if first else Operation("not", (item,), BOOLEAN)
    if isinstance(of_type, EnumerationType):
        one: list[Expression] = [
            Operation("=", (item, Literal(of_type.literals[at], of_type)), BOOLEAN)
            for at in range(first, last + 1)
        ]
        return all_joined("or", one)
    if first == last:
        return Operation("=", (item, Literal(first, None)), BOOLEAN)
    parts: list[Expression] = []
    if first > of_type.first:
        parts.append(Operation(">=", (item, Literal(first, None)), BOOLEAN))
    if last < of_type.last:
        parts.append(Operation("<=", (item, Literal(last, None)), BOOLEAN))
    return all_joined("and", parts)
