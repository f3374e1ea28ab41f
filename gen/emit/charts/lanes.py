# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A step that can fire more than one: a transition in each lane, each with its segments.

`Follows` is the contract: what a step fires is what was chosen for the lanes, in
their order, and a choice is dropped only when one that conflicts with it has fired. Where
ways go on from choices and histories it says less: when an earlier lane has fired.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import (
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Comment,
    Decl,
    Do,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    IfStatement,
    Loop,
    Object,
    Old,
    OperatorChain,
    Param,
    Pragma,
    Prefix,
    Ref,
    Say,
    Stmt,
    Subprogram,
    arguments,
    both,
    call,
    chain,
    do,
    equal,
    member,
    number,
    one_of,
)
from ravenchart.gen.emit.language.compound import Firing, FiringKind
from ravenchart.gen.model.statechart import Lane

from .firing import Moves
from .selection import segment, whole
from .shape import START, RegionShape


def fire(moves: Moves, chosen: str) -> Do:
    names = (p.name for p in moves.fire_params())
    return Do("Fire", arguments(*(Ref(chosen if n == "Chosen" else n) for n in names)))


def _nothing() -> Aggregate:
    """An empty list of firings."""
    return Aggregate(
        (Arg("Count", number(0)), Arg("Items", Aggregate((Arg("others", Ref("None")),))))
    )


# --- The contract ------------------------------------------------------------


def declared_lanes(shape: RegionShape) -> list[Decl]:
    """Choose, and what a step may fire of a choice."""
    fired = Param("Fired", "in", "Firing_List")
    items: list[Decl] = [*_starts_with(shape, fired)]
    if shape.single:
        return items
    params = shape.situation
    chosen = Call("Is_Choice", (Arg(None, Ref("Choose'Result")), *shape.situation_args()))
    found = ForSome("I", _FIRED, equal(Ref(_ITEM), Ref("T")))
    earlier = OperatorChain("<", (Ref("Fired.Items (J)"), Ref(_ITEM)))
    pairs = ForAll("J", "1 .. I - 1", _unless_segment(shape, earlier, "J"))
    choice = Param("C", "in", "Choice")
    ghost = (Aspect("Ghost"),)
    return [
        *items,
        Subprogram("Choose", params, "Choice", aspects=(Aspect("Post", chosen),)),
        Comment("The transitions that one occurrence asks for."),
        Subprogram(
            "Has",
            (fired, Param("T", "in", "Selection")),
            "Boolean",
            aspects=() if shape.watched else ghost,
            expression=found,
        ),
        Subprogram(
            _IS_OF,
            (fired, choice, Param("Last", "in", "Selection")),
            "Boolean",
            aspects=ghost,
            expression=_of_choice(shape),
        ),
        Comment("Is what has fired chosen, and none of it after Last?"),
        Subprogram(
            "Is_Ordered",
            (fired,),
            "Boolean",
            aspects=ghost,
            expression=ForAll("I", _FIRED, _unless_segment(shape, pairs, "I")),
        ),
        Comment("Do the lanes fire in their order?"),
        Subprogram(
            "Follows", (fired, choice), "Boolean", aspects=ghost, expression=_follows(shape)
        ),
        Comment(_FOLLOWS + (_DROPPED if shape.watched and not shape.passes else _OVERTAKEN)),
    ]


def _of_choice(shape: RegionShape) -> Expr:
    """Each is chosen for a lane, or goes on from a choice or history."""
    chosen = " | ".join(f"C.{shape.lane_name(n)}" for n in shape.busy_lanes)
    due = both(OperatorChain("<=", (Ref(_ITEM), Ref("Last"))), member(Ref(_ITEM), chosen))
    return ForAll("I", _FIRED, _unless_segment(shape, due, "I"))


def _is_of(lane: str) -> Expr:
    return call(_IS_OF, Ref("Fired"), Ref("C"), Ref(f"{lane}_Transition'Last"))


BEFORE = "Place_Before"
"""The configuration before anything has fired."""

_IS_OF = "Is_Of_Choice"
_FIRED = "1 .. Fired.Count"
_ITEM = "Fired.Items (I)"
_ORDERED = call("Is_Ordered", Ref("Fired"))
_FOLLOWS = (
    "A deferral is fired alone. Otherwise what is chosen is fired, lane by lane, and nothing else; "
)
_OVERTAKEN = "a lane inside a state that transitions leave may be overtaken by an earlier one."
_DROPPED = "of two that conflict, as one leaves a state in which the other fires, the earlier one."


def _starts_with(shape: RegionShape, fired: Param) -> list[Decl]:
    first = [
        OperatorChain(
            ">" if shape.passes else "=", (Ref("Fired.Count"), number(0 if shape.passes else 1))
        ),
        equal(Ref("Fired.Items (1)"), Ref("T")),
    ]
    items: list[Decl] = []
    if shape.passes:
        names = [f.literal for f in shape.firings if is_segment(shape, f)]
        items = [
            Subprogram(
                "Is_Segment",
                (Param("T", "in", "Selection"),),
                "Boolean",
                expression=one_of(Ref("T"), names),
            ),
            Comment("Does it go on from a choice or history?"),
        ]
        rest = call("Is_Segment", Ref(_ITEM))
        first.append(ForAll("I", "2 .. Fired.Count", rest))
    return [
        *items,
        Subprogram(
            "Is_Only",
            (fired, Param("T", "in", "Selection")),
            "Boolean",
            aspects=(Aspect("Ghost"),),
            expression=both(*first),
        ),
        Comment("Is that fired, with the segments of its way, and nothing else?"),
    ]


def is_segment(shape: RegionShape, firing: Firing) -> bool:
    """Does it go on from a choice or history?"""
    return shape.region.pseudostate(firing.sources[0]) is not None


def _unless_segment(shape: RegionShape, fact: Expr, index: str) -> Expr:
    if not shape.passes:
        return fact
    return OperatorChain("or else", (call("Is_Segment", Ref(f"Fired.Items ({index})")), fact))


def _choice(shape: RegionShape, lane: Lane) -> Expr:
    return Ref(f"C.{shape.lane_name(lane)}")


def _follows(shape: RegionShape) -> Expr:
    last = shape.lane_name(shape.busy_lanes[-1])
    facts = both(_is_of(last), _ORDERED, *_asked(shape, shape.busy_lanes))
    deferrals = tuple(
        (call("Is_Deferral", lane), call("Is_Only", Ref("Fired"), lane))
        for lane in _deferring(shape)
    )
    return IfExpr(deferrals, facts) if deferrals else facts


def _deferring(shape: RegionShape) -> list[Expr]:
    """What is chosen for the lanes that have deferrals."""
    lanes = {f.lane for f in shape.firings if f.kind is FiringKind.DEFERRAL}
    return [_choice(shape, n) for n in shape.busy_lanes if n in lanes]


def _asked(shape: RegionShape, lanes: Sequence[Lane]) -> list[Expr]:
    """What is chosen for these lanes is fired, but for what conflicts with an earlier lane; where
    ways go on from choices and histories, what is chosen for the first lane that asks."""
    if not shape.passes:
        return [fact for n in lanes for fact in (_has(shape, n), *_apart(shape, n))]
    rows = (
        (OperatorChain("/=", (_choice(shape, n), Ref("None"))), _fired(shape, n)) for n in lanes
    )
    return [IfExpr(tuple(rows), None)]


def _has(shape: RegionShape, lane: Lane) -> Expr:
    """What is chosen for a lane is fired, unless what conflicts with it was."""
    asked: list[Expr] = [OperatorChain("/=", (_choice(shape, lane), Ref("None")))]
    before = shape.busy_lanes[: shape.busy_lanes.index(lane)]
    asked += [Prefix("not", clash) for clash in _clashes(shape, lane, before)]
    return IfExpr(((both(*asked), _fired(shape, lane)),), None)


def _fired(shape: RegionShape, lane: Lane) -> Expr:
    return call("Has", Ref("Fired"), _choice(shape, lane))


def _clashes(shape: RegionShape, lane: Lane, others: Sequence[Lane]) -> Iterator[Expr]:
    """For each of the others: it has fired, and one of both leaves a state around the other."""
    for other in others:
        leaving = [
            call(f"Leaves_{ada_case(state)}", _choice(shape, one))
            for state in shape.watched
            if {lane, other} <= set(shape.lanes_in(state))
            for one in (other, lane)
        ]
        if leaving:
            yield both(_fired(shape, other), chain("or else", leaving))


def _apart(shape: RegionShape, lane: Lane) -> Iterator[Expr]:
    """What is fired for a lane conflicts with nothing that is fired for an earlier one."""
    before = shape.busy_lanes[: shape.busy_lanes.index(lane)]
    for clash in _clashes(shape, lane, before):
        yield Prefix("not", both(_fired(shape, lane), clash))


def _unmoved(shape: RegionShape, done: Sequence[Lane]) -> Iterator[Expr]:
    """Where something is chosen for a lane still to come, and no state around it has been
    left, it is as it was."""
    for lane in () if shape.passes else shape.busy_lanes[len(done) :]:
        around = [ada_case(s) for s in shape.watched if lane in shape.lanes_in(s)]
        if around:
            stays = [Prefix("not", call(f"Has_Left_{s}", Ref("Fired"))) for s in around]
            asked: list[Expr] = [OperatorChain("/=", (_choice(shape, lane), Ref("None"))), *stays]
            same = [
                equal(Ref(shape.at(f"Self.{shape.place}", n)), Ref(shape.at(BEFORE, n)))
                for n in shape.lanes_around(lane)
            ]
            yield IfExpr(((both(*asked), both(*same)),), None)


def _overtaken(shape: RegionShape, lane: Lane) -> bool:
    """Can what earlier lanes fire disable what was chosen for this one? Where they go on from
    choices and histories this is asked rather than proved."""
    return shape.passes or any(lane in shape.lanes_in(s) for s in shape.watched)


def followed(shape: RegionShape) -> Expr:
    """What Step says of all that it has fired."""
    begun = equal(Ref("Now"), Ref("Start_Of_Region"))
    choice = Call("Choose", shape.situation_args(Self=Old("Self")))
    only = call("Is_Only", Ref("Fired"), Ref(START))
    follows = call("Follows", Ref("Fired"), choice)
    #  no `if`: 'Old behind a condition known on entry wants an exception handler
    goes_on = OperatorChain("/=", (Ref("Now"), Ref("Start_Of_Region")))
    return OperatorChain(
        "or", (OperatorChain("and", (begun, only)), OperatorChain("and", (goes_on, follows)))
    )


# --- The step ----------------------------------------------------------------


def lane_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """Every lane's transition in order; what conflicts with an earlier one is dropped."""
    work: tuple[Stmt, ...] = (
        *moves.safety.alone(),
        *(s for lane in shape.busy_lanes for s in (_lane(shape, lane), _so_far(shape, lane))),
    )
    if deferred := _deferring(shape):
        rows = [(call("Is_Deferral", one), (do("Fire_Whole", one),)) for one in deferred]
        work = (IfStatement(tuple(rows), work),)
    choose = Assign("C", Call("Choose", shape.situation_args()))
    declared: list[Decl] = [Object("C", "Choice")]
    if shape.watched and not shape.passes:
        held, ghost = Ref(f"Self.{shape.place}"), (Aspect("Ghost"),)
        declared.append(Object(BEFORE, shape.place_type, held, constant=True, aspects=ghost))
    return _step(shape, moves, profile, declared, (choose, *work))


def passing_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """One transition, then the segments that its way passes."""
    pick = Assign("Chosen", whole(shape, shape.lanes[0]))
    some = OperatorChain("/=", (Ref("Chosen"), Ref("None")))
    work = (pick, IfStatement(((some, (do("Fire_Whole", Ref("Chosen")),)),)))
    return _step(shape, moves, profile, [Object("Chosen", "Selection")], work)


def _step(
    shape: RegionShape,
    moves: Moves,
    profile: tuple[Param, ...],
    declared: Sequence[Decl],
    work: tuple[Stmt, ...],
) -> Subprogram:
    """At the start of the region its initial entry; later ``work``, with what it declares."""
    begun = equal(Ref("Now"), Ref("Start_Of_Region"))
    return Subprogram(
        "Step",
        profile,
        declarations=(*declared, _fire_whole(shape, moves)),
        body=(
            Assign("Fired", _nothing()),
            IfStatement(((begun, (do("Fire_Whole", Ref(START)),)),), work),
        ),
    )


def _lane(shape: RegionShape, lane: Lane) -> Stmt:
    """Fire the transition of a lane, unless an earlier one left its state, or it would leave
    a state in which an earlier one fired: one that was dropped is no obstacle."""
    chosen = _choice(shape, lane)
    free: list[Expr] = [OperatorChain("/=", (chosen, Ref("None")))]
    around = [s for s in shape.watched if lane in shape.lanes_in(s)]
    for state in around:
        inside = shape.lanes_in(state)
        earlier = inside[: inside.index(lane)]
        if not earlier:
            continue
        name = ada_case(state)
        still = [Prefix("not", call("Has", Ref("Fired"), _choice(shape, n))) for n in earlier]
        stays = Prefix("not", call(f"Leaves_{name}", chosen))
        free.append(Prefix("not", call(f"Has_Left_{name}", Ref("Fired"))))
        free.append(OperatorChain("or else", (stays, chain("and then", still))))
    if lane != shape.busy_lanes[0] and _overtaken(shape, lane):
        free.append(call("In_Source", chosen, Ref(f"Self.{shape.place}")))
    return IfStatement(((chain("and then", free), (do("Fire_Whole", chosen),)),))


def _so_far(shape: RegionShape, lane: Lane) -> Pragma:
    """What has been fired of the lanes up to this one; types bound it when it is the last."""
    done = shape.busy_lanes[: shape.busy_lanes.index(lane) + 1]
    few: list[Expr] = []
    if lane != shape.busy_lanes[-1]:
        few = [OperatorChain("<=", (_COUNT, number(len(done) * (1 + shape.most_segments))))]
    of_lanes = _is_of(shape.lane_name(lane))
    facts = (*few, of_lanes, _ORDERED, *_asked(shape, done), *_unmoved(shape, done))
    return Pragma("Assert", (both(*facts),))


def _fire_whole(shape: RegionShape, moves: Moves) -> Subprogram:
    """A transition with the segments that its way passes, and note what fired."""
    held = Ref(f"Self.{shape.place}")
    safe = moves.safety.holds()
    most = shape.most_segments
    before = shape.most_firings - 1 - most
    room = OperatorChain("<=" if before else "=", (_COUNT, number(before)))
    left = call("Segments_Left", held)
    body: list[Stmt] = [fire(moves, "T"), *_note("T")]
    declarations: tuple[Decl, ...] = ()
    grown = equal(_COUNT, Ref("Fired.Count'Old + 1"))
    settled: list[Expr] = []
    if most:
        ghost = (Aspect("Ghost"),)
        declarations = (
            Object("Before", "Firing_List", Ref("Fired"), constant=True, aspects=ghost),
            Object("Segment", "Selection"),
        )
        bound = OperatorChain("<=", (left, OperatorChain("-", (number(most + 1), Ref("I")))))
        counted = equal(_COUNT, Ref("Before.Count + I"))
        noted = _noted(shape, "Before.Count", "Before.Items")
        going_on = Pragma("Loop_Invariant", (both(counted, *noted, bound, *safe),))
        body.append(
            Loop(
                f"for I in 1 .. {most}",
                (
                    going_on,
                    IfStatement(((equal(left, number(0)), (Say("exit"),)),)),
                    Assign("Segment", segment(shape)),
                    fire(moves, "Segment"),
                    *_note("Segment"),
                ),
            )
        )
        if before:
            grown = member(_COUNT, f"Fired.Count'Old + 1 .. Fired.Count'Old + {most + 1}")
        else:
            grown = OperatorChain(">=", (_COUNT, number(1)))
        settled = [equal(left, number(0))]
    else:
        settled = [equal(held, shape.target("T"))]
    facts = (grown, *_noted(shape, "Fired.Count'Old", "Fired.Items'Old"), *settled, *safe)
    return Subprogram(
        "Fire_Whole",
        (Param("T", "in", "Firing"),),
        aspects=(Aspect("Pre", both(moves.ready("T"), room)), Aspect("Post", both(*facts))),
        declarations=declarations,
        body=tuple(body),
    )


_COUNT = Ref("Fired.Count")


def _noted(shape: RegionShape, count: str, items: str) -> list[Expr]:
    """The transition and its segments stand behind what was fired before."""
    item = Ref("Fired.Items (J)")
    facts: list[Expr] = [
        Ref("Self.Started"),
        equal(Ref(f"Fired.Items ({count} + 1)"), Ref("T")),
        ForAll("J", f"1 .. {count}", equal(item, Ref(f"{items} (J)"))),
    ]
    if shape.passes:
        segments = ForAll("J", f"{count} + 2 .. Fired.Count", call("Is_Segment", item))
        facts.append(segments)
    return facts


def _note(fired: str) -> tuple[Stmt, ...]:
    """It is the last that has fired."""
    return (
        Assign("Fired.Count", OperatorChain("+", (_COUNT, number(1)))),
        Assign("Fired.Items (Fired.Count)", Ref(fired)),
    )
