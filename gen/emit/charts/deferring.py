"""Deferral: which of the events that are kept come next.

A kept event is due when no active state defers it, and also from the exit of a state that
defers it: PSSM 8.5.5 gives it back to the pool then, though the state may be entered again.
`Ravenchart.Deferrals` keeps the events; the chart declares which states defer which.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import component_name
from ravenchart.gen.emit.ada.syntax import (
    FALSE,
    CaseExpr,
    Comment,
    Decl,
    Expr,
    GenericInstance,
    Old,
    Param,
    Ref,
    Stmt,
    Subprogram,
    arguments,
    both,
    call,
    chain,
    do,
    number,
    one_of,
)
from ravenchart.gen.emit.language.compound import FiringKind
from ravenchart.gen.emit.language.events import carries, name_of, null_event
from ravenchart.gen.emit.language.places import flat

from .shape import ITEM, RegionShape

KEPT = "Self.Deferred"
STORE = "Deferrals.Store"
_NAME_OF, _IS_DEFERRED, _IS_FREED = "Name_Of", "Is_Deferred", "Is_Freed"


def kept_events(shape: RegionShape) -> list[str]:
    """The events that a state defers, in model order."""
    return [e for e in shape.region.events() if any(e in s.defers for s in shape.region.states)]


def deferral_types(shape: RegionShape, spans: dict[str, Expr]) -> list[Decl]:
    """What is deferred and what is freed, and the package that keeps it.

    ``spans`` holds for each state the test whether a domain spans it.
    """
    names = "Event_Name" if carries(shape.component) else "Event"
    deferred: list[tuple[str, Expr]] = []
    freed: list[tuple[str, Expr]] = []
    for event in kept_events(shape):
        states = [s.name for s in shape.region.states if event in s.defers]
        inside = [shape.in_state(shape.place, s) for s in states]
        left = [both(*flat([spans[s], shape.in_state(shape.place, s)])) for s in states]
        deferred.append((shape.event(event), chain("or else", inside)))
        freed.append((shape.event(event), chain("or else", left)))
    if len(deferred) < len(shape.component.events):
        deferred.append(("others", FALSE))
        freed.append(("others", FALSE))
    name, place = Param("Name", "in", names), Param(shape.place, "in", shape.place_type)
    domain = Param("D", "in", "Domain")
    deferrals = [f.literal for f in shape.firings if f.kind is FiringKind.DEFERRAL]
    chosen = Param("T", "in", "Selection")
    return [
        Subprogram(_NAME_OF, (ITEM,), names, expression=Ref(name_of(shape.component, ITEM.name))),
        Subprogram(
            _IS_DEFERRED,
            (name, place),
            "Boolean",
            expression=CaseExpr(Ref("Name"), tuple(deferred)),
        ),
        Comment("Does an active state defer it?"),
        Subprogram(
            _IS_FREED,
            (name, domain, place),
            "Boolean",
            expression=CaseExpr(Ref("Name"), tuple(freed)),
        ),
        Comment("Is a state exited that defers it? Then it is due, whatever is entered."),
        Subprogram("Is_Deferral", (chosen,), "Boolean", expression=one_of(Ref("T"), deferrals)),
        GenericInstance(
            "Deferrals",
            "Ravenchart.Deferrals",
            arguments(
                Event=Ref(f"{component_name(shape.component)}.Event"),
                Null_Event=null_event(shape.component),
                Event_Name=Ref(f"{component_name(shape.component)}.{names}"),
                Name_Of=Ref(_NAME_OF),
                Capacity=number(shape.region.deferral_depth),
                Configuration=Ref(shape.place_type),
                Is_Deferred=Ref(_IS_DEFERRED),
                Domain=Ref("Domain"),
                Is_Freed=Ref(_IS_FREED),
            ),
        ),
    ]


def change(shape: RegionShape, chosen: str, domain: Expr, before: str) -> Stmt:
    """What a firing does to the events that are kept."""
    is_deferral = call("Is_Deferral", Ref(chosen))
    return do("Deferrals.Change", Ref(KEPT), is_deferral, Ref(ITEM.name), domain, Ref(before))


def is_changed(shape: RegionShape, chosen: str, domain: Expr) -> Expr:
    """The claim that a firing has done that, and nothing else to them."""
    is_deferral = call("Is_Deferral", Ref(chosen))
    item, held = Ref(ITEM.name), Old(f"Self.{shape.place}")
    return call("Deferrals.Is_Changed", Old(KEPT), Ref(KEPT), is_deferral, item, domain, held)


def due(shape: RegionShape) -> Expr:
    """The place of the event that was due first."""
    return call("Deferrals.Due", Old(KEPT), Ref(f"Self.{shape.place}"))


def is_taken(shape: RegionShape) -> Expr:
    """The claim that the event that was due first is taken."""
    held = Ref(f"Self.{shape.place}")
    return call("Deferrals.Is_Taken", Old(KEPT), held, Ref(ITEM.name), Ref(KEPT))


def take_due(shape: RegionShape, taken: str) -> Stmt:
    """Take the event that is due first, if there is one."""
    held = Ref(f"Self.{shape.place}")
    return do("Deferrals.Take_Due", Ref(KEPT), held, Ref(ITEM.name), Ref(taken))
