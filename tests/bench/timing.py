# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How the response-time analysis grows, and how it stands beside a compiled one.

The crate `response-time-analysis` gets the same sets of plain tasks and must give the same
answers; both are timed apart from start-up and reading. Of ours there are two figures:
`bounds` gives the responses, as the crate does, and `analyse` every term of them besides.
"""

from __future__ import annotations

import random
import shutil
import subprocess
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from ravenchart.analysis.core import can, fixed_priority
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.frames import classic_bits
from ravenchart.analysis.core.tasks import Task
from ravenchart.paths import ROOT

COUNTS = (10, 100, 1_000)
LOAD = 0.8
ROUNDS = 9
MS = 10**6
CRATE = ROOT / "tests" / "rta_crate"

AUTOMOTIVE = {1: 3, 2: 2, 5: 2, 10: 25, 20: 25, 50: 3, 100: 20, 200: 1, 1000: 4}
"""Periods in ms of engine control, and the share of each: Kramer, Ziegenbein, Hamann, Real
world automotive benchmarks for free (WATERS 2015), table III."""

BIT_RATE = 1_000_000
BIT_TIME = 1_000


def least_us(work: Callable[[], object]) -> float:
    """The shortest time of `ROUNDS` calls, in us: what else runs only lengthens it."""
    spent = []
    for _ in range(ROUNDS):
        start = time.perf_counter()
        work()
        spent.append(1e6 * (time.perf_counter() - start))
    return min(spent)


def shares(count: int, load: float, chance: random.Random) -> list[float]:
    """Utilisations that add up to ``load``, evenly distributed (UUniFast, Bini, Buttazzo 2005)."""
    left, found = load, []
    for others in range(count - 1, 0, -1):
        rest = left * chance.random() ** (1 / others)
        found.append(left - rest)
        left = rest
    return [*found, left]


def task_set(count: int, *, automotive: bool) -> list[Task]:
    """Tasks in rate-monotonic order at 80 %; periods from 1 ms to 1 s, few or all different."""
    chance = random.Random(count)
    if automotive:
        drawn = chance.choices(list(AUTOMOTIVE), list(AUTOMOTIVE.values()), k=count)
        periods = sorted(MS * period for period in drawn)
    else:
        periods = sorted(int(MS * 10 ** (3 * chance.random())) for _ in range(count))
    return [
        Task(f"t{n}", count - n, period, period, max(1, int(period * share)))
        for n, (period, share) in enumerate(zip(periods, shares(count, LOAD, chance), strict=True))
    ]


def message_set(count: int) -> list[Frame]:
    """Frames of 0 to 8 bytes, most frequent first, with periods such that they load 80 %."""
    chance = random.Random(count)
    costs = [classic_bits(chance.randint(0, 8)).time(BIT_RATE) for _ in range(count)]
    periods = sorted(
        (int(cost / share) for cost, share in zip(costs, shares(count, LOAD, chance), strict=True))
    )
    scale = sum(cost / period for cost, period in zip(costs, periods, strict=True)) / LOAD
    return [
        Frame(f"m{n}", n, int(period * scale) + 1, int(period * scale) + 1, cost)
        for n, (cost, period) in enumerate(zip(costs, periods, strict=True))
    ]


@dataclass(frozen=True, slots=True)
class CrateResult:
    """What the crate found for one set, and its time in us."""

    spent: float
    bounds: tuple[int | None, ...]


def by_crate(sets: Sequence[Sequence[Task]]) -> list[CrateResult]:
    """The crate's answers; nothing, and why on the terminal, where it cannot be built."""
    cargo = shutil.which("cargo")
    if cargo is None:
        print("  the crate: cargo is not installed, nothing to compare with")
        return []
    target = ROOT / "obj" / "rta-crate"
    built = subprocess.run(
        [cargo, "build", "--release", "--locked", "--quiet", "--target-dir", target],
        cwd=CRATE,
        capture_output=True,
        text=True,
    )
    if built.returncode != 0:
        print(f"  the crate could not be built: {built.stderr.strip()[-300:]}")
        return []
    lines = [" ".join(f"{task.period} {task.wcet}" for task in tasks) for tasks in sets]
    done = subprocess.run(
        [target / "release" / "rta-crate"],
        input="\n".join(lines) + "\n",
        capture_output=True,
        text=True,
        check=True,
    )
    found = [[int(word) for word in line.split()] for line in done.stdout.splitlines()]
    return [CrateResult(n[0] / 1e3, tuple(bound or None for bound in n[1:])) for n in found]


def tasks() -> None:
    """Task sets of both kinds, beside the crate."""
    for automotive in (False, True):
        kind = "periods as in engine control" if automotive else "all periods different"
        print(f"response times at {100 * LOAD:.0f} %, {kind}:")
        sets = [task_set(count, automotive=automotive) for count in COUNTS]
        crate = by_crate(sets)
        before = 0.0
        for number, tasks in enumerate(sets):
            spent = least_us(partial(fixed_priority.bounds, tasks))
            terms = least_us(partial(fixed_priority.analyse, tasks))
            text = f"  {len(tasks)} tasks: {_spent(spent, before)}, with all terms {_ms(terms)}"
            if crate:
                same = crate[number].bounds == fixed_priority.bounds(tasks)
                answers = "the same answers" if same else "OTHER ANSWERS"
                text += f"; the crate {_ms(crate[number].spent)}, {answers}"
            print(text)
            before = spent


def messages() -> None:
    """Message sets on one bus."""
    print(f"CAN response times at {100 * LOAD:.0f} %:")
    before = 0.0
    for count in (64, 256):
        spent = least_us(partial(can.analyse, message_set(count), Bus(BIT_TIME)))
        print(f"  {count} messages: {_spent(spent, before)}")
        before = spent


def _ms(spent: float) -> str:
    return f"{spent / 1e3:.3f} ms"


def _spent(spent: float, before: float) -> str:
    """The time, and how it has grown."""
    return _ms(spent) + (f" ({spent / before:.1f} times the one before)" if before else "")


def main() -> None:
    """All figures."""
    tasks()
    messages()


if __name__ == "__main__":
    main()
