# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The operations that a region offers to its instances, with the contracts that are proved.

All contracts are in terms of the chart as declared.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    OTHERS,
    Attribute,
    CaseExpr,
    Choice,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    Indexed,
    OperatorChain,
    Prefix,
    Range,
    both,
    call,
    equal,
    member,
    number,
    old,
    plain,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.emit.language.events import name_of
from ravenchart.gen.model.statechart import TOP

from .deferring import due, is_taken
from .lasting import Lasting
from .safety import Safety
from .selection import is_selected
from .several_transitions import LIST, followed, is_only
from .shape import START, RegionShape
from .working import notices


def operations(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    held = shape.held
    safety = Safety(shape)
    same = both(
        equal(held, old(held)),
        equal(ref("Self.Started"), old("Self.Started")),
        *safety.unchanged(),
    )
    items: list[Decl] = []
    if shape.timers:
        ticked = call("Ravenchart.Timers.Ticked", _TIMER_BEFORE)
        nearer = ForAll("I", _EACH_TIMER, equal(Indexed("Self.Timers", ref("I")), ticked))
        items += [
            Subprogram("Tick", (self_out,), aspects=(Aspect("Post", both(same, nearer)),)),
            Comment("Count one execution for each time-out."),
        ]
    items += notices(shape, same)
    if shape.region.events():
        rows_of: list[tuple[Choice, Expr]] = [
            (shape.event(e), ref(f"On_{ada_case(e)}")) for e in shape.region.events()
        ]
        if len(rows_of) < len(shape.component.events):
            rows_of.append((OTHERS, ref("Conditions")))
        items += [
            Subprogram(
                "To_Occurrence",
                (Param("Item", "in", "Event"),),
                "Occurrence",
                expression=CaseExpr(name_of(shape.component, "Item"), rows_of),
            ),
        ]
    due = equal(equal(ref("Now"), ref("Start_Of_Region")), Prefix("not", ref("Self.Started")))
    post = [same, *_taken(shape)] if shape.polls_out else []
    items += [
        Subprogram(
            "Poll",
            shape.poll_params(),
            aspects=(Aspect("Post", both(*post, due, *_next(shape))),),
        ),
        Comment(_POLLS if shape.polls_more else _POLLS_TIME),
    ]
    fired = LIST if shape.listed else "Selection"
    params = shape.step_params()
    items += [
        Subprogram(
            "Step",
            (
                params[0],
                Param("Now", "in", "Occurrence"),
                *params[1:],
                Param("Fired", "out", fired),
            ),
            aspects=(
                Aspect("Pre", both(*safety.kept(), due, *shape.begins)),
                Aspect("Post", both(ref("Self.Started"), *safety.kept(), *_stepped(shape))),
            ),
        ),
        Comment("One run-to-completion step."),
    ]
    return items


_POLLS_TIME = (
    "The next occurrence: the start or the time-out that is due; Conditions when there is neither."
)
_POLLS = (
    "The next occurrence: the start, a completion, the time-out that is due or a deferred event "
    "that is due; Conditions when there is none."
)


def _next(shape: RegionShape) -> list[Expr]:
    """Which occurrence comes next, once the region has started."""
    now = ref("Now")
    rows: list[tuple[Expr, Expr]] = [
        (
            old(ref("Self", shape.completed(s))),
            equal(now, ref(f"Completion_Of_{ada_case(s)}")),
        )
        for s in shape.completing
    ]
    if shape.timers:
        names = [f"Expiry_Of_{ada_case(t.name)}" for t in shape.timers]
        due = ForSome("I", _EACH_TIMER, call(_IS_DUE, _TIMER_BEFORE))
        first, last = ref(names[0]), ref(names[-1])
        rows.append((due, member(now, first if first == last else Range(first, last))))
    if shape.deferring:
        rows.append(_released(shape))
    rest = equal(now, ref("Conditions"))
    polled = IfExpr(tuple(rows), rest) if rows else rest
    return [IfExpr(((ref("Self.Started"), polled),), None)]


_IS_DUE = ref("Ravenchart.Timers.Is_Due")
_EACH_TIMER = Attribute("Self.Timers", "Range")
_TIMER_BEFORE = Indexed(old("Self.Timers"), ref("I"))


def _released(shape: RegionShape) -> tuple[Expr, Expr]:
    """When an event is released from deferral, it comes next."""
    comes = equal(ref("Now"), call("To_Occurrence", ref("Item")))
    return OperatorChain(">", (due(shape), number(0))), both(is_taken(shape), comes)


def _taken(shape: RegionShape) -> list[Expr]:
    """That the taken occurrence is gone, and nothing else."""
    facts: list[Expr] = []
    for state in shape.completing:
        flag = ref("Self", shape.completed(state))
        other = OperatorChain("/=", (ref("Now"), ref(f"Completion_Of_{ada_case(state)}")))
        facts.append(equal(flag, both(old(flag), other)))
    if shape.timers:
        times = old("Self.Timers"), ref("Self.Timers")
        rows = [
            (
                f"Expiry_Of_{ada_case(t.name)}",
                call("Ravenchart.Timers.Is_Taken", *times, number(i)),
            )
            for i, t in enumerate(shape.timers, 1)
        ]
        facts.append(CaseExpr(ref("Now"), (*rows, (OTHERS, equal(*times)))))
    return facts


def _stepped(shape: RegionShape) -> list[Expr]:
    """The postcondition of a step, in terms of the chart as declared."""
    held = shape.held
    kept = equal(held, old(held))
    begun = equal(ref("Now"), ref("Start_Of_Region"))
    first = Indexed("Fired.Items", plain(1)) if shape.listed else ref("Fired")
    chosen = is_selected(shape, first, TOP, Self=old("Self"))
    started = equal(first, ref(START))
    if not shape.listed:
        none = equal(ref("Fired"), ref("None"))
        moved = both(equal(held, shape.target("Fired")), *Lasting(shape).fired("Fired"))
        return [IfExpr(((begun, started),), chosen), IfExpr(((none, kept),), moved)]
    facts: list[Expr] = [IfExpr(((equal(ref("Fired.Count"), number(0)), kept),), None)]
    if shape.passes:
        rests = equal(call("Segments_Left", old(held)), number(0))
        still = equal(call("Segments_Left", held), number(0))
        facts.append(IfExpr(((rests, still),), None))
    if not shape.single:
        return [*facts, followed(shape)]
    only = is_only(first)
    some = IfExpr(((OperatorChain(">", (ref("Fired.Count"), number(0))), only),), None)
    return [*facts, IfExpr(((begun, started),), chosen), some]
