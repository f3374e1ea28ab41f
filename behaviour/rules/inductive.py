# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Invariants as contracts of the code: those that each move of a region keeps, with facts.

An invariant may hold in every reachable situation, and still a transition may seem to break it
from a situation that is never reached. Facts exclude these situations. A fact of a leaf has the
cells that a data item can be in while the leaf is active. The search grows the facts from the
start of the region to the strongest ones that every move keeps: the largest inductive set of
candidates, as in Flanagan and Leino, *Houdini*, 2001. Unsatisfiable cores drop unneeded facts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, cast

import z3

from ravenchart.behaviour.limits import ON_MODEL
from ravenchart.behaviour.tree import ChartTree
from ravenchart.gen.diagnostics import Diagnostic, warning
from ravenchart.gen.language.terms import (
    BOOLEAN,
    Expression,
    Operation,
    PortTest,
    Reading,
)
from ravenchart.gen.model.component import Component, Invariant
from ravenchart.gen.model.safety import Fact, SafeRegion, ValueRange, knows_guards
from ravenchart.gen.model.statechart import OnEvent, Region, Segment, Transition, When
from ravenchart.gen.model.system import System

from . import logic
from .budget import TooManyQuestions
from .cells import partition
from .logic import Term, Variable
from .moves import ChartMove, Position, TooManyMoves, guard_of, moves_of

MOST_QUESTIONS = 20_000
"""Questions for the facts of one region at most: the same on every machine."""

Held = tuple[str, Variable]
"""A vertex, and a data item of which a fact speaks there."""


@dataclass(frozen=True, slots=True)
class Contracts:
    """The invariants that the code of a system is proved to keep, and findings on the others."""

    regions: tuple[SafeRegion, ...] = ()
    found: tuple[Diagnostic, ...] = ()


def contracts(system: System) -> Contracts:
    """The invariants of every component, each with its region or with the reason why it has none.

    The caller must have excluded that the model violates one of these invariants.
    """
    regions: list[SafeRegion] = []
    found: list[Diagnostic] = []
    for component in system.components:
        open_ = {one.name: one for one in component.invariants}
        for region in component.regions:
            own = [one for one in component.invariants if _is_over(one, component, region)]
            if not own:
                continue
            safe = _of_region(component, region, own)
            if safe is not None and safe.invariants:
                regions.append(safe)
            for one in own:
                del open_[one.name]
                if safe is None or one.name not in safe.invariants:
                    found.append(_unproved(one, _TOO_LARGE if safe is None else _NOT_INDUCTIVE))
        found += [_unproved(one, _SEVERAL) for one in open_.values()]
    return Contracts(tuple(regions), tuple(found))


_SEVERAL = (
    "it is not about the states of one region and the data that this region alone writes",
    "let one region write the data and have the states that the condition names",
)
_TOO_LARGE = (
    "its region is too large, or ends in a terminate",
    "move states into a region of their own",
)
_NOT_INDUCTIVE = (
    "no facts about single data items were found with which each transition keeps it",
    "say more in the condition of `never`, or in the guard of the transition",
)


def _unproved(invariant: Invariant, why: tuple[str, str]) -> Diagnostic:
    message = f"the invariant {invariant.name} is checked on the model alone: {why[0]}"
    return warning(ON_MODEL, invariant.origin, message, hint=why[1])


def _is_over(invariant: Invariant, component: Component, region: Region) -> bool:
    """Whether an invariant asks only for states and data of one region, and for constants."""
    constant = {d.name for d in component.data} - component.from_outside()
    constant -= {name for row in component.runnables() for name in row.writes}
    named = list(logic.names(invariant.condition))
    states = {name[1] for name in logic.tested([invariant.condition])}
    owned = [one for one in named if one.name in region.writes]
    return (
        states <= {region.name}
        and bool(states or owned)
        and all(
            one.kind is Reading.DATA and (one.name in region.writes or one.name in constant)
            for one in named
        )
        and not _asks_port(invariant.condition)
    )


def _asks_port(expression: Expression) -> bool:
    match expression:
        case PortTest():
            return True
        case Operation(operands=operands):
            return any(map(_asks_port, operands))
        case _:
            return False


def _of_region(
    component: Component, region: Region, invariants: list[Invariant]
) -> SafeRegion | None:
    try:
        search = _Search(component, region, invariants, frozenset())
        search.run()
        alone = frozenset(_guarded(region))
        while alone and len(search.bad) < len(invariants):
            tried = _Search(component, region, invariants, alone)
            tried.run()
            beside = tried.accompanied()
            if not beside:
                search = tried
                break
            alone -= beside
        kept = tuple(one.name for one in invariants if one.name in search.bad)
        facts = tuple(search.facts())
        return SafeRegion(component.name, region.name, kept, facts, tuple(sorted(search.alone)))
    except (TooManyMoves, TooManyQuestions):
        return None


def _guarded(region: Region) -> Iterator[str]:
    """The transitions whose guards another region may make false before they are taken."""
    for one in region.transitions:
        own = region.concurrent_region(one.source)
        if isinstance(one.trigger, Segment) or knows_guards(region, own):
            continue
        if one.guard is not None or isinstance(one.trigger, When):
            yield one.name


@dataclass
class _Search:
    """The facts and invariants that every move of a region keeps."""

    component: Component
    region: Region
    invariants: list[Invariant]
    alone: frozenset[str]
    """Transitions that are assumed to be the first ones taken in their step."""
    questions: int = 0
    symbols: dict[Variable, Term] = field(default_factory=dict)
    bad: dict[str, Term] = field(default_factory=dict)
    """The invariants kept so far, each with the condition that must not hold."""
    made: dict[object, Any] = field(default_factory=dict)
    """Terms that were made before, each by a key of the objects that it depends on."""

    def __post_init__(self) -> None:
        component = self.component
        self.types = logic.readable(component)
        self.initial = {
            name: value
            for data in component.data
            for name, value in logic.scalars(data.name, data.type, data.initial).items()
        }
        cells = partition(component, self.types, self.initial)
        self.cells = {n: c for n, c in cells.items() if n[1] in self.region.writes}
        self.tree = ChartTree(self.region)
        self.moves = list(moves_of(self.tree, self.symbol, self.alone))
        self.bad = {i.name: logic.term(i.condition, self.of_condition) for i in self.invariants}
        positions = {move.after for move in self.moves}
        marked = {v for one in positions for v in one.vertices if self.is_marked(v)}
        self.allowed: dict[Held, set[int]] = {
            (vertex, name): set() for vertex in sorted(marked) for name in self.cells
        }

    def symbol(self, name: Variable) -> Term:
        """The unknown that stands for a variable before a move."""
        if name not in self.symbols:
            self.symbols[name] = logic.symbol(name.unknown, self.types[name])
        return self.symbols[name]

    def of_condition(self, name: Variable) -> Term:
        """The same in a condition, where data without a writer are constants."""
        if name in self.initial and name[1] not in self.region.writes:
            return self.initial[name]
        return self.symbol(name)

    def is_marked(self, vertex: str) -> bool:
        """Whether facts may be about a vertex: a leaf, or a pseudostate on the way."""
        return vertex in self.tree.kinds or len(self.tree.states[vertex].regions) != 1

    # --- terms

    def once(self, key: object, make: Callable[[], Any]) -> Any:
        """The term of a key, made at its first use."""
        if key not in self.made:
            self.made[key] = make()
        return self.made[key]

    def written(self, move: ChartMove) -> list[tuple[Term, Term]]:
        """The variables that a move writes, each with its value after the move."""
        return cast("list[tuple[Term, Term]]", self.once(move, lambda: self._written(move)))

    def _written(self, move: ChartMove) -> list[tuple[Term, Term]]:
        own = self.initial if move.before is None else {}
        pairs = {n: v for n, v in own.items() if n[1] in self.region.writes}
        if move.before is None:
            start = [(self.symbol(n), v) for n, v in pairs.items()]
            made = {n: z3.simplify(z3.substitute(v, *start)) for n, v in move.updates.items()}
            pairs |= made
        else:
            pairs = dict(move.updates)
        return [(self.symbol(n), v) for n, v in pairs.items()]

    def violated(self, name: str, position: Position) -> Term:
        """That a position, as the condition sees it, violates an invariant."""
        states = [
            (self.symbol(one), z3.BoolVal(one[2] in position.active))
            for one in list(self.symbols)
            if one[0] == "in" and one[1] == self.region.name
        ]
        return z3.simplify(z3.substitute(self.bad[name], *states))

    def in_cells(self, name: Variable, value: Term, cells: set[int]) -> Term:
        """That a value is in one of some cells."""
        if len(cells) == len(self.cells[name]):
            return z3.BoolVal(True)
        spans = _spans(sorted(self.cells[name][i] for i in cells))
        if self.types[name] == BOOLEAN:
            return z3.Or([value if low else z3.Not(value) for low, _ in spans])
        return z3.Or([z3.And(value >= low, value <= high) for low, high in spans])

    def before(self, move: ChartMove) -> dict[Held | str, Term]:
        """The terms known before a move, each by its fact or invariant."""
        position = move.before
        if position is None:
            return {}
        known: dict[Held | str, Term] = {held: self.fact(held) for held in self.facts_at(position)}
        return known | {name: self.refuted(name, position) for name in self.bad}

    def after(self, move: ChartMove) -> dict[Held | str, Term]:
        """The terms that must hold after a move, each by its fact or invariant."""
        wanted: dict[Held | str, Term] = {
            held: self.behind(move, (held, len(self.allowed[held])), self.fact(held))
            for held in self.facts_at(move.after)
        }
        for name in self.bad:
            wanted[name] = self.behind(move, name, self.refuted(name, move.after))
        return wanted

    def facts_at(self, position: Position) -> Iterator[Held]:
        """The pairs of vertex and data item that facts can be about in a position."""
        for vertex in filter(self.is_marked, position.vertices):
            for name in self.cells:
                yield vertex, name

    def fact(self, held: Held) -> Term:
        """That a data item is in the cells allowed for it so far; their number only grows."""
        name, cells = held[1], self.allowed[held]
        return self.once((held, len(cells)), lambda: self.in_cells(name, self.symbol(name), cells))

    def refuted(self, name: str, position: Position) -> Term:
        """That a position does not violate an invariant."""
        return self.once((position, name), lambda: z3.Not(self.violated(name, position)))

    def behind(self, move: ChartMove, statement: object, term: Term) -> Term:
        """That the term of a statement holds after a move."""
        return self.once(
            (move, statement), lambda: z3.simplify(z3.substitute(term, *self.written(move)))
        )

    def typed(self) -> list[Term]:
        """That every variable lies in its type."""
        return [logic.within(s, self.types[n]) for n, s in self.symbols.items() if n[0] != "in"]

    def asked(self, terms: list[Term], tracked: Mapping[Held, Term]) -> Term:
        """A solver that was asked about some terms, with the tracked ones as assumptions."""
        self.questions += 1
        if self.questions > MOST_QUESTIONS:
            raise TooManyQuestions
        solver = logic.solver()
        solver.add(*terms)
        marks = [z3.Bool(f"known {i}") for i in range(len(tracked))]
        for mark, one in zip(marks, tracked.values(), strict=True):
            solver.add(z3.Implies(mark, one))
        self.answer = solver.check(*marks)
        return solver

    # --- the strongest facts

    def run(self) -> None:
        """Allow the cells that moves lead to until no move leads to another one."""
        first = Position(self.tree.default)
        own = [(self.symbol(n), v) for n, v in self.initial.items()]
        for name in list(self.bad):
            if not z3.is_false(z3.simplify(z3.substitute(self.violated(name, first), *own))):
                del self.bad[name]
        typed = self.typed()
        leaving: dict[str, dict[int, ChartMove]] = {}
        for move in self.moves:
            for vertex in () if move.before is None else move.before.vertices:
                leaving.setdefault(vertex, {})[id(move)] = move
        waiting = {id(move): move for move in self.moves}
        while waiting:
            move = waiting.pop(next(iter(waiting)))
            kept = len(self.bad)
            grown = False
            while self.grows(move, typed):
                grown = True
            if len(self.bad) < kept:
                waiting = {id(one): one for one in self.moves}
            elif grown:
                for vertex in move.after.vertices:
                    waiting |= leaving.get(vertex, {})

    def grows(self, move: ChartMove, typed: list[Term]) -> bool:
        """Allow one more outcome of a move; False when it has no more."""
        wanted = [one for one in self.after(move).values() if not z3.is_true(one)]
        if not wanted:
            return False
        known = [*typed, *self.before(move).values(), move.condition]
        solver = self.asked([*known, z3.Not(z3.And(wanted))], {})
        if self.answer == z3.unsat:
            return False
        if self.answer != z3.sat:
            raise TooManyQuestions
        model, pairs = solver.model(), dict(_by_id(self.written(move)))
        before = self.weight()
        for vertex in filter(self.is_marked, move.after.vertices):
            for name in self.cells:
                symbol = self.symbol(name)
                value = model.eval(pairs.get(symbol.get_id(), symbol), model_completion=True)
                self.allowed[vertex, name].add(self.cell_of(name, value))
        for statement, kept in self.after(move).items():
            if isinstance(statement, str) and z3.is_false(model.eval(kept, model_completion=True)):
                del self.bad[statement]
        if self.weight() == before:
            raise TooManyQuestions
        return True

    def weight(self) -> int:
        """A number that grows with each allowed cell, and with each invariant given up."""
        return sum(map(len, self.allowed.values())) - len(self.bad)

    def cell_of(self, name: Variable, value: Term) -> int:
        """The cell that a constant is in."""
        number = int(z3.is_true(value)) if self.types[name] == BOOLEAN else value.as_long()
        return next(i for i, (low, high) in enumerate(self.cells[name]) if low <= number <= high)

    # --- what is selected together

    def accompanied(self) -> set[str]:
        """The transitions of `alone` beside which one of an earlier region is enabled too."""
        typed = self.typed()
        found: set[str] = set()
        for move, other in self.pairs():
            name = move.path[0].name
            if name not in found:
                self.asked([*self.both(move, other, typed), *self.before(move).values()], {})
                if self.answer != z3.unsat:
                    found.add(name)
        return found

    def pairs(self) -> Iterator[tuple[ChartMove, ChartMove]]:
        """Each move of `alone`, with each move of an earlier region from the same position."""
        regions = self.region.concurrent_regions()
        at: dict[Position, list[ChartMove]] = {}
        for move in self.moves:
            if move.before is not None and move.path and not move.before.passing:
                at.setdefault(move.before, []).append(move)
        for moves in at.values():
            for move in moves:
                if move.path[0].name in self.alone:
                    own = regions.index(self.region.concurrent_region(move.path[0].source))
                    for other in moves:
                        theirs = regions.index(self.region.concurrent_region(other.path[0].source))
                        if theirs < own and _occur_together(move.path[0], other.path[0]):
                            yield move, other

    def both(self, move: ChartMove, other: ChartMove, typed: list[Term]) -> list[Term]:
        """That the guards of both hold."""
        return [*typed, guard_of(move.path, self.symbol), guard_of(other.path, self.symbol)]

    # --- those that are needed

    def facts(self) -> Iterator[Fact]:
        """The facts without which the invariants would not be inductive, in tree order."""
        needed: set[Held] = set()
        waiting: list[Held | str] = list(self.bad)
        typed = self.typed()
        while waiting:
            statement = waiting.pop(0)
            for move in self.moves:
                more = self.reasons(move, statement, typed, needed) - needed
                needed |= more
                waiting += sorted(more, key=str)
            if not waiting:
                for move, other in self.pairs():
                    more = self.core(move, self.both(move, other, typed), needed)
                    needed |= more
                    waiting += sorted(more, key=str)
        order = {vertex: i for i, vertex in enumerate((*self.tree.states, *self.tree.kinds))}
        for vertex, name in sorted(needed, key=lambda item: (order[item[0]], str(item[1]))):
            spans = _spans(sorted(self.cells[name][i] for i in self.allowed[vertex, name]))
            yield Fact(vertex, name[1], name[2], tuple(spans))

    def reasons(
        self, move: ChartMove, statement: Held | str, typed: list[Term], needed: set[Held]
    ) -> set[Held]:
        """The facts from which it follows that a move keeps a statement."""
        wanted = self.after(move).get(statement)
        if wanted is None or z3.is_true(wanted):
            return set()
        return self.core(move, [*typed, move.condition, z3.Not(wanted)], needed)

    def core(self, move: ChartMove, terms: list[Term], needed: set[Held]) -> set[Held]:
        """The facts about the position before a move that exclude some terms."""
        known = self.before(move)
        terms = terms + [one for key, one in known.items() if isinstance(key, str) or key in needed]
        self.asked(terms, {})
        if self.answer == z3.unsat:
            return set()
        facts = {k: one for k, one in known.items() if not isinstance(k, str) and k not in needed}
        solver = self.asked(terms, facts)
        core = {str(mark) for mark in solver.unsat_core()}
        return {key for i, key in enumerate(facts) if f"known {i}" in core}


def _occur_together(one: Transition, other: Transition) -> bool:
    """Whether two transitions can be made for one occurrence."""
    match one.trigger, other.trigger:
        case OnEvent(first), OnEvent(second):
            return first == second
        case When(), When():
            return True
        case _:
            return False


def _by_id(pairs: list[tuple[Term, Term]]) -> Iterator[tuple[int, Term]]:
    for symbol, value in pairs:
        yield symbol.get_id(), value


def _spans(cells: list[ValueRange]) -> list[ValueRange]:
    """Adjacent cells joined into one."""
    found: list[ValueRange] = []
    for first, last in cells:
        if found and found[-1][1] + 1 == first:
            found[-1] = (found[-1][0], last)
        else:
            found.append((first, last))
    return found
