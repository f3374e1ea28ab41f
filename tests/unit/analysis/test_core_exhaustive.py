# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bounds against everything that can happen to small sets, one after another.

A bound is never below what was observed; it is equal where the theory is exact. In
the simulation's ticks a section or frame that holds others up has begun a whole tick
before, so there the bound with blockers one tick shorter is the exact one.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import product

import pytest

from ravenchart.analysis.core import can
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.fixed_priority import analyse_tasks
from ravenchart.analysis.core.tasks import TableRow, Task
from tests.support.exhaustive import Toy, longest_responses

pytestmark = pytest.mark.slow

LONG = "RAVENCHART_LONG_TESTS" in os.environ
"""`make test-long`: sets of four tasks, and longer periods."""

Shape = tuple[int, tuple[tuple[int, ...], ...], int]
"""Period, costs of the rows of each frame, jitter; the first of a set is the most urgent."""

FAR = 1_000
"""A deadline that nothing misses."""


def load(chosen: Sequence[Shape]) -> Fraction:
    """The share of the processor that a set needs."""
    return sum(
        (Fraction(sum(map(sum, frames)), len(frames) * period) for period, frames, _ in chosen),
        Fraction(0),
    )


def sets(shapes: Sequence[Shape], count: int) -> Iterator[tuple[Shape, ...]]:
    """All sets of so many of the shapes with a load of at most 1."""
    loads = {shape: load([shape]) for shape in shapes}

    def extended(chosen: tuple[Shape, ...], used: Fraction) -> Iterator[tuple[Shape, ...]]:
        if len(chosen) == count:
            yield chosen
            return
        for shape in shapes:
            if used + loads[shape] <= 1:
                yield from extended((*chosen, shape), used + loads[shape])

    yield from extended((), Fraction(0))


def plain_shapes(longest: int, jitter: int = 0) -> list[Shape]:
    """Every period and cost up to ``longest``, every jitter up to ``jitter``."""
    return [
        (period, ((cost,),), late)
        for period in range(1, longest + 1)
        for cost in range(1, period + 1)
        for late in range(jitter + 1)
    ]


def framed_shapes(longest: int, frames: int) -> list[Shape]:
    """Tables of so many frames of at most one row each."""
    return [
        (period, tuple((cost,) if cost else () for cost in costs), 0)
        for period in range(2, longest + 1)
        for costs in product(range(period + 1), repeat=frames)
        if len(set(costs)) > 1
    ]


def toys(chosen: Sequence[Shape]) -> list[Toy]:
    return [Toy(9 - n, period, frames, late) for n, (period, frames, late) in enumerate(chosen)]


def task_of(number: int, shape: Shape, priority: int) -> Task:
    """The task of a shape; each frame's rows become rows of that phase."""
    period, frames, late = shape
    if len(frames) == 1 and len(frames[0]) == 1:
        return Task(f"t{number}", priority, period, FAR, frames[0][0], late)
    rows = tuple(
        TableRow(f"r{k}.{i}", cost, len(frames), k)
        for k, costs in enumerate(frames)
        for i, cost in enumerate(costs)
    )
    return Task(f"t{number}", priority, period, FAR, 0, late, rows=rows)


def tasks_of(chosen: Sequence[Shape]) -> list[Task]:
    return [task_of(n, shape, 9 - n) for n, shape in enumerate(chosen)]


def bounds(tasks: Sequence[Task], sections: Sequence[Section] = ()) -> list[int | None]:
    return [response.bound for response in analyse_tasks(tasks, sections)]


def observed(of: Sequence[Toy]) -> list[int]:
    return [seen.response for seen in longest_responses(of)]


def at_least(bound: Sequence[int | None], seen: Sequence[int]) -> bool:
    return all(b is not None and b >= s for b, s in zip(bound, seen, strict=True))


def long(*values: object) -> object:
    """A case of `make test-long`."""
    return pytest.param(
        *values, marks=pytest.mark.skipif(not LONG, reason="set RAVENCHART_LONG_TESTS")
    )


@pytest.mark.parametrize(
    ("count", "longest", "jitter", "number"),
    [
        (1, 8, 8, 324),
        (2, 8, 0, 416),
        (3, 6, 0, 329),
        (2, 4, 4, 550),
        (3, 4, 1, 112),
        long(3, 4, 2, 378),
        long(3, 7, 0, 976),
        long(4, 6, 0, 345),
        long(2, 5, 6, 2744),
    ],
)
def test_plain_sets_and_jitter_are_exact(
    count: int, longest: int, jitter: int, number: int
) -> None:
    compared = 0
    for chosen in sets(plain_shapes(longest, jitter), count):
        compared += 1
        assert bounds(tasks_of(chosen)) == observed(toys(chosen)), chosen
    assert compared == number


@pytest.mark.parametrize(
    ("count", "longest", "number"), [(2, 5, 56), (3, 4, 14), long(3, 5, 81), long(4, 5, 36)]
)
def test_sporadic_sets_are_no_worse_than_periodic_ones(
    count: int, longest: int, number: int
) -> None:
    compared = 0
    for chosen in sets(plain_shapes(longest), count):
        compared += 1
        lazy = [replace(toy, sporadic=True) for toy in toys(chosen)]
        assert bounds(tasks_of(chosen)) == observed(lazy), chosen
    assert compared == number


@pytest.mark.parametrize(
    ("count", "longest", "number"), [(2, 6, 125), (3, 5, 243), long(4, 5, 252)]
)
def test_equal_priorities_are_safe_whichever_job_runs(
    count: int, longest: int, number: int
) -> None:
    compared = 0
    for chosen in sets(plain_shapes(longest), count):
        for ties in product((0, 1), repeat=count - 1):
            if any(ties):
                compared += 1
                levels = [9 - n + sum(ties[:n]) for n in range(count)]
                tasks = [
                    task_of(n, s, p) for n, (s, p) in enumerate(zip(chosen, levels, strict=True))
                ]
                tied = [replace(t, priority=p) for t, p in zip(toys(chosen), levels, strict=True)]
                assert at_least(bounds(tasks), observed(tied)), (chosen, levels)
    assert compared == number


def sharings(chosen: Sequence[Shape]) -> Iterator[tuple[int, int, int, int]]:
    """A more and a less urgent task, and where and how long the second is in their object."""
    for low in range(1, len(chosen)):
        cost = sum(chosen[low][1][0])
        for high in range(low):
            for length in range(1, cost + 1):
                for start in {0, cost - length}:
                    yield high, low, start, length


@pytest.mark.parametrize(
    ("count", "longest", "jitter", "number"),
    [(2, 6, 0, 319), (3, 5, 0, 339), (2, 4, 1, 152), long(3, 6, 0, 1665), long(4, 5, 0, 228)],
)
def test_ceiling_blocking_is_safe_and_exact_a_tick_earlier(
    count: int, longest: int, jitter: int, number: int
) -> None:
    """All but a task whose job ends inside the object: that part of it is not preempted."""
    compared = 0
    for chosen in sets(plain_shapes(longest, jitter), count):
        tasks = tasks_of(chosen)
        for high, low, start, length in sharings(chosen):
            compared += 1
            simulated = toys(chosen)
            simulated[low] = replace(simulated[low], hold=(start, length, 9 - high))
            seen = observed(simulated)
            safe, exact = (
                [Section("o", f"t{low}", size), Section("o", f"t{high}", 1)] if size else []
                for size in (length, length - 1)
            )
            assert at_least(bounds(tasks, safe), seen), (chosen, high, low, start, length)
            found = bounds(tasks, exact)
            if start + length == sum(chosen[low][1][0]):
                found[low] = seen[low]
            assert found == seen, (chosen, high, low, start, length)
    assert compared == number


def row_bounds(tasks: Sequence[Task]) -> list[dict[str, int]]:
    return [{row.row.name: row.bound for row in r.rows} for r in analyse_tasks(tasks)]


def row_observations(of: Sequence[Toy]) -> list[dict[str, int]]:
    return [
        {f"r{frame}.{row}": seen for (frame, row), seen in sorted(one.rows.items())}
        if len(one.rows) > 1 or () in toy.frames
        else {}
        for toy, one in zip(of, longest_responses(of), strict=True)
    ]


@pytest.mark.parametrize(
    ("longest", "frames", "others", "number"),
    [(4, 2, 4, 260), (3, 3, 4, 546), long(5, 2, 6, 1100), long(4, 3, 5, 2166)],
)
def test_tables_are_safe_and_exact_with_two_frames(
    longest: int, frames: int, others: int, number: int
) -> None:
    compared = 0
    tables = framed_shapes(longest, frames)
    for plain, table in product(plain_shapes(others), tables):
        for chosen in ((plain, table), (table, plain)):
            if load(chosen) > 1:
                continue
            compared += 1
            found, seen = bounds(tasks_of(chosen)), observed(toys(chosen))
            assert at_least(found, seen), chosen
            if frames == 2:
                assert found == seen, chosen
                assert row_bounds(tasks_of(chosen)) == row_observations(toys(chosen)), chosen
    assert compared == number


@pytest.mark.parametrize(("longest", "number"), [(3, 192), long(4, 816)])
def test_two_tables_are_exact_with_two_frames(longest: int, number: int) -> None:
    compared = 0
    for chosen in sets(framed_shapes(longest, 2), 2):
        compared += 1
        assert bounds(tasks_of(chosen)) == observed(toys(chosen)), chosen
    assert compared == number


Phased = tuple[tuple[Shape, int | None], ...]
"""Shapes with their offsets; None: at any time."""


def phased(chosen: Sequence[Shape], *, unknown: bool = False) -> Iterator[Phased]:
    """All offsets within a cycle of each table, perhaps of none; those of the first are 0."""
    places: list[list[int | None]] = [[0]]
    for period, frames, _ in chosen[1:]:
        places.append([*range(period * len(frames)), *([None] if unknown else [])])
    for offsets in product(*places):
        yield tuple(zip(chosen, offsets, strict=True))


def both(known: Phased) -> tuple[list[Task], list[Toy]]:
    chosen = [shape for shape, _ in known]
    offsets = [offset for _, offset in known]
    return (
        [replace(t, offset=o) for t, o in zip(tasks_of(chosen), offsets, strict=True)],
        [replace(t, offset=o) for t, o in zip(toys(chosen), offsets, strict=True)],
    )


@pytest.mark.parametrize(
    ("count", "longest", "jitter", "number", "shorter"),
    [
        (2, 6, 0, 581, 178),
        (3, 5, 0, 1_425, 793),
        (2, 4, 2, 657, 228),
        (3, 3, 1, 72, 62),
        long(3, 4, 1, 1_424, 1_048),
        long(2, 5, 5, 8_028, 1_992),
    ],
)
def test_offsets_are_exact(
    count: int, longest: int, jitter: int, number: int, shorter: int
) -> None:
    compared = less = 0
    for chosen in sets(plain_shapes(longest, jitter), count):
        plain = bounds(tasks_of(chosen))
        for known in phased(chosen):
            compared += 1
            tasks, simulated = both(known)
            found = bounds(tasks)
            assert found == observed(simulated), known
            less += found != plain
    assert (compared, less) == (number, shorter)


@pytest.mark.parametrize(("count", "longest", "number"), [(2, 5, 279), (3, 4, 292)])
def test_offsets_beside_tasks_of_unknown_phase_are_exact(
    count: int, longest: int, number: int
) -> None:
    compared = 0
    for chosen in sets(plain_shapes(longest), count):
        for known in phased(chosen, unknown=True):
            compared += 1
            tasks, simulated = both(known)
            assert bounds(tasks) == observed(simulated), known
    assert compared == number


@pytest.mark.parametrize(("count", "longest", "number"), [(2, 4, 133), (3, 4, 630)])
def test_offsets_beside_sections_and_equal_priorities_are_safe(
    count: int, longest: int, number: int
) -> None:
    compared = 0
    for chosen in sets(plain_shapes(longest), count):
        for known in phased(chosen):
            tasks, simulated = both(known)
            equal = [replace(task, priority=1) for task in tasks]
            seen = observed([replace(toy, priority=1) for toy in simulated])
            assert at_least(bounds(equal), seen), known
            for high, low, start, length in sharings(chosen):
                compared += 1
                held = list(simulated)
                held[low] = replace(held[low], hold=(start, length, 9 - high))
                sections = Section("o", f"t{low}", length), Section("o", f"t{high}", 1)
                assert at_least(bounds(tasks, sections), observed(held)), (known, high, low)
    assert compared == number


@pytest.mark.parametrize(
    ("longest", "frames", "others", "number"),
    [(3, 2, 2, 2_136), long(2, 3, 3, 4_602), long(4, 2, 4, 12_276)],
)
def test_tables_with_offsets_are_exact_row_by_row(
    longest: int, frames: int, others: int, number: int
) -> None:
    compared = 0
    tables = framed_shapes(longest, frames)
    for plain, table in product([*plain_shapes(others), *tables], tables):
        for chosen in ((plain, table), (table, plain)):
            if load(chosen) > 1:
                continue
            for known in phased(chosen):
                compared += 1
                tasks, simulated = both(known)
                assert bounds(tasks) == observed(simulated), known
                assert row_bounds(tasks) == row_observations(simulated), known
    assert compared == number


@pytest.mark.parametrize(
    ("count", "longest", "jitter", "number"),
    [
        (2, 6, 0, 125),
        (3, 6, 0, 329),
        (2, 4, 3, 352),
        (3, 4, 1, 112),
        long(3, 8, 0, 2475),
        long(4, 7, 0, 1862),
    ],
)
def test_frames_on_a_bus_are_safe_and_exact_a_tick_earlier(
    count: int, longest: int, jitter: int, number: int
) -> None:
    compared = 0
    bus = Bus(bit_time=1)
    for chosen in sets(plain_shapes(longest, jitter), count):
        compared += 1
        frames = [Frame(f"m{n}", n, s[0], FAR, s[1][0][0], s[2]) for n, s in enumerate(chosen)]
        seen = observed([replace(toy, preemptible=False) for toy in toys(chosen)])
        assert at_least([r.bound for r in can.analyse(frames, bus)], seen), chosen
        for n, frame in enumerate(frames):
            lower = [
                replace(f, transmission_time=f.transmission_time - 1)
                for f in frames[n + 1 :]
                if f.transmission_time > 1
            ]
            assert can.response_under(frame, frames[:n], lower, bus).bound == seen[n], chosen
    assert compared == number


@pytest.mark.parametrize(
    ("count", "longest", "queues", "number"),
    [
        (2, 7, ("qq",), 236),
        (3, 5, ("qq-", "q-q", "-qq", "qqq"), 4 * 81),
        long(3, 6, ("qq-", "q-q", "-qq", "qqq"), 4 * 329),
        long(3, 7, ("qq-", "q-q", "-qq", "qqq"), 4 * 976),
        long(4, 5, ("qpqp", "qppq", "qqpp", "q-qp", "qq-q", "q-q-", "-q-q"), 7 * 36),
    ],
)
def test_first_in_first_out_queues_are_safe(
    count: int, longest: int, queues: tuple[str, ...], number: int
) -> None:
    compared = 0
    for chosen in sets(plain_shapes(longest), count):
        for names in queues:
            compared += 1
            homes = [name.strip("-") for name in names]
            frames = [
                Frame(f"m{n}", n, s[0], FAR, s[1][0][0], queue=home)
                for n, (s, home) in enumerate(zip(chosen, homes, strict=True))
            ]
            simulated = [
                replace(toy, preemptible=False, queue=home)
                for toy, home in zip(toys(chosen), homes, strict=True)
            ]
            found = [r.bound for r in can.analyse(frames, Bus(bit_time=1))]
            seen = observed(simulated)
            for bound, one in zip(found, seen, strict=True):
                assert bound is None or bound >= one, (chosen, names, found, seen)
    assert compared == number
