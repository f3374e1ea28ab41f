# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tables judged by the analysis of the whole model: tasks, messages, chains, queues.

The core's strategies know tasks only. Their tables are the start here: single rows and tables
move until the whole model keeps every deadline and limit. Then they move while the rank by
the strategy grows.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice

from ravenchart.analysis.core.allocation import Strategy, Table, neighbours
from ravenchart.analysis.system.timing import Analysis

TRIALS = 20_000
"""Analyses times rows that one search may take; then the best tables so far are the answer."""

LOST = Fraction(1_000)
"""How bad it is that something has no bound, in units of its limit."""

Rank = tuple[bool, Fraction, Fraction, Fraction]
"""Whether everything is kept, by how much it is not, what the strategy wants, and then what."""

SET = (Strategy.BY_PERIOD, Strategy.BY_LOCALITY)
"""They say which rows belong together: nothing moves once everything is kept."""


@dataclass(frozen=True, slots=True)
class Judged:
    """Tables, and the analysis of the model that has them; None where it would be refused.

    ``short`` counts the tables that are shorter than a section of theirs.
    """

    tables: list[Table]
    analysis: Analysis | None
    short: int = 0


Judge = Callable[[list[Table]], Judged]
Better = Callable[[Judged], None]
"""Gets the best tables so far, each time when there are better ones."""
Ranked = Callable[[Sequence[list[Table]]], Iterator[Rank]]
"""How good each of many tables is, in their order. Only as many are asked for as are needed."""


def searched(
    starts: Sequence[list[Table]],
    strategy: Strategy,
    judge: Judge,
    better: Better = lambda _: None,
    ranked: Ranked | None = None,
) -> Judged:
    """The best tables that moves lead to from the best of the ``starts``.

    ``ranked`` says of many tables at once what ``judge`` and `rank` say of each: elsewhere, where
    that is faster. The answer is the same.
    """

    def here(many: Sequence[list[Table]]) -> Iterator[Rank]:
        return (rank_of_tables(judge(tables), strategy) for tables in many)

    ranks = ranked or here
    rows = sum(map(len, starts[0]))
    left = TRIALS // max(1, rows)
    best = max((judge(tables) for tables in starts), key=lambda one: rank_of_tables(one, strategy))
    found = rank_of_tables(best, strategy)
    better(best)
    while left > 0 and not (found[0] and strategy in SET):
        near = list(islice(neighbours(best.tables), left))
        for tables, other in zip(near, ranks(near), strict=True):
            left -= 1
            if other > found:
                best, found = judge(tables), other
                better(best)
                break
        else:
            break
    return best


def rank_of_tables(judged: Judged, strategy: Strategy) -> Rank:
    """How good tables are: the larger, the better."""
    if judged.analysis is None:
        return False, -LOST * LOST * judged.short, Fraction(0), Fraction(0)
    over = excess(judged.analysis)
    few, slack = Fraction(-len(judged.tables)), _slack(judged)
    wanted = (few, slack) if strategy is Strategy.FEWEST_TASKS else (slack, few)
    return judged.analysis.schedulable, -over, *wanted


def excess(analysis: Analysis) -> Fraction:
    """By how much deadlines and limits are not kept, each as a share of itself, in all."""
    pairs: list[tuple[int | None, int]] = [
        (analysis.found.from_event(name), analysis.found.deadline(name))
        for name in analysis.failed()
    ]
    for chain, found in analysis.limited:
        pairs += [(found.reaction, chain.reaction)] if chain.reaction is not None else []
        pairs += [(found.age, chain.age)] if chain.age is not None else []
    late = (LOST if time is None else max(Fraction(0), Fraction(time - limit, limit))
            for time, limit in pairs)  # fmt: skip
    lost = len(analysis.undelivered) + sum(one.needed is not None for one in analysis.short_queues)
    return sum(late, lost * LOST)


def _slack(judged: Judged) -> Fraction:
    """The least slack of the rows, as a share of their deadlines; very little without a bound."""
    assert judged.analysis is not None
    bounds = {row.row.name: row.bound for _, row in judged.analysis.rows()}
    slacks = [
        Fraction(one.deadline - bounds[one.name], one.deadline) if one.name in bounds else -LOST
        for table in judged.tables
        for one in table
    ]
    return min(slacks, default=Fraction(0))
