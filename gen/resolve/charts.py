# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Regions resolved: states in tree order, transitions with their triggers."""

from __future__ import annotations

from dataclasses import replace

from ravenchart.gen.files.schema import RegionForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.model.statechart import Overflow, Region, State, Timing, Transition, When

from .chart_names import States
from .chart_states import Setting, initial_of, vertices_of
from .chart_transitions import transition_of
from .flows import Targets, Use
from .vocabulary import Vocabulary


def region_of(
    name: str,
    form: RegionForm,
    timing: Timing,
    states: States,
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> Region:
    """A region, as far as it is sound."""
    setting = Setting(name, timing.period, states, words, targets, findings)
    vertices, pseudostates = vertices_of(form, setting)
    transitions: list[Transition] = []
    names: NameScope[str] = NameScope(f"transition of {name}")
    for transition, given in form.transitions.items():
        names.declare(transition, given.origin, transition, findings)
        made = transition_of(transition, given, setting)
        transitions += [] if made is None else [made]
    initial = initial_of(form, name, setting)
    safe = None
    if form.safe_state is not None:
        safe = states.look_up(form.safe_state, form.at("safe_state"), findings)
    _check_room(name, form, vertices, findings)
    region = Region(
        name=name,
        origin=form.origin,
        timing=timing,
        queue_depth=form.queue or 1,
        overflow=Overflow(form.overflow or "reject_newest"),
        on_overflow=_on_overflow(name, form, targets, findings),
        steps_per_execution=form.steps,
        initial=initial,
        safe_state=safe,
        states=tuple(vertices),
        transitions=tuple(transitions),
        reads=(),
        writes=(),
        sends=(),
        raises=(),
        pseudostates=tuple(pseudostates),
        deferral_depth=form.deferred or 0,
    )
    return with_uses(region)


def with_uses(region: Region) -> Region:
    """The region with what its guards and flows read, write, send and raise."""
    use = Use()
    for state in region.states:
        use.flow(state.entry)
        use.flow(state.exit)
        for nested in state.regions:
            use.flow(nested.initial.effect)
    use.flow(region.initial.effect)
    for transition in region.transitions:
        use.expression(transition.guard)
        if isinstance(transition.trigger, When):
            use.expression(transition.trigger.condition)
        use.flow(transition.effect)
    return replace(
        region,
        reads=tuple(name for name in use.reads if name != region.name),
        writes=tuple(use.writes),
        sends=tuple(use.sends),
        raises=tuple(use.raises),
    )


def _on_overflow(name: str, form: RegionForm, targets: Targets, findings: Findings) -> str | None:
    """The event raised when the queue lost one; it can carry no value."""
    if form.on_overflow is None:
        return None
    event = targets.events.look_up(form.on_overflow, form.at("on_overflow"), findings)
    if event is not None and event.type is not None:
        message = f"`on_overflow` of {name} has no value for {event.name}, which carries one"
        hint = "name an event without a type"
        findings.error("RV-0528", form.at("on_overflow"), message, hint=hint)
    return None if event is None else event.name


def _check_room(name: str, form: RegionForm, states: list[State], findings: Findings) -> None:
    """A region has a queue, and room for deferred events, exactly when it needs them."""
    waits = [(t.at("on"), t.on) for t in form.transitions.values() if t.on is not None]
    deferring = next((state for state in states if state.defers), None)
    if deferring is not None:
        waits.append((deferring.origin, deferring.defers[0]))
    if form.queue is None and not form.lost("queue"):
        if waits:
            message = f"{name} waits for events, but has no `queue`"
            notes = [(waits[0][0], f"`{waits[0][1]}` is one of them")]
            hint = "give the depth of the queue, such as `queue: 8`"
            findings.error("RV-0504", form.origin, message, notes=notes, hint=hint)
        for key in ("overflow", "on_overflow"):
            if form.has(key) and not waits:
                message = f"`{key}` has no meaning without `queue`"
                findings.error("RV-0210", form.at_key(key), message)
    if deferring is not None and form.deferred is None and not form.lost("deferred"):
        message = f"{name} defers events, but has no `deferred`"
        notes = [(deferring.origin, f"{deferring.name} defers `{deferring.defers[0]}`")]
        hint = "give the number of deferred events that may wait, such as `deferred: 4`"
        findings.error("RV-0526", form.origin, message, notes=notes, hint=hint)
    if deferring is None and form.deferred is not None and not form.damaged:
        message = f"`deferred` has no meaning for {name}: no state of it has `defer`"
        findings.error("RV-0210", form.at_key("deferred"), message, hint="remove it")
