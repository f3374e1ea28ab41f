# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Who raises the events that release a processor, and how many at once."""

from __future__ import annotations

from collections.abc import Iterator

from .chart.steps import RAISED, Steps
from .chart.tree import Tree
from .component import Component, Port
from .instances import End, Events
from .statechart import Completion, Region
from .system import Stop, System


def taking_region(system: System, taken: Events) -> Region:
    """The region whose events these are."""
    return system.instance(taken.instance).component.region(taken.name)


def released_at(system: System, place: Stop | None) -> Events | None:
    """The events of the region at a place, where they release its processor; else None."""
    if not isinstance(place, End):
        return None
    taken = Events(place.instance, place.name)
    return None if system.called(taken) is None else taken


def raises_for(system: System, place: Stop, following: Stop | None) -> bool:
    """Whether a row or port raises events that release the region at the next place."""
    taken = released_at(system, following)
    if taken is None or not isinstance(place, End) or place.instance != taken.instance:
        return False
    events = set(taking_region(system, taken).events())
    component = system.instance(place.instance).component
    rows = (row for row in component.runnables() if row.name == place.name)
    ports = (port for port in component.inputs() if port.name == place.name)
    return any(events & set(row.raises) for row in rows) or any(
        _of_port(port, events) for port in ports
    )


def raised_at_once(system: System, taken: Events) -> dict[str, int]:
    """For each row that raises such events, how many one execution of it raises at most."""
    component = system.instance(taken.instance).component
    events = set(taking_region(system, taken).events())
    found = {one.name: len(events & set(one.raises)) for one in component.activities}
    for region in component.regions:
        if events & set(region.raises):
            steps = Steps(Tree(region))
            tallies = [tally for _, tally in (*steps.single(), *steps.shared())]
            most = max((len(tally.get(RAISED, ())) for tally in tallies), default=0)
            found[region.name] = most * region.steps_per_execution
    for handler in component.handlers():
        found[handler] = sum(_of_port(port, events) for port in component.handled(handler))
    return {f"{taken.instance}.{row}": count for row, count in found.items() if count}


def _of_port(port: Port, events: set[str]) -> int:
    """How many of the events one execution of its handler raises for a port."""
    return len(events & {port.on_overflow}) + bool(events & {port.on_arrival, port.on_stale})


def more_events(system: System, taken: Events, row: str) -> str:
    """Why more events may wait in a queue than one row raises for it; "" where none do."""
    own = taking_region(system, taken)
    others = [one for one in raised_at_once(system, taken) if one != row]
    others += _from_outside(system, taken, own)
    if others:
        return f"{others[0]} raises events for {taken} as well"
    if any(isinstance(one.trigger, Completion) for one in own.transitions):
        return f"{taken} takes completions as well as events"
    if system.processor_of(row).released_by is not None:
        return f"{row} raises events for {taken}, and is on a sporadic processor"
    return ""


def _from_outside(system: System, taken: Events, own: Region) -> Iterator[str]:
    """Sources of the events of a region that are no rows of its instance, in words."""
    component, events = system.instance(taken.instance).component, set(own.events())
    for region in component.regions:
        if region.on_overflow in events:
            yield f"a full queue of {taken.instance}.{region.name}"
    for need in component.needs:
        if events & {need.on_reply, need.on_full, need.on_timeout}:
            yield f"a call of {need.name}"
    if any(who == taken.instance and event in events for who, event in system.raised_outside):
        yield "a fault, a bus or the shutdown"
    if any(event.external for event in component.events if event.name in events):
        yield "the environment"


def starts_with(component: Component, region: Region) -> tuple[str, ...]:
    """The commands that the start of a region calls, in the order of its entries."""
    tally = Steps(Tree(region)).start()
    commands = {port.name for port in component.ports if port.is_command}
    return tuple(name for name in tally if name in commands)
