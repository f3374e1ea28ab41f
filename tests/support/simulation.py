# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A brute-force schedule of small synchronous task sets, one unit of time after another."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ravenchart.gen.model.system import Task


def longest_responses(tasks: Sequence[Task]) -> dict[str, int]:
    """The longest response of each task over two hyperperiods, all released at 0.

    Priorities differ, there is no jitter and no shared object, and the load is at
    most 1, so the processor is idle or done at every hyperperiod.
    """
    ordered = sorted(tasks, key=lambda t: -t.priority)
    pending: dict[str, list[list[int]]] = {t.element: [] for t in tasks}
    longest = {t.element: 0 for t in tasks}
    for now in range(2 * math.lcm(*(t.period for t in tasks))):
        for t in ordered:
            if now % t.period == 0:
                pending[t.element].append([now, t.wcet])
        for t in ordered:
            if pending[t.element]:
                job = pending[t.element][0]
                job[1] -= 1
                if job[1] == 0:
                    pending[t.element].pop(0)
                    longest[t.element] = max(longest[t.element], now + 1 - job[0])
                break
    return longest
