# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions and flows, evaluated as they stand.

A truth value is the literal of `Boolean` that it is in the model: ``"True"`` or
``"False"``. A record is its (field, value) pairs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ravenchart.gen.language.terms import (
    EnumerationType,
    Expression,
    Flow,
    If,
    InState,
    IntegerType,
    Literal,
    Name,
    Operation,
    PortTest,
    Raise,
    Reading,
    Scalar,
    Send,
    Set,
    Type,
    Value,
)

TRUE, FALSE = "True", "False"


@dataclass(frozen=True, slots=True)
class PortReading:
    """An input port as its readers see it; ``state`` is worded as the test for it."""

    value: Value
    state: str = "never_received"
    age: int = 0
    """Executions of the port region since the last arrival."""


@dataclass(slots=True)
class View:
    """The values that one execution reads, copied at its start; its assignments change ``data``."""

    data: dict[str, Value]
    parameters: Mapping[str, Scalar]
    ports: Mapping[str, PortReading]
    active: Mapping[str, frozenset[str]]
    """The states that each region last published as active; its own before the step."""
    event: Value | None = None
    """The value of the event that this step is made for."""


@dataclass(slots=True)
class Outbox:
    """The values to send after the step, by port, and the events to raise, in order."""

    sent: dict[str, Value] = field(default_factory=dict)
    raised: list[tuple[str, Value | None]] = field(default_factory=list)


def least_value(kind: Type) -> Value:
    """The value nearest to zero; of an enumeration the first."""
    match kind:
        case IntegerType(first=first, last=last):
            return min(max(0, first), last)
        case EnumerationType(literals=literals):
            return literals[0]
    return tuple((one.name, _scalar(least_value(one.type))) for one in kind.fields)


def holds(condition: Expression | None, view: View) -> bool:
    """Whether a guard holds; a missing guard holds."""
    return condition is None or value_in(condition, view) == TRUE


def value_in(expression: Expression, view: View) -> Value:
    """The value of an expression."""
    match expression:
        case Literal(value=value):
            return value
        case Name():
            whole = _read(expression, view)
            return whole if expression.field is None else _member(whole, expression.field)
        case PortTest(port=port, state=state):
            return _truth(view.ports[port].state == state)
        case InState(region=region, state=state):
            return _truth(state in view.active[region])
        case Operation(operator="and", operands=(left, right)):
            return _truth(holds(left, view) and holds(right, view))
        case Operation(operator="or", operands=(left, right)):
            return _truth(holds(left, view) or holds(right, view))
        case Operation(operator="if", operands=(condition, then, otherwise)):
            return value_in(then if holds(condition, view) else otherwise, view)
        case Operation(operator=operator, operands=operands):
            values = [value_in(operand, view) for operand in operands]
            if operator in _LOGIC:
                return _truth(_LOGIC[operator](*values))
            return _ARITHMETIC[operator](*map(_number, values))


def _read(name: Name, view: View) -> Value:
    match name.kind:
        case Reading.DATA:
            return view.data[name.name]
        case Reading.PARAMETER:
            return view.parameters[name.name]
        case Reading.PORT:
            return view.ports[name.name].value
    assert view.event is not None, f"{name.name} carries nothing"
    return view.event


def _member(record: Value, name: str) -> Scalar:
    assert isinstance(record, tuple)
    return dict(record)[name]


def _truth(fact: bool) -> str:
    return TRUE if fact else FALSE


def _scalar(value: Value) -> Scalar:
    assert not isinstance(value, tuple)
    return value


def _number(value: Value) -> int:
    assert isinstance(value, int)
    return value


def _divided(dividend: int, divisor: int) -> int:
    """Rounded towards zero."""
    quotient = abs(dividend) // abs(divisor)
    return quotient if (dividend < 0) == (divisor < 0) else -quotient


_LOGIC: Mapping[str, Callable[..., bool]] = {
    "not": lambda a: a == FALSE,
    "=": lambda a, b: a == b,
    "/=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
}

_ARITHMETIC: Mapping[str, Callable[..., int]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _divided,
    "neg": lambda a: -a,
    "abs": abs,
    "min": min,
    "max": max,
    "clamp": lambda a, low, high: min(max(a, low), high),
}


# --- Flows ----------------------------------------------------------------------------


def perform(flow: Flow, view: View, out: Outbox) -> None:
    """Execute the actions of a flow, one after another."""
    for action in flow:
        match action:
            case Set(data=data, field=None, value=value):
                view.data[data] = value_in(value, view)
            case Set(data=data, field=member, value=value):
                new = _scalar(value_in(value, view))
                old = view.data[data]
                assert isinstance(old, tuple)
                view.data[data] = tuple((f, new if f == member else v) for f, v in old)
            case Send(port=port, values=values):
                out.sent[port] = _made(values, view)
            case Raise(event=event, values=values):
                out.raised.append((event, _made(values, view) if values else None))
            case If(condition=condition, then=then, otherwise=otherwise):
                perform(then if holds(condition, view) else otherwise, view, out)


def _made(values: tuple[tuple[str | None, Expression], ...], view: View) -> Value:
    """A scalar, or the record of these fields."""
    if values[0][0] is None:
        return value_in(values[0][1], view)
    return tuple((str(name), _scalar(value_in(value, view))) for name, value in values)
