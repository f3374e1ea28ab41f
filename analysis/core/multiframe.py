# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Exact demand of releases whose execution times repeat in a cycle.

Mok and Chen, A multiframe model for real-time tasks (IEEE TSE 23, 1997), here for any
cycle of times. The demand of k releases in a row is the largest sum over all jobs of
the cycle that they may begin with (Baruah, Chen, Gorinsky, Mok 1999).
"""

from __future__ import annotations

from itertools import accumulate


class Demand:
    """The demand of consecutive releases: C is ``wcets[k mod n]`` for release k, in ticks."""

    __slots__ = ("_most", "_sums", "total", "wcets")

    def __init__(self, wcets: tuple[int, ...]) -> None:
        """``wcets`` has at least one execution time, none negative."""
        n = len(wcets)
        self.wcets = wcets
        self.total = sum(wcets)
        self._sums: tuple[int, ...] = (0, *wcets)
        self._most: tuple[int, ...] = (0,)
        if n > 1:
            sums = self._sums = tuple(accumulate(wcets + wcets, initial=0))
            self._most = tuple(max(sums[s + k] - sums[s] for s in range(n)) for k in range(n))

    def most(self, count: int) -> int:
        """The most that ``count`` releases in a row can execute."""
        cycles, rest = divmod(count, len(self.wcets))
        return cycles * self.total + self._most[rest]

    def first(self, count: int) -> int:
        """The job of the cycle with which those releases begin; the first of several."""
        n = len(self.wcets)
        rest = count % n
        sums = self._sums
        return next(s for s in range(n) if sums[s + rest] - sums[s] == self._most[rest])

    def before(self, count: int, frame: int) -> int:
        """The execution time of the ``count`` releases before job ``frame`` of the cycle."""
        n = len(self.wcets)
        if n == 1:
            return count * self.total
        cycles, rest = divmod(count, n)
        return cycles * self.total + self._sums[frame + n] - self._sums[frame + n - rest]

    @property
    def steady(self) -> tuple[int, ...] | None:
        """None when every release has the same C, else the table behind `most`."""
        return None if len(self.wcets) == 1 else self._most
