# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Busy periods of many plain tasks at once, by the compiled and proved part of the analysis.

For plain tasks (one C, no jitter) the busy period at the level of a task is the least W
with

    W = B + sum over the tasks as urgent or more of  ceil(W / T_j) C_j

`analysis/kernel/busy_periods.ads` has the contract that is proved. Where the library has not
been built, the integers of `window` give the same result, more slowly.
"""

from __future__ import annotations

import ctypes
from array import array
from collections.abc import Sequence
from functools import cache

from ravenchart.paths import work

LIBRARY = work() / "obj" / "kernel" / "libbusy_periods.so"

LIMIT = 1 << 47
"""Times from here on are left to Python's integers."""

MOST_TASKS = 1 << 13
"""The tasks that the library has room for."""

WORTH_IT = 8
"""With fewer tasks than this, a call is no faster."""


def busy_periods(
    periods: Sequence[int], wcets: Sequence[int], last: Sequence[int], blocked: Sequence[int]
) -> list[int]:
    """The busy period at the level of each task, 0 where it is longer than the task's period.

    Tasks come most urgent first; ``last[j]`` is the number of the last one as urgent as
    task j, and ``blocked[j]`` is B of task j. An empty list where the library is not
    built, or has no room for the tasks or their times.
    """
    find, count = library(), len(periods)
    if find is None or count > MOST_TASKS or max(*periods, *blocked) >= LIMIT:
        return []
    for wcet, period in zip(wcets, periods, strict=True):
        if wcet > period:
            return []
    found = array("q", bytes(8 * count))
    given = (
        array("q", periods),
        array("q", wcets),
        array("i", [level + 1 for level in last]),
        array("q", blocked),
        found,
    )
    find(count, *[one.buffer_info()[0] for one in given])
    return found.tolist()


@cache
def library() -> ctypes._NamedFuncPointer | None:
    """`Busy_Periods.Find`, where it has been built."""
    try:
        find = ctypes.CDLL(str(LIBRARY)).find_busy_periods
    except OSError:
        return None
    find.argtypes = [ctypes.c_int, *[ctypes.c_void_p] * 5]
    find.restype = None
    return find
