# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""First bodies of the user's activities: they compile, are proved and do nothing yet."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import SPARK, Package, Subprogram, Unit
from ravenchart.gen.emit.ada.expressions import FALSE, Expr
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case, component_package, default_value
from ravenchart.gen.emit.ada.statements import Assign, Pragma, Stmt
from ravenchart.gen.emit.commands.device_calls import reply_param
from ravenchart.gen.language.terms import Type, named
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.system import System

from .packages import activity_package, activity_params, raise_value, raised_type


def first_bodies(system: System, component: Component, header: str) -> Iterator[Unit]:
    """A body for each package of activities that the user writes."""
    users = tuple(a for a in component.activities if a.by_user)
    package = component_package(system, component)
    for home in dict.fromkeys(activity_package(component, a) for a in users):
        inside = tuple(a for a in users if activity_package(component, a) == home)
        bodies = tuple(_body(system, component, activity) for activity in inside)
        yield Unit(header, (), Package(ref(package, home), bodies, (SPARK,), is_body=True))


def _body(system: System, component: Component, activity: Activity) -> Subprogram:
    """Written items keep their values or get their first ones, and no event is raised."""
    params = activity_params(system, component, activity)
    starts = _starts(system, component, activity)
    idle = tuple(ref(p.name) for p in params if p.mode != "out")
    steps: tuple[Stmt, ...] = tuple(
        Assign(p.name, starts.get(p.name, FALSE)) for p in params if p.mode == "out"
    )
    return Subprogram(
        ada_case(activity.name),
        params,
        declarations=(Pragma("Unreferenced", idle),) if idle else (),
        body=steps,
    )


def _starts(system: System, component: Component, activity: Activity) -> dict[str, Expr]:
    """The first value of each parameter that is not a flag."""
    types: dict[str, Type] = {ada_case(p.name): p.type for p in component.ports if not p.is_void}
    for event in activity.raises:
        if (carried := raised_type(component, event)) is not None:
            types[raise_value(event)] = carried
    served = component.served_by(activity.name)
    for one in served.requests if served is not None else ():
        if one.reply is not None:
            types[reply_param(one.name)] = one.reply
    starts = {name: default_value(system, of_type) for name, of_type in types.items()}
    for name in activity.writes:
        data = named(component.data, name)
        starts[ada_case(name)] = default_value(system, data.type)
    return starts
