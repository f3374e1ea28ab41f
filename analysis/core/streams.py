# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Jobs whose arrivals are known: one every period, from an offset on, for ever both ways."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .multiframe import Demand


@dataclass(frozen=True, slots=True)
class Stream:
    """Jobs that arrive at ``offset`` + k ``period``, with the demand of a cycle; in ticks."""

    offset: int
    period: int
    jitter: int
    demand: Demand

    @property
    def cycle(self) -> int:
        """The time after which it repeats."""
        return self.period * len(self.demand.wcets)

    def number(self, time: int) -> int:
        """The number of the first job that arrives no earlier than ``time``."""
        return -((self.offset - time) // self.period)

    def count(self, begin: int, end: int) -> int:
        """Jobs that arrive from ``begin`` on and before ``end``."""
        return self.number(end) - self.number(begin)

    def execution(self, begin: int, end: int) -> int:
        """The execution time of those jobs."""
        count = self.count(begin, end)
        return self.demand.before(count, self.number(end) % len(self.demand.wcets))

    def arrivals(self, until: int) -> Iterator[tuple[int, int]]:
        """Time and C of its jobs, wrapped into ``0 .. until - 1``, of whole cycles."""
        wcets = self.demand.wcets
        for k in range(until // self.period):
            yield (self.offset + k * self.period) % until, wcets[k % len(wcets)]
