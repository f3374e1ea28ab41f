# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Exact demand of releases whose costs repeat in a cycle.

Mok and Chen, A multiframe model for real-time tasks (IEEE TSE 23, 1997); here for
any cycle of costs: the most that k releases in a row can cost is the largest sum
over all frames they may begin with (Baruah, Chen, Gorinsky, Mok 1999).
"""

from __future__ import annotations

from itertools import accumulate


class Demand:
    """What consecutive releases cost, ``costs[k mod n]`` for release k, in ticks."""

    __slots__ = ("_most", "_sums", "costs", "total")

    def __init__(self, costs: tuple[int, ...]) -> None:
        """``costs`` holds at least one cost, none negative."""
        n = len(costs)
        self.costs = costs
        self.total = sum(costs)
        self._sums: tuple[int, ...] = (0, *costs)
        self._most: tuple[int, ...] = (0,)
        if n > 1:
            sums = self._sums = tuple(accumulate(costs + costs, initial=0))
            self._most = tuple(max(sums[s + k] - sums[s] for s in range(n)) for k in range(n))

    def most(self, count: int) -> int:
        """The most that ``count`` releases in a row can cost."""
        cycles, rest = divmod(count, len(self.costs))
        return cycles * self.total + self._most[rest]

    def first(self, count: int) -> int:
        """The frame with which those ``count`` releases begin; the first of several."""
        n = len(self.costs)
        rest = count % n
        sums = self._sums
        return next(s for s in range(n) if sums[s + rest] - sums[s] == self._most[rest])

    def before(self, count: int, frame: int) -> int:
        """The cost of the ``count`` releases that precede one of ``frame``."""
        n = len(self.costs)
        if n == 1:
            return count * self.total
        cycles, rest = divmod(count, n)
        return cycles * self.total + self._sums[frame + n] - self._sums[frame + n - rest]

    @property
    def steady(self) -> tuple[int, ...] | None:
        """None when every release costs the same, else the table behind `most`."""
        return None if len(self.costs) == 1 else self._most
