# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Conditions that a data item meets whenever it is read, beside its type.

An activity that requires a condition must be given data that meet it. A condition on one data
item alone holds at every reading if the initial value meets it and the writer keeps it. Such
a writer is an activity that ensures it, or a region whose code never breaks the invariant.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.language import folding, intervals
from ravenchart.gen.language.terms import (
    BOOLEAN,
    Expression,
    Literal,
    Name,
    Operation,
    Reading,
    Scalar,
    leaves,
)
from ravenchart.gen.model.component import Activity, Clause, Component, Data
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System


def kept_of(system: System, component: Component, data: Data) -> tuple[Expression, ...]:
    """The conditions that hold of a data item; none where no `requires` of an activity names it."""
    if not any(data.name in _names(clause) for a in component.activities for clause in a.requires):
        return ()
    writers = (row for row in component.runnables() if data.name in row.writes)
    promised = _promised(system, component, next(writers, None))
    parts = (part for condition in promised for part in _conjuncts(condition))
    return tuple(one for one in parts if _is_about(one, data) and _holds(one, data))


def _conjuncts(condition: Expression) -> Iterator[Expression]:
    """The conditions that `and` joins."""
    if isinstance(condition, Operation) and condition.operator == "and":
        for operand in condition.operands:
            yield from _conjuncts(operand)
    else:
        yield condition


def _promised(
    system: System, component: Component, writer: Region | Activity | None
) -> list[Expression]:
    if isinstance(writer, Activity):
        return [clause.condition for clause in writer.ensures]
    if writer is None:
        return []
    kept = {
        name
        for safe in system.safe_regions
        if (safe.component, safe.region) == (component.name, writer.name)
        for name in safe.invariants
    }
    return [folding.negated(i.condition) for i in component.invariants if i.name in kept]


def _names(clause: Clause) -> set[str]:
    return {leaf.name for leaf in leaves(clause.condition) if isinstance(leaf, Name)}


def _is_about(condition: Expression, data: Data) -> bool:
    """Whether a condition names that data item as it is, and nothing else."""
    found = [leaf for leaf in leaves(condition) if not isinstance(leaf, Literal)]
    return bool(found) and all(
        isinstance(leaf, Name) and (leaf.kind, leaf.name) == (Reading.DATA, data.name)
        for leaf in found
    )


def _holds(condition: Expression, data: Data) -> bool:
    """Whether the initial value meets a condition on the data item alone."""
    return _value(condition, data) == folding.TRUE.value


def _value(expression: Expression, data: Data) -> Scalar:
    match expression:
        case Literal(value=value):
            return value
        case Name(field=field):
            return data.initial_of(field)
        case Operation(operator="if", operands=(condition, then, otherwise)):
            return _value(then if _value(condition, data) == "True" else otherwise, data)
        case Operation(operator="and" | "or" as operator, operands=(left, right)):
            first = _value(left, data)
            return _value(right, data) if (first == "True") == (operator == "and") else first
        case Operation(operator="not", operands=(inner,)):
            return str(_value(inner, data) != "True")
        case Operation(operator="=" | "/=" as operator, operands=(left, right)):
            return str((_value(left, data) == _value(right, data)) == (operator == "="))
        case Operation(operator=operator, operands=operands):
            numbers = [int(_value(operand, data)) for operand in operands]
            if expression.type == BOOLEAN:
                compared = folding.compared_numbers(operator, numbers[0], numbers[1])
                return str(compared)
            points = tuple((number, number) for number in numbers)
            return intervals.apply(operator, points)[0]
    raise AssertionError(expression)
