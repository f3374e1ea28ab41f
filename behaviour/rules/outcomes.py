"""Every outcome of a step that some data allow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import z3

from .logic import Read, Term, Variable
from .stepping import Configuration, Rival, Step
from .tree import Occurrence, Tree


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What one step may come to: the condition on what it reads, and what it does."""

    occurrence: Occurrence
    before: Configuration
    condition: Term
    after: Configuration
    updates: tuple[tuple[Variable, Term], ...]
    raised: tuple[tuple[str, tuple[tuple[str | None, Term], ...]], ...]
    fired: tuple[str, ...]
    """Transitions and segments, in the order fired."""
    stuck: str | None
    """The pseudostate that no enabled segment leaves."""
    deferred: bool
    rivals: tuple[Rival, ...]
    entered: frozenset[str]


MOST_WAYS = 512
"""Outcomes of one step at most; a region with more is not looked into further."""


class TooManyWays(Exception):  # noqa: N818
    """One step has more than `MOST_WAYS` outcomes."""


def outcomes(
    tree: Tree, before: Configuration, occurrence: Occurrence, symbols: Read, solver: Term
) -> tuple[Outcome, ...]:
    """Every outcome of a step that some data allow, in order of the first answer `yes`."""
    found: list[Outcome] = []
    waiting: list[list[bool]] = [[]]
    while waiting:
        answers = waiting.pop()
        asked: list[Term] = []

        def decide(
            condition: Term, answers: list[bool] = answers, asked: list[Term] = asked
        ) -> bool:
            if z3.is_true(condition) or z3.is_false(condition):
                return bool(z3.is_true(condition))
            if len(asked) == len(answers):
                can = [_possible(solver, asked, one) for one in (condition, z3.Not(condition))]
                if all(can):
                    waiting.append([*answers, False])
                answers.append(can[0])
            answer = answers[len(asked)]
            asked.append(condition if answer else z3.Not(condition))
            return answer

        step = Step(tree, before, occurrence, symbols, decide)
        stuck = step.run()
        found.append(
            Outcome(
                occurrence,
                before,
                z3.And(asked) if asked else z3.BoolVal(True),
                step.configuration() if stuck is None else before,
                tuple(sorted(step.store.items(), key=lambda item: str(item[0]))),
                tuple(step.raised),
                tuple(step.fired),
                stuck,
                step.deferred,
                tuple(step.rivals),
                frozenset(step.entered),
            )
        )
        if len(found) > MOST_WAYS:
            raise TooManyWays
    return tuple(found)


def _possible(solver: Term, path: Sequence[Term], condition: Term) -> bool:
    """Whether some data meet all these conditions; when in doubt, yes."""
    solver.push()
    solver.add(*path, condition)
    answer = solver.check()
    solver.pop()
    return bool(answer != z3.unsat)
