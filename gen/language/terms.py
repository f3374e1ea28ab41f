# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Types, expressions and flows: the terms that a model is written in.

Every element carries the `Origin` it was read from. Expressions are resolved
and typed: their names are known, their integer bounds computed.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NewType, Protocol, TypeVar

from ravenchart.gen.origins import Origin

Ns = NewType("Ns", int)
"""A duration in nanoseconds."""

NO_TIME = Ns(0)


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """Its name."""
        ...


N = TypeVar("N", bound=Named)


def named(items: tuple[N, ...], name: str) -> N:
    """The item called ``name``, without regard to case; KeyError where there is none."""
    for item in items:
        if item.name == name:
            return item
    wanted = name.lower()
    for item in items:
        if item.name.lower() == wanted:
            return item
    raise KeyError(name)


# --- Types -------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class IntegerType:
    """An integer range ``first .. last``, both included, counted in ``unit``."""

    name: str
    origin: Origin
    first: int
    last: int
    unit: str | None = None


@dataclass(frozen=True, slots=True)
class EnumerationType:
    """An enumeration; ``Boolean`` is the one that every system has."""

    name: str
    origin: Origin
    literals: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Field:
    """One scalar field of a record."""

    name: str
    origin: Origin
    type: IntegerType | EnumerationType


@dataclass(frozen=True, slots=True)
class RecordType:
    """A flat record: the type of what ports carry and blackboards hold."""

    name: str
    origin: Origin
    fields: tuple[Field, ...]

    def field(self, name: str) -> Field:
        """The field called ``name`` (any case); KeyError where there is none."""
        return named(self.fields, name)


ScalarType = IntegerType | EnumerationType
Type = IntegerType | EnumerationType | RecordType

BUILT_IN = Origin("<built in>", 1, 1)
BOOLEAN = EnumerationType("Boolean", BUILT_IN, ("False", "True"))
Scalar = int | str
"""A scalar value: an integer, or the name of a literal as declared."""
Value = Scalar | tuple[tuple[str, Scalar], ...]
"""A value of any type; a record's is (field, value) in the type's field order."""


# --- Expressions and flows ---------------------------------------------------


class Reading(Enum):
    """The kind of element that a name in an expression denotes."""

    DATA = "data"
    PARAMETER = "parameter"
    PORT = "port"
    EVENT = "event"
    """The value that the triggering event carries; ``name`` is the event's."""
    OUTPUT = "output"
    """The value that an execution sends on an output port, or gives a command that it calls."""
    OLD = "old"
    """A data item as it was before the execution."""
    SENT = "sent"
    """Whether an execution sends on an output port, or calls a command."""


@dataclass(frozen=True, slots=True)
class Literal:
    """A number or an enumeration literal; ``type`` is None for a bare number."""

    value: Scalar
    type: ScalarType | None


@dataclass(frozen=True, slots=True)
class Name:
    """A data item, parameter or input port of the component, or a field of one."""

    kind: Reading
    name: str
    field: str | None
    type: Type


@dataclass(frozen=True, slots=True)
class PortTest:
    """``fresh(port)``, ``stale(port)`` or ``never_received(port)``."""

    port: str
    state: str


@dataclass(frozen=True, slots=True)
class InState:
    """``in(Region.State)``: what the region last published is that state or inside it."""

    region: str
    state: str


@dataclass(frozen=True, slots=True)
class Operation:
    """An operator or function applied to its operands.

    ``operator`` is one of ``and or not = /= < <= > >= + - * / neg abs min max
    clamp if``; ``and`` and ``or`` stop early, ``/`` rounds towards zero, ``if``
    has condition, then, else. For an integer, ``low .. high`` bounds
    the value and ``unit`` is what it counts.
    """

    operator: str
    operands: tuple[Expression, ...]
    type: ScalarType | None
    """None for an integer: it then has a unit and bounds instead."""
    unit: str | None = None
    low: int = 0
    high: int = 0


Leaf = Literal | Name | PortTest | InState
Expression = Leaf | Operation


def leaves(expression: Expression) -> Iterator[Leaf]:
    """The names, numbers and tests in an expression, as they stand in it."""
    if isinstance(expression, Operation):
        for operand in expression.operands:
            yield from leaves(operand)
    else:
        yield expression


def all_joined(operator: str, parts: Sequence[Expression]) -> Expression:
    """Conditions joined by ``and`` or by ``or``; there is at least one."""
    made = parts[0]
    for part in parts[1:]:
        made = Operation(operator, (made, part), BOOLEAN)
    return made


@dataclass(frozen=True, slots=True)
class Set:
    """``set: data[.field]`` ``to: expression``; the expression fits the target's range."""

    origin: Origin
    data: str
    field: str | None
    value: Expression


@dataclass(frozen=True, slots=True)
class Send:
    """``send: port``: one value on an output port; every field is given."""

    origin: Origin
    port: str
    values: tuple[tuple[str | None, Expression], ...]
    """(field, expression) in the type's field order; field None for a scalar port."""


@dataclass(frozen=True, slots=True)
class Raise:
    """``raise: event``: offered to every region of the component that names it.

    ``values`` is as in `Send`; empty for an event that carries nothing.
    """

    origin: Origin
    event: str
    values: tuple[tuple[str | None, Expression], ...] = ()


@dataclass(frozen=True, slots=True)
class If:
    """``if: condition`` ``then: [...]`` ``else: [...]``."""

    origin: Origin
    condition: Expression
    then: tuple[Action, ...]
    otherwise: tuple[Action, ...]


Action = Set | Send | Raise | If
Flow = tuple[Action, ...]


def always(flow: Flow) -> set[str]:
    """The ports, events and data that a flow sends on, raises or sets on every path.

    Of a record whose fields are set one by one: ``data.field``.
    """
    sure: set[str] = set()
    for action in flow:
        match action:
            case Set(_, data, field):
                sure.add(data if field is None else f"{data}.{field}")
            case Send(_, port):
                sure.add(port)
            case Raise(_, event):
                sure.add(event)
            case If(_, _, then, otherwise):
                sure |= always(then) & always(otherwise)
    return sure


def has_one_value(of_type: Type) -> bool:
    """Has a scalar type a single value?"""
    match of_type:
        case IntegerType():
            return of_type.first == of_type.last
        case EnumerationType():
            return len(of_type.literals) == 1
        case _:
            return False


def default(of_type: Type) -> Value:
    """The value before any is known: nearest to zero, first literal, field by field."""
    if isinstance(of_type, RecordType):
        return tuple((field.name, _scalar_default(field.type)) for field in of_type.fields)
    return _scalar_default(of_type)


def _scalar_default(of_type: ScalarType) -> Scalar:
    if isinstance(of_type, IntegerType):
        return min(max(0, of_type.first), of_type.last)
    return of_type.literals[0]
