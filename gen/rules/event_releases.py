# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for processors that the events of a region release: the region, and their tables.

An event in the queue of the region releases the processor, and nothing else does. So the region
counts no time, reads no condition while nothing waits, and defers nothing.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.instances import Events, Instance
from ravenchart.gen.model.raising import starts_with, taking_region
from ravenchart.gen.model.statechart import After, Every, Region, When
from ravenchart.gen.model.system import Processor, System, Work
from ravenchart.gen.resolve.releasers import UNFIT_PORT
from ravenchart.gen.resolve.system import Resolved

from .released_tables import TABLE, Problem, other_period, waiting_rows


def events_can_release(resolved: Resolved) -> Iterator[Diagnostic]:
    """The region waits for events alone, and its table has it and activities of its instance."""
    system = resolved.system
    for processor in system.processors:
        taken = processor.released_by
        if not isinstance(taken, Events):
            continue
        instance = system.instance(taken.instance)
        component = instance.component
        if {component.name, f"{component.name}.{taken.name}"} & resolved.damaged:
            continue
        region = taking_region(system, taken)
        problems = [*_of_region(instance, region, str(taken))]
        if {"processors", "instances", "messages"} <= resolved.sound_sections:
            cannot = f"{taken} cannot release a processor"
            problems += waiting_rows(system, processor, instance, cannot)
        at = processor.released_at or processor.origin
        for message, declared, words, hint in problems:
            yield error(UNFIT_PORT, at, message, notes=[(declared, words)], hint=hint)
        if "processors" in resolved.sound_sections:
            yield from _table(system, processor, taken)


def _of_region(instance: Instance, region: Region, taken: str) -> Iterator[Problem]:
    """Parts of the region that wait for something else than events."""
    cannot = f"{taken} cannot release a processor"
    here = f"{region.name} is declared here"
    if not region.events():
        message = f"{cannot}: no transition of {region.name} has an event as its trigger"
        yield message, region.origin, here, "let a periodic processor run it"
        return
    for transition in region.transitions:
        trigger = transition.trigger
        declared = f"{transition.name} is declared here"
        if isinstance(trigger, After | Every):
            key = "after" if isinstance(trigger, After) else "every"
            message = f"{cannot}: {transition.name} has `{key}`, which counts executions as time"
            hint = "let a periodic region raise an event when the time is over"
            yield message, transition.origin, declared, hint
        if isinstance(trigger, When):
            message = f"{cannot}: {transition.name} has `when`, and nothing reads the condition "
            message += "while no event comes"
            hint = "let a periodic row raise an event when the condition holds"
            yield message, transition.origin, declared, hint
    for state in region.states:
        for event in state.defers[:1]:
            message = f"{cannot}: {state.name} defers {event}, and an event that is due later "
            message += "releases nothing"
            hint = "remove `defer`, or let a periodic processor run the region"
            yield message, state.origin, f"{state.name} is declared here", hint
    for activity, state_name in instance.component.completing(region.name):
        message = f"{cannot}: {activity.name} completes its state {state_name}, which is no event"
        hint = "let the activity raise an event instead of `done`"
        yield message, activity.origin, f"{activity.name} is declared here", hint
    for command in starts_with(instance.component, region)[:1]:
        message = f"{cannot}: its start calls `{command}`, before devices have been started"
        yield message, region.origin, here, "call it in a transition"


def _table(system: System, processor: Processor, taken: Events) -> Iterator[Diagnostic]:
    """The region first, then activities of the instance, in each release."""
    component = system.instance(taken.instance).component
    periodic = {one.name for one in component.activities if one.while_in is not None}
    if not processor.slots or processor.slots[0].element != str(taken):
        message = f"{processor.name} is released by {taken}, but does not begin with it"
        hint = f"begin its table with `{taken}`"
        yield error(TABLE, processor.origin, message, hint=hint)
    for slot in processor.slots:
        follows = slot.work is Work.ACTIVITY and slot.name not in periodic
        if slot.owner != taken.instance or not (follows or slot.element == str(taken)):
            message = f"{processor.name} is released by {taken}, but holds {slot.element}"
            yield error(TABLE, slot.origin, message, hint="move it to a periodic processor")
        else:
            yield from other_period(processor, slot)
