# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The library gives what the integers give: small sets one after another, large ones at random."""

from __future__ import annotations

import os
import random
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core import fixed_priority, kernel
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.fixed_priority import analyse_tasks, bounds
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.core.tasks import TableRow, Task

NEVER = 10**9


def found(
    tasks: Sequence[Task], sections: Sequence[Section], platform: Platform, worth_it: int
) -> tuple[Response, ...]:
    """The responses where the library is asked from so many tasks on."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(fixed_priority, "WORTH_IT", worth_it)
        responses = analyse_tasks(tasks, sections, {"": platform})
        assert bounds(tasks, sections, {"": platform}) == tuple(r.bound for r in responses)
        return responses


def compare(
    tasks: Sequence[Task],
    sections: Sequence[Section] = (),
    platform: Platform = fixed_priority.NO_OVERHEAD,
) -> None:
    for fast, slow in zip(
        found(tasks, sections, platform, 1), found(tasks, sections, platform, NEVER), strict=True
    ):
        assert (fast.bound, fast.reason, fast.window) == (slow.bound, slow.reason, slow.window)
        assert fast.interference == slow.interference
        assert (fast.own, fast.blocked, fast.overheads) == (slow.own, slow.blocked, slow.overheads)


def small_sets(count: int, longest: int) -> Iterator[list[Task]]:
    pairs = [(t, c) for t in range(1, longest + 1) for c in range(1, t + 1)]
    for chosen in product(pairs, repeat=count):
        yield [Task(f"t{n}", 9 - n, t, t, c) for n, (t, c) in enumerate(chosen)]


@pytest.mark.parametrize(("count", "longest"), [(1, 12), (2, 5), (3, 3)])
def test_all_small_sets_agree_overloaded_ones_too(count: int, longest: int) -> None:
    for tasks in small_sets(count, longest):
        compare(tasks)


@st.composite
def large_sets(draw: st.DrawFn) -> tuple[list[Task], list[Section], Platform]:
    rng = random.Random(draw(st.integers(0, 10**9)))
    count, load = draw(st.integers(1, 200)), draw(st.sampled_from((0.4, 0.8, 0.97, 1.0, 1.3)))
    longest = draw(st.sampled_from((3, 50, 10**6, 10**9, 1 << 47)))
    levels = draw(st.sampled_from((1, count // 3 + 1, 3 * count)))
    few = [rng.randint(1, longest) for _ in range(9)]
    tasks = []
    for n in range(count):
        period = rng.choice(few) if draw(st.booleans()) else rng.randint(1, longest)
        wcet = max(1, int(period * load / count * 2 * rng.random()))
        tasks.append(Task(f"t{n}", rng.randint(1, levels), period, period, wcet))
    sections = [
        Section(f"o{rng.randint(0, 3)}", task.name, rng.randint(1, task.wcet))
        for task in tasks
        if draw(st.integers(0, 9)) == 0
    ]
    return tasks, sections, Platform(context_switch=draw(st.integers(0, 1)))


@settings(max_examples=40 if "RAVENCHART_LONG_TESTS" in os.environ else 12, deadline=None)
@given(large_sets())
def test_large_sets_agree(drawn: tuple[list[Task], list[Section], Platform]) -> None:
    compare(*drawn)


def test_the_library_is_built_and_asked() -> None:
    assert kernel.busy_periods([4, 9], [1, 2], [0, 1], [0, 3]) == [1, 7]
    assert kernel.busy_periods([4, 9], [1, 7], [0, 1], [0, 0]) == [1, 0]


def test_where_it_is_not_built_the_integers_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    tasks = [Task(f"t{n}", 50 - n, 1_000 + n, 1_000, 10) for n in range(40)]
    before = bounds(tasks)
    monkeypatch.setattr(kernel, "LIBRARY", Path("/nowhere/libbusy_periods.so"))
    kernel.library.cache_clear()
    try:
        assert kernel.busy_periods([4, 9], [1, 2], [0, 1], [0, 3]) == []
        assert bounds(tasks) == before
    finally:
        kernel.library.cache_clear()


def test_as_many_tasks_as_there_is_room_for_and_one_more() -> None:
    for count in (kernel.MOST_TASKS, kernel.MOST_TASKS + 1):
        fits = count <= kernel.MOST_TASKS
        expected = [2 * n for n in range(1, count + 1)] if fits else []
        given = [10**9] * count, [2] * count, list(range(count)), [0] * count
        assert kernel.busy_periods(*given) == expected


def test_levels_that_many_tasks_share() -> None:
    tasks = [Task(f"t{n}", -(n // 7), 10_000 + 61 * n, 10**6, 40) for n in range(210)]
    compare(tasks, [Section("o", "t150", 39), Section("o", "t3", 1)])


def test_any_levels_are_answered() -> None:
    """The proof does not ask for levels that fit together."""
    rng = random.Random(7)
    for _ in range(300):
        count = rng.randint(2, 9)
        periods = [rng.randint(1, 40) for _ in range(count)]
        wcets = [rng.randint(1, period) for period in periods]
        last = [rng.randint(n, count - 1) for n in range(count)]
        blocked = [rng.randint(0, 9) for _ in range(count)]
        for n, w in enumerate(kernel.busy_periods(periods, wcets, last, blocked)):
            level = range(last[n] + 1)
            assert w == 0 or blocked[n] + sum(-(-w // periods[j]) * wcets[j] for j in level) <= w


def test_full_to_the_brim_and_a_tick_more() -> None:
    tasks = [Task(f"t{n}", 50 - n, 50, 50, 1) for n in range(50)]
    compare(tasks)
    assert bounds(tasks)[-1] == 50
    compare([*tasks, Task("more", 0, 10**12, 10**12, 1)])


def test_what_the_library_cannot_hold_is_left_to_integers() -> None:
    huge = 1 << 70
    tasks = [Task(f"t{n}", 50 - n, huge + n, huge, huge // 64) for n in range(40)]
    compare(tasks)
    assert bounds(tasks)[39] == 40 * (huge // 64)
    near = [Task(f"t{n}", 50 - n, (1 << 47) + n, 1 << 47, (1 << 41) - n) for n in range(40)]
    compare(near)


@pytest.mark.slow
def test_counts_are_exact_next_to_whole_numbers() -> None:
    """One tick to either side of a release."""
    for period in (3, 7, 10**6 + 3, (1 << 40) - 1):
        for times in (1, 2, kernel.LIMIT // period // 2):
            for away in (-1, 0, 1):
                first = period * times + away
                if first > 0:
                    tasks = [Task("a", 2, kernel.LIMIT - 1, 1, first), Task("b", 1, period, 1, 1)]
                    compare(tasks)


def test_what_is_not_plain_is_left_to_the_general_analysis() -> None:
    plain = [Task(f"t{n}", 50 - n, 1_000, 1_000, 10) for n in range(40)]
    for other in (
        Task("x", 99, 1_000, 1_000, 10, jitter=5),
        Task("x", 99, 1_000, 1_000, 10, rows=(TableRow("r", 9, 2, 1),)),
    ):
        compare([*plain, other])
    compare(plain, platform=Platform(release=1))
    compare(plain, platform=Platform(tick_period=100, tick_wcet=1))
