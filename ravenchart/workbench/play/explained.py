# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An observed step in words."""

from __future__ import annotations

from ravenchart.behaviour.interpreter.observed import (
    FalseGuard,
    FiringReason,
    Judgement,
    ObservedStep,
)
from ravenchart.behaviour.interpreter.region import Completed, Happened, TimeOut
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns, Value
from ravenchart.gen.model.notation import shown_expression, trigger
from ravenchart.gen.model.statechart import After, Completion, Every, OnEvent, When


def value_text(value: Value) -> str:
    """A value, as an event file has it."""
    if isinstance(value, tuple):
        return f"{{{', '.join(f'{name}: {value_text(one)}' for name, one in value)}}}"
    return {"True": "true", "False": "false"}.get(str(value), str(value))


def with_value(name: str, value: Value | None) -> str:
    """An event with what it carries."""
    return name if value is None else f"{name} with {value_text(value)}"


def occurrence(step: ObservedStep) -> str:
    """The occurrence of the step, in words."""
    match step.occurrence:
        case None if step.started:
            return "the start: the initial state is entered"
        case None:
            return "nothing: the region has terminated"
        case Completed(state):
            return f"the completion of {state}"
        case TimeOut(transition):
            return f"the time-out of {transition.name} ({trigger(transition.trigger)})"
        case Happened(event, value):
            return f"the event {with_value(event, value)}"
    return "no occurrence: `when` conditions are read"


def reason(verdict: Judgement, period: Ns) -> str:
    """Why a transition was taken or not; ``period`` is that of its region."""
    names = ", ".join(verdict.because)
    match verdict.reason:
        case FiringReason.FIRED:
            return "fired"
        case FiringReason.NOT_DUE:
            count = verdict.executions
            many = f"{count} executions" if count > 1 else "1 execution"
            return f"not yet due: {shown(count * period)} left ({many})"
        case FiringReason.NOT_COMPLETE:
            return f"{names} has not completed"
        case FiringReason.COMPLETION_OVER:
            return f"the completion of {verdict.transition.source} has had its step"
        case FiringReason.TIME_OUT_OVER:
            return "its time-out has had its step"
        case FiringReason.CONDITION_FALSE | FiringReason.GUARD_FALSE:
            what = "condition" if verdict.reason is FiringReason.CONDITION_FALSE else "guard"
            return f"its {what} {' and '.join(map(_false, verdict.failed))}"
        case FiringReason.NO_WAY_ON:
            failed = [f"the guard {_false(one)}" for one in verdict.failed]
            failed += [f"{state} has not completed" for state in verdict.because]
            return "; ".join((f"no way on from {verdict.transition.target}", *failed))
        case FiringReason.INSIDE:
            return f"a transition inside {verdict.transition.source} goes first: {names}"
        case FiringReason.EARLIER:
            return f"an earlier transition of {verdict.transition.source} is taken: {names}"
        case FiringReason.DEFERRED:
            return f"the event is deferred by {names}"
        case FiringReason.CONFLICT:
            return f"conflicts with what was taken before it: {names}"
    return _another(verdict)


def _false(found: FalseGuard) -> str:
    """A condition that is false, with what it read."""
    values = ", ".join(
        f"{shown_expression(one)} = {value_text(value)}" for one, value in found.reads
    )
    return f"`{shown_expression(found.expression)}` is false{': ' if values else ''}{values}"


def _another(verdict: Judgement) -> str:
    """Of a transition that the occurrence of the step does not trigger."""
    later = verdict.reason is FiringReason.LATER
    match verdict.transition.trigger:
        case OnEvent(event) if later:
            return f"{event} is queued: it has a later step"
        case OnEvent(event):
            return f"waits for the event {event}"
        case After() | Every():
            return "due: it has a later step"
        case Completion():
            return f"{verdict.transition.source} has completed: that has a later step"
        case When():
            return "its condition is read only when nothing else waits"
    return "the step was for something else"
