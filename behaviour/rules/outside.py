# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The surroundings of a component: events from outside, parameters, activities as regions."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.language.terms import InState, Ns, Reading
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.statechart import (
    DONE,
    Every,
    Initial,
    Overflow,
    Region,
    State,
    Transition,
    TransitionKind,
)
from ravenchart.gen.model.system import System

from . import logic
from .logic import Term, Variable


def as_region(activity: Activity) -> Region:
    """An activity's flow as the internal transition of a region of one state."""
    here = activity.origin
    condition = activity.while_in
    guard = None if condition is None else InState(condition.region, condition.state)
    state = State("working", here, None, "", (), (), ())
    work = Transition(
        "run",
        here,
        "working",
        "working",
        TransitionKind.INTERNAL,
        Every(Ns(0), 1),
        guard,
        activity.flow or (),
    )
    return Region(
        name=activity.name,
        origin=here,
        timing=activity.timing,
        queue_depth=1,
        overflow=Overflow.REJECT_NEWEST,
        on_overflow=None,
        steps_per_execution=1,
        initial=Initial("working"),
        safe_state=None,
        states=(state,),
        transitions=(work,),
        reads=activity.reads,
        writes=activity.writes,
        sends=activity.sends,
        raises=activity.raises,
    )


def done_of(component: Component, activity: str) -> str:
    """The name of the completion that an activity raises."""
    found = next(a for a in component.activities if a.name == activity)
    assert found.while_in is not None
    return f"{found.while_in.region}.{found.while_in.state}.{DONE}"


def external_events(component: Component, system: System) -> Iterator[tuple[str, str | None]]:
    """The events that may come from outside, each with the row that raises it; None: at any time.

    An event that nothing raises is among them: a rule of `gen` reports it.
    """
    instances = {i.name for i in system.instances if i.component.name == component.name}
    for port in component.ports:
        row = component.handler(port.name)
        yield from ((e, row) for e in (port.on_arrival, port.on_stale, port.on_overflow) if e)
    for activity in component.activities:
        if activity.flow is None:
            for event in activity.raises:
                named = done_of(component, activity.name) if event == DONE else event
                yield named, activity.name
    yield from ((r.on_overflow, None) for r in component.regions if r.on_overflow)
    for need in component.needs:
        told = (need.on_reply, need.on_full, need.on_timeout)
        yield from ((event, None) for event in told if event)
    yield from ((e, None) for owner, e in system.raised_outside if owner in instances)
    raised = {e for item in component.runnables() for e in item.raises}
    raised |= {e for port in component.ports for e in (port.on_arrival, port.on_stale) if e}
    outside = (e for e in component.events if e.external or e.name not in raised)
    yield from ((event.name, None) for event in outside)


def instance_parameters(component: Component, system: System) -> dict[str, dict[Variable, Term]]:
    """The parameters of each instance that has any."""
    types = {p.name: p.type for p in component.parameters}
    return {
        instance.name: {
            logic.variable(Reading.PARAMETER, name, None): logic.constant(value, types[name])
            for name, value in instance.parameters
        }
        for instance in system.instances
        if instance.component.name == component.name and instance.parameters
    }
