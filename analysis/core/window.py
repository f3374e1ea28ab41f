# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Least fixed points of demand, for windows and sets of sources that only grow.

The recurrence of every response-time analysis here is

    w = fixed + sum over sources of  most(ceil((w + jitter) / period))

Each source is kept with the window up to which its number of releases stays as
it is; the smallest of these is on top of a heap. So a step touches only the
sources whose number changes, and takes each at once to its new number. A window
that grows from level to level, and from job to job, is never started again from
zero (Sjodin and Hansson 1998). It starts no lower than the demand of a
fluid of the same rates (Davis, Zabos, Burns, IEEE TC 57, 2008, equation 17).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from fractions import Fraction
from heapq import heappop, heappush, heapreplace

from .multiframe import Demand

SCALE = 1 << 96
"""Rates are counted in 1 / this of the resource, rounded down."""

Source = tuple[int, int, int, tuple[int, ...] | None]
"""T, J, C of a release or of a cycle, and the table of `Demand` for a cycle."""


def source(period: int, jitter: int, demand: Demand) -> Source:
    """Releases every ``period`` with that jitter and demand."""
    return period, jitter, demand.total, demand.steady


def constant_source(period: int, jitter: int, wcet: int) -> Source:
    """Releases every ``period`` with that jitter, all of the same C."""
    return period, jitter, wcet, None


def releases_in(length: int, period: int, jitter: int) -> int:
    """Releases in a window of that length that is closed by no release."""
    return -(-(length + jitter) // period)


def execution_of(item: Source, count: int) -> int:
    """The most that ``count`` releases of a source execute."""
    _, _, wcet, table = item
    if table is None:
        return count * wcet
    cycles, rest = divmod(count, len(table))
    return cycles * wcet + table[rest]


def rate(item: Source) -> int:
    """The share that a source needs in the long run, in 1 / `SCALE`, rounded down."""
    period, _, wcet, table = item
    return wcet * SCALE // (period if table is None else period * len(table))


class Load:
    """A sum of rates, compared with 1 exactly, but by fractions only where they are needed."""

    __slots__ = ("_count", "_low")

    def __init__(self) -> None:
        """No load."""
        self._low = 0
        self._count = 0

    def add(self, item: Source) -> None:
        """Add a source."""
        self._low += rate(item)
        self._count += 1

    def above_one(self, exact: Callable[[], Fraction], extra: int = 0) -> bool:
        """Whether the sum, with a rate ``extra``, is above 1; ``exact()`` is the exact sum."""
        low = self._low + extra
        return low > SCALE or (low + self._count + 1 > SCALE and exact() > 1)


class Effort:
    """The work that may still be done: one unit for each change of a number of releases."""

    __slots__ = ("left",)

    def __init__(self, left: int) -> None:
        """``left`` units in all."""
        self.left = left


class Window:
    """A window over sources that are added while it grows."""

    __slots__ = ("_apart", "_due", "_head_start", "_rate", "demand", "length")

    def __init__(self) -> None:
        """A window of length zero without sources."""
        self.length = 0
        self.demand = 0
        self._rate = 0
        self._head_start = 0
        self._due: list[tuple[float, int, int, Source]] = [(math.inf, -1, 0, (1, 0, 0, None))]
        self._apart = -1

    def fork(self) -> Window:
        """A copy of the window that grows independently."""
        other = Window.__new__(Window)
        other.length = self.length
        other.demand = self.demand
        other._rate = self._rate
        other._head_start = self._head_start
        other._due = self._due.copy()
        other._apart = self._apart
        return other

    def add(self, serial: int, item: Source) -> None:
        """Add a source; ``serial``, from 0 up, is its unique number."""
        period, jitter, _, _ = item
        count = releases_in(self.length, period, jitter)
        taken = execution_of(item, count)
        self.demand += taken
        heappush(self._due, (count * period - jitter, serial, taken, item))
        self._weigh(item, 1)

    def leave_out(self, serial: int, item: Source) -> None:
        """Remove one source; a window allows this once."""
        period, jitter, _, _ = item
        self.demand -= execution_of(item, releases_in(self.length, period, jitter))
        self._apart = serial
        self._weigh(item, -1)

    def settle(self, fixed: int, effort: Effort) -> bool:
        """Grow to the least fixed point; False when the effort does not suffice.

        ``fixed`` and the sources must be such that the fixed point is no less than
        the present length: they never shrink from call to call.
        """
        due, apart = self._due, self._apart
        length, demand = self.length, self.demand
        room = SCALE - self._rate
        fluid = (fixed * SCALE + self._head_start) // room if room > 0 else 0
        needed = max(fixed + demand, length, fluid)
        while needed > length and effort.left > 0:
            length = needed
            spent = 1
            while due[0][0] < length:
                _, serial, taken, item = due[0]
                if serial == apart:
                    heappop(due)
                    continue
                period, jitter, wcet, table = item
                count = -(-(length + jitter) // period)
                if table is None:
                    now = count * wcet
                else:
                    cycles, rest = divmod(count, len(table))
                    now = cycles * wcet + table[rest]
                demand += now - taken
                spent += 1
                heapreplace(due, (count * period - jitter, serial, now, item))
            effort.left -= spent
            needed = fixed + demand
        self.length, self.demand = length, demand
        return needed <= length

    def _weigh(self, item: Source, sign: int) -> None:
        """Count its long-run rate, and the demand that its jitter adds, both rounded down."""
        share = rate(item)
        self._rate += sign * share
        self._head_start += sign * share * item[1]
