# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The situations that the regions of a component can reach, under every interleaving.

Each region is explored alone, against all that the others may do: the states
they publish, the data they write, the events they raise. The exploration is repeated
until nothing new is found. A region sees at each step any combination of what the
others have ever published. So a situation that is not found cannot occur, however the
tasks interrupt one another. The values of data are divided into *cells*: the literals of
an enumeration, and for integers the ranges between the numbers that the model
compares them with. A region of too many nodes is explored more coarsely. A history may then
remember any leaf that it was ever seen to remember. If that is not enough, the
values of data are not distinguished. Where the configurations alone are too many,
the regions of an orthogonal state are explored one by one (`parts`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cached_property

import z3

from ravenchart.behaviour.tree import CONDITIONS, START, ChartTree, Occurrence
from ravenchart.gen.language.terms import BOOLEAN, Set
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import DONE, After, Every, When
from ravenchart.gen.model.system import System

from . import logic
from .budget import Budget, TooManyQuestions
from .cells import actions, expressions, partition
from .logic import Term, Variable
from .outcomes import Outcome, outcomes
from .outside import as_region, done_of, external_events, instance_parameters
from .publishing import is_in, is_in_parts
from .stepping import Configuration, OpenStep
from .threads import MOST_QUESTIONS, Cells, Edge, Situation, Thread

PendingStep = tuple[Situation, Configuration, Occurrence | None]
"""A node, the configuration where its step starts, and its occurrence; None: all of them."""


class Reachable:
    """The reachable nodes of every thread of a component."""

    def __init__(
        self,
        component: Component,
        system: System,
        budget: Budget,
        make: Callable[..., OpenStep] = OpenStep,
    ) -> None:
        """``make`` begins a step."""
        self.component = component
        self.make = make
        self.budget = budget
        self.types = logic.readable(component)
        self.symbols: dict[Variable, Term] = {}
        self.constants = instance_parameters(component, system)
        self.initial = {
            name: value
            for data in component.data
            for name, value in logic.scalars(data.name, data.type, data.initial).items()
        }
        self.cells = partition(component, self.types, self.initial)
        self.cell_terms = {
            (name, cell): self.in_cell(name, self.symbol(name), cell)
            for name, cells in self.cells.items()
            for cell in range(len(cells))
        }
        self.threads = self._threads()
        self.events = {event for event, _ in external_events(component, system)}
        regions = [t.tree for t in self.threads if t.name in self.regions()]
        self.published = {tree.region.name: {tree.default} for tree in regions}
        self.values: dict[Variable, set[int]] = {
            name: {self.cell_of(name, self.initial[name])} for name in self.cells
        }
        values = (a.value for a in actions(component) if isinstance(a, Set))
        for name in logic.tested((*expressions(component), *values)):
            self.symbol(name)
        self._user_bodies()
        self.plain = logic.Questions(self.symbol, self.typed, self.budget.ask)
        self._run()

    # --- set-up

    def _threads(self) -> list[Thread]:
        regions = [ChartTree(r, frozenset(self._working(r.name))) for r in self.component.regions]
        flows = [ChartTree(as_region(a)) for a in self.component.activities if a.flow is not None]
        made = []
        for tree in (*regions, *flows):
            own = (v for v in self.cells if v[1] in tree.region.writes)
            made.append(Thread(tree, tuple(own), self.types))
        return made

    def _working(self, region: str) -> Iterator[str]:
        """The states of a region with a do activity."""
        for activity in self.component.activities:
            if activity.while_in is not None and activity.while_in.region == region:
                yield activity.while_in.state

    def _user_bodies(self) -> None:
        """Allow every value for data that a body of the user's or a command writes."""
        outside = self.component.from_outside()
        for name, cells in self.cells.items():
            if name[1] in outside:
                self.values[name] = set(range(len(cells)))

    def regions(self) -> set[str]:
        """The names of the regions, which publish their active states."""
        return {region.name for region in self.component.regions}

    # --- terms

    def symbol(self, name: Variable) -> Term:
        """The unknown that stands for a variable as a step reads it."""
        if name not in self.symbols:
            self.symbols[name] = logic.symbol(name.unknown, self.types[name])
        return self.symbols[name]

    @cached_property
    def typed(self) -> list[Term]:
        """That variables lie in their types, and that parameters are those of one instance."""
        typed = [
            logic.within(self.symbol(name), type_)
            for name, type_ in self.types.items()
            if type_ != BOOLEAN
        ]
        sets = [
            z3.And([self.symbol(n) == v for n, v in one.items()]) for one in self.constants.values()
        ]
        return [*typed, z3.Or(sets)] if sets else typed

    def cell_of(self, name: Variable, value: Term) -> int:
        """The cell that a constant is in."""
        number = int(z3.is_true(value)) if self.types[name] == BOOLEAN else value.as_long()
        return next(i for i, (low, high) in enumerate(self.cells[name]) if low <= number <= high)

    def in_cell(self, name: Variable, value: Term, cell: int) -> Term:
        """That a term is in a cell of a variable."""
        low, high = self.cells[name][cell]
        if self.types[name] == BOOLEAN:
            return value if low else z3.Not(value)
        return z3.And(value >= low, value <= high)

    def of_node(self, thread: Thread, cells: Cells) -> list[Term]:
        """That the data of a thread are in the cells of a node."""
        return [self.cell_terms[pair] for pair in zip(thread.own, cells, strict=True)]

    def of_others(self, thread: Thread) -> list[Term]:
        """The known limits on the data and states that other threads write and publish."""
        found = [
            z3.Or([self.in_cell(name, self.symbol(name), cell) for cell in sorted(cells)])
            for name, cells in self.values.items()
            if name not in thread.own and len(cells) < len(self.cells[name])
        ]
        for region, configurations in self.published.items():
            if region != thread.name:
                found.append(self.is_published(region, sorted(configurations)))
        return found

    def _seen_of_others(self, thread: Thread) -> object:
        """A key of the knowledge about others, which only grows."""
        values = (len(cells) for name, cells in self.values.items() if name not in thread.own)
        states = (len(found) for name, found in self.published.items() if name != thread.name)
        return (*values, *states)

    def is_published(self, region: str, configurations: Sequence[tuple[str, ...]]) -> Term:
        """That a region has published one of these sets of active states."""
        asked = [name for name in self.symbols if name[:2] == ("in", region)]
        thread = self.thread(region)
        if thread.parts is not None:
            return is_in_parts(thread.tree, asked, configurations, self.symbol)
        return is_in(asked, configurations, self.symbol)

    # --- the search

    def _run(self) -> None:
        """Explore each thread again until none shows the others anything new."""
        while True:
            before = self._shown()
            for thread in self.threads:
                self._look_at(thread)
            if self._shown() == before:
                return

    def _look_at(self, thread: Thread) -> None:
        """Explore a thread as finely as possible, until its histories have nothing new."""
        while True:
            recalls = thread.recalls()
            try:
                self._explore(thread)
            except TooManyQuestions:
                thread.look_coarser()
                continue
            if thread.recalls() == recalls:
                return

    def _shown(self) -> object:
        return (
            {name: len(cells) for name, cells in self.values.items()},
            {name: len(found) for name, found in self.published.items()},
            len(self.events),
        )

    def _explore(self, thread: Thread) -> None:
        """Find every node of a thread, nearest first."""
        solver = logic.solver()
        others = self.of_others(thread)
        solver.add(*self.typed, *others)
        context = self._seen_of_others(thread)
        start = Situation(
            Configuration(), tuple(self.cell_of(name, self.initial[name]) for name in thread.own)
        )
        thread.begin(start)
        waiting: deque[PendingStep] = deque([(start, start.configuration, None)])
        while waiting:
            node, at, only = waiting.popleft()
            self.budget.count()
            for occurrence in self.occurrences(thread, at) if only is None else (only,):
                for outcome in self._outcomes(thread, at, occurrence):
                    thread.remember(outcome)
                    for cells in self._successors(thread, node.cells, outcome, solver, context):
                        for at_end in thread.explored(outcome.after):
                            edge = Edge(node, outcome, Situation(at_end, cells))
                            waiting.extend(self._arrive(thread, edge))
                        if thread.parts is not None and only is None:
                            met = thread.parts.left(at, outcome)
                            waiting.extend((Situation(p, cells), both, o) for p, both, o in met)

    def _arrive(self, thread: Thread, edge: Edge) -> Iterator[PendingStep]:
        """Note an edge; the steps to make when it leads to a new node."""
        after = edge.after
        thread.edges.append(edge)
        self._show(thread, edge)
        if after in thread.nodes:
            return
        if len(thread.nodes) == thread.most:
            raise TooManyQuestions
        thread.nodes[after] = edge
        yield after, after.configuration, None
        if thread.parts is not None and not after.configuration.stopped:
            for part in thread.parts.see(after.configuration):
                yield from self._arrive(
                    thread, replace(edge, after=replace(after, configuration=part))
                )
            for part, both, occurrence in thread.parts.meetings(after.configuration):
                yield Situation(part, after.cells), both, occurrence

    def _show(self, thread: Thread, edge: Edge) -> None:
        """Publish the states, data and events of a step to the other threads."""
        after = edge.after
        if thread.name in self.published:
            self.published[thread.name].add(after.configuration.active)
        for name, cell in zip(thread.own, after.cells, strict=True):
            self.values[name].add(cell)
        for name in self.cells:
            if name[1] in thread.tree.region.writes and name not in thread.own:
                self.values[name] = set(range(len(self.cells[name])))
        for event, _ in edge.outcome.raised:
            self.events.add(done_of(self.component, thread.name) if event == DONE else event)

    def occurrences(self, thread: Thread, at: Configuration) -> Iterator[Occurrence]:
        """The occurrences that a step may be made for in a configuration."""
        tree = thread.tree
        if at.stopped:
            return
        if at == Configuration():
            yield START
            return
        for name in at.active:
            done = f"{thread.name}.{name}.{DONE}"
            if thread.parts is not None and not thread.parts.says(at, name):
                continue
            if name in tree.working and name not in at.done and done in self.events:
                yield Occurrence("done", name)
        if at.pending:
            yield Occurrence("completion", at.pending[0])
            return
        if thread.parts is not None and thread.parts.is_outer(at):
            return
        triggers = [t for name in at.active for t in tree.outgoing[name]]
        for transition in triggers:
            if isinstance(transition.trigger, After | Every):
                yield Occurrence("time", transition.name)
        for event in tree.region.events():
            if event in self.events:
                yield Occurrence("event", event)
        if any(isinstance(t.trigger, When) for t in triggers):
            yield CONDITIONS

    def steps(
        self, thread: Thread, at: Configuration, occurrence: Occurrence
    ) -> tuple[Outcome, ...]:
        """The outcomes of a step from a whole configuration, data aside."""
        is_exact = thread.past is None and thread.parts is None
        made = thread.steps if is_exact else thread.exact
        key = (at, occurrence)
        if key not in made:
            made[key] = outcomes(thread.tree, at, occurrence, self.plain, make=self.make)
        return made[key]

    def _outcomes(
        self, thread: Thread, at: Configuration, occurrence: Occurrence
    ) -> tuple[Outcome, ...]:
        """The same, as coarsely as a thread is explored."""
        key = (at, occurrence)
        if key not in thread.steps:
            contested = None if thread.parts is None else thread.parts.contested(at)
            thread.steps[key] = outcomes(
                thread.tree, at, occurrence, self.plain, thread.past, contested, self.make
            )
        return thread.steps[key]

    def _successors(
        self, thread: Thread, cells: Cells, outcome: Outcome, solver: Term, context: object
    ) -> tuple[Cells, ...]:
        """The cells after an outcome; none where it cannot come about."""
        key = (outcome, cells, context)
        if key not in thread.known:
            thread.known[key] = tuple(self._computed(thread, cells, outcome, solver, context))
        return thread.known[key]

    def _computed(
        self, thread: Thread, cells: Cells, outcome: Outcome, solver: Term, context: object
    ) -> Iterator[Cells]:
        updates = {n: v for n, v in outcome.updates if n in thread.own}
        fixed = list(cells)
        open_: list[tuple[int, Variable, Term]] = []
        for index, name in enumerate(thread.own):
            if name in updates and z3.is_const(updates[name]) and _is_value(updates[name]):
                fixed[index] = self.cell_of(name, updates[name])
            elif name in updates:
                open_.append((index, name, updates[name]))
        if not open_ and z3.is_true(outcome.condition):
            yield tuple(fixed)
            return
        if not open_:
            if self._can_be_met(thread, cells, outcome.condition, solver, context):
                yield tuple(fixed)
            return
        solver.push()
        solver.add(*self.of_node(thread, cells), outcome.condition)
        while (answer := self.budget.ask(solver)) != z3.unsat:
            thread.questions += 1
            if thread.questions > MOST_QUESTIONS and thread.tells_more:
                raise TooManyQuestions
            if answer == z3.unknown:
                yield from self._all(fixed, open_)
                break
            model = solver.model()
            here = []
            for index, name, value in open_:
                fixed[index] = self.cell_of(name, model.eval(value, model_completion=True))
                here.append(self.in_cell(name, value, fixed[index]))
            yield tuple(fixed)
            solver.add(z3.Not(z3.And(here)))
        solver.pop()

    def _can_be_met(
        self, thread: Thread, cells: Cells, condition: Term, solver: Term, context: object
    ) -> bool:
        """Whether some data of a node meet a condition; when in doubt, yes."""
        key = (condition.get_id(), cells, context)
        if key not in thread.answers:
            thread.questions += 1
            if thread.questions > MOST_QUESTIONS and thread.tells_more:
                raise TooManyQuestions
            solver.push()
            solver.add(*self.of_node(thread, cells), condition)
            thread.answers[key] = condition, bool(self.budget.ask(solver) != z3.unsat)
            solver.pop()
        return thread.answers[key][1]

    def _all(self, fixed: list[int], open_: list[tuple[int, Variable, Term]]) -> Iterator[Cells]:
        """Every combination of cells, where the solver gave up."""
        if not open_:
            yield tuple(fixed)
            return
        (index, name, _), *rest = open_
        for cell in range(len(self.cells[name])):
            yield from self._all([*fixed[:index], cell, *fixed[index + 1 :]], rest)

    # --- what was found

    def thread(self, name: str) -> Thread:
        """The thread of a region or activity."""
        return next(t for t in self.threads if t.name == name)

    def parameters_of(self, instance: str) -> dict[Variable, Term]:
        """The parameters of an instance."""
        return self.constants.get(instance, {})

    def completes(self, thread: Thread) -> Iterator[tuple[str, str]]:
        """The region and state that an activity may complete."""
        for activity in self.component.activities:
            if activity.name == thread.name and activity.while_in and DONE in activity.raises:
                yield activity.while_in.region, activity.while_in.state

    def way(self, thread: Thread, node: Situation) -> list[Edge]:
        """The shortest way to a node."""
        way: list[Edge] = []
        edge = thread.nodes[node]
        while edge is not None:
            way.append(edge)
            edge = thread.nodes[edge.before]
        return way[::-1]


def _is_value(value: Term) -> bool:
    return bool(z3.is_int_value(value) or z3.is_true(value) or z3.is_false(value))
