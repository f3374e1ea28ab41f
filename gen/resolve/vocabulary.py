# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The names that expressions may use, and the type or bounds that a sound expression yields."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass, field, replace

from ravenchart.gen.language.intervals import Interval
from ravenchart.gen.language.names import NameScope, NameUse
from ravenchart.gen.language.narrowing import Known, narrowed
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    Expression,
    Reading,
    RecordType,
    Type,
)
from ravenchart.gen.origins import Origin

EVENT = "event"
"""The name of the triggering event's value in expressions."""


@dataclass(frozen=True, slots=True)
class Vocabulary:
    """The names that expressions of one region or activity may use."""

    readable: NameScope[tuple[Reading, str, Type]]
    inputs: NameScope[str]
    regions: NameScope[NameScope[str]]
    """Each region's states; the name of the region is that of the inner scope's kind."""
    literals: frozenset[str]
    """All enumeration literals of the model, in lower case."""
    own_region: str | None = None
    concurrent: frozenset[str] = frozenset()
    """States of the own region that lie in one of several regions of a state, in lower case."""
    may_ask: Callable[[str], bool] | None = None
    """Which of them may be tested here; None where nothing is read before a step's transitions."""
    no_event: str = "there is no triggering event here"
    """Why ``event`` has no value."""
    known: Known = field(default_factory=dict)
    """The bounds of names by the conditions around an expression."""

    def where(self, condition: Expression, holds: bool) -> Vocabulary:
        """The same, where it is known whether the condition holds."""
        return replace(self, known=narrowed(self.known, condition, holds))

    def after(self, written: Container[tuple[str, str | None]]) -> Vocabulary:
        """The same, after these data items or fields were set: no condition holds of them now."""
        kept = {
            key: bounds
            for key, bounds in self.known.items()
            if key[0] is not Reading.DATA or key[1:] not in written
        }
        return replace(self, known=kept)

    def with_event(self, event: str, type_: Type | None) -> Vocabulary:
        """The same, where ``event`` is the value of the triggering event; silent without type."""
        known = self.readable
        value = None if type_ is None else (Reading.EVENT, event, type_)
        items = {**known.items, EVENT: (EVENT, None, value)}
        return replace(self, readable=NameScope(known.kind, items, known.open))

    def without_event(self, reason: str) -> Vocabulary:
        """The same, with another reason why ``event`` has no value."""
        return replace(self, no_event=reason)


@dataclass(frozen=True, slots=True)
class CheckedExpression:
    """A sound expression; an integer has no ``type`` but bounds and a unit.

    ``bare`` marks an expression of numbers only: it agrees with every unit.
    """

    expression: Expression
    type: EnumerationType | RecordType | None
    bounds: Interval = (0, 0)
    unit: str | None = None
    bare: bool = False


def literal_use(literal: str, of_type: EnumerationType, origin: Origin) -> NameUse:
    """A literal that is used."""
    kind = f"literal of {of_type.name}"
    return NameUse(
        literal, origin, kind, None if of_type is BOOLEAN else of_type.origin, within=True
    )


def yielded(checked: CheckedExpression) -> str:
    """The kind of an expression's value, in words."""
    if checked.type is not None:
        kind = "a record" if isinstance(checked.type, RecordType) else "a value"
        return f"{kind} of type {checked.type.name}"
    return "a number"


def range_text(bounds: Interval, unit: str | None = None) -> str:
    """An interval in words."""
    return f"{bounds[0]} .. {bounds[1]}" + (f" {unit}" if unit else "")
