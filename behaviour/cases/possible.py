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
from ravenchart.behaviour.rules.stepping import Configuration, OpenStep, TransitionPath
from ravenchart.behaviour.rules.threads import Situation, Thread
from ravenchart.behaviour.tree import Occurrence
from ravenchart.gen.language.terms import Expression, Reading
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
        one = tree.transitions.get(name)
        if one is not None and tree.kinds.get(one.target) is PseudoKind.JOIN:
            return False
        return not self.coverage.shows(goal) or self._is_left_before(goal)

    def _is_left_before(self, goal: Goal) -> bool:
        """Whether a shorter time-out has always taken a leaf away when a longer one is due.

        So it is where the leaf is entered only with the state around it, and both times begin.
        """
        if goal.kind is not GoalKind.LEFT:
            return False
        thread = self.reach.thread(goal.element[1])
        tree, leaf = thread.tree, str(goal.detail)
        outer = tree.transitions[goal.element[2]]
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
        made: dict[tuple[Configuration, Occurrence], list[tuple[Outcome, GoalCoverage]]] = {}
        solver.add(*self.reach.typed, *self.reach.of_others(thread))
        for node in thread.nodes:
            at = node.configuration
            for occurrence in self.reach.occurrences(thread, at):
                if (at, occurrence) not in made:
                    found = outcomes(
                        thread.tree,
                        at,
                        occurrence,
                        self.reach.plain,
                        thread.past,
                        make=_WatchedStep,
                    )
                    made[at, occurrence] = [(one, self._shown_by(thread, one)) for one in found]
                for outcome, shown in made[at, occurrence]:
                    known = self.coverage.has(shown)
                    if not known and self._is_possible(thread, node, outcome, solver):
                        self.coverage.join(shown)

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
        asked = {
            variable: symbol
            for variable, symbol in self.reach.symbols.items()
            if variable[:2] == (Reading.EVENT.value, event) and str(variable) in used
        }
        if not asked:
            return
        #  the first answer that comes would depend on what the process has asked before
        least = logic.optimizer()
        least.add(*solver.assertions())
        for symbol in asked.values():
            least.minimize(symbol if z3.is_int(symbol) else z3.If(symbol, 1, 0))
        if self.reach.budget.ask(least) != z3.sat:
            return
        model = least.model()
        value = {
            variable[2]: logic.scalar(
                model.eval(symbol, model_completion=True), self.reach.types[variable]
            )
            for variable, symbol in asked.items()
        }
        known = self.values.setdefault(event, [])
        if value not in known:
            known.append(value)

    def _shown_by(self, thread: Thread, outcome: Outcome) -> GoalCoverage:
        """What an outcome shows where it comes about."""
        shown, tree = GoalCoverage(), thread.tree
        place = self.component.name, thread.name
        for name, decision, values in outcome.noted:
            shown.decide((*place, name), decision, values)
        leaves = [s for s in {*outcome.before.active, *outcome.entered} if tree.states[s].is_leaf]
        for name in outcome.fired:
            shown.take((*place, name))
            for leaf in leaves:
                if tree.source_of(name) in tree.around(leaf):
                    shown.leave((*place, name), leaf)
        for state in outcome.before.active if outcome.deferred else ():
            event = outcome.occurrence.subject
            if event in tree.states[state].defers:
                shown.defer((*place, state), event)
        return shown
