"""Times and shares as people read them. Nothing here rounds to the unsafe side."""

from __future__ import annotations

from fractions import Fraction

_UNITS = ((1_000_000_000, "s"), (1_000_000, "ms"), (1_000, "us"), (1, "ns"))


def duration(ns: int) -> str:
    """A duration in the largest unit that holds it exactly: ``10 ms``, ``1500 us``."""
    for factor, unit in _UNITS:
        if ns and ns % factor == 0:
            return f"{ns // factor} {unit}"
    return "0 us"


def microseconds(ns: int) -> str:
    """A duration in us, rounded up to a tenth; whole numbers without the tenth."""
    tenths = -(-ns // 100)
    sign, tenths = ("-", -tenths) if tenths < 0 else ("", tenths)
    return f"{sign}{tenths // 10}" + (f".{tenths % 10}" if tenths % 10 else "")


def seconds(ns: int) -> str:
    """A point in time, in s to the millisecond."""
    return f"{ns / 1e9:.3f} s"


def percent(share: Fraction) -> str:
    """A share as a percentage, rounded up to a tenth."""
    tenths = -(-share.numerator * 1000 // share.denominator)
    return f"{tenths // 10}.{tenths % 10} %"
