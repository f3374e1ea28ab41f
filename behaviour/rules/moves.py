# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The single moves of a region: the effect of each transition or segment, as terms.

A step of the model is a series of moves: a transition in each orthogonal region, each with the
segments on its way. The generated code has a contract for each move. So an invariant that every
move keeps is proved of the code. A move knows less than a step. Unknown are the leaf that a history
remembers, whether an event came, and the guards of a region that acts after another one.
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from dataclasses import dataclass, field

import z3

from ravenchart.behaviour.tree import START, TOP, ChartTree, RegionKey
from ravenchart.gen.language.terms import Expression, Flow, If, Set
from ravenchart.gen.model.safety import knows_guards
from ravenchart.gen.model.statechart import PseudoKind, Segment, Transition, When

from .logic import Questions, Read, Term, Variable, term
from .stepping import Configuration, OpenStep, TransitionPath

MOST_POSITIONS = 300
"""A region with more configurations is not explored."""
MOST_MOVES = 6_000
"""A region with more moves is not explored."""


@dataclass(frozen=True, slots=True)
class Position:
    """A region between two moves: its active states, and pseudostates on the way."""

    active: tuple[str, ...] = ()
    passing: tuple[str, ...] = ()

    @property
    def vertices(self) -> tuple[str, ...]:
        """The states and the pseudostates."""
        return (*self.active, *self.passing)


@dataclass(frozen=True, slots=True, eq=False)
class ChartMove:
    """The effect of one transition or segment, from a position where it can be taken."""

    before: Position | None
    """None at the start of the region."""
    condition: Term
    updates: dict[Variable, Term]
    after: Position
    path: TransitionPath
    """The transition or segment, with its way; empty at the start and at a history."""


class TooManyMoves(Exception):  # noqa: N818
    """The region is too large for its moves to be explored one by one."""


def moves_of(tree: ChartTree, symbols: Read, alone: Container[str]) -> Iterator[ChartMove]:
    """Every move from every position that control can reach, data aside.

    ``alone`` names the transitions that are assumed to be the first ones taken in their step.
    """
    if any(kind is PseudoKind.TERMINATE for kind in tree.kinds.values()):
        raise TooManyMoves
    questions = Questions(symbols, ())
    first = _Mover(tree, Configuration(), START, questions, lambda condition: True)
    first.initial(TOP)
    begun = first.move(None, z3.BoolVal(True), ())
    yield begun
    waiting, seen, made = [begun.after], {begun.after}, 0
    while waiting:
        position = waiting.pop(0)
        for move in _from(tree, position, questions, alone):
            made += 1
            if made > MOST_MOVES:
                raise TooManyMoves
            yield move
            if move.after not in seen:
                if len(seen) == MOST_POSITIONS:
                    raise TooManyMoves
                seen.add(move.after)
                waiting.append(move.after)


@dataclass
class _Mover(OpenStep):
    """A step that stops after one move; a condition only says which branch an action takes."""

    remembered: list[str | None] = field(default_factory=list)
    """The leaves that histories answer, one after the other."""
    asked: list[RegionKey] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.recall = self._recalled

    def perform(self, flow: Flow) -> None:
        """Execute only the assignments of a flow: values sent and events raised concern no move."""
        for action in flow:
            if isinstance(action, Set):
                super().perform((action,))
            elif isinstance(action, If):
                self.merge(action)

    def move(self, before: Position | None, condition: Term, path: TransitionPath) -> ChartMove:
        """The move made so far."""
        position = Position(self.tree.ordered(self.active), tuple(sorted(self.arrivals)))
        return ChartMove(before, condition, self.store, position, path)

    def _recalled(self, slot: RegionKey) -> str | None:
        self.asked.append(slot)
        if len(self.asked) <= len(self.remembered):
            return self.remembered[len(self.asked) - 1]
        return None


def _mover(
    tree: ChartTree,
    position: Position,
    questions: Questions,
    remembered: tuple[str | None, ...] = (),
) -> _Mover:
    made = _Mover(
        tree,
        Configuration(position.active),
        START,
        questions,
        lambda condition: True,
        remembered=list(remembered),
    )
    made.arrivals = list(position.passing)
    return made


def _from(
    tree: ChartTree, position: Position, questions: Questions, alone: Container[str]
) -> Iterator[ChartMove]:
    if position.passing:
        yield from _passed(tree, position, questions)
        return
    for name in position.active:
        known = knows_guards(tree.region, tree.region.concurrent_region(name))
        for transition in tree.outgoing[name]:
            if not isinstance(transition.trigger, Segment):
                sure = known or transition.name in alone
                for path in _ways(tree, position, transition):
                    yield _fired(tree, position, questions, path, known=sure)


def _passed(tree: ChartTree, position: Position, questions: Questions) -> Iterator[ChartMove]:
    """The moves from the first pseudostate on the way."""
    vertex = next(_mover(tree, position, questions).passing(TOP))
    rest = Position(position.active, tuple(n for n in position.passing if n != vertex))
    if tree.kinds[vertex] is PseudoKind.CHOICE:
        for transition in tree.outgoing[vertex]:
            for path in _ways(tree, position, transition):
                fired = _fired(tree, rest, questions, path, known=True)
                yield ChartMove(position, fired.condition, fired.updates, fired.after, fired.path)
        return
    waiting: list[tuple[str | None, ...]] = [()]
    while waiting:
        remembered = waiting.pop()
        mover = _mover(tree, position, questions, remembered)
        mover.go_on()
        yield mover.move(position, z3.BoolVal(True), ())
        for count in range(len(remembered), len(mover.asked)):
            unknown = (None,) * (count - len(remembered))
            leaves = _leaves(tree, mover.asked[count])
            waiting += [(*remembered, *unknown, leaf) for leaf in leaves]


def _leaves(tree: ChartTree, slot: RegionKey) -> list[str]:
    """The leaves that a region inside may remember."""
    return [
        name
        for name, state in tree.states.items()
        if len(state.regions) != 1 and slot in tree.inner_regions(name) and tree.slots[name].owner
    ]


def _ways(tree: ChartTree, position: Position, transition: Transition) -> Iterator[TransitionPath]:
    """A transition with each way through junctions; a join only where all sources are active."""
    kind = tree.kinds.get(transition.target)
    if kind is PseudoKind.JUNCTION:
        for out in tree.outgoing[transition.target]:
            yield from ((transition, *rest) for rest in _ways(tree, position, out))
    elif kind is PseudoKind.JOIN:
        incoming = tree.incoming[transition.target]
        if all(one.source in position.active for one in incoming):
            for out in tree.outgoing[transition.target]:
                yield from ((*incoming, *rest) for rest in _ways(tree, position, out))
    else:
        yield (transition,)


def _fired(
    tree: ChartTree, position: Position, questions: Questions, path: TransitionPath, *, known: bool
) -> ChartMove:
    mover = _mover(tree, position, questions)
    mover.fire(path)
    return mover.move(position, guard_of(path, questions.read) if known else z3.BoolVal(True), path)


def guard_of(path: TransitionPath, symbols: Read) -> Term:
    """The condition under which a path is enabled, its source and trigger aside."""
    asked = [term(guard, symbols) for guard in _guards(path)]
    return z3.And(asked) if asked else z3.BoolVal(True)


def _guards(path: TransitionPath) -> Iterator[Expression]:
    for transition in path:
        if isinstance(transition.trigger, When):
            yield transition.trigger.condition
        if transition.guard is not None:
            yield transition.guard
