# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A running system that notes the coverage of its charts."""

from __future__ import annotations

from ravenchart.behaviour.interpreter.expressions import holds
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import (
    ExecutedTransition,
    Happened,
    Nothing,
    Occurrence,
    RegionRun,
)
from ravenchart.gen.language.terms import Expression
from ravenchart.gen.model.statechart import Transition, When
from ravenchart.gen.model.system import System

from .goals import Decision, GoalCoverage, evaluated


class WatchedRegion(RegionRun):
    """A region that notes its coverage, for its component."""

    component: str
    coverage: GoalCoverage

    def _lets_through(self, transition: Transition) -> bool:
        if transition.guard is None:
            return True
        return self._decided(transition, Decision.GUARD, transition.guard)

    def _triggers(self, transition: Transition, occurrence: Occurrence) -> bool:
        if not (isinstance(occurrence, Nothing) and isinstance(transition.trigger, When)):
            return super()._triggers(transition, occurrence)
        return self._decided(transition, Decision.TRIGGER, transition.trigger.condition)

    def _decided(self, transition: Transition, decision: Decision, condition: Expression) -> bool:
        found = evaluated(condition, lambda one: holds(one, self._view))
        element = self.component, self.region.name, transition.name
        self.coverage.decide(element, decision, found)
        return found[1]

    def _effect(self, transition: Transition) -> None:
        self.coverage.take((self.component, self.region.name, transition.name))
        super()._effect(transition)

    def _fire(self, firing: ExecutedTransition) -> None:
        inside = [state for state in self.configuration() if self.tree.states[state].is_leaf]
        for transition in firing.effects:
            element = self.component, self.region.name, transition.name
            for leaf in inside:
                if transition.source in self.tree.around(leaf):
                    self.coverage.leave(element, leaf)
        super()._fire(firing)

    def _defer(self, event: Happened) -> None:
        for state in self.configuration():
            if event.event in self._defers(state):
                self.coverage.defer((self.component, self.region.name, state), event.event)
        super()._defer(event)


def watched_machine(system: System, coverage: GoalCoverage) -> Machine:
    """The system before its epoch; its charts add to ``coverage``."""
    machine = Machine(system, WatchedRegion)
    for instance in machine.instances.values():
        for run in instance.regions.values():
            assert isinstance(run, WatchedRegion)
            run.component, run.coverage = instance.component.name, coverage
    return machine
