# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The goals of test cases for a component's charts, and the coverage that executions show.

The goals are those of structural coverage (DO-178C, 6.4.4.2) on the chart as modelled. Each
transition is taken. Each guard and each condition that triggers is decided both ways. Each
condition of such a decision decides it by itself (modified condition/decision coverage, MC/DC).

Two evaluations show MC/DC when they differ in that condition and in the outcome. In each other
condition they are equal, or one evaluation stopped before it, as ``and`` and ``or`` stop early.
This is the masking MC/DC of Chilenski, DOT/FAA/AR-01/18, 2001.

Each event that a state defers is deferred there. Each leaf is left by each transition of a state
around it: the code that leaves a composite state has a part for each of its leaves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from enum import Enum
from itertools import combinations

from ravenchart.behaviour.tree import ChartTree
from ravenchart.gen.language.terms import BOOLEAN, Expression, Operation
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import (
    Completion,
    OnEvent,
    Transition,
    TransitionKind,
    Trigger,
    When,
)
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

GoalElement = tuple[str, str, str]
"""Component, region, and transition or state."""
GuardValues = tuple[tuple[bool | None, ...], bool]
"""The conditions of a decision, None where it did not come to one, and the outcome."""


class Decision(Enum):
    """A condition of a transition; the value names it in a report."""

    GUARD = "guard"
    TRIGGER = "trigger"


class GoalKind(Enum):
    """The kind of a goal; the value names it in a report."""

    TAKEN = "transitions taken"
    TRUE = "guards and triggers true"
    FALSE = "guards and triggers false"
    CONDITION = "conditions that decide by themselves"
    DEFERRED = "events deferred"
    LEFT = "states left by transitions around them"


@dataclass(frozen=True, slots=True)
class Goal:
    """One goal. ``detail`` is the number of the condition, the event, or the state."""

    kind: GoalKind
    element: GoalElement
    origin: Origin
    state: str
    """The state that must be active."""
    detail: int | str = ""
    decision: Decision = Decision.GUARD

    def text(self) -> str:
        """In words."""
        component, region, name = self.element
        named, decision = f"{component}.{region}.{name}", self.decision.value
        match self.kind:
            case GoalKind.TAKEN:
                return f"{named} is taken"
            case GoalKind.TRUE:
                return f"the {decision} of {named} is true"
            case GoalKind.FALSE:
                return f"the {decision} of {named} is false"
            case GoalKind.CONDITION:
                assert isinstance(self.detail, int)
                return f"condition {self.detail + 1} of the {decision} of {named} decides it"
            case GoalKind.LEFT:
                return f"{named} leaves {self.detail}"
        return f"{self.detail} is deferred in {named}"


def goals_of(system: System) -> list[Goal]:
    """The goals of all components that have instances, in model order."""
    components = {one.component.name: one.component for one in system.instances}
    return [goal for component in components.values() for goal in goals(component)]


def goals(component: Component) -> Iterator[Goal]:
    """The goals of its charts, in model order."""
    for region in component.regions:
        tree = ChartTree(region)
        for transition in region.transitions:
            yield from _of_transition(component.name, region.name, transition)
            yield from _of_leaves(component.name, tree, transition)
        for state in region.states:
            for event in state.defers:
                element = component.name, region.name, state.name
                yield Goal(GoalKind.DEFERRED, element, state.origin, state.name, event)


def _of_transition(component: str, region: str, transition: Transition) -> Iterator[Goal]:
    element = component, region, transition.name
    here = transition.origin, transition.source
    yield Goal(GoalKind.TAKEN, element, *here)
    decisions = [(Decision.GUARD, transition.guard)]
    if isinstance(transition.trigger, When):
        decisions.append((Decision.TRIGGER, transition.trigger.condition))
    for decision, expression in decisions:
        if expression is None:
            continue
        yield Goal(GoalKind.TRUE, element, *here, decision=decision)
        yield Goal(GoalKind.FALSE, element, *here, decision=decision)
        count = _conditions(expression)
        for number in range(count) if count > 1 else ():
            yield Goal(GoalKind.CONDITION, element, *here, number, decision)


def _of_leaves(component: str, tree: ChartTree, transition: Transition) -> Iterator[Goal]:
    """That a transition of a composite state leaves each leaf inside it."""
    is_internal = transition.kind is TransitionKind.INTERNAL
    if is_internal or isinstance(transition.trigger, Completion):
        return
    element = component, tree.region.name, transition.name
    for leaf in tree.region.states:
        around = tree.around(leaf.name)
        if not leaf.is_leaf or leaf.final or transition.source not in around:
            continue
        inner = [leaf.name, *around[: around.index(transition.source)]]
        if not any(_always_takes(tree, state, transition.trigger) for state in inner):
            yield Goal(GoalKind.LEFT, element, transition.origin, leaf.name, leaf.name)


def _always_takes(tree: ChartTree, state: str, trigger: Trigger) -> bool:
    """Whether a state has an unguarded transition for an event, or defers it."""
    if not isinstance(trigger, OnEvent):
        return False
    return trigger.event in tree.states[state].defers or any(
        one.trigger == trigger and one.guard is None for one in tree.outgoing[state]
    )


def _parts(expression: Expression) -> tuple[Expression, ...]:
    """The operands of a Boolean operation; none for a condition."""
    match expression:
        case Operation(operator="and" | "or" | "not", operands=operands):
            return operands
        case Operation(operator="if", operands=operands, type=kind) if kind == BOOLEAN:
            return operands
    return ()


def _conditions(expression: Expression) -> int:
    """The number of conditions of an expression."""
    parts = _parts(expression)
    return sum(map(_conditions, parts)) if parts else 1


def evaluated(expression: Expression, holds: Callable[[Expression], bool]) -> GuardValues:
    """A guard and its conditions, evaluated as the generated code does: no further than needed.

    ``holds`` evaluates one condition.
    """
    parts = _parts(expression)
    if not parts:
        found = holds(expression)
        return (found,), found
    assert isinstance(expression, Operation)
    first, outcome = evaluated(parts[0], holds)
    if expression.operator == "not":
        return first, not outcome
    if expression.operator == "if":
        branches = [
            evaluated(part, holds) if outcome is chosen else (_unknown(part), False)
            for part, chosen in zip(parts[1:], (True, False), strict=True)
        ]
        conditions = (*first, *branches[0][0], *branches[1][0])
        return conditions, branches[0 if outcome else 1][1]
    if outcome is (expression.operator == "or"):
        return (*first, *_unknown(parts[1])), outcome
    second, outcome = evaluated(parts[1], holds)
    return (*first, *second), outcome


def _unknown(expression: Expression) -> tuple[None, ...]:
    return (None,) * _conditions(expression)


@dataclass(slots=True)
class GoalCoverage:
    """The coverage of executions. ``size`` grows with each new entry."""

    taken: set[GoalElement] = field(default_factory=set)
    evaluations: dict[tuple[GoalElement, Decision], set[GuardValues]] = field(default_factory=dict)
    deferred: set[tuple[GoalElement, str]] = field(default_factory=set)
    left: set[tuple[GoalElement, str]] = field(default_factory=set)
    size: int = 0

    def take(self, element: GoalElement) -> None:
        """Note that a transition was taken."""
        self.size += element not in self.taken
        self.taken.add(element)

    def decide(self, element: GoalElement, decision: Decision, evaluation: GuardValues) -> None:
        """Note how a guard or a trigger was evaluated."""
        known = self.evaluations.setdefault((element, decision), set())
        self.size += evaluation not in known
        known.add(evaluation)

    def defer(self, element: GoalElement, event: str) -> None:
        """Note that a state deferred an event."""
        self.size += (element, event) not in self.deferred
        self.deferred.add((element, event))

    def leave(self, element: GoalElement, state: str) -> None:
        """Note that a transition left a state inside its source."""
        self.size += (element, state) not in self.left
        self.left.add((element, state))

    def has(self, other: GoalCoverage) -> bool:
        """Whether this coverage includes another one."""
        return (
            other.taken <= self.taken
            and other.deferred <= self.deferred
            and other.left <= self.left
            and all(
                evaluations <= self.evaluations.get(one, set())
                for one, evaluations in other.evaluations.items()
            )
        )

    def join(self, other: GoalCoverage) -> None:
        """Add another coverage to this one."""
        for element in other.taken:
            self.take(element)
        for (element, decision), known in other.evaluations.items():
            for evaluation in known:
                self.decide(element, decision, evaluation)
        for element, event in other.deferred:
            self.defer(element, event)
        for element, state in other.left:
            self.leave(element, state)

    def shows(self, goal: Goal) -> bool:
        """Whether a goal is met."""
        if goal.kind is GoalKind.TAKEN:
            return goal.element in self.taken
        if goal.kind is GoalKind.DEFERRED:
            return (goal.element, goal.detail) in self.deferred
        if goal.kind is GoalKind.LEFT:
            return (goal.element, goal.detail) in self.left
        known = self.evaluations.get((goal.element, goal.decision), set())
        if goal.kind is GoalKind.CONDITION:
            assert isinstance(goal.detail, int)
            return any(_decides(goal.detail, *pair) for pair in combinations(known, 2))
        return any(outcome is (goal.kind is GoalKind.TRUE) for _, outcome in known)


def union(*parts: GoalCoverage) -> GoalCoverage:
    """The joint coverage of several."""
    found = GoalCoverage()
    for one in parts:
        found.join(one)
    return found


def _decides(number: int, one: GuardValues, other: GuardValues) -> bool:
    """Whether two evaluations show that a condition decides by itself."""
    if one[1] is other[1] or {one[0][number], other[0][number]} != {True, False}:
        return False
    return all(
        a is b or a is None or b is None
        for index, (a, b) in enumerate(zip(one[0], other[0], strict=True))
        if index != number
    )
