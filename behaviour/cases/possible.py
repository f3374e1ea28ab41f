# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The goals that no execution can show, as far as the rules of behaviour determine them.

The rules explore each region against all that may come from elsewhere, under every interleaving,
and leave nothing out (`behaviour.rules.reach`). This module makes each step from each situation
once more and asks the conditions of its guards one by one. So its coverage includes that of
every execution. A goal that it does not show is unreachable. The order of time-outs
counts only where a state and a leaf in it are always entered together. For each step that
shows something new, the solver gives the values that make it. Such scenes guide the search.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import z3

from ravenchart.behaviour.limits import EFFORT
from ravenchart.behaviour.rules import logic
from ravenchart.behaviour.rules.budget import Budget, Exhausted
from ravenchart.behaviour.rules.outcomes import Outcome, TooManyWays, outcomes
from ravenchart.behaviour.rules.reach import Reachable
from ravenchart.behaviour.rules.stepping import Configuration, OpenStep, TransitionPath
from ravenchart.behaviour.rules.threads import Situation, Thread
from ravenchart.behaviour.tree import Occurrence
from ravenchart.gen.language.terms import Expression, IntegerType, Reading, Scalar
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


@dataclass(frozen=True, slots=True, eq=False)
class Scene:
    """The conditions of one step of a region: active states, an event, and values from outside."""

    region: str
    active: tuple[str, ...]
    event: str | None
    values: tuple[tuple[str, PartialValue | None], ...]
    """The values that matter, of the event, input ports and data items. None: nothing arrives at
    the port, so it is not fresh."""
    equal: Mapping[tuple[str, str | None], tuple[str, str | None]]
    """The values that must equal a data item of the component, each with its field."""
    raises: tuple[str, ...]
    """The events that the step raises."""
    shows: GoalCoverage
    """The coverage of the step."""

    def renamed(self, names: Mapping[str, str]) -> Scene:
        """The same scene with other names of the ports and data items."""
        return replace(
            self,
            values=tuple((names.get(name, name), value) for name, value in self.values),
            equal={(names.get(name, name), part): one for (name, part), one in self.equal.items()},
        )


@dataclass(frozen=True, slots=True)
class Outlook:
    """Goals that no execution can show, and scenes for the others."""

    unreachable: list[Goal] = field(default_factory=list)
    scenes: dict[str, list[Scene]] = field(default_factory=dict)
    """By component."""

    def values(self) -> dict[tuple[str, str], list[PartialValue]]:
        """Values that steps need, by component and event, port or data item."""
        found: dict[tuple[str, str], list[PartialValue]] = {}
        for component, scenes in self.scenes.items():
            for name, value in (pair for scene in scenes for pair in scene.values):
                known = found.setdefault((component, name), [])
                if value and value not in known:
                    known.append(value)
        return found


def outlook(system: System, goals: Sequence[Goal], effort: int = EFFORT) -> Outlook:
    """The unreachable goals and the scenes that the rules of behaviour find, without execution.

    Each component may take ``effort``. A component that takes more, and a region that is explored
    in parts, may have further unreachable goals.
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
            found.scenes[name] = looked.scenes
    return found


class _WatchedStep(OpenStep):
    """A step that notes each evaluated guard and trigger: transition, kind and values."""

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
    """The largest coverage that executions of a component can show."""

    def __init__(self, component: Component, system: System, effort: int) -> None:
        self.component = component
        self.coverage = GoalCoverage()
        self.scenes: list[Scene] = []
        self.outside = component.from_outside()
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
        """Whether a shorter time-out has always left the leaf when a longer one is due.

        This holds where the leaf is entered only with the state around it: both times begin then.
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
        """Make all steps from all situations of a region."""
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
                    if not known and self._is_possible(thread, node, outcome, shown, solver):
                        self.coverage.join(shown)

    def _is_possible(
        self,
        thread: Thread,
        node: Situation,
        outcome: Outcome,
        shown: GoalCoverage,
        solver: logic.Term,
    ) -> bool:
        """Whether some data of a situation lead to an outcome; when in doubt, yes."""
        solver.push()
        solver.add(*self.reach.of_node(thread, node.cells), outcome.condition)
        answer = self.reach.budget.ask(solver)
        if answer == z3.sat:
            self._keep(thread, outcome, shown, solver)
        solver.pop()
        return bool(answer != z3.unsat)

    def _keep(
        self, thread: Thread, outcome: Outcome, shown: GoalCoverage, solver: logic.Term
    ) -> None:
        """Keep the scene of an outcome, with the least values from outside that make it."""
        occurrence, used = outcome.occurrence, logic.unknowns([outcome.condition])
        event = occurrence.subject if occurrence.kind == "event" else None
        asked = {
            one: symbol
            for one, symbol in self.reach.symbols.items()
            if one.unknown in used and self._is_from_outside(one, event)
        }
        values: dict[str, dict[str | None, Scalar]] = {} if event is None else {event: {}}
        silent: list[str] = []
        equal: dict[tuple[str, str | None], tuple[str, str | None]] = {}
        if asked:
            model = self._least(asked.values(), solver)
            if model is None:
                return
            equal = self._equal(asked, used, model, solver)
            for one, symbol in asked.items():
                found = model.eval(symbol, model_completion=True)
                kind, name, part = one
                if kind != "port state":
                    values.setdefault(name, {})[part] = logic.scalar(found, self.reach.types[one])
                elif found.as_long() == logic.PORT_STATES.index("fresh"):
                    values.setdefault(name, {})
                else:
                    silent.append(name)
        active = outcome.before.active
        items = (*values.items(), *((name, None) for name in silent))
        raised = tuple(name for name, _ in outcome.raised)
        self.scenes.append(Scene(thread.name, active, event, items, equal, raised, shown))

    def _equal(
        self,
        asked: Mapping[logic.Variable, logic.Term],
        used: Collection[str],
        model: logic.Term,
        solver: logic.Term,
    ) -> dict[tuple[str, str | None], tuple[str, str | None]]:
        """The values that must equal the component's own data."""
        found = {}
        own = [
            (one, symbol)
            for one, symbol in self.reach.symbols.items()
            if one[0] == Reading.DATA.value and one not in asked and one.unknown in used
        ]
        for one, symbol in asked.items():
            for other, value in own:
                kinds = self.reach.types[one], self.reach.types[other]
                if not all(isinstance(kind, IntegerType) for kind in kinds):
                    continue
                if not z3.is_true(model.eval(symbol == value, model_completion=True)):
                    continue
                solver.push()
                solver.add(symbol != value)
                if self.reach.budget.ask(solver) == z3.unsat:
                    found[one[1:]] = other[1:]
                solver.pop()
        return found

    def _is_from_outside(self, one: logic.Variable, event: str | None) -> bool:
        kind, name, _ = one
        if kind == Reading.EVENT.value:
            return name == event
        if kind == Reading.DATA.value:
            return name in self.outside
        return kind in (Reading.PORT.value, "port state")

    def _least(self, symbols: Iterable[logic.Term], solver: logic.Term) -> logic.Term | None:
        """The model with the least values; the solver's first one depends on earlier questions."""
        least = logic.optimizer()
        least.add(*solver.assertions())
        for symbol in symbols:
            least.minimize(symbol if z3.is_int(symbol) else z3.If(symbol, 1, 0))
        return least.model() if self.reach.budget.ask(least) == z3.sat else None

    def _shown_by(self, thread: Thread, outcome: Outcome) -> GoalCoverage:
        """The coverage of an outcome."""
        shown, tree = GoalCoverage(), thread.tree
        region = self.component.name, thread.name
        for name, decision, values in outcome.noted:
            shown.decide((*region, name), decision, values)
        leaves = [s for s in {*outcome.before.active, *outcome.entered} if tree.states[s].is_leaf]
        for name in outcome.fired:
            shown.take((*region, name))
            for leaf in leaves:
                if tree.source_of(name) in tree.around(leaf):
                    shown.leave((*region, name), leaf)
        for state in outcome.before.active if outcome.deferred else ():
            event = outcome.occurrence.subject
            if event in tree.states[state].defers:
                shown.defer((*region, state), event)
        return shown
