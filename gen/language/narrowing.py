# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Bounds of names from conditions: narrower ones where a condition is known to hold."""

from __future__ import annotations

from collections.abc import Mapping

from . import intervals
from .intervals import Interval
from .terms import Expression, IntegerType, Literal, Name, Operation, Reading

COMPARISONS = ("=", "/=", "<", "<=", ">", ">=")

Key = tuple[Reading, str, str | None]
Known = Mapping[Key, Interval]
"""The bounds of names by the conditions around a term, beyond their types."""

MIRRORED = {"<": ">", "<=": ">=", ">": "<", ">=": "<=", "=": "=", "/=": "/="}
NEGATED = {"<": ">=", "<=": ">", ">": "<=", ">=": "<", "=": "/=", "/=": "="}


def narrowed(known: Known, condition: Expression, holds: bool) -> Known:
    """The bounds of names once it is known whether the condition holds."""
    if not isinstance(condition, Operation):
        return known
    operator, operands = condition.operator, condition.operands
    if operator == "not":
        return narrowed(known, operands[0], not holds)
    if operator == ("and" if holds else "or"):
        return narrowed(narrowed(known, operands[0], holds), operands[1], holds)
    if operator in COMPARISONS:
        told = operator if holds else NEGATED[operator]
        known = _narrow_one(known, operands[0], told, operands[1])
        return _narrow_one(known, operands[1], MIRRORED[told], operands[0])
    return known


def _bounds(known: Known, expression: Expression) -> Interval | None:
    match expression:
        case Literal(int(value), None):
            return value, value
        case Name(kind, name, field_name, IntegerType(first=first, last=last)):
            return known.get((kind, name, field_name), (first, last))
        case Operation(type=None, low=low, high=high):
            return low, high
    return None


def _narrow_one(known: Known, name: Expression, operator: str, other: Expression) -> Known:
    """The bounds with ``name operator other`` added, when the first is a name."""
    mine, others = _bounds(known, name), _bounds(known, other)
    if not isinstance(name, Name) or mine is None or others is None:
        return known
    left = intervals.below(mine, operator, others)
    if left is None:
        return known
    return {**known, (name.kind, name.name, name.field): left}
