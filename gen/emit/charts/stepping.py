# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The body of a region's package: selection, occurrences, Fire, and the step that joins them."""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Decl, Object, Param, Subprogram, UseType
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    OTHERS,
    Expr,
    IfExpr,
    OperatorChain,
    Prefix,
    call,
    equal,
    plain,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Case, IfStatement, Stmt, do
from ravenchart.gen.emit.language.events import null_event
from ravenchart.gen.emit.language.terms import expressions_in, flow_operators
from ravenchart.gen.model.statechart import TOP

from .deferring import take_due
from .firing import Moves
from .guards import guard_operators, guards_of
from .safety import Safety
from .selection import selectors, whole
from .several_transitions import LIST, concurrent_step, fire, passing_step
from .shape import START, RegionShape
from .working import notice_bodies


def body_of(shape: RegionShape) -> tuple[Decl, ...]:
    """All of the package's body."""
    region = shape.region
    moves = Moves(shape)
    fire = moves.fire()
    compared = shape.compared_in(e for flow in moves.flows() for e in expressions_in(flow))
    operators = {name for flow in moves.flows() for name in flow_operators(flow)}
    more = sorted(operators - guard_operators(region) - Safety(shape).operators())
    more += [ref("Ravenchart.Event_Count")] if shape.working else []
    more += sorted(compared - shape.compared_in(guards_of(region)))
    return (
        *(UseType(name) for name in more),
        *selectors(shape),
        moves.chart(fire),
        *notice_bodies(shape),
        *_polling(shape),
        *moves.claims(),
        fire,
        _step(shape, moves),
    )


# --- the next occurrence -----------------------------------------------------


def _polling(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    items: list[Decl] = []
    if shape.timers:
        tick = do("Ravenchart.Timers.Tick", ref("Self.Timers"))
        items.append(Subprogram("Tick", (self_out,), body=(tick,)))
    branches: list[tuple[Expr, tuple[Stmt, ...]]] = [
        (Prefix("not", ref("Self.Started")), (Assign("Now", ref("Start_Of_Region")),))
    ]
    for state in shape.completing:
        done = ref("Self", shape.completed(state))
        occurs = Assign("Now", ref(f"Completion_Of_{ada_case(state)}"))
        branches.append((done, (Assign(done, FALSE), occurs)))
    declarations: list[Decl] = [Object("Due", "Natural")] if shape.timers else []
    declarations += [Object("Released", "Boolean")] if shape.deferring else []
    params = shape.poll_params()
    before: tuple[Stmt, ...] = ()
    if len(params) > 2:
        before = (Assign("Item", null_event(shape.component)),)
    rest = _deferred(shape) if shape.deferring else (Assign("Now", ref("Conditions")),)
    if shape.timers:
        rows = [
            (plain(i), (Assign("Now", ref(f"Expiry_Of_{ada_case(t.name)}")),))
            for i, t in enumerate(shape.timers, 1)
        ]
        rest = (
            do("Ravenchart.Timers.Take_Due", ref("Self.Timers"), ref("Due")),
            Case(ref("Due"), (*rows, (OTHERS, rest))),
        )
    items.append(
        Subprogram(
            "Poll",
            params,
            declarations=tuple(declarations),
            body=(*before, IfStatement(tuple(branches), rest)),
        )
    )
    return items


def _deferred(shape: RegionShape) -> tuple[Stmt, ...]:
    """The oldest deferred event that is due."""
    released = ref("Released")
    taken = IfExpr(((released, call("To_Occurrence", ref("Item"))),), ref("Conditions"))
    return (take_due(shape, released), Assign("Now", taken))


# --- the step ----------------------------------------------------------------


def _step(shape: RegionShape, moves: Moves) -> Subprogram:
    params = shape.step_params()
    profile = (
        params[0],
        Param("Now", "in", "Occurrence"),
        *params[1:],
        Param("Fired", "out", LIST if shape.listed else "Selection"),
    )
    if not shape.listed:
        return Subprogram("Step", profile, body=_plain_step(shape, moves))
    if shape.single:
        return passing_step(shape, moves, profile)
    return concurrent_step(shape, moves, profile)


def _plain_step(shape: RegionShape, moves: Moves) -> tuple[Stmt, ...]:
    pick = Assign("Fired", whole(shape, TOP))
    begun = equal(ref("Now"), ref("Start_Of_Region"))
    some = OperatorChain("/=", (ref("Fired"), ref("None")))
    return (
        IfStatement(((begun, (Assign("Fired", ref(START)),)),), (pick,)),
        IfStatement(((some, (fire(moves, "Fired"),)),)),
    )
