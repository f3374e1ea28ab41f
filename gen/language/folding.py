# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions in simplest form: constants computed, redundant operators left out.

The Ada compiler warns of such parts, and warnings are errors. So no such part leaves this module.
`decided` reports comparisons whose result no data can change.
"""

from __future__ import annotations

from dataclasses import dataclass

from .terms import (
    BOOLEAN,
    EnumerationType,
    Expression,
    IntegerType,
    Literal,
    Name,
    Operation,
    RecordType,
)

TRUE, FALSE = Literal("True", BOOLEAN), Literal("False", BOOLEAN)


def _truth(expression: Expression) -> bool | None:
    """The value of a Boolean literal; None for all else."""
    if isinstance(expression, Literal) and expression.type == BOOLEAN:
        return str(expression.value).lower() == "true"
    return None


def arithmetic(operation: Operation) -> Expression:
    """An operation on numbers: a literal where it has one result, no needless sign or `abs`."""
    if operation.low == operation.high:
        return Literal(operation.low, None)
    (first, *_) = operation.operands
    if operation.operator == "abs" and _least(first) >= 0:
        return first
    if operation.operator == "neg" and isinstance(first, Operation) and first.operator == "neg":
        return first.operands[0]
    return operation


def _least(expression: Expression) -> int:
    """A number that it is never below, as far as its type says."""
    match expression:
        case Literal(int(value)):
            return value
        case Operation(low=low):
            return low
        case Name(_, _, field, of_type):
            scalar = of_type
            if isinstance(of_type, RecordType) and field is not None:
                scalar = of_type.field(field).type
            if isinstance(scalar, IntegerType):
                return scalar.first
    return -1


def negated(condition: Expression) -> Expression:
    """``not``: without a second one, and of a literal the other."""
    truth = _truth(condition)
    if truth is not None:
        return FALSE if truth else TRUE
    if isinstance(condition, Operation) and condition.operator == "not":
        return condition.operands[0]
    return Operation("not", (condition,), BOOLEAN)


def joined(operator: str, left: Expression, right: Expression) -> Expression:
    """``and`` or ``or``: without operands that change nothing."""
    neutral = operator == "and"
    for one, other in ((left, right), (right, left)):
        truth = _truth(one)
        if truth is not None:
            return other if truth == neutral else one
    return Operation(operator, (left, right), BOOLEAN)


def compared(operator: str, left: Expression, right: Expression) -> Expression:
    """A comparison: one with a truth value is the condition itself, or its opposite."""
    for one, other in ((left, right), (right, left)):
        truth = _truth(one)
        if truth is not None and operator in ("=", "/="):
            return other if truth == (operator == "=") else negated(other)
    return Operation(operator, (left, right), BOOLEAN)


def chosen(operation: Operation) -> Expression:
    """``if``: the branch that a literal condition takes, and no choice between the same."""
    condition, then, otherwise = operation.operands
    truth = _truth(condition)
    if truth is not None:
        return then if truth else otherwise
    if then == otherwise:
        return then
    if _truth(then) is not None and _truth(otherwise) is not None:
        return condition if _truth(then) else negated(condition)
    return operation


@dataclass(frozen=True, slots=True)
class Decided:
    """The outcome of a comparison that nothing can change, and why."""

    holds: bool
    reason: str


def decided(operator: str, left: Expression, right: Expression) -> Decided | None:
    """The result of a comparison without data: of two constants, or of a term with itself."""
    if left == right:
        return Decided(operator in ("=", "<=", ">="), "both sides are the same")
    if isinstance(left, Literal) and isinstance(right, Literal):
        return Decided(_holds(operator, left, right), "it reads nothing")
    return None


def _holds(operator: str, left: Literal, right: Literal) -> bool:
    if isinstance(left.type, EnumerationType):
        return operator == "/="  # the same literals are the same expressions
    return compared_numbers(operator, int(left.value), int(right.value))


def compared_numbers(operator: str, first: int, second: int) -> bool:
    """The outcome of a comparison of two numbers."""
    return {
        "=": first == second,
        "/=": first != second,
        "<": first < second,
        "<=": first <= second,
        ">": first > second,
        ">=": first >= second,
    }[operator]
