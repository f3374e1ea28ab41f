# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Integer intervals: the results that an operation can yield, given the ranges of its operands."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import product

Interval = tuple[int, int]
"""First and last value, both included."""

WORD = 2**63 - 1
"""Every intermediate result lies within -WORD .. WORD."""


def quotient(a: int, b: int) -> int:
    """``a / b`` rounded towards zero, as in Ada."""
    return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


def _corners(function: Callable[[int, int], int], a: Interval, b: Interval) -> Interval:
    """The interval of a function that is monotonic in each operand."""
    values = [function(x, y) for x, y in product(a, b)]
    return min(values), max(values)


def _abs(a: Interval) -> Interval:
    low = 0 if a[0] <= 0 <= a[1] else min(abs(a[0]), abs(a[1]))
    return low, max(abs(a[0]), abs(a[1]))


def _min(a: Interval, b: Interval) -> Interval:
    return min(a[0], b[0]), min(a[1], b[1])


def _max(a: Interval, b: Interval) -> Interval:
    return max(a[0], b[0]), max(a[1], b[1])


def _join(a: Interval, b: Interval) -> Interval:
    return min(a[0], b[0]), max(a[1], b[1])


def _quotients(a: Interval, b: Interval) -> Interval:
    return _corners(quotient, a, b)


BINARY: Mapping[str, Callable[[Interval, Interval], Interval]] = {
    "+": lambda a, b: (a[0] + b[0], a[1] + b[1]),
    "-": lambda a, b: (a[0] - b[1], a[1] - b[0]),
    "*": lambda a, b: _corners(lambda x, y: x * y, a, b),
    "/": _quotients,
    "min": _min,
    "max": _max,
    "if": _join,
}


def apply(operator: str, operands: tuple[Interval, ...]) -> Interval:
    """The interval of an operation; a divisor's interval must not hold 0."""
    if operator == "neg":
        return -operands[0][1], -operands[0][0]
    if operator == "abs":
        return _abs(operands[0])
    if operator == "clamp":
        return _min(_max(operands[0], operands[1]), operands[2])
    return BINARY[operator](operands[0], operands[1])


def meet(a: Interval, b: Interval) -> Interval | None:
    """The numbers in both; None when there are none."""
    low, high = max(a[0], b[0]), min(a[1], b[1])
    return (low, high) if low <= high else None


def below(a: Interval, operator: str, b: Interval) -> Interval | None:
    """The part of ``a`` for which ``a operator b`` can hold; None when there is none."""
    match operator:
        case "<":
            return meet(a, (a[0], b[1] - 1))
        case "<=":
            return meet(a, (a[0], b[1]))
        case ">":
            return meet(a, (b[0] + 1, a[1]))
        case ">=":
            return meet(a, (b[0], a[1]))
        case "=":
            return meet(a, b)
        case _:  # "/=": only a single value at an end tells anything
            if b[0] != b[1]:
                return a
            return meet(a, (a[0] + (b[0] == a[0]), a[1] - (b[0] == a[1])))
