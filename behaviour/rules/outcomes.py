# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Every outcome of a step that some data allow."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import z3

from ravenchart.behaviour.tree import ChartTree, Occurrence, RegionKey

from .logic import Questions, Term, Variable, unknowns
from .stepping import Beaten, Configuration, OpenStep, Rival

Past = Mapping[RegionKey, set[str]]
"""Every leaf that each region has been seen to remember."""


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """One possible outcome of a step: the condition on its inputs, and its effects."""

    occurrence: Occurrence
    before: Configuration
    condition: Term
    after: Configuration
    updates: tuple[tuple[Variable, Term], ...]
    raised: tuple[tuple[str, tuple[tuple[str | None, Term], ...]], ...]
    fired: tuple[str, ...]
    """Transitions and segments, in the order taken."""
    stuck: str | None
    """The pseudostate that no enabled segment leaves."""
    deferred: bool
    rivals: tuple[Rival, ...]
    entered: frozenset[str]
    left: frozenset[str]
    beaten: tuple[Beaten, ...]
    recalled: frozenset[RegionKey] = frozenset()
    """The regions whose remembered leaf may be any of `Past`."""
    remembered: tuple[tuple[RegionKey, str], ...] = ()
    """The leaf that each region remembers, where the configuration does not have it."""
    noted: tuple[Any, ...] = ()
    """The notes of a watched step."""


MOST_WAYS = 512
"""Outcomes of one step at most; a region with more is not explored further."""


class TooManyWays(Exception):  # noqa: N818
    """One step has more than `MOST_WAYS` outcomes."""


def outcomes(
    tree: ChartTree,
    before: Configuration,
    occurrence: Occurrence,
    questions: Questions,
    past: Past | None = None,
    contested: Mapping[Variable, Term] | None = None,
    make: Callable[..., OpenStep] = OpenStep,
) -> tuple[Outcome, ...]:
    """Every outcome of a step that some data allow, in order of the first answer `yes`.

    With a ``past``, a history may remember each leaf of it. With ``contested``, ``before`` is a
    part of a configuration (`parts`): a condition on these unknowns may be true or false.
    ``make`` begins a step.
    """
    found: list[Outcome] = []
    waiting: list[tuple[list[bool], list[str | None]]] = [([], [])]
    while waiting:
        answers, recalled = waiting.pop()
        asked: list[Term] = []
        slots: list[RegionKey] = []
        guessed: list[Term] = []

        def recall(
            slot: RegionKey,
            answers: list[bool] = answers,
            recalled: list[str | None] = recalled,
            asked: list[Term] = asked,
            slots: list[RegionKey] = slots,
        ) -> str | None:
            if past is None:
                return None
            slots.append(slot)
            if len(slots) <= len(recalled):
                return recalled[len(slots) - 1]
            known = answers[: len(asked)]
            chosen = [s for s, leaf in zip(slots, recalled, strict=False) if leaf is not None]
            if contested is None or all(tree.inside(slot, s) for s in chosen):
                waiting.extend((known, [*recalled, leaf]) for leaf in sorted(past.get(slot, ())))
            recalled.append(None)
            return None

        def decide(
            condition: Term,
            answers: list[bool] = answers,
            recalled: list[str | None] = recalled,
            asked: list[Term] = asked,
            guessed: list[Term] = guessed,
        ) -> bool:
            if z3.is_true(condition) or z3.is_false(condition):
                return bool(z3.is_true(condition))
            is_guess = _mentions(condition, contested)
            if len(asked) == len(answers):
                both = (condition, z3.Not(condition))
                can = [is_guess or questions.possible((*asked, one)) for one in both]
                if all(can):
                    waiting.append(([*answers, False], list(recalled)))
                answers.append(can[0])
            answer = answers[len(asked)]
            if is_guess:
                guessed.append(condition)
                asked.append(z3.BoolVal(True))
            else:
                asked.append(condition if answer else z3.Not(condition))
            return answer

        step = make(tree, before, occurrence, questions, decide, recall, contested)
        stuck = step.run()
        if stuck is not None and guessed:
            continue
        after = step.configuration() if stuck is None else before
        found.append(
            Outcome(
                occurrence,
                before,
                z3.And(asked) if asked else TRUE,
                after if past is None else replace(after, history=()),
                tuple(sorted(step.store.items(), key=lambda item: str(item[0]))),
                tuple(step.raised),
                tuple(step.fired),
                stuck,
                step.deferred,
                tuple(r for r in step.rivals if not _mentions(r.condition, contested)),
                frozenset(step.entered),
                frozenset(step.left),
                tuple(step.beaten),
                frozenset(slots),
                () if past is None else after.history,
                tuple(step.noted),
            )
        )
        if len(found) > MOST_WAYS:
            raise TooManyWays
    return tuple(found)


TRUE = z3.BoolVal(True)


def _mentions(condition: Term, contested: Mapping[Variable, Term] | None) -> bool:
    """Whether a condition reads data that other regions may have set in the same step."""
    if not contested:
        return False
    used = unknowns([condition])
    return any(str(unknown) in used for unknown in contested.values())
