# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Do activities that complete their state: the visits of the state, and the notice of `done`.

A region counts the visits of such a state and publishes them. The do activity names the visit that
it works for when it raises `done`. A `done` that comes late, after the state has been left,
completes nothing, whether the state was entered again or not.
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
from ravenchart.gen.emit.ada.expressions import FALSE, TRUE, Expr, Prefix, both, equal, number
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Stmt
from ravenchart.gen.emit.language.configurations import conjuncts

from .shape import RegionShape

_PARAMS = (Param("Self", "in out", "Region"), Param("Visit", "in", "Ravenchart.Event_Count"))


def done_types(shape: RegionShape) -> list[Decl]:
    """The record of what is done."""
    if not shape.working:
        return []
    flags = tuple(RecordComponent(ada_case(s), "Boolean", FALSE) for s in shape.working)
    return [
        Comment("For each active state, whether its do activity is done."),
        RecordDeclaration("Done_States", flags),
    ]


def work_fields(shape: RegionShape) -> list[RecordComponent]:
    """The components of the region's own state."""
    if not shape.working:
        return []
    visits = (shape.visits(s) for s in shape.working)
    counts = [RecordComponent(v, "Ravenchart.Event_Count", number(0)) for v in visits]
    return [RecordComponent("Done_In", "Done_States"), *counts]


def notices(shape: RegionShape, kept: Expr) -> list[Decl]:
    """The procedures that notify the region of `done`; they leave ``kept`` unchanged."""
    items: list[Decl] = []
    for state in shape.working:
        name = f"Notice_{ada_case(state)}"
        items += [
            Subprogram(name, _PARAMS, aspects=(Aspect("Post", kept),)),
            Comment(f"Note that a do activity of {state} is done in this visit."),
        ]
    return items


def notice_bodies(shape: RegionShape) -> list[Decl]:
    """Their bodies: the state completes, when its regions have ended too."""
    items: list[Decl] = []
    for state in shape.working:
        done = ref("Self", shape.done(state))
        held = shape.held
        news = both(
            *conjuncts(
                [
                    ref("Self.Started"),
                    equal(ref("Visit"), ref("Self", shape.visits(state))),
                    shape.in_state(held, state),
                    Prefix("not", ref(done)),
                ]
            )
        )
        completes: tuple[Stmt, ...] = ()
        if state in shape.completing:
            completes = (Assign(ref("Self", shape.completed(state)), TRUE),)
            if ends := shape.finals(state, held):
                completes = (IfStatement(((both(*conjuncts(ends)), completes),)),)
        body = IfStatement(((news, (Assign(done, TRUE), *completes)),))
        items.append(Subprogram(f"Notice_{ada_case(state)}", _PARAMS, body=(body,)))
    return items
