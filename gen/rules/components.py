# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Validity rules of one component: writers, sends, events, and what is unused."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator

from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.language.terms import Flow, Set
from ravenchart.gen.model.chart.steps import tally
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.origins import Origin
from ravenchart.gen.resolve.flows import Use, actions_of
from ravenchart.gen.resolve.system import Resolved

from .charts import (
    completions_can_come,
    deferred_events_are_taken,
    firings_agree,
    safe_states_are_reachable,
    states_are_reachable,
    steps_stay_within_bounds,
    transitions_can_fire,
    twice,
)

ComponentRule = Callable[[Component, Resolved], Iterator[Diagnostic]]


# --- Writers -----------------------------------------------------------------------


def data_have_one_writer(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """Each data item is written by one region or activity at most."""
    writers: defaultdict[str, list[tuple[str, Origin]]] = defaultdict(list)
    for item in component.runnables():
        for name in item.writes:
            writers[name].append((item.name, _writes_at(item, name)))
    for data in component.data:
        found = writers[data.name]
        if len(found) > 1:
            names = [writer for writer, _ in found]
            listed = f"{', '.join(names[:-1])} and {names[-1]}"
            count = {2: "two", 3: "three"}.get(len(found), str(len(found)))
            message = f"{component.name}.{data.name} has {count} writers: {listed}"
            notes = [(origin, f"{writer} writes it here") for writer, origin in found]
            hint = "let one write it, and the other send or raise what it wants to the first"
            yield error("RV-0412", data.origin, message, notes=notes, hint=hint)


def _writes_at(item: Region | Activity, data: str) -> Origin:
    """Where a region or activity writes a data item: its first action, or itself."""
    for flow in _flows(item):
        for action in actions_of(flow):
            if isinstance(action, Set) and action.data == data:
                return action.origin
    return item.origin


def _flows(item: Region | Activity) -> list[Flow]:
    """Every flow of a region or activity."""
    if isinstance(item, Region):
        states = [flow for state in item.states for flow in (state.entry, state.exit)]
        initials = [item.initial, *(n.initial for state in item.states for n in state.regions)]
        effects = [initial.effect for initial in initials]
        return [*states, *effects, *(transition.effect for transition in item.transitions)]
    return [] if item.flow is None else [item.flow]


# --- Sends -------------------------------------------------------------------------


def activities_send_once(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """No execution of an activity can send twice on one port."""
    reported: set[tuple[Origin, Origin]] = set()
    for activity in component.activities:
        if activity.flow is not None:
            yield from twice(f"one execution of {activity.name}", tally(activity.flow), reported)


# --- Events ------------------------------------------------------------------------


def events_are_raised_and_used(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning for each event that nothing raises or no region waits for."""
    system = resolved.system
    instances = system.instances_of(component.name)
    whole = {"instances", "processors"} <= resolved.sound_sections
    if component.name in resolved.damaged or not whole or not instances:
        return
    raised = {e for item in component.runnables() for e in item.raises}
    raised |= {e for p in component.ports for e in (p.on_arrival, p.on_stale, p.on_overflow) if e}
    raised |= {
        e for need in component.needs for e in (need.on_reply, need.on_full, need.on_timeout) if e
    }
    raised |= {region.on_overflow for region in component.regions if region.on_overflow}
    raised |= {e for owner, e in system.raised_outside if owner in instances}
    used = {event for region in component.regions for event in region.events()}
    used |= {e for bus in system.buses for owner, e in bus.recovers_on if owner in instances}
    for event in component.events:
        is_raised, is_used = event.name in raised, event.name in used
        if is_raised and not is_used:
            message = f"no region of {component.name} handles {event.name}: each is lost"
            yield warning("RV-0510", event.origin, message)
        elif not is_raised:
            message = f"nothing raises {event.name}"
            if not is_used:
                message += f", and no region of {component.name} waits for it"
            yield warning("RV-0509", event.origin, message)


# --- Parameters and data -----------------------------------------------------------


def parameters_and_data_are_used(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning for each parameter that nothing reads, and data that nothing reads or writes."""
    if component.name in resolved.damaged:
        return
    conditions = Use()
    for invariant in component.invariants:
        conditions.expression(invariant.condition)
    used = {name for item in component.runnables() for name in (*item.reads, *item.writes)}
    used |= set(conditions.reads)
    used |= {one.item for interface in component.provides for one in interface.published}
    used |= {need.fallback.item for need in component.needs if need.fallback is not None}
    hint = "remove it, or name it in a condition, a body or `reads`"
    for parameter in component.parameters:
        if parameter.name not in used:
            message = f"nothing reads the parameter {parameter.name} of {component.name}"
            yield warning("RV-0534", parameter.origin, message, hint=hint)
    for data in component.data:
        if data.name not in used and not data.is_command:
            message = f"nothing reads or writes the data item {data.name} of {component.name}"
            yield warning("RV-0534", data.origin, message, hint=hint)


COMPONENT_RULES: tuple[ComponentRule, ...] = (
    data_have_one_writer,
    steps_stay_within_bounds,
    activities_send_once,
    completions_can_come,
    states_are_reachable,
    safe_states_are_reachable,
    transitions_can_fire,
    firings_agree,
    deferred_events_are_taken,
    events_are_raised_and_used,
    parameters_and_data_are_used,
)
