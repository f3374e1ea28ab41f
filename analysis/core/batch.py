"""Busy periods of many tasks at once, in arrays: what makes large sets fast.

For plain tasks (one cost, no jitter) the busy period at the level of a task is the least W
with

    W = B + sum over the tasks as urgent or more of  ceil(W / T_j) C_j

All of them grow to their fixed points together; those that are there drop out. Tasks of
one period are one source. Each starts from a lower bound after Davis, Zabos, Burns (IEEE
TC 57, 2008): the most urgent tasks, up to any one, need at least what a fluid of their
rates needs, and all others at least one job each.

The numbers are doubles, and the results exact. Doubles hold integers up to 2^53. With r
the double next to (1 - 2^-50) / T, the double product w r, rounded up, is ceil(w / T)
for integers 1 <= w < `LIMIT`: it is at most w / T, and less by under 1 / T, and no integer
lies between, as w / T is whole or at least 1 / T above a whole number. A level that would
reach `LIMIT`, or the longest period, is given up.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Doubles = NDArray[np.float64]
else:
    Doubles = Any

LIMIT = 1 << 48
"""Times from here on are left to integers."""

CELLS = 1 << 14
"""Tasks times sources that are taken together: more do not fit a processor's cache."""

NARROWEST = 50
"""Fewer tasks are not taken together, however many sources there are."""

WORTH_IT = 24
"""With fewer tasks than this, arrays are no faster."""

STEPS = 200
"""Steps after which what still grows is given up."""

TINY = 1e-9
"""More than all rounding in a sum of rates."""


def busy_periods(
    periods: Sequence[int], costs: Sequence[int], last: Sequence[int], blocked: Sequence[int]
) -> list[int]:
    """The busy period at the level of each task, 0 where it is given up.

    Tasks come most urgent first; ``last[j]`` is the number of the last one as urgent as
    task j, and ``blocked[j]`` what task j suffers once.
    """
    import numpy as np

    count, longest = len(periods), max(periods)
    if max(longest, *costs, *blocked) >= LIMIT:
        return [0] * count
    numbers: dict[int, int] = {}
    source = np.array([numbers.setdefault(period, len(numbers)) for period in periods])
    own = np.array(costs, float)
    rate = ((1 - 2.0**-50) / np.array(list(numbers), float))[None, :]
    total = np.zeros(count + 1)
    np.cumsum(own, out=total[1:])
    level = np.array(last)
    once = np.array(blocked, float)
    used = np.cumsum(own * rate[0, source])
    #  Where the rates are above 1 there is no busy period.
    end = int(np.searchsorted(used[level], 1 + TINY))
    needed = np.ones((count, 2))
    needed[:, 0] = total[level + 1] + once
    bounds = _fluid(used, total)
    found = np.zeros(count)
    before: Doubles = np.zeros(len(numbers))
    block = max(NARROWEST, CELLS // len(numbers))
    low = 0
    while low < end:
        high = 1 + int(level[min(low + block, end) - 1])
        seen = 1 + int(source[:high].max())
        rows = np.zeros((high - low, seen))
        rows[np.arange(high - low), source[low:high]] = own[low:high]
        rows[0] += before[:seen]
        np.cumsum(rows, axis=0, out=rows)
        before[:seen] = rows[-1]
        start = np.floor(np.dot(needed[low:high], bounds[:, :high]).max(1))
        if low:
            np.maximum(start, found[low - 1], out=start, where=once[low:high] >= once[low - 1])
        found[low:high] = _settled(
            start, rows[level[low:high] - low], rate[:, :seen], once[low:high], longest
        )
        low = high
    return [int(length) for length in found.tolist()]


def _fluid(used: Doubles, total: Doubles) -> Doubles:
    """Factors of what is needed, and of 1, that make lower bounds of a busy period.

    Column k takes the tasks before k as a fluid: (needed - total[k]) / (1 - used[k - 1]).
    """
    import numpy as np

    factors = np.empty((2, len(used)))
    factors[0, 0] = 1.0
    factors[0, 1:] = 1 / np.maximum(1 + TINY - used[:-1], TINY)
    np.multiply(factors[0], -total[:-1], out=factors[1])
    factors[0, 1:] *= 1 - 2.0**-40
    return factors


def _settled(window: Doubles, cost: Doubles, rate: Doubles, once: Doubles, longest: int) -> Doubles:
    """The least fixed point of each row from ``window`` on, 0 where it is above ``longest``.

    In row i a release of source j takes ``cost[i, j]``; ``once[i]`` comes on top.
    """
    import numpy as np

    found = np.zeros(len(window))
    rows = np.arange(len(window))
    blocked = bool(once.any())
    for _ in range(STEPS):
        demand = np.dot(window[:, None], rate)
        np.ceil(demand, out=demand)
        needed: Doubles = np.vecdot(demand, cost)
        if blocked:
            needed += once
        going = (needed > window).nonzero()[0]
        if 2 * len(going) <= len(rows):
            found[rows] = needed
            found[rows[going]] = 0
            going = going[needed[going] <= longest]
            if not len(going):
                break
            rows, cost, once, needed = rows[going], cost[going], once[going], needed[going]
        window = needed
    found[found > longest] = 0
    return found
