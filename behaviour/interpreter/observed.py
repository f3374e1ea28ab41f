# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A region that notes for each transition from an active state why it was taken or not.

The values are read where the step itself reads them: after its occurrence left the queue, before
a transition is taken. So they are the values that the guards had.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum, auto

from ravenchart.gen.language.terms import (
    Expression,
    InState,
    Name,
    Operation,
    PortTest,
    Value,
)
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    OnEvent,
    PseudoKind,
    Transition,
    When,
)

from .expressions import View, value_in
from .region import ExecutedTransition, Happened, Nothing, Occurrence, RegionRun, Step

Reads = tuple[tuple[Name | PortTest | InState, Value], ...]
"""The names and tests in an expression, with their values."""


class FiringReason(Enum):
    """Why a transition from an active state was taken or not."""

    FIRED = auto()
    OTHER_TRIGGER = auto()
    """The step was for another occurrence."""
    NOT_DUE = auto()
    """Its time-out is not due yet."""
    LATER = auto()
    """Its own occurrence waits for a later step."""
    NOT_COMPLETE = auto()
    """Its source has not completed."""
    COMPLETION_OVER = auto()
    """The completion of its source has had its step."""
    TIME_OUT_OVER = auto()
    """Its time-out has had its step."""
    CONDITION_FALSE = auto()
    """The condition of its `when` is false."""
    GUARD_FALSE = auto()
    NO_WAY_ON = auto()
    """The junction or join behind it lets nothing through."""
    INSIDE = auto()
    """A transition inside its source was selected."""
    EARLIER = auto()
    """An earlier transition of its source was selected."""
    DEFERRED = auto()
    """An active state defers the event."""
    CONFLICT = auto()
    """A transition that was taken before has left its source."""


@dataclass(frozen=True, slots=True)
class FalseGuard:
    """A guard or condition that did not hold."""

    expression: Expression
    reads: Reads


@dataclass(frozen=True, slots=True)
class Judgement:
    """A transition, and why it was taken or not."""

    transition: Transition
    reason: FiringReason
    because: tuple[str, ...] = ()
    """The transitions taken instead, or the states that defer or have not completed."""
    failed: tuple[FalseGuard, ...] = ()
    """Its guard, or those of the segments behind it."""
    executions: int = 0
    """The executions until it is due."""


@dataclass(frozen=True, slots=True)
class ObservedStep:
    """One step; ``occurrence`` is None of the first, and of a region that has terminated."""

    occurrence: Occurrence | None
    started: bool
    """Whether it was the first step of the region."""
    deferring: tuple[str, ...]
    """The active states that defer its event, where it was deferred."""
    verdicts: tuple[Judgement, ...]
    behaviours: tuple[str, ...]
    sent: tuple[tuple[str, Value], ...]
    raised: tuple[tuple[str, Value | None], ...]
    lost: int


class ObservedRegion(RegionRun):
    """A region that keeps the steps of its last execution."""

    steps: tuple[ObservedStep, ...] = ()
    _occurrence: Occurrence | None = None
    _verdicts: tuple[Judgement, ...] = ()
    _deferring: tuple[str, ...] = ()

    def begin(self) -> None:
        """Another execution begins."""
        super().begin()
        self.steps = ()

    def step(self, view: View) -> Step:
        """One step, observed."""
        started = not self.active and not self.stopped
        self._occurrence, self._verdicts, self._deferring = None, (), ()
        found = super().step(view)
        observed = ObservedStep(
            self._occurrence,
            started,
            self._deferring,
            self._verdicts,
            tuple(found.behaviours),
            tuple(found.out.sent.items()),
            tuple(found.out.raised),
            found.lost,
        )
        self.steps = (*self.steps, observed)
        return found

    def _next(self) -> Occurrence:
        self._occurrence = super()._next()
        return self._occurrence

    def _defer(self, event: Happened) -> None:
        self._deferring = tuple(s for s in self._active() if event.event in self._defers(s))
        self._verdicts = tuple(self._judged(()))
        super()._defer(event)

    def _fire_all(self, selected: Sequence[ExecutedTransition]) -> None:
        judged = tuple(self._judged(selected))
        self._fired: list[ExecutedTransition] = []
        super()._fire_all(selected)
        self._verdicts = tuple(self._settled(one, selected) for one in judged)

    def _fire(self, firing: ExecutedTransition) -> None:
        self._fired.append(firing)
        super()._fire(firing)

    # --- verdicts

    def _active(self) -> list[str]:
        """The active states, in model order."""
        active = self.configuration()
        return [state for state in self.tree.states if state in active]

    def _judged(self, selected: Sequence[ExecutedTransition]) -> Iterator[Judgement]:
        """The verdicts before any transition is taken: FIRED marks all that were selected."""
        active = self._active()
        for transition in self.region.transitions:
            if transition.source in active:
                yield self._verdict(transition, selected)

    def _settled(self, verdict: Judgement, selected: Sequence[ExecutedTransition]) -> Judgement:
        """The final verdict: a selected transition was taken, or others were taken before it."""
        if verdict.reason is not FiringReason.FIRED:
            return verdict
        mine = next(one for one in selected if verdict.transition in one.effects)
        if any(one is mine for one in self._fired):
            return verdict
        before = [one.effects[0].name for one in self._fired if one in selected]
        return replace(verdict, reason=FiringReason.CONFLICT, because=tuple(before))

    def _verdict(self, transition: Transition, selected: Sequence[ExecutedTransition]) -> Judgement:
        if any(transition in one.effects for one in selected):
            return Judgement(transition, FiringReason.FIRED)
        assert self._occurrence is not None
        if not self._triggers(transition, self._occurrence):
            return self._not_triggered(transition, self._occurrence)
        inside = [
            one.effects[0].name
            for one in selected
            if transition.source in self.tree.around(one.source)
        ]
        if inside:
            return Judgement(transition, FiringReason.INSIDE, tuple(inside))
        if not self._lets_through(transition):
            assert transition.guard is not None
            return Judgement(
                transition, FiringReason.GUARD_FALSE, (), (self._failed(transition.guard),)
            )
        if self._enabled(transition) is None:
            failed = tuple(self._failures(transition.target, (transition.target,)))
            waiting = tuple(self._incomplete(transition.target))
            return Judgement(transition, FiringReason.NO_WAY_ON, waiting, failed)
        earlier = [one.effects[0].name for one in selected if one.source == transition.source]
        if earlier:
            return Judgement(transition, FiringReason.EARLIER, tuple(earlier))
        return Judgement(transition, FiringReason.DEFERRED, self._deferring)

    def _not_triggered(self, transition: Transition, occurrence: Occurrence) -> Judgement:
        """Why the occurrence of this step does not trigger a transition."""
        name = transition.name
        match transition.trigger:
            case OnEvent(event):
                waits = any(one.event == event for one in self.queue)
                waits = waits or any(one.happened.event == event for one in self.deferred)
                return Judgement(
                    transition, FiringReason.LATER if waits else FiringReason.OTHER_TRIGGER
                )
            case After() | Every() if name in self.timers:
                left = self.timers[name] - self.executions
                reason = FiringReason.NOT_DUE if left > 0 else FiringReason.LATER
                return Judgement(transition, reason, executions=max(0, left))
            case After() | Every():
                return Judgement(transition, FiringReason.TIME_OUT_OVER)
            case Completion() if transition.source in self.completed:
                return Judgement(transition, FiringReason.LATER)
            case Completion() if self._is_complete(transition.source):
                return Judgement(transition, FiringReason.COMPLETION_OVER)
            case Completion():
                return Judgement(transition, FiringReason.NOT_COMPLETE, (transition.source,))
            case When(condition) if isinstance(occurrence, Nothing):
                failed = self._failed(condition)
                return Judgement(transition, FiringReason.CONDITION_FALSE, failed=(failed,))
        return Judgement(transition, FiringReason.OTHER_TRIGGER)

    def _failures(self, vertex: str, seen: tuple[str, ...]) -> Iterator[FalseGuard]:
        """The guards behind a junction that do not hold."""
        if self.tree.kinds.get(vertex) is not PseudoKind.JUNCTION:
            return
        for segment in self.tree.outgoing[vertex]:
            if segment.guard is not None and not self._lets_through(segment):
                yield self._failed(segment.guard)
            elif segment.target not in seen:
                yield from self._failures(segment.target, (*seen, segment.target))

    def _incomplete(self, vertex: str) -> Iterator[str]:
        """The sources of a join that have not completed."""
        if self.tree.kinds.get(vertex) is PseudoKind.JOIN:
            for segment in self.tree.incoming[vertex]:
                if not self._ready(segment):
                    yield segment.source

    def _failed(self, expression: Expression) -> FalseGuard:
        reads = dict.fromkeys(_reads(expression))
        return FalseGuard(expression, tuple((one, value_in(one, self._view)) for one in reads))


def _reads(expression: Expression) -> Iterator[Name | PortTest | InState]:
    """The names and tests in an expression, in its order."""
    match expression:
        case Operation(operands=operands):
            for operand in operands:
                yield from _reads(operand)
        case Name() | PortTest() | InState():
            yield expression
