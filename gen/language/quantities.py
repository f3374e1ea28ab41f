# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Quantities as text: durations, sizes and bit rates, exact or refused.

All durations are integers in nanoseconds.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction

from .terms import Ns

NANOSECONDS: Mapping[str, int] = {"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9}
BYTES: Mapping[str, int] = {"B": 1, "KiB": 2**10, "MiB": 2**20}
BITS_PER_SECOND: Mapping[str, int] = {"bit/s": 1, "kbit/s": 10**3, "Mbit/s": 10**6}

LONGEST = Ns(3_600 * 10**9)
"""One hour, the longest duration in a model."""

NUMBER = r"[0-9]{1,15}(?:\.[0-9]{1,15})?"


def pattern(units: Mapping[str, int]) -> str:
    """The regular expression of a quantity in these units."""
    return rf"^{NUMBER} ?(?:{'|'.join(units)})$"


def quantity(text: str, units: Mapping[str, int]) -> int | None:
    """The quantity in the smallest unit; None when not well-formed or not exact."""
    match = re.fullmatch(rf"({NUMBER}) ?({'|'.join(units)})", text)
    if match is None:
        return None
    value = Fraction(match[1]) * units[match[2]]
    return value.numerator if value.denominator == 1 else None


def duration(text: str) -> Ns | None:
    """A duration such as ``20 ms`` in ns; None when not well-formed or not exact."""
    value = quantity(text, NANOSECONDS)
    return None if value is None else Ns(value)


def shown(value: int) -> str:
    """A duration in ns, in the largest unit that needs no fraction."""
    for unit in ("s", "ms", "us"):
        if value and value % NANOSECONDS[unit] == 0:
            return f"{value // NANOSECONDS[unit]} {unit}"
    return f"{value} ns"
