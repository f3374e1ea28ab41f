"""A system under way of which one sees what its charts show, and that can be branched."""

from __future__ import annotations

import copy
from collections import deque
from dataclasses import replace

from ravenchart.behaviour.interpreter.machine import InstanceRun, Machine, Mailbox
from ravenchart.behaviour.interpreter.region import (
    ExecutedTransition,
    Happened,
    Nothing,
    Occurrence,
    RegionRun,
)
from ravenchart.gen.model.statechart import Transition, When
from ravenchart.gen.model.system import System

from .goals import WHEN, GoalCoverage, evaluated


class WatchedRegion(RegionRun):
    """A region that notes what it shows, for its component."""

    component: str
    coverage: GoalCoverage

    def _lets_through(self, transition: Transition) -> bool:
        if transition.guard is None:
            return True
        found = evaluated(transition.guard, self._view)
        self.coverage.decide((self.component, self.region.name, transition.name), found)
        return found[1]

    def _triggers(self, transition: Transition, occurrence: Occurrence) -> bool:
        if not (isinstance(occurrence, Nothing) and isinstance(transition.trigger, When)):
            return super()._triggers(transition, occurrence)
        found = evaluated(transition.trigger.condition, self._view)
        self.coverage.decide((self.component, self.region.name, transition.name + WHEN), found)
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


def watched(system: System, coverage: GoalCoverage) -> Machine:
    """The system before its epoch; what its charts show goes to ``coverage``."""
    machine = Machine(system, WatchedRegion)
    for instance in machine.instances.values():
        for run in instance.regions.values():
            assert isinstance(run, WatchedRegion)
            run.component, run.coverage = instance.component.name, coverage
    return machine


def branched(machine: Machine) -> Machine:
    """The same as it is now, to go on by itself; both note to the same coverage."""
    new = copy.copy(machine)
    new.instances = {name: _instance(one) for name, one in machine.instances.items()}
    return new


def _instance(run: InstanceRun) -> InstanceRun:
    new = copy.copy(run)
    new.data, new.ports = dict(run.data), dict(run.ports)
    new.mailboxes = {name: _mailbox(one) for name, one in run.mailboxes.items()}
    new.regions = {name: _region(one) for name, one in run.regions.items()}
    return new


def _mailbox(box: Mailbox) -> Mailbox:
    new = copy.copy(box)
    new.waiting = deque(box.waiting)
    return new


def _region(run: RegionRun) -> RegionRun:
    new = copy.copy(run)
    new.active, new.history, new.timers = dict(run.active), dict(run.history), dict(run.timers)
    new.completed, new.done = set(run.completed), set(run.done)
    new.deferred = [replace(kept) for kept in run.deferred]
    new.queue = deque(run.queue)
    return new
