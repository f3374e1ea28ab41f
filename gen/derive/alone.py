# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An instance by itself: the system in which a component is tested as a unit.

Nothing is connected: values come to its ports from outside, or not at all. An activity whose body
is the user's has a stub. For each data item that the activity writes there is an input port
``<item>_given``, whose values are written. The events that it raises come from outside. So the
stub does all that the declaration allows, and nothing else. Values that a required command reads
or replies come through such ports as well.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ravenchart.gen.language.terms import (
    BOOLEAN,
    Action,
    Expression,
    If,
    Name,
    Named,
    Operation,
    PortTest,
    Raise,
    Reading,
    RecordType,
    Set,
    Type,
    all_joined,
    leaves,
    named,
)
from ravenchart.gen.model.component import PORTS, Activity, Component, Direction, Port
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.statechart import DONE
from ravenchart.gen.model.system import Processor, Shutdown, Slot, System, Work
from ravenchart.gen.origins import Origin

from .completion import completed, on_one_core
from .distribution import as_one

REPLIES = ""
"""No activity's name."""


def hindrance(component: Component) -> str | None:
    """The reason why its instances cannot stand alone; None where they can."""
    for one in component.provides:
        if one.server is None:
            continue
        server = named(component.activities, one.server)
        if server.forwards:
            return f"{one.server} forwards the requests of {one.name}"
        if server.flow is None:
            return f"the user's {one.server} serves its interface {one.name}"
    return None


def alone(system: System, name: str) -> System:
    """The part of a valid system that is the instance ``name``, with stubs.

    KeyError where there is no such instance; `hindrance` must be None for its component.
    """
    system = on_one_core(as_one(system))
    instance = system.instance(name)
    component = _with_stubs(instance.component)
    processors = tuple(_only(processor, instance.name) for processor in system.processors)
    processors = tuple(processor for processor in processors if processor.slots)
    processors = _with_rows(processors, instance, component)
    made = replace(
        system,
        components=(component,),
        instances=(replace(instance, component=component, delegations=()),),
        processors=processors,
        buses=(),
        connections=(),
        messages=(),
        traffic=(),
        chains=(),
        devices=(),
        bindings=(),
        polls=(),
        shutdown=Shutdown((), system.shutdown.grace),
        safe_regions=tuple(r for r in system.safe_regions if r.component == component.name),
        recorded=tuple(one for one in system.recorded if one.instance == instance.name),
    )
    return completed(made)


def given_by(component: Component) -> dict[str, str]:
    """The input port by which each data item comes that a stub writes."""
    ports = [pair for some in _given(component).values() for pair in some.items()]
    return {item: port.name for item, port in ports if item != DONE}


def unit_instances(system: System) -> Iterator[Instance]:
    """The instances that can stand alone, one for each component and its parameters' values."""
    seen: set[object] = set()
    for instance in system.instances:
        key = instance.component.name, instance.parameters
        if key not in seen and hindrance(instance.component) is None:
            seen.add(key)
            yield instance


def _only(processor: Processor, instance: str) -> Processor:
    """With the rows of one instance, released by its own port or by time."""
    port = processor.released_by_port
    kept = port is not None and port.instance == instance
    return replace(
        processor,
        core=1,
        slots=tuple(s for s in processor.slots if s.owner == instance and not s.of_bus),
        released_by=processor.released_by if kept else None,
        on_deadline_miss=(),
        on_overrun=(),
        on_silence=(),
    )


def _with_rows(
    processors: Sequence[Processor], instance: Instance, component: Component
) -> tuple[Processor, ...]:
    """With rows, in front of all others, for the parts that only the lone component has."""
    first = min(processors, key=lambda one: (one.released_by is not None, one.period))
    rows: list[Slot] = []
    if instance.component.port_region is None and component.port_region is not None:
        timing = component.port_region
        rows.append(Slot(first.origin, instance.name, Work.PORT_REGION, PORTS, timing, 1, 0))
    for one in component.activities[len(instance.component.activities) :]:
        rows.append(Slot(first.origin, instance.name, Work.ACTIVITY, one.name, one.timing, 1, 0))
    more = replace(first, slots=(*rows, *first.slots))
    return tuple(more if one is first else one for one in processors)


def _with_stubs(component: Component) -> Component:
    """The component with stubs, and without the parts that only others can serve."""
    given = _given(component)
    ports = [replace(port, is_command=False, is_void=False) for port in component.ports]
    ports += [port for some in given.values() for port in some.values()]
    activities = [
        one if one.flow is not None else _stub(one, given[one.name]) for one in component.activities
    ]
    rows = component.runnables()
    shortest = min((row.timing for row in rows), key=lambda one: one.period, default=None)
    if given[REPLIES] and shortest is not None:
        name = _free("replies", {row.name.lower() for row in rows})
        items = tuple(given[REPLIES])
        own = Activity(name, component.origin, shortest, (), items, (), (), None, None)
        activities.append(_stub(own, given[REPLIES]))
    region = component.port_region
    if region is None and any(port.direction is Direction.IN for port in ports):
        region = shortest
    return replace(
        component,
        ports=tuple(ports),
        activities=tuple(activities),
        port_region=region,
        needs=(),
        hears=(),
        data=tuple(replace(one, is_command=False) for one in component.data),
    )


def _given(component: Component) -> dict[str, dict[str, Port]]:
    """New ports of each activity of the user's, by the data item, or `DONE`, that they are for.

    Those for what required commands read and reply are under `REPLIES`.
    """
    named_parts: tuple[Named, ...] = (*component.ports, *component.data, *component.events)
    named_parts = (*named_parts, *component.parameters, *component.runnables())
    taken = {one.name.lower() for one in named_parts}
    found: dict[str, dict[str, Port]] = {REPLIES: {}}
    for data in component.data:
        if data.is_command:
            port = _port(_free(f"{data.name}_given", taken), data.origin, data.type)
            found[REPLIES][data.name] = port
    for activity in component.activities:
        ports = found.setdefault(activity.name, {})
        if activity.flow is None:
            for item in activity.writes:
                of_type = named(component.data, item).type
                ports[item] = _port(_free(f"{item}_given", taken), activity.origin, of_type)
            if activity.completes is not None:
                name = _free(f"{activity.name}_done", taken)
                ports[DONE] = _port(name, activity.origin, BOOLEAN)
    return found


def _free(stem: str, taken: set[str]) -> str:
    """A name that nothing else has."""
    name, number = stem, 1
    while name.lower() in taken:
        number += 1
        name = f"{stem}_{number}"
    taken.add(name.lower())
    return name


def _port(name: str, origin: Origin, of_type: Type) -> Port:
    return Port(name, origin, Direction.IN, of_type)


def _stub(activity: Activity, given: dict[str, Port]) -> Activity:
    """The activity with a body that writes what was given, where its ``ensures`` allow that."""
    flow: list[Action] = []
    items = {item: port for item, port in given.items() if item != DONE}
    allowed = [_of_given(c.condition, items) for c in activity.ensures if _is_known(c.condition)]
    for item, port in items.items():
        sets = tuple(_sets(activity.origin, item, port))
        asked = all_joined("and", [PortTest(port.name, "fresh"), *allowed])
        flow.append(If(activity.origin, asked, sets, ()))
    if DONE in given:
        port = given[DONE]
        asked = all_joined(
            "and", [PortTest(port.name, "fresh"), Name(Reading.PORT, port.name, None, BOOLEAN)]
        )
        flow.append(If(activity.origin, asked, (Raise(activity.origin, DONE),), ()))
    old = {leaf.name for c in allowed for leaf in leaves(c) if isinstance(leaf, Name)}
    reads = (*activity.reads, *(name for name in items if name in old))
    return replace(
        activity,
        reads=(*dict.fromkeys(reads), *(port.name for port in given.values())),
        sends=(),
        may_send=(),
        raises=(DONE,) if DONE in given else (),
        flow=tuple(flow),
        requires=(),
        ensures=(),
    )


def _sets(origin: Origin, item: str, port: Port) -> Iterator[Set]:
    """The whole value, a record field by field."""
    if isinstance(port.type, RecordType):
        for one in port.type.fields:
            value = Name(Reading.PORT, port.name, one.name, port.type)
            yield Set(origin, item, one.name, value)
    else:
        yield Set(origin, item, None, Name(Reading.PORT, port.name, None, port.type))


def _is_known(condition: Expression) -> bool:
    """Whether a clause speaks of data alone, and not of what is sent."""
    told = (Reading.OUTPUT, Reading.SENT)
    return not any(isinstance(one, Name) and one.kind in told for one in leaves(condition))


def _of_given(condition: Expression, given: dict[str, Port]) -> Expression:
    """The clause over the values before the execution and those that were given."""
    match condition:
        case Operation(operands=operands):
            inner = tuple(_of_given(one, given) for one in operands)
            return replace(condition, operands=inner)
        case Name(kind=Reading.DATA, name=name) if name in given:
            return replace(condition, kind=Reading.PORT, name=given[name].name)
        case Name(kind=Reading.OLD):
            return replace(condition, kind=Reading.DATA)
    return condition
