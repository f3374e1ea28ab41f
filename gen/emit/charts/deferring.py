# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Deferral: which of the events that are kept come next.

A kept event is due when no active state defers it, and also from the exit of a state that
defers it: PSSM 8.5.5 gives it back to the pool then, though the state may be entered again.
The list of kept events is in the order in which they came, so for each event one number
says which are *freed* by an exit: those among the first so many.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import (
    Aspect,
    Decl,
    Param,
    RecordComponent,
    RecordDeclaration,
    Subprogram,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    OTHERS,
    Aggregate,
    Arg,
    CaseExpr,
    Choice,
    Expr,
    ForAll,
    IfExpr,
    OperatorChain,
    Prefix,
    both,
    call,
    chain,
    equal,
    number,
    old,
    one_of,
    up_to,
)
from ravenchart.gen.emit.ada.named import Named, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, Stmt
from ravenchart.gen.emit.language.compound import FiringKind
from ravenchart.gen.emit.language.events import name_of

from .shape import RegionShape

FREED = ref("Self.Freed")
COUNT = call("Deferrals.Count", ref("Self.Deferred"))
_TYPE = "Freed_Events"


def kept_events(shape: RegionShape) -> list[str]:
    """The events that a state defers, in model order."""
    return [e for e in shape.region.events() if any(e in s.defers for s in shape.region.states)]


def freed_type(shape: RegionShape) -> list[Decl]:
    """For each event the length of the list when a state that defers it was exited last."""
    rows = tuple(RecordComponent(ada_case(e), "Natural", number(0)) for e in kept_events(shape))
    return [
        Comment("Of each event those among the first so many were kept when an exit freed it."),
        RecordDeclaration(_TYPE, rows),
    ]


def freed_field() -> RecordComponent:
    """Its component of the region's state."""
    return RecordComponent("Freed", _TYPE)


def freed_by(shape: RegionShape, state: str) -> tuple[Stmt, ...]:
    """The exit of a state frees what it defers."""
    events = shape.region.state(state).defers
    return tuple(Assign(ref(FREED, ada_case(e)), COUNT) for e in events)


def freed_after(shape: RegionShape, domain: Expr, count: Expr) -> Expr:
    """The claim that all was freed that states in a domain defer."""
    held = old(shape.held)
    return equal(FREED, call("Freed_After", domain, held, count, old(FREED)))


def declared_deferrals(shape: RegionShape) -> list[Decl]:
    """What is deferred, what is due, and what is due next."""
    rows: list[tuple[Choice, Expr]] = []
    limits: list[tuple[Choice, Expr]] = []
    for event in kept_events(shape):
        states = [s.name for s in shape.region.states if event in s.defers]
        inside = [shape.in_state(shape.place, s) for s in states]
        rows.append((shape.event(event), chain("or else", inside)))
        limits.append((shape.event(event), ref("Freed", ada_case(event))))
    if len(rows) < len(shape.component.events):
        rows.append((OTHERS, FALSE))
        limits.append((OTHERS, number(0)))
    item, place = Param("Item", "in", "Event"), Param(shape.place, "in", shape.place_type)
    freed, index = Param("Freed", "in", _TYPE), Param("I", "in", "Positive")
    kept = (Param("Kept", "in", "Deferrals.List"), place, freed, index)
    name = name_of(shape.component, "Item")
    element = call("Deferrals.Element", ref("Kept"), ref("I"))
    limit = call("Freed_Up_To", element, ref("Freed"))
    waits = call("Is_Deferred", element, ref(place.name))
    due = chain("or else", [Prefix("not", waits), OperatorChain("<=", (ref("I"), limit))])
    there = OperatorChain("<=", (ref("I"), call("Deferrals.Count", ref("Kept"))))
    without = tuple(
        Arg(
            ada_case(e),
            IfExpr(
                ((OperatorChain("<=", (ref("I"), of)), OperatorChain("-", (of, number(1)))),),
                of,
            ),
        )
        for e in kept_events(shape)
        for of in (ref("Freed", ada_case(e)),)
    )
    deferrals = [f.literal for f in shape.firings if f.kind is FiringKind.DEFERRAL]
    return [
        Subprogram("Is_Deferred", (item, place), "Boolean", expression=CaseExpr(name, tuple(rows))),
        Comment("Does an active state defer it?"),
        Subprogram(
            "Freed_Up_To", (item, freed), "Natural", expression=CaseExpr(name, tuple(limits))
        ),
        Comment("Among how many of the oldest was it kept when a state that defers it was exited?"),
        Subprogram("Is_Due", kept, "Boolean", expression=both(there, due)),
        Comment("Does no active state defer it, or was one exited that does?"),
        Subprogram(
            "Is_Released",
            kept,
            "Boolean",
            aspects=(Aspect("Ghost"),),
            expression=both(
                is_due("Kept", place.name, "Freed", "I"),
                ForAll("J", BEFORE_I, Prefix("not", is_due("Kept", place.name, "Freed", "J"))),
            ),
        ),
        Comment("Is it the oldest that is due?"),
        Subprogram("Freed_Without", (index, freed), _TYPE, expression=Aggregate(without)),
        Comment("What is freed when the event in this place is taken out."),
        Subprogram(
            "Is_Deferral",
            (Param("T", "in", "Selection"),),
            "Boolean",
            expression=one_of(ref("T"), deferrals),
        ),
    ]


BEFORE_I = up_to(OperatorChain("-", (ref("I"), number(1))))
"""The places before the one that I is."""


def is_due(kept: Named, place: Named, freed: Named, index: Named) -> Expr:
    """A call of that function."""
    return call("Is_Due", ref(kept), ref(place), ref(freed), ref(index))
