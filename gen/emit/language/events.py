# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Events in Ada: an enumeration, or a record with the value that some of them carry."""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import (
    Decl,
    EnumType,
    Object,
    RecordComponent,
    RecordDeclaration,
)
from ravenchart.gen.emit.ada.expressions import BOX, OTHERS, Aggregate, Arg, Expr, all_else
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, component_name, default_value, type_name
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.language.terms import Type, named
from ravenchart.gen.model.component import Component, Event
from ravenchart.gen.model.system import System

from .own_names import event_literal


def carries(component: Component) -> bool:
    """Does any event of the component carry a value?"""
    return any(e.type is not None for e in component.events)


def field_of(of_type: Type) -> str:
    """The component of an event that holds values of a type."""
    return f"Value_{ada_case(of_type.name)}"


def event_types(system: System, component: Component) -> list[Decl]:
    """The type `Event`; where events carry values, `Event_Name` too."""
    names = tuple(event_literal(e.name) for e in component.events)
    title = Comment(f"[{component.name}.events]")
    if not carries(component):
        return [title, EnumType("Event", names)]
    types = {e.type.name: e.type for e in component.events if e.type is not None}
    fields = [RecordComponent("Name", "Event_Name", ref(names[0]))]
    fields += [
        RecordComponent(field_of(t), type_name(system, t), default_value(system, t))
        for t in types.values()
    ]
    return [
        title,
        EnumType("Event_Name", names),
        Comment("An event with its value; components that it does not use keep their default."),
        RecordDeclaration("Event", tuple(fields)),
        Object("No_Event", "Event", all_else(BOX), constant=True),
    ]


def null_event(component: Component) -> Expr:
    """The value that means no event."""
    name = "No_Event" if carries(component) else event_literal(component.events[0].name)
    return ref(component_name(component), name)


def event_value(
    component: Component, name: str, value: Expr | None = None, root: str | None = None
) -> Expr:
    """An event, with the value that it carries; ``root`` where the unit does not see into it."""
    event: Event = named(component.events, name)
    package = ref(component_name(component))
    if root is not None:
        package = ref(root, package)
    literal = ref(package, event_literal(event.name))
    if not carries(component):
        return literal
    rows = [Arg("Name", literal)]
    if event.type is not None and value is not None:
        rows.append(Arg(field_of(event.type), value))
    types = {e.type.name for e in component.events if e.type is not None}
    rest = () if len(rows) > len(types) else (Arg(OTHERS, BOX),)
    return Aggregate((*rows, *rest), ref(package, "Event"))


def name_type(component: Component) -> str:
    """The enumeration of the events, as the component's package names it."""
    return "Event_Name" if carries(component) else "Event"


def name_of(component: Component, event: str) -> DottedName:
    """The enumeration value of an event held in ``event``."""
    return ref(event, "Name") if carries(component) else ref(event)
