# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Times and shares for people: three significant digits, rounded to the safe side.

A time that work needs or took is rounded up: C, J, B, R, an observation. So is a load. A time that
is left or allowed is rounded down: T, D, a limit, slack. So is room to grow. Therefore no printed
bound is shorter than the bound, and no printed slack is longer than the slack. Where three digits
would hide how two figures compare, both have more.

Digits before the point are never replaced by zeros, and zeros at the end are left out. Times are in
ns here. JSON and files have the exact values.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from fractions import Fraction
from math import ceil, floor

DIGITS = 3
"""Significant digits of a printed figure."""

PLACES = 12
"""Decimal places of a printed figure at most."""

FAR = 1_000
"""Ratio from which on two times need not have one unit."""


class Rounding(Enum):
    """The side to which a figure is rounded."""

    UP = "up"
    DOWN = "down"
    NEAREST = "nearest"


_WHOLE: dict[Rounding, Callable[[Fraction], int]] = {
    Rounding.UP: ceil,
    Rounding.DOWN: floor,
    Rounding.NEAREST: round,
}


def _rounded(value: Fraction, side: Rounding, digits: int = DIGITS) -> Fraction:
    """The value with so many significant digits, or more where it has more before the point."""
    power = 0
    while power > -PLACES and abs(value) < Fraction(10) ** (power + digits - 1):
        power -= 1
    last = Fraction(10) ** power
    return _WHOLE[side](value / last) * last


def _text(value: Fraction) -> str:
    """A rounded value as a decimal number."""
    whole, rest = divmod(abs(int(value * 10**PLACES)), 10**PLACES)
    decimals = f"{rest:0{PLACES}}".rstrip("0")
    return ("-" if value < 0 else "") + f"{whole}" + (f".{decimals}" if decimals else "")


Pair = tuple[Fraction, Fraction]


def _pairs(of: Pair, sides: tuple[Rounding, Rounding]) -> Iterator[tuple[Pair, Pair]]:
    """Two figures, each to its side and to the nearest: with three digits, then with more."""
    nearest = Rounding.NEAREST
    for digits in range(DIGITS, DIGITS + PLACES):
        safe = _rounded(of[0], sides[0], digits), _rounded(of[1], sides[1], digits)
        yield safe, (_rounded(of[0], nearest, digits), _rounded(of[1], nearest, digits))


def _compared(first: Fraction, second: Fraction, of_second: Rounding) -> tuple[str, str]:
    """Both with the digits that show whether the first is larger, and how much."""
    safe = first, second
    for safe, near in _pairs((first, second), (Rounding.UP, of_second)):
        if first <= second and safe[0] <= safe[1]:
            break
        if first > second and safe[0] > safe[1] and near[0] > near[1]:
            break
    return _text(safe[0]), _text(safe[1])


def _changed(before: Fraction, now: Fraction, side: Rounding) -> tuple[str, str]:
    """Two values of one figure with the digits by which they differ."""
    safe = before, now
    for safe, near in _pairs((before, now), (side, side)):
        if before == now or (safe[0] != safe[1] and near[0] != near[1]):
            break
    return _text(safe[0]), _text(safe[1])


# --- Times -----------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class TimeUnit:
    """A unit for the cells of a table: one table has one unit. A time that is None is ``-``."""

    name: str
    length: int
    """In ns."""

    def up(self, time: int | None) -> str:
        """A time that work needs or took."""
        return "-" if time is None else _text(_rounded(self._of(time), Rounding.UP))

    def down(self, time: int | None) -> str:
        """A time that is left or allowed."""
        return "-" if time is None else _text(_rounded(self._of(time), Rounding.DOWN))

    def against(self, needed: int | None, limit: int | None) -> tuple[str, str]:
        """A needed time and its limit: their cells show whether the first is longer."""
        if needed is None or limit is None:
            return self.up(needed), self.down(limit)
        return _compared(self._of(needed), self._of(limit), Rounding.DOWN)

    def beside(self, seen: int | None, bound: int | None) -> tuple[str, str]:
        """An observed time and its bound: their cells show whether the first is longer."""
        if seen is None or bound is None:
            return self.up(seen), self.up(bound)
        return _compared(self._of(seen), self._of(bound), Rounding.UP)

    def _of(self, time: int) -> Fraction:
        return Fraction(time, self.length)


US = TimeUnit("us", 1_000)
MS = TimeUnit("ms", 1_000_000)
SECONDS = TimeUnit("s", 1_000_000_000)


def unit_of(times: Iterable[int | None]) -> TimeUnit:
    """The unit for a table of these times: ms if one of them is 1 ms or longer, else us."""
    longest = max((abs(time) for time in times if time is not None), default=0)
    return MS if longest >= MS.length else US


def _unit(*times: int) -> TimeUnit:
    """The unit for a sentence: s from 1 s on, ms from 1 ms on, else us."""
    return SECONDS if max(map(abs, times)) >= SECONDS.length else unit_of(times)


def up(time: int) -> str:
    """A time that work needs or took, with its unit: ``7.74 ms`` for 7735 us."""
    return _with_unit(time, Rounding.UP)


def down(time: int) -> str:
    """A time that is left or allowed, with its unit: ``7.73 ms`` for 7735 us."""
    return _with_unit(time, Rounding.DOWN)


def _with_unit(time: int, side: Rounding) -> str:
    unit = _unit(time)
    unit = _unit(int(_rounded(Fraction(time, unit.length), side) * unit.length))
    return f"{_text(_rounded(Fraction(time, unit.length), side))} {unit.name}"


def against(needed: int, limit: int) -> tuple[str, str]:
    """A needed time and its limit with the digits that show which is longer: R and D.

    They have one unit, except where one is a thousand times as long as the other.
    """
    if max(needed, limit) >= FAR * min(needed, limit):
        return up(needed), down(limit)
    unit = _unit(needed, limit)
    first, second = unit.against(needed, limit)
    return f"{first} {unit.name}", f"{second} {unit.name}"


def beside(seen: int, bound: int) -> tuple[str, str]:
    """An observed time and its bound, R or C, with the digits that show which is longer."""
    if max(seen, bound) >= FAR * min(seen, bound):
        return up(seen), up(bound)
    unit = _unit(seen, bound)
    first, second = unit.beside(seen, bound)
    return f"{first} {unit.name}", f"{second} {unit.name}"


def changed(before: int, now: int, side: Rounding) -> tuple[str, str]:
    """Two values of one time in one unit, with the digits by which they differ."""
    unit = _unit(before, now)
    texts = _changed(Fraction(before, unit.length), Fraction(now, unit.length), side)
    return f"{texts[0]} {unit.name}", f"{texts[1]} {unit.name}"


def of_seconds(time: float) -> int:
    """A time of a clock that counts in s, in ns."""
    return round(time * SECONDS.length)


def instant(time: int) -> str:
    """A time on the clock of a run, in s to the millisecond: its digits are not significant."""
    return f"{time / SECONDS.length:.3f}"


def age(time: int) -> str:
    """The time since something happened, in s to a tenth: for a table that changes all the time."""
    return f"{max(0, time) / SECONDS.length:.1f}"


# --- Shares ----------------------------------------------------------------------------

_ALL = Fraction(100)


def percent(share: Fraction) -> str:
    """A needed share as a percentage: ``100 %`` only where it is exactly that."""
    value = safe = share * _ALL
    for (safe, _), (near, _) in _pairs((value, _ALL), (Rounding.UP, Rounding.UP)):
        if value == _ALL or (near > _ALL if value > _ALL else safe < _ALL):
            break
    return f"{_text(safe)} %"


def shares_beside(seen: Fraction, bound: Fraction) -> tuple[str, str]:
    """An observed load and its bound with the digits that show which is larger."""
    first, second = _compared(seen * _ALL, bound * _ALL, Rounding.UP)
    return f"{first} %", f"{second} %"


def room(share: Fraction) -> str:
    """A share that is left, as a percentage."""
    return f"{_text(_rounded(share * _ALL, Rounding.DOWN))} %"


def factor(value: Fraction) -> str:
    """A factor by which times may grow."""
    return _text(_rounded(value, Rounding.DOWN))


def changed_shares(before: Fraction, now: Fraction) -> tuple[str, str]:
    """Two values of a load as percentages, with the digits by which they differ."""
    first, second = _changed(before * _ALL, now * _ALL, Rounding.UP)
    return f"{first} %", f"{second} %"


def changed_factors(before: Fraction, now: Fraction) -> tuple[str, str]:
    """Two factors by which times may grow, with the digits by which they differ."""
    return _changed(before, now, Rounding.DOWN)


def signed_percent(share: Fraction) -> str:
    """A difference as a percentage with its sign, to the nearest."""
    text = _text(_rounded(share * _ALL, Rounding.NEAREST))
    return f"{text} %" if share < 0 else f"+{text} %"
