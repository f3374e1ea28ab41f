# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The packages that all instances of a component share: events, states, port views, activities."""

from __future__ import annotations

from functools import partial

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    GenericInstance,
    Package,
    Param,
    Subprogram,
    SubtypeDeclaration,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import FALSE, NOTHING, TRUE, Expr, arguments, number
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    component_name,
    component_package,
    default_value,
    type_name,
)
from ravenchart.gen.emit.ada.statements import Assign, Comment, Stmt
from ravenchart.gen.emit.commands.device_calls import request_types, serving_params
from ravenchart.gen.emit.language.configurations import Configurations
from ravenchart.gen.emit.language.events import event_types, null_event
from ravenchart.gen.emit.language.terms import (
    Scope,
    compared_states,
    effective,
    emit_flow,
    expressions_in,
    flow_operators,
    reads_first,
)
from ravenchart.gen.language.terms import RecordType, Type, always, named
from ravenchart.gen.model.component import Activity, Component, Data, Direction, Port
from ravenchart.gen.model.statechart import RAISED_PER_STEP, Region
from ravenchart.gen.model.system import System

from .contracts import contract, kept_types, needed_before, used_types


def published_type(component: Component, region: Region) -> DottedName:
    """The type of a region's published state, seen from a sibling package."""
    return ref(component_name(component), Configurations(region).configuration_type)


def view_type(component: Component, port: str) -> DottedName:
    """The type of an input port's view."""
    return ref(component_name(component), f"{ada_case(port)}_View")


def reading_type(system: System, component: Component, name: str) -> DottedName:
    """The type in which a region or activity sees what it reads."""
    return _readings(system, component)[name.lower()]


def _readings(system: System, component: Component) -> dict[str, DottedName]:
    types: dict[str, DottedName] = {}
    for port in component.inputs():
        types[port.name.lower()] = view_type(component, port.name)
    for region in component.regions:
        types[region.name.lower()] = published_type(component, region)
    items: list[tuple[str, Type]] = [(d.name, d.type) for d in component.data]
    items += [(p.name, p.type) for p in component.parameters]
    for name, of_type in items:
        types[name.lower()] = type_name(system, of_type)
    return types


def emit_component(system: System, component: Component, header: str) -> Unit:
    """The package of a component type: pure, no state."""
    items: list[Decl] = []
    if component.events:
        items += event_types(system, component)
        items.append(
            GenericInstance(
                "Event_Lists",
                "Ravenchart.Event_Lists",
                arguments(
                    Event=ref(component_name(component), "Event"),
                    Null_Event=null_event(component),
                    Capacity=number(RAISED_PER_STEP),
                ),
            )
        )
    items += request_types(system, component)
    for region in component.regions:
        items.append(Comment(f"[{component.name}.{region.name}.states]"))
        items.append(Configurations(region).package_of_states(system.origin))
    for port in component.inputs():
        name = ada_case(port.name)
        items.append(Comment(f"[{component.name}.{port.name}] the view that its readers have"))
        items.append(
            GenericInstance(
                f"{name}_Port",
                "Ravenchart.Port_Regions",
                arguments(
                    Value_Type=type_name(system, port.type),
                    Default=default_value(system, port.type),
                ),
                behind_package=True,
            )
        )
        view = ref(f"{name}_Port", "Port")
        items.append(SubtypeDeclaration(f"{name}_View", view, behind_package=True))
    items += kept_types(system, component)
    withs = [ref("Ravenchart.Event_Lists")] if component.events else []
    withs += [ref("Ravenchart.Port_Regions")] if component.inputs() else []
    package = component_package(system, component)
    return Unit(header, tuple(withs), Package(package, tuple(items), (SPARK,)))


# --- Activities --------------------------------------------------------------


def raise_flag(event: str) -> str:
    """The parameter by which an activity raises an event."""
    return f"Raise_{ada_case(event)}"


def raise_value(event: str) -> str:
    """The parameter by which an activity gives the value of an event."""
    return f"{ada_case(event)}_Value"


def raised_type(component: Component, event: str) -> Type | None:
    """The type of the value that an event carries; None for `DONE` and events without."""
    return next((e.type for e in component.events if e.name == event), None)


def _raised(event: str, given: Expr | None) -> tuple[Stmt, ...]:
    value = () if given is None else (Assign(raise_value(event), given),)
    return (Assign(raise_flag(event), TRUE), *value)


def send_flag(port: Port) -> str:
    """The parameter by which an activity says that it sends, or calls."""
    return f"{'Call' if port.is_command else 'Send'}_{ada_case(port.name)}"


def _sent_flag(component: Component, activity: Activity, port: str) -> str | None:
    """The parameter that tells whether an execution sends on a port; None: each does."""
    found = component.port(port)
    return send_flag(found) if has_flag(activity, found) else None


def has_flag(activity: Activity, port: Port) -> bool:
    """Whether an execution may go without sending on a port."""
    return activity.flow is not None or port.is_command or port.name in activity.may_send


def activity_params(system: System, component: Component, activity: Activity) -> tuple[Param, ...]:
    """The profile of an activity: the items that it reads and writes, the events that it raises."""
    params = list(serving_params(system, component, activity.name))
    params += [
        Param(ada_case(name), "in", reading_type(system, component, name))
        for name in activity.reads
        if name not in activity.writes
    ]
    params += [
        Param(
            ada_case(name),
            _write_mode(activity, named(component.data, name)),
            reading_type(system, component, name),
        )
        for name in activity.writes
    ]
    for port in component.ports:
        if port.direction is Direction.OUT and port.name in activity.sends:
            if not port.is_void:
                params.append(Param(ada_case(port.name), "out", type_name(system, port.type)))
            if has_flag(activity, port):
                params.append(Param(send_flag(port), "out", "Boolean"))
    for event in activity.raises:
        params.append(Param(raise_flag(event), "out", "Boolean"))
        if (carried := raised_type(component, event)) is not None:
            params.append(Param(raise_value(event), "out", type_name(system, carried)))
    return tuple(params)


def fallbacks(component: Component) -> set[str]:
    """The activities that are the fallback of a command, where nothing provides it."""
    return {need.fallback.activity for need in component.needs if need.fallback is not None}


FLOWS = "Flows"
"""The package of the activities that the model gives as flows."""
ACTIVITIES = "Activities"
"""That of those that the user writes."""


def activity_package(component: Component, activity: Activity) -> str:
    """The child of the component's package that holds an activity.

    A fallback by the user has a package of its own: its body is left out where it is idle.
    """
    if activity.flow is not None:
        return FLOWS
    if activity.name in fallbacks(component):
        return f"{ada_case(activity.name)}_Fallback"
    return ACTIVITIES


def emit_activities(system: System, component: Component, header: str) -> tuple[Unit, ...]:
    """The spec of the user's activities; spec and body of those given as flows."""
    package = component_package(system, component)
    users = tuple(a for a in component.activities if a.by_user)
    flows = tuple(a for a in component.activities if a.flow is not None)
    units: list[Unit] = []
    for home in dict.fromkeys(activity_package(component, a) for a in users):
        inside = tuple(a for a in users if activity_package(component, a) == home)
        items = _specs(system, component, inside)
        apart = home == ACTIVITIES
        spec = Package(ref(package, home), items, (SPARK,), independent=apart)
        units.append(Unit(header, (), spec))
    if flows:
        items = _specs(system, component, flows)
        name = ref(package, FLOWS)
        units.append(Unit(header, (), Package(name, items, (SPARK,), independent=True)))
        operators = {name for a in flows for name in flow_operators(a.flow or ())}
        operators |= compared_states(
            component, [e for a in flows for e in expressions_in(a.flow or ())]
        )
        operators -= {*used_types(component, flows)}  # the spec uses these
        bodies: tuple[Decl, ...] = (
            *(UseType(name) for name in sorted(operators)),
            *(_flow_body(system, component, a) for a in flows),
        )
        body = Package(name, bodies, (SPARK,), is_body=True, independent=True)
        units.append(Unit(header, (), body))
    return tuple(units)


def _write_mode(activity: Activity, data: Data) -> str:
    """``in out`` for what is read first, or not always set; ``out`` otherwise."""
    if activity.flow is None:
        return "in out" if data.name in activity.reads else "out"
    if data.name in needed_before(activity):
        return "in out"
    parts = {data.name}
    if isinstance(data.type, RecordType):
        parts = {f"{data.name}.{field.name}" for field in data.type.fields}
    sure = parts <= always(activity.flow) and not reads_first(activity.flow, data.name)
    return "out" if sure else "in out"


def _specs(
    system: System, component: Component, activities: tuple[Activity, ...]
) -> tuple[Decl, ...]:
    items: list[Decl] = [UseType(name) for name in used_types(component, activities)]
    for activity in activities:
        params = activity_params(system, component, activity)
        aspects = (
            Aspect("Global", NOTHING),
            *contract(system, component, activity, partial(_sent_flag, component, activity)),
        )
        items.append(Subprogram(ada_case(activity.name), params, aspects=aspects))
        timing = activity.timing
        items.append(
            Comment(
                f"[{component.name}.{activity.name}] WCET {timing.wcet:_} ns, "
                f"every {timing.period:_} ns"
                + (f", while in {activity.while_in.state}" if activity.while_in else "")
            )
        )
    return tuple(items)


def _flow_body(system: System, component: Component, activity: Activity) -> Subprogram:
    assert activity.flow is not None
    scope = Scope(
        system,
        component,
        variable=ada_case,
        target=ada_case,
        sent=lambda port: (ada_case(port), send_flag(component.port(port))),
        raised=_raised,
    )
    sure = always(activity.flow)  # needs no value before
    start: list[Stmt] = []
    for port in component.outputs():
        if port.name in activity.sends and port.name not in sure:
            if not port.is_void:
                start.append(Assign(ada_case(port.name), default_value(system, port.type)))
            start.append(Assign(send_flag(port), FALSE))
    for event in activity.raises:
        if event not in sure:
            start.append(Assign(raise_flag(event), FALSE))
            if (carried := raised_type(component, event)) is not None:
                start.append(Assign(raise_value(event), default_value(system, carried)))
    return Subprogram(
        ada_case(activity.name),
        activity_params(system, component, activity),
        body=(*start, *emit_flow(scope, effective(activity.flow))),
    )
