# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Types and expressions as terms of the solver z3.

Integers are bounded terms ``Int``, enumerations ``Int`` over the positions of their
literals, Booleans ``Bool``. A *variable* is a scalar that expressions read.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import z3

from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    Expression,
    InState,
    IntegerType,
    Literal,
    Name,
    Operation,
    PortTest,
    Reading,
    RecordType,
    Scalar,
    ScalarType,
    Type,
    Value,
)
from ravenchart.gen.model.component import Component

Term = Any
"""A term of z3, which has no types for mypy."""

EFFORT = 200_000
"""Work on one question at most, in z3's own unit: the same on every machine."""

PORT_STATES = ("fresh", "stale", "never_received")


class Variable(tuple[str, str, str | None]):
    """(kind, name, field): data, a parameter, a port, an event's value, or a published state."""

    __slots__ = ()

    def __str__(self) -> str:
        """As a model reads it."""
        kind, name, field = self
        if kind == "in":
            return f"in({name}.{field})"
        if kind == "port state":
            return f"state of {name}"
        name = "event" if kind == Reading.EVENT.value else name
        return name if field is None else f"{name}.{field}"

    @property
    def unknown(self) -> str:
        """The name of its unknown: the values of two events are two, though both read `event`."""
        return f"{self} of {self[1]}" if self[0] == Reading.EVENT.value else str(self)

    @property
    def state(self) -> str:
        """The state that a published one is about."""
        assert self[2] is not None
        return self[2]


def variable(kind: Reading, name: str, field: str | None) -> Variable:
    """The variable that a name denotes."""
    return Variable((kind.value, name, field))


def published(region: str, state: str) -> Variable:
    """Whether ``in(region.state)`` holds."""
    return Variable(("in", region, state))


def parts(kind: Reading, name: str, type_: Type) -> list[tuple[Variable, ScalarType]]:
    """The variables of a name: one for each field of a record."""
    if isinstance(type_, RecordType):
        return [(variable(kind, name, f.name), f.type) for f in type_.fields]
    return [(variable(kind, name, None), type_)]


def scalars(name: str, type_: Type, value: Value) -> dict[Variable, Term]:
    """The terms of a data item's value."""
    if isinstance(value, tuple) and isinstance(type_, RecordType):
        return {
            variable(Reading.DATA, name, field): constant(item, type_.field(field).type)
            for field, item in value
        }
    assert not isinstance(value, tuple) and not isinstance(type_, RecordType)
    return {variable(Reading.DATA, name, None): constant(value, type_)}


def constant(value: Scalar, type_: ScalarType | None) -> Term:
    """The term of a value."""
    if isinstance(value, int):
        return z3.IntVal(value)
    if type_ == BOOLEAN:
        return z3.BoolVal(value.lower() == "true")
    assert isinstance(type_, EnumerationType)
    return z3.IntVal(type_.literals.index(value))


def symbol(name: str, type_: ScalarType) -> Term:
    """An unknown of a type."""
    return z3.Bool(name) if type_ == BOOLEAN else z3.Int(name)


def within(term: Term, type_: ScalarType) -> Term:
    """That a term lies in a type."""
    if type_ == BOOLEAN:
        return z3.BoolVal(True)
    if isinstance(type_, EnumerationType):
        return z3.And(term >= 0, term < len(type_.literals))
    return z3.And(term >= type_.first, term <= type_.last)


def scalar(value: Term, type_: ScalarType) -> Scalar:
    """The value of a type that a term is: of an enumeration the literal."""
    if type_ == BOOLEAN:
        return BOOLEAN.literals[bool(z3.is_true(value))]
    number: int = value.as_long()
    return type_.literals[number] if isinstance(type_, EnumerationType) else number


def said(value: Term, type_: ScalarType) -> str:
    """A value of a type as a model writes it."""
    text = str(scalar(value, type_))
    return text.lower() if type_ == BOOLEAN else text


# --- Expressions -----------------------------------------------------------------

Read = Callable[[Variable], Term]
"""Returns the term of a variable."""

Ask = Callable[[z3.Solver], z3.CheckSatResult]
"""Asks a solver."""


def term(expression: Expression, read: Read) -> Term:
    """The term of an expression."""
    match expression:
        case Literal(value, type_):
            return constant(value, type_)
        case Name(kind, name, field):
            return read(variable(kind, name, field))
        case PortTest(port, state):
            return read(Variable(("port state", port, None))) == PORT_STATES.index(state)
        case InState(region, state):
            return read(published(region, state))
    return _operation(expression.operator, [term(o, read) for o in expression.operands])


def _quotient(a: Term, b: Term) -> Term:
    """``a / b`` towards zero; z3 leaves a remainder that is never negative."""
    size = z3.If(a >= 0, a, -a) / z3.If(b >= 0, b, -b)
    return z3.If((a >= 0) == (b >= 0), size, -size)


OPERATIONS: Mapping[str, Callable[..., Term]] = {
    "and": lambda a, b: z3.And(a, b),
    "or": lambda a, b: z3.Or(a, b),
    "not": z3.Not,
    "=": lambda a, b: a == b,
    "/=": lambda a, b: a != b,
    "<": lambda a, b: a < b,
    "<=": lambda a, b: a <= b,
    ">": lambda a, b: a > b,
    ">=": lambda a, b: a >= b,
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _quotient,
    "neg": lambda a: -a,
    "abs": lambda a: z3.If(a >= 0, a, -a),
    "min": lambda a, b: z3.If(a <= b, a, b),
    "max": lambda a, b: z3.If(a >= b, a, b),
    "clamp": lambda a, low, high: z3.If(
        a > high, high, z3.If(a < low, z3.If(low < high, low, high), a)
    ),
    "if": z3.If,
}


def _operation(operator: str, operands: Sequence[Term]) -> Term:
    return z3.simplify(OPERATIONS[operator](*operands))


# --- What a component's expressions can read ---------------------------------------


def readable(component: Component) -> dict[Variable, ScalarType]:
    """Every variable of a component with its type; published states are Boolean."""
    found: dict[Variable, ScalarType] = {}
    for data in component.data:
        found.update(parts(Reading.DATA, data.name, data.type))
    for parameter in component.parameters:
        found.update(parts(Reading.PARAMETER, parameter.name, parameter.type))
    for port in component.inputs():
        found.update(parts(Reading.PORT, port.name, port.type))
        states = PORT_STATES
        kind = EnumerationType("state of a port", port.origin, states)
        found[Variable(("port state", port.name, None))] = kind
    for event in component.events:
        if event.type is not None:
            found.update(parts(Reading.EVENT, event.name, event.type))
    for region in component.regions:
        for state in region.states:
            found[published(region.name, state.name)] = BOOLEAN
    return found


def landmarks(expression: Expression) -> Iterable[tuple[Variable, int]]:
    """Each integer that an expression compares with a term that contains a variable."""
    if not isinstance(expression, Operation):
        return
    for operand in expression.operands:
        yield from landmarks(operand)
    if expression.operator in ("=", "/=", "<", "<=", ">", ">="):
        numbers = [n for o in expression.operands for n in _numbers(o)]
        for operand in expression.operands:
            for name in names(operand):
                if isinstance(name.type, IntegerType):
                    for number in numbers:
                        yield variable(name.kind, name.name, name.field), number


def _numbers(expression: Expression) -> Iterable[int]:
    match expression:
        case Literal(int(value)):
            yield value
        case Operation(operands=operands):
            for operand in operands:
                yield from _numbers(operand)


def names(expression: Expression) -> Iterable[Name]:
    """The names in an expression."""
    match expression:
        case Name():
            yield expression
        case Operation(operands=operands):
            for operand in operands:
                yield from names(operand)


def tested(expressions: Iterable[Expression]) -> Iterable[Variable]:
    """The published states that expressions ask for."""
    for expression in expressions:
        match expression:
            case InState(region, state):
                yield published(region, state)
            case Operation(operands=operands):
                yield from tested(operands)


def unknowns(terms: Iterable[Term]) -> dict[str, Term]:
    """The unknowns in some terms, by name."""
    found: dict[str, Term] = {}
    seen: set[int] = set()
    waiting = list(terms)
    while waiting:
        one = waiting.pop()
        if one.get_id() in seen:
            continue
        seen.add(one.get_id())
        if one.num_args():
            waiting.extend(one.children())
        elif one.decl().kind() == z3.Z3_OP_UNINTERPRETED:
            found[one.decl().name()] = one
    return found


# --- Questions ---------------------------------------------------------------------


def solver() -> Term:
    """A solver that gives the same answer each time."""
    made = z3.Solver()
    made.set("random_seed", 0)
    made.set("rlimit", EFFORT)
    return made


def optimizer() -> Term:
    """An optimizer for the least values, with as much work as a solver may take."""
    made = z3.Optimize()
    made.set("rlimit", EFFORT)
    return made


class Questions:
    """The terms that a step reads, and whether conditions can hold together; each asked once."""

    def __init__(self, read: Read, context: Sequence[Term], ask: Ask = z3.Solver.check) -> None:
        """Questions within ``context``; ``ask`` may count them."""
        self._ask = ask
        self.read = read
        self._solver = solver()
        self._solver.add(*context)
        self._terms: dict[int, tuple[Expression, Term]] = {}
        self._answers: dict[tuple[int, ...], tuple[Sequence[Term], bool]] = {}
        """With the terms, which keep their numbers."""

    def term(self, expression: Expression) -> Term:
        """The term of an expression as a step reads it at its start."""
        key = id(expression)
        if key not in self._terms:
            self._terms[key] = expression, term(expression, self.read)
        return self._terms[key][1]

    def possible(self, conditions: Sequence[Term]) -> bool:
        """Whether some data meet all these conditions; when in doubt, yes."""
        key = tuple(one.get_id() for one in conditions)
        if key not in self._answers:
            self._solver.push()
            self._solver.add(*conditions)
            self._answers[key] = conditions, bool(self._ask(self._solver) != z3.unsat)
            self._solver.pop()
        return self._answers[key][1]
