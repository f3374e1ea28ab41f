# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Named numbers and the checks between them, as Ada constructs."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import Decl, Object
from ravenchart.gen.emit.ada.expressions import (
    Attribute,
    Expr,
    OperatorChain,
    StringLiteral,
    both,
    call,
    chain,
    number,
)
from ravenchart.gen.emit.ada.named import Named, ref
from ravenchart.gen.emit.ada.naming import constant_name
from ravenchart.gen.emit.ada.statements import Pragma

name_of = constant_name
"""An element's name in the certificate, to which a letter is added."""

ONE = number(1)

LATE = "can miss its deadline"

OVERLAP = "can be released before it completes"

RESPONSE = "response time"
"""The subject of most claims."""

IN_WINDOWS = "each claimed window, and the demand within it"
"""The comment above the claims about a task or a message."""

LONG = 69
"""A message of more columns is broken behind the name of its element."""


def named_number(name: Named, value: Expr) -> Decl:
    """``name : constant := value;``"""
    return Object(name, None, value, constant=True)


def stated(name: Named, value: int) -> Decl:
    """A number as it is given."""
    return named_number(name, number(value))


def plus(*terms: Expr) -> Expr:
    """The sum; of one term, that."""
    flat: list[Expr] = []
    for term in terms:
        flat += (
            term.operands if isinstance(term, OperatorChain) and term.operator == "+" else (term,)
        )
    return chain("+", [term for term in flat if term != number(0)], number(0))


def times(*factors: Expr) -> Expr:
    """The product."""
    return chain("*", [factor for factor in factors if factor != ONE], ONE)


def less_periods(time: Expr, own: str, jobs: int) -> Expr:
    """Less the periods of an element that lie before a job, counted from 0."""
    return OperatorChain("-", (time, times(number(jobs), ref(f"{own}_T")))) if jobs else time


def ceiling(dividend: Expr, divisor: Expr) -> Expr:
    """The quotient of numbers that are not negative, rounded up."""
    return OperatorChain("/", (plus(dividend, OperatorChain("-", (divisor, ONE))), divisor))


def refuse(left: Expr, right: Expr, element: str, problem: str) -> Decl:
    """A build fails, with our words, when ``left`` exceeds ``right``."""
    return _refused(OperatorChain(">", (left, right)), element, problem)


def differs(left: Expr, right: Expr, element: str, problem: str) -> Decl:
    """A build fails, with our words, when the two differ."""
    return _refused(OperatorChain("/=", (left, right)), element, problem)


def _refused(condition: Expr, element: str, problem: str) -> Decl:
    words = f"{element} {problem}"
    split: Expr = StringLiteral(words)
    if len(words) > LONG:
        split = OperatorChain("&", (StringLiteral(f"{element} "), StringLiteral(problem)))
    return Pragma("Compile_Time_Error", (condition, split))


def none_of(conditions: Sequence[Expr], element: str, problem: str) -> list[Decl]:
    """A build fails, with our words, when one of the conditions holds."""
    return [_refused(chain("or else", conditions), element, problem)] if conditions else []


def exact(claimed: Expr, terms: Sequence[Expr], element: str, what: str, least: int = 0) -> Decl:
    """A build fails unless a claim is the longest of the terms, neither less nor more.

    Of a window the demand within it is the only term: one that is shorter does not hold the
    demand, and a longer one shows that a term is missing. It may have to be ``least`` at least.
    """
    other: Expr = OperatorChain("/=", (claimed, longest(terms)))
    if least:
        other = OperatorChain("or else", (OperatorChain("<", (claimed, number(least))), other))
    return _refused(other, element, f"claims a wrong {what}")


def longest(terms: Sequence[Expr]) -> Expr:
    """The longest of some times."""
    found = terms[-1]
    for term in reversed(terms[:-1]):
        found = call(Attribute("Time", "Max"), term, found)
    return found


def assured(*pairs: tuple[Expr, Expr]) -> Decl:
    """For gnatprove: of each pair the first is no more than the second."""
    return Pragma("Assert", (both(*(OperatorChain("<=", pair) for pair in pairs)),))
