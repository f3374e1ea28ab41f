"""What a region offers to its instances, with the contracts that are proved.

All contracts are in terms of the chart as declared.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import (
    Aspect,
    CaseExpr,
    Comment,
    Decl,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    Old,
    OperatorChain,
    Param,
    Prefix,
    Ref,
    Subprogram,
    both,
    call,
    equal,
    member,
    number,
)
from ravenchart.gen.emit.language.events import name_of

from .deferring import due, is_taken
from .lanes import LIST, followed, is_only
from .lasting import Lasting
from .safety import Safety
from .selection import is_selected
from .shape import START, RegionShape
from .working import notices


def operations(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    held = f"Self.{shape.place}"
    safety = Safety(shape)
    same = both(
        equal(Ref(held), Old(held)),
        equal(Ref("Self.Started"), Old("Self.Started")),
        *safety.unchanged(),
    )
    items: list[Decl] = []
    if shape.timers:
        ticked = call("Ravenchart.Timers.Ticked", Old("Self.Timers", " (I)"))
        nearer = ForAll("I", "Self.Timers'Range", equal(Ref("Self.Timers (I)"), ticked))
        items += [
            Subprogram("Tick", (self_out,), aspects=(Aspect("Post", both(same, nearer)),)),
            Comment("One more execution: the time-outs come nearer."),
        ]
    items += notices(shape, same)
    if shape.region.events():
        rows_of = tuple((shape.event(e), Ref(f"On_{ada_case(e)}")) for e in shape.region.events())
        if len(rows_of) < len(shape.component.events):
            rows_of += (("others", Ref("Conditions")),)
        items += [
            Subprogram(
                "To_Occurrence",
                (Param("Item", "in", "Event"),),
                "Occurrence",
                expression=CaseExpr(Ref(name_of(shape.component, "Item")), rows_of),
            ),
        ]
    due = equal(equal(Ref("Now"), Ref("Start_Of_Region")), Prefix("not", Ref("Self.Started")))
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
                Aspect("Pre", both(*safety.kept(), due)),
                Aspect("Post", both(Ref("Self.Started"), *safety.kept(), *_stepped(shape))),
            ),
        ),
        Comment("One run-to-completion step."),
    ]
    return items


_POLLS_TIME = "Its start, or the time-out that is due; Conditions when there is neither."
_POLLS = (
    "Its start, a completion, the time-out that is due or a deferred event that is due again; "
    "Conditions when there is none."
)


def _next(shape: RegionShape) -> list[Expr]:
    """Which occurrence comes next, once the region has started."""
    now = Ref("Now")
    rows: list[tuple[Expr, Expr]] = [
        (
            Old(f"Self.{shape.completed(s)}"),
            equal(now, Ref(f"Completion_Of_{ada_case(s)}")),
        )
        for s in shape.completing
    ]
    if shape.timers:
        names = [f"Expiry_Of_{ada_case(t.name)}" for t in shape.timers]
        due = ForSome("I", "Self.Timers'Range", call(_IS_DUE, Old("Self.Timers", " (I)")))
        rows.append((due, member(now, " .. ".join(dict.fromkeys((names[0], names[-1]))))))
    if shape.deferring:
        rows.append(_released(shape))
    rest = equal(now, Ref("Conditions"))
    polled = IfExpr(tuple(rows), rest) if rows else rest
    return [IfExpr(((Ref("Self.Started"), polled),), None)]


_IS_DUE = "Ravenchart.Timers.Is_Due"


def _released(shape: RegionShape) -> tuple[Expr, Expr]:
    """When an event is released from deferral, it comes next."""
    comes = equal(Ref("Now"), call("To_Occurrence", Ref("Item")))
    return OperatorChain(">", (due(shape), number(0))), both(is_taken(shape), comes)


def _taken(shape: RegionShape) -> list[Expr]:
    """What is taken is gone, and nothing else."""
    facts: list[Expr] = []
    for state in shape.completing:
        flag = f"Self.{shape.completed(state)}"
        other = OperatorChain("/=", (Ref("Now"), Ref(f"Completion_Of_{ada_case(state)}")))
        facts.append(equal(Ref(flag), both(Old(flag), other)))
    if shape.timers:
        times = Old("Self.Timers"), Ref("Self.Timers")
        rows = [
            (
                f"Expiry_Of_{ada_case(t.name)}",
                call("Ravenchart.Timers.Is_Taken", *times, number(i)),
            )
            for i, t in enumerate(shape.timers, 1)
        ]
        facts.append(CaseExpr(Ref("Now"), (*rows, ("others", equal(*times)))))
    return facts


def _stepped(shape: RegionShape) -> list[Expr]:
    """What a step achieves, in terms of the chart as declared."""
    held = f"Self.{shape.place}"
    kept = equal(Ref(held), Old(held))
    begun = equal(Ref("Now"), Ref("Start_Of_Region"))
    first = "Fired.Items (1)" if shape.listed else "Fired"
    chosen = is_selected(shape, first, shape.lanes[-1], Self=Old("Self"))
    started = equal(Ref(first), Ref(START))
    if not shape.listed:
        none = equal(Ref("Fired"), Ref("None"))
        moved = both(equal(Ref(held), shape.target("Fired")), *Lasting(shape).fired("Fired"))
        return [IfExpr(((begun, started),), chosen), IfExpr(((none, kept),), moved)]
    facts: list[Expr] = [IfExpr(((equal(Ref("Fired.Count"), number(0)), kept),), None)]
    if shape.passes:
        rests = equal(call("Segments_Left", Old(held)), number(0))
        still = equal(call("Segments_Left", Ref(held)), number(0))
        facts.append(IfExpr(((rests, still),), None))
    if not shape.single:
        return [*facts, followed(shape)]
    only = is_only(Ref(first))
    some = IfExpr(((OperatorChain(">", (Ref("Fired.Count"), number(0))), only),), None)
    return [*facts, IfExpr(((begun, started),), chosen), some]
