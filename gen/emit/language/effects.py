"""What a flow does to data, as one expression for each item over the data before."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ravenchart.gen.language.terms import (
    Expression,
    Flow,
    If,
    IntegerType,
    Name,
    Operation,
    Reading,
    RecordType,
    Set,
    named,
)
from ravenchart.gen.model.component import Component

Target = tuple[str, str | None]
"""A data item, or a field of one."""


def effect_of(flow: Flow, component: Component) -> dict[Target, Expression]:
    """The value of each item that a flow may set, over the data before the flow."""
    return _after(flow, {}, component)


def _after(
    flow: Flow, before: Mapping[Target, Expression], component: Component
) -> dict[Target, Expression]:
    values = dict(before)
    for action in flow:
        match action:
            case Set(_, data, field, value):
                values[data, field] = _over(value, values)
            case If(_, condition, then, otherwise):
                asked = _over(condition, values)
                taken = _after(then, values, component)
                other = _after(otherwise, values, component)
                for target in {**taken, **other}:
                    kept = _kept(target, component)
                    sides = taken.get(target, kept), other.get(target, kept)
                    if sides[0] != sides[1]:
                        values[target] = _choice(asked, sides, kept)
                    else:
                        values[target] = sides[0]
    return values


def _kept(target: Target, component: Component) -> Name:
    """An item as it was."""
    data, field = target
    return Name(Reading.DATA, data, field, named(component.data, data).type)


def _choice(asked: Expression, sides: tuple[Expression, Expression], kept: Name) -> Expression:
    of_type = kept.type
    if isinstance(of_type, RecordType) and kept.field is not None:
        of_type = of_type.field(kept.field).type
    assert not isinstance(of_type, RecordType)
    if isinstance(of_type, IntegerType):
        bounds = of_type.first, of_type.last
        return Operation("if", (asked, *sides), None, of_type.unit, *bounds)
    return Operation("if", (asked, *sides), of_type)


def _over(expression: Expression, values: Mapping[Target, Expression]) -> Expression:
    """An expression over the data before, where some have been set since."""
    match expression:
        case Name(Reading.DATA, name, field):
            return values.get((name, field), expression)
        case Operation(operands=operands):
            return replace(expression, operands=tuple(_over(o, values) for o in operands))
        case _:
            return expression
