"""Every outcome of a step that some data allow."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import z3

from .logic import Read, Term, Variable
from .stepping import Beaten, Configuration, Rival, Step
from .tree import Occurrence, Slot, Tree

Past = Mapping[Slot, set[str]]
"""Every leaf that each region has been seen to remember."""


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
    left: frozenset[str]
    beaten: tuple[Beaten, ...]
    recalled: frozenset[Slot] = frozenset()
    """The regions whose remembered leaf was any that is known of (`Past`)."""
    remembered: tuple[tuple[Slot, str], ...] = ()
    """What it remembers, where the configuration does not say."""


MOST_WAYS = 512
"""Outcomes of one step at most; a region with more is not looked into further."""


class TooManyWays(Exception):  # noqa: N818
    """One step has more than `MOST_WAYS` outcomes."""


def outcomes(
    tree: Tree,
    before: Configuration,
    occurrence: Occurrence,
    symbols: Read,
    solver: Term,
    past: Past | None = None,
) -> tuple[Outcome, ...]:
    """Every outcome of a step that some data allow, in order of the first answer `yes`.

    With a ``past``, a history may remember each of the leaves that this says.
    """
    found: list[Outcome] = []
    waiting: list[tuple[list[bool], list[str | None]]] = [([], [])]
    while waiting:
        answers, recalled = waiting.pop()
        asked: list[Term] = []
        recalls = iter(range(len(recalled)))
        slots: set[Slot] = set()

        def recall(
            slot: Slot,
            answers: list[bool] = answers,
            recalled: list[str | None] = recalled,
            asked: list[Term] = asked,
            recalls: Iterator[int] = recalls,
            slots: set[Slot] = slots,
        ) -> str | None:
            if past is None:
                return None
            slots.add(slot)
            index = next(recalls, None)
            if index is not None:
                return recalled[index]
            known = answers[: len(asked)]
            waiting.extend((known, [*recalled, leaf]) for leaf in sorted(past.get(slot, ())))
            recalled.append(None)
            return None

        def decide(
            condition: Term,
            answers: list[bool] = answers,
            recalled: list[str | None] = recalled,
            asked: list[Term] = asked,
        ) -> bool:
            if z3.is_true(condition) or z3.is_false(condition):
                return bool(z3.is_true(condition))
            if len(asked) == len(answers):
                can = [_possible(solver, asked, one) for one in (condition, z3.Not(condition))]
                if all(can):
                    waiting.append(([*answers, False], list(recalled)))
                answers.append(can[0])
            answer = answers[len(asked)]
            asked.append(condition if answer else z3.Not(condition))
            return answer

        step = Step(tree, before, occurrence, symbols, decide, recall)
        stuck = step.run()
        after = step.configuration() if stuck is None else before
        found.append(
            Outcome(
                occurrence,
                before,
                z3.And(asked) if asked else z3.BoolVal(True),
                after if past is None else replace(after, history=()),
                tuple(sorted(step.store.items(), key=lambda item: str(item[0]))),
                tuple(step.raised),
                tuple(step.fired),
                stuck,
                step.deferred,
                tuple(step.rivals),
                frozenset(step.entered),
                frozenset(step.left),
                tuple(step.beaten),
                frozenset(slots),
                () if past is None else after.history,
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
