"""What a region offers to its instances, with the contracts that are proved.

All contracts are in terms of the chart as declared.
"""

from __future__ import annotations

from ..ada import (
    Arg,
    Aspect,
    Call,
    CaseExpr,
    Comment,
    Decl,
    Expr,
    IfExpr,
    Param,
    Prefix,
    Ref,
    Subprogram,
    both,
    call,
    equal,
    number,
)
from ..events import name_of
from ..naming import ada_case
from .shape import START, RegionShape
from .working import notices


def operations(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    held = f"Self.{shape.place}"
    same = both(
        equal(Ref(held), Ref(f"{held}'Old")),
        equal(Ref("Self.Started"), Ref("Self.Started'Old")),
    )
    items: list[Decl] = []
    if shape.timers:
        items += [
            Subprogram("Tick", (self_out,), aspects=(Aspect("Post", same),)),
            Comment("One more execution: the time-outs come nearer."),
        ]
    items += notices(shape, same)
    due = equal(equal(Ref("Now"), Ref("Start_Of_Region")), Prefix("not", Ref("Self.Started")))
    post: list[Expr] = [same, due] if shape.polls_out else [due]
    if shape.completing:
        rows = tuple(
            (
                Ref(f"Self.{shape.completed(s)}'Old"),
                equal(Ref("Now"), Ref(f"Completion_Of_{ada_case(s)}")),
            )
            for s in shape.completing
        )
        post.append(IfExpr(((Ref("Self.Started"), IfExpr(rows, None)),), None))
    items += [
        Subprogram(
            "Poll",
            shape.poll_params(),
            aspects=(Aspect("Post", both(*post)),),
        ),
        Comment(_POLLS if shape.polls_more else _POLLS_TIME),
    ]
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
    fired = "Firing_List" if shape.listed else "Selection"
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
                Aspect("Pre", due),
                Aspect("Post", both(Ref("Self.Started"), *_stepped(shape))),
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


def _stepped(shape: RegionShape) -> list[Expr]:
    """What a step achieves, in terms of the chart as declared."""
    held = f"Self.{shape.place}"
    kept = equal(Ref(held), Ref(f"{held}'Old"))
    if not shape.listed:
        chosen = Call("Is_Selection", (Arg(None, Ref("Fired")), *shape.choice_args(old=True)))
        none = equal(Ref("Fired"), Ref("None"))
        moved = equal(Ref(held), shape.target("Fired"))
        started = equal(Ref("Fired"), Ref(START))
        return [
            IfExpr(((equal(Ref("Now"), Ref("Start_Of_Region")), started),), chosen),
            IfExpr(((none, kept),), moved),
        ]
    facts: list[Expr] = [
        IfExpr(((equal(Ref("Fired.Count"), number(0)), kept),), None),
    ]
    if shape.passes:
        rests = equal(call("Segments_Left", Ref(f"{held}'Old")), number(0))
        still = equal(call("Segments_Left", Ref(held)), number(0))
        facts.append(IfExpr(((rests, still),), None))
    if shape.single:
        first = equal(Ref("Now"), Ref("Start_Of_Region"))
        chosen = Call(
            "Is_Selection", (Arg(None, Ref("Fired.Items (1)")), *shape.choice_args(old=True))
        )
        facts.append(IfExpr(((first, equal(Ref("Fired.Items (1)"), Ref(START))),), chosen))
    return facts
