# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The goals that no execution can show, as far as the rules of behaviour tell.

The rules look at each region against all that may come from elsewhere, under every interleaving,
and leave nothing out (`behaviour.rules.reach`). Here each step from each situation is made
once more, with the conditions of its guards asked one by one. So this coverage has all that any
execution shows, and more. A goal that it does not show is unreachable. Which time-out comes first
is looked at only where a state and a leaf in it are always entered together. Of each step the
solver tells an event's value with which it is made: such values guide the search.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import z3

from ravenchart.behaviour.limits import EFFORT
from ravenchart.behaviour.rules import logic
from ravenchart.behaviour.rules.budget import Budget, Exhausted
from ravenchart.behaviour.rules.outcomes import Outcome, TooManyWays, outcomes
from ravenchart.behaviour.rules.reach import Reachable
from ravenchart.behaviour.rules.stepping import OpenStep, TransitionPath
from ravenchart.behaviour.rules.threads import Situation, Steps, Thread
from ravenchart.behaviour.tree import Occurrence
from ravenchart.gen.language.terms import (
    BOOLEAN,
    Expression,
    IntegerType,
    Reading,
    Scalar,
    ScalarType,
)
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import (
    After,
    Every,
    PseudoKind,
    Transition,
    TransitionKind,
    When,
)
from ravenchart.gen.model.system import System

from .goals import Decision, Goal, GoalCoverage, GoalKind, evaluated
from .stimulation import PartialValue


@dataclass(frozen=True, slots=True)
class Outlook:
    """Goals that no execution can show, and values that others may need."""

    unreachable: list[Goal] = field(default_factory=list)
    values: dict[tuple[str, str], list[PartialValue]] = field(default_factory=dict)
    """By component and event."""


def outlook(system: System, goals: Sequence[Goal], effort: int = EFFORT) -> Outlook:
    """What the rules of behaviour tell of the goals before anything is executed.

    Each component may take ``effort``; one that takes more, and a region that can only be looked
    at in parts, may have further goals that are unreachable.
    """
    components = {one.component.name: one.component for one in system.instances}
    found = Outlook()
    for name, component in components.items():
        own = [goal for goal in goals if goal.element[0] == name]
        try:
            looked = _PossibleCoverage(component, system, effort) if own else None
        except (Exhausted, TooManyWays):
            continue
        if looked is not None:
            found.unreachable.extend(goal for goal in own if looked.excludes(goal))
            found.values.update(((name, one), some) for one, some in looked.values.items())
    return found


class _WatchedStep(OpenStep):
    """A step that notes each guard and trigger: its transition, which of them, and the values."""

    asking: Transition | None = None

    def through(self, transition: Transition) -> TransitionPath | None:
        self.asking = transition
        return super().through(transition)

    def holds(self, expression: Expression | None) -> bool:
        one = self.asking
        if expression is None or one is None:
            return super().holds(expression)
        if expression is one.guard:
            decision = Decision.GUARD
        elif isinstance(one.trigger, When) and expression is one.trigger.condition:
            decision = Decision.TRIGGER
        else:
            return super().holds(expression)
        found = evaluated(expression, super().holds)
        self.noted.append((one.name, decision, found))
        return found[1]


class _PossibleCoverage:
    """What executions of a component can show at the most."""

    def __init__(self, component: Component, system: System, effort: int) -> None:
        self.component = component
        self.coverage = GoalCoverage()
        self.values: dict[str, list[PartialValue]] = {}
        self.reach = Reachable(component, system, Budget(effort))
        regions = [self.reach.thread(region.name) for region in component.regions]
        self.looked = {thread.name for thread in regions if thread.parts is None}
        for thread in regions:
            if thread.name in self.looked:
                self._look_at(thread)

    def excludes(self, goal: Goal) -> bool:
        """Whether no execution shows a goal."""
        _, region, name = goal.element
        if region not in self.looked:
            return False
        tree = self.reach.thread(region).tree
        joins = any(t.name == name and tree.kinds.get(t.target) is PseudoKind.JOIN
                    for t in tree.region.transitions)  # fmt: skip
        if joins:
            return False
        return not self.coverage.shows(goal) or self._is_left_before(goal)

    def _is_left_before(self, goal: Goal) -> bool:
        """Whether a shorter time-out has always taken a leaf away when a longer one is due.

        So it is where the leaf is entered only with the state around it, and both times begin.
        """
        thread = self.reach.thread(goal.element[1])
        tree = thread.tree
        outer, leaf = tree.transitions.get(goal.element[2]), str(goal.detail)
        if goal.kind is not GoalKind.LEFT or outer is None:
            return False
        if not isinstance(outer.trigger, After | Every):
            return False
        longest = outer.trigger.executions
        takes_away = any(
            isinstance(one.trigger, After)
            and one.trigger.executions < longest
            and one.guard is None
            and one.kind is not TransitionKind.INTERNAL
            and one.target in tree.states
            for one in tree.outgoing[leaf]
        )
        return takes_away and all(
            outer.source in edge.outcome.entered
            for edge in thread.edges
            if leaf in edge.outcome.entered
        )

    def _look_at(self, thread: Thread) -> None:
        """All steps from all situations of a region."""
        solver = logic.solver()
        made: Steps = {}
        solver.add(*self.reach.typed, *self.reach.of_others(thread))
        for node in thread.nodes:
            at = node.configuration
            for occurrence in self.reach.occurrences(thread, at):
                if (at, occurrence) not in made:
                    made[at, occurrence] = self._outcomes(thread, node, occurrence)
                for outcome in made[at, occurrence]:
                    new = self._seen_in(thread, outcome)
                    if new.size and self._is_possible(thread, node, outcome, solver):
                        self.coverage.join(new)

    def _outcomes(
        self, thread: Thread, node: Situation, occurrence: Occurrence
    ) -> tuple[Outcome, ...]:
        at, questions = node.configuration, self.reach.plain
        return outcomes(thread.tree, at, occurrence, questions, thread.past, None, _WatchedStep)

    def _is_possible(
        self, thread: Thread, node: Situation, outcome: Outcome, solver: logic.Term
    ) -> bool:
        """Whether some data of a situation lead to an outcome; when in doubt, yes."""
        solver.push()
        solver.add(*self.reach.of_node(thread, node.cells), outcome.condition)
        answer = self.reach.budget.ask(solver)
        if answer == z3.sat:
            self._keep(outcome, solver)
        solver.pop()
        return bool(answer != z3.unsat)

    def _keep(self, outcome: Outcome, solver: logic.Term) -> None:
        """The least value of an event with which an outcome comes about."""
        event = outcome.occurrence.subject
        used = logic.unknowns([outcome.condition])
        asked = [
            variable
            for variable in self.reach.symbols
            if variable[:2] == (Reading.EVENT.value, event) and str(variable) in used
        ]
        #  the first answer that comes would depend on what the process has asked before
        least = z3.Optimize()
        least.add(*solver.assertions())
        for variable in asked:
            symbol = self.reach.symbol(variable)
            least.minimize(symbol if z3.is_int(symbol) else z3.If(symbol, 1, 0))
        if not asked or least.check() != z3.sat:
            return
        value = {
            member: _scalar(
                least.model().eval(self.reach.symbol(variable), model_completion=True),
                self.reach.types[variable],
            )
            for variable in asked
            for member in variable[2:]
        }
        known = self.values.setdefault(event, [])
        if value not in known:
            known.append(value)

    def _seen_in(self, thread: Thread, outcome: Outcome) -> GoalCoverage:
        """What an outcome shows that nothing has shown before."""
        new, tree = GoalCoverage(), thread.tree
        known, place = self.coverage, (self.component.name, thread.name)
        for name, decision, values in outcome.noted:
            element = (*place, name)
            if values not in known.evaluations.get((element, decision), ()):
                new.decide(element, decision, values)
        sources = {one.name: one.source for one in tree.region.transitions}
        leaves = [s for s in {*outcome.before.active, *outcome.entered} if tree.states[s].is_leaf]
        for name in outcome.fired:
            element = (*place, name)
            if element not in known.taken:
                new.take(element)
            for leaf in leaves:
                left = element, leaf
                if sources[name] in tree.around(leaf) and left not in known.left:
                    new.leave(element, leaf)
        for state in outcome.before.active if outcome.deferred else ():
            event, element = outcome.occurrence.subject, (*place, state)
            if event in tree.states[state].defers and (element, event) not in known.deferred:
                new.defer(element, event)
        return new


def _scalar(value: logic.Term, type_: ScalarType) -> Scalar:
    """A value of the solver as the interpreter has it."""
    if isinstance(type_, IntegerType):
        return int(value.as_long())
    if type_ == BOOLEAN:
        return BOOLEAN.literals[bool(z3.is_true(value))]
    return type_.literals[int(value.as_long())]
