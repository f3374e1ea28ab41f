# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Deferral: which of the events that are kept come next.

A kept event is due when no active state defers it, and also from the exit of a state that defers
it. PSSM 8.5.5 gives the event back to the pool then, though the state may be entered again.
`Ravenchart.Deferrals` keeps the events; the chart declares which states defer which.
"""

from __future__ import annotations

from collections.abc import Mapping

from ravenchart.gen.emit.ada.declarations import Decl, GenericInstance, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    OTHERS,
    CaseExpr,
    Choice,
    Expr,
    arguments,
    both,
    call,
    chain,
    number,
    old,
    one_of,
)
from ravenchart.gen.emit.ada.named import Named, ref
from ravenchart.gen.emit.ada.naming import component_name
from ravenchart.gen.emit.ada.statements import Comment, Stmt, do
from ravenchart.gen.emit.language.compound import FiringKind
from ravenchart.gen.emit.language.configurations import conjuncts
from ravenchart.gen.emit.language.events import carries, name_of, null_event

from .shape import ITEM, RegionShape

KEPT = ref("Self.Deferred")
STORE = ref("Deferrals.Store")
_NAME_OF, _IS_DEFERRED, _IS_FREED = "Name_Of", "Is_Deferred", "Is_Freed"
_ITEM = ref(ITEM.name)


def kept_events(shape: RegionShape) -> list[str]:
    """The events that a state defers, in model order."""
    return [e for e in shape.region.events() if any(e in s.defers for s in shape.region.states)]


def deferral_types(shape: RegionShape, spans: Mapping[str, Expr]) -> list[Decl]:
    """Which events are deferred and which are freed, and the package that keeps them.

    ``spans`` holds for each state the test whether a domain spans it.
    """
    names = "Event_Name" if carries(shape.component) else "Event"
    configuration = shape.configuration_param
    deferred: list[tuple[Choice, Expr]] = []
    freed: list[tuple[Choice, Expr]] = []
    for event in kept_events(shape):
        states = [s.name for s in shape.region.states if event in s.defers]
        inside = [shape.in_state(configuration.name, s) for s in states]
        left = [both(*conjuncts([spans[s], one])) for s, one in zip(states, inside, strict=True)]
        deferred.append((shape.event(event), chain("or else", inside)))
        freed.append((shape.event(event), chain("or else", left)))
    if len(deferred) < len(shape.component.events):
        deferred.append((OTHERS, FALSE))
        freed.append((OTHERS, FALSE))
    name, domain = Param("Name", "in", names), Param("D", "in", "Domain")
    deferrals = [f.literal for f in shape.firings if f.kind is FiringKind.DEFERRAL]
    chosen = Param("T", "in", "Selection")
    return [
        Subprogram(_NAME_OF, (ITEM,), names, expression=name_of(shape.component, ITEM.name)),
        Subprogram(
            _IS_DEFERRED,
            (name, configuration),
            "Boolean",
            expression=CaseExpr(ref(name.name), deferred),
        ),
        Comment("Whether an active state defers the event."),
        Subprogram(
            _IS_FREED,
            (name, domain, configuration),
            "Boolean",
            expression=CaseExpr(ref(name.name), freed),
        ),
        Comment(
            "Whether a state that defers the event is exited. The event is then due, whichever "
            "states are entered."
        ),
        Subprogram("Is_Deferral", (chosen,), "Boolean", expression=one_of(ref("T"), deferrals)),
        GenericInstance(
            "Deferrals",
            "Ravenchart.Deferrals",
            arguments(
                Event=ref(component_name(shape.component), "Event"),
                Null_Event=null_event(shape.component),
                Event_Name=ref(component_name(shape.component), names),
                Name_Of=ref(_NAME_OF),
                Capacity=number(shape.region.deferral_depth),
                Configuration=shape.configuration_type,
                Is_Deferred=ref(_IS_DEFERRED),
                Domain=ref("Domain"),
                Is_Freed=ref(_IS_FREED),
            ),
        ),
    ]


def change(chosen: Named, domain: Expr, before: Named) -> Stmt:
    """The effect of a transition on the kept events."""
    is_deferral = call("Is_Deferral", ref(chosen))
    return do("Deferrals.Change", KEPT, is_deferral, _ITEM, domain, ref(before))


def is_changed(shape: RegionShape, chosen: Named, domain: Expr) -> Expr:
    """The claim that a transition has had this effect on them, and no other."""
    is_deferral = call("Is_Deferral", ref(chosen))
    held = old(shape.held)
    return call("Deferrals.Is_Changed", old(KEPT), KEPT, is_deferral, _ITEM, domain, held)


def due(shape: RegionShape) -> Expr:
    """The position of the event that was due first."""
    return call("Deferrals.Due", old(KEPT), shape.held)


def is_taken(shape: RegionShape) -> Expr:
    """The claim that the event that was due first is taken."""
    return call("Deferrals.Is_Taken", old(KEPT), shape.held, _ITEM, KEPT)


def take_due(shape: RegionShape, taken: Named) -> Stmt:
    """Take the event that is due first, if there is one."""
    return do("Deferrals.Take_Due", KEPT, shape.held, _ITEM, ref(taken))
