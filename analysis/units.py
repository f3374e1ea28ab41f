# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Times and shares in files and pages: exact, or to a tenth of a us and never to the unsafe side.

`ravenchart.rounded` has those of the terminal and of messages.
"""

from __future__ import annotations

from fractions import Fraction

EXACT_DIGITS = 18
"""A share whose denominator has more digits is rounded up to so many decimal places."""

US, MS = 1_000, 1_000_000
"""Nanoseconds in a microsecond and in a millisecond."""

TENTH = US // 10
"""Nanoseconds in a tenth of a microsecond."""

_UNITS = ((1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "us"), (1, "ns"))


def duration(ns: int) -> str:
    """A duration in the largest unit that holds it exactly: ``10 ms``, ``1500 us``."""
    for factor, unit in _UNITS:
        if ns and ns % factor == 0:
            return f"{ns // factor} {unit}"
    return "0 us"


def exact_time(ns: int) -> str:
    """A time in ms from 1 ms on, else in us, with all its digits: ``9.8003 ms``."""
    length, unit = (MS, "ms") if abs(ns) >= MS else (US, "us")
    whole, rest = divmod(abs(ns), length)
    decimals = f"{length + rest}"[1:].rstrip("0")
    return ("-" if ns < 0 else "") + f"{whole}" + (f".{decimals}" if decimals else "") + f" {unit}"


def microseconds(ns: int) -> str:
    """A duration in us, rounded up to a tenth; whole numbers without the tenth."""
    tenths = -(-ns // TENTH)
    sign, tenths = ("-", -tenths) if tenths < 0 else ("", tenths)
    return f"{sign}{tenths // 10}" + (f".{tenths % 10}" if tenths % 10 else "")


def milliseconds(ns: int) -> str:
    """The same time as `microseconds` says, in ms: the point is three places further left."""
    tenths = -(-ns // TENTH)
    sign, tenths = ("-", -tenths) if tenths < 0 else ("", tenths)
    part = f"{tenths % 10_000:04}".rstrip("0")
    return f"{sign}{tenths // 10_000}" + (f".{part}" if part else "")


def ratio(share: Fraction) -> str:
    """A share as ``n/d``: exact, or rounded up where ``d`` would have over EXACT_DIGITS digits.

    The sum of 5,000 shares of different periods has a denominator of 50,000 digits.
    """
    whole: int = 10**EXACT_DIGITS
    if share.denominator < whole:
        return f"{share.numerator}/{share.denominator}"
    return f"{-(-share.numerator * whole // share.denominator)}/{whole}"
