# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A step that can fire more than one: a transition in each lane, each with its segments.

`Follows` is the contract: what a step fires is what was chosen for the lanes, in
their order, and a choice is dropped only when one that conflicts with it has fired. Where
ways go on from choices and histories it says less: when an earlier lane has fired.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Attribute,
    Call,
    Expr,
    ForAll,
    ForSome,
    IfExpr,
    Indexed,
    OperatorChain,
    Prefix,
    Range,
    all_else,
    both,
    call,
    chain,
    equal,
    member,
    number,
    old,
    one_of,
    plain,
    result,
    up_to,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import (
    Assign,
    Comment,
    Do,
    ExitStatement,
    ForLoop,
    IfStatement,
    Loop,
    Pragma,
    Stmt,
    do,
)
from ravenchart.gen.emit.language.compound import Firing, FiringKind
from ravenchart.gen.model.statechart import Lane

from .deferring import BEFORE_I
from .firing import Moves
from .selection import segment, whole
from .shape import START, RegionShape


def fire(moves: Moves, chosen: str) -> Do:
    names = (p.name for p in moves.fire_params())
    return do("Fire", *(ref(chosen if n == "Chosen" else n) for n in names))


def _nothing() -> Aggregate:
    """An empty list of firings."""
    return Aggregate((Arg("Count", number(0)), Arg("Items", all_else(ref("None")))))


# --- The contract ------------------------------------------------------------


def declared_lanes(shape: RegionShape) -> list[Decl]:
    """Choose, and what a step may fire of a choice."""
    fired = Param("Fired", "in", "Firing_List")
    items: list[Decl] = [*_starts_with(shape, fired)]
    if shape.single:
        return items
    params = shape.situation
    chosen = Call("Is_Choice", (Arg(None, result("Choose")), *shape.situation_args()))
    found = ForSome("I", _FIRED, equal(_ITEM, ref("T")))
    earlier = OperatorChain("<", (_item("J"), _ITEM))
    pairs = ForAll("J", BEFORE_I, _unless_segment(shape, earlier, "J"))
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
    chosen = (ref("C", shape.lane_name(n)) for n in shape.busy_lanes)
    due = both(OperatorChain("<=", (_ITEM, ref("Last"))), member(_ITEM, *chosen))
    return ForAll("I", _FIRED, _unless_segment(shape, due, "I"))


def _is_of(shape: RegionShape, lane: Lane) -> Expr:
    last = Attribute(shape.transitions_of(lane), "Last")
    return call(_IS_OF, ref("Fired"), ref("C"), last)


BEFORE = "Place_Before"
"""The configuration before anything has fired."""

_IS_OF = "Is_Of_Choice"
_COUNT = ref("Fired.Count")
_FIRED = up_to(_COUNT)


def _item(index: str) -> Indexed:
    return Indexed("Fired.Items", ref(index))


_ITEM = _item("I")
_ORDERED = call("Is_Ordered", ref("Fired"))
_FOLLOWS = (
    "A deferral is fired alone. Otherwise what is chosen is fired, lane by lane, and nothing else; "
)
_OVERTAKEN = "a lane inside a state that transitions leave may be overtaken by an earlier one."
_DROPPED = "of two that conflict, as one leaves a state in which the other fires, the earlier one."


def _starts_with(shape: RegionShape, fired: Param) -> list[Decl]:
    first: list[Expr] = [
        OperatorChain(
            ">" if shape.passes else "=", (ref("Fired.Count"), number(0 if shape.passes else 1))
        ),
        equal(Indexed("Fired.Items", plain(1)), ref("T")),
    ]
    items: list[Decl] = []
    if shape.passes:
        names = [f.literal for f in shape.firings if is_segment(shape, f)]
        items = [
            Subprogram(
                "Is_Segment",
                (Param("T", "in", "Selection"),),
                "Boolean",
                expression=one_of(ref("T"), names),
            ),
            Comment("Does it go on from a choice or history?"),
        ]
        rest = call("Is_Segment", _ITEM)
        first.append(ForAll("I", Range(plain(2), _COUNT), rest))
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
    return OperatorChain("or else", (call("Is_Segment", _item(index)), fact))


def _choice(shape: RegionShape, lane: Lane) -> Expr:
    return ref("C", shape.lane_name(lane))


def _follows(shape: RegionShape) -> Expr:
    facts = both(_is_of(shape, shape.busy_lanes[-1]), _ORDERED, *_asked(shape, shape.busy_lanes))
    deferrals = tuple(
        (call("Is_Deferral", lane), call("Is_Only", ref("Fired"), lane))
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
        (OperatorChain("/=", (_choice(shape, n), ref("None"))), _fired(shape, n)) for n in lanes
    )
    return [IfExpr(tuple(rows), None)]


def _has(shape: RegionShape, lane: Lane) -> Expr:
    """What is chosen for a lane is fired, unless what conflicts with it was."""
    asked: list[Expr] = [OperatorChain("/=", (_choice(shape, lane), ref("None")))]
    before = shape.busy_lanes[: shape.busy_lanes.index(lane)]
    asked += [Prefix("not", clash) for clash in _clashes(shape, lane, before)]
    return IfExpr(((both(*asked), _fired(shape, lane)),), None)


def _fired(shape: RegionShape, lane: Lane) -> Expr:
    return call("Has", ref("Fired"), _choice(shape, lane))


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
            stays = [Prefix("not", call(f"Has_Left_{s}", ref("Fired"))) for s in around]
            asked: list[Expr] = [OperatorChain("/=", (_choice(shape, lane), ref("None"))), *stays]
            same = [
                equal(shape.at(shape.held, n), shape.at(BEFORE, n))
                for n in shape.lanes_around(lane)
            ]
            yield IfExpr(((both(*asked), both(*same)),), None)


def _overtaken(shape: RegionShape, lane: Lane) -> bool:
    """Can what earlier lanes fire disable what was chosen for this one? Where they go on from
    choices and histories this is asked rather than proved."""
    return shape.passes or any(lane in shape.lanes_in(s) for s in shape.watched)


def followed(shape: RegionShape) -> Expr:
    """What Step says of all that it has fired."""
    begun = equal(ref("Now"), ref("Start_Of_Region"))
    choice = Call("Choose", shape.situation_args(Self=old("Self")))
    only = call("Is_Only", ref("Fired"), ref(START))
    follows = call("Follows", ref("Fired"), choice)
    #  no `if`: 'Old behind a condition known on entry wants an exception handler
    goes_on = OperatorChain("/=", (ref("Now"), ref("Start_Of_Region")))
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
        held, ghost = shape.held, (Aspect("Ghost"),)
        declared.append(Object(BEFORE, shape.place_type, held, constant=True, aspects=ghost))
    return _step(shape, moves, profile, declared, (choose, *work))


def passing_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """One transition, then the segments that its way passes."""
    pick = Assign("Chosen", whole(shape, shape.lanes[0]))
    some = OperatorChain("/=", (ref("Chosen"), ref("None")))
    work = (pick, IfStatement(((some, (do("Fire_Whole", ref("Chosen")),)),)))
    return _step(shape, moves, profile, [Object("Chosen", "Selection")], work)


def _step(
    shape: RegionShape,
    moves: Moves,
    profile: tuple[Param, ...],
    declared: Sequence[Decl],
    work: tuple[Stmt, ...],
) -> Subprogram:
    """At the start of the region its initial entry; later ``work``, with what it declares."""
    begun = equal(ref("Now"), ref("Start_Of_Region"))
    return Subprogram(
        "Step",
        profile,
        declarations=(*declared, _fire_whole(shape, moves)),
        body=(
            Assign("Fired", _nothing()),
            IfStatement(((begun, (do("Fire_Whole", ref(START)),)),), work),
        ),
    )


def _lane(shape: RegionShape, lane: Lane) -> Stmt:
    """Fire the transition of a lane, unless an earlier one left its state, or it would leave
    a state in which an earlier one fired: one that was dropped is no obstacle."""
    chosen = _choice(shape, lane)
    free: list[Expr] = [OperatorChain("/=", (chosen, ref("None")))]
    around = [s for s in shape.watched if lane in shape.lanes_in(s)]
    for state in around:
        inside = shape.lanes_in(state)
        earlier = inside[: inside.index(lane)]
        if not earlier:
            continue
        name = ada_case(state)
        still = [Prefix("not", call("Has", ref("Fired"), _choice(shape, n))) for n in earlier]
        stays = Prefix("not", call(f"Leaves_{name}", chosen))
        free.append(Prefix("not", call(f"Has_Left_{name}", ref("Fired"))))
        free.append(OperatorChain("or else", (stays, chain("and then", still))))
    if lane != shape.busy_lanes[0] and _overtaken(shape, lane):
        free.append(call("In_Source", chosen, shape.held))
    return IfStatement(((chain("and then", free), (do("Fire_Whole", chosen),)),))


def _so_far(shape: RegionShape, lane: Lane) -> Pragma:
    """What has been fired of the lanes up to this one; types bound it when it is the last."""
    done = shape.busy_lanes[: shape.busy_lanes.index(lane) + 1]
    few: list[Expr] = []
    if lane != shape.busy_lanes[-1]:
        few = [OperatorChain("<=", (_COUNT, number(len(done) * (1 + shape.most_segments))))]
    of_lanes = _is_of(shape, lane)
    facts = (*few, of_lanes, _ORDERED, *_asked(shape, done), *_unmoved(shape, done))
    return Pragma("Assert", (both(*facts),))


def _fire_whole(shape: RegionShape, moves: Moves) -> Subprogram:
    """A transition with the segments that its way passes, and note what fired."""
    held = shape.held
    safe = moves.safety.holds()
    most = shape.most_segments
    before = shape.most_firings - 1 - most
    room = OperatorChain("<=" if before else "=", (_COUNT, number(before)))
    left = call("Segments_Left", held)
    body: list[Stmt] = [fire(moves, "T"), *_note("T")]
    declarations: tuple[Decl, ...] = ()
    count = old(_COUNT)
    grown: Expr = equal(_COUNT, _more(count, 1))
    settled: list[Expr] = []
    if most:
        ghost = (Aspect("Ghost"),)
        declarations = (
            Object("Before", "Firing_List", ref("Fired"), constant=True, aspects=ghost),
            Object("Segment", "Selection"),
        )
        bound = OperatorChain("<=", (left, OperatorChain("-", (number(most + 1), ref("I")))))
        counted = equal(_COUNT, OperatorChain("+", (ref("Before.Count"), ref("I"))))
        noted = _noted(shape, ref("Before.Count"), ref("Before.Items"))
        going_on = Pragma("Loop_Invariant", (both(counted, *noted, bound, *safe),))
        body.append(
            Loop(
                ForLoop("I", up_to(plain(most))),
                (
                    going_on,
                    IfStatement(((equal(left, number(0)), (ExitStatement(),)),)),
                    Assign("Segment", segment(shape)),
                    fire(moves, "Segment"),
                    *_note("Segment"),
                ),
            )
        )
        if before:
            grown = member(_COUNT, Range(_more(count, 1), _more(count, most + 1)))
        else:
            grown = OperatorChain(">=", (_COUNT, number(1)))
        settled = [equal(left, number(0))]
    else:
        settled = [equal(held, shape.target("T"))]
    facts = (grown, *_noted(shape, count, old("Fired.Items")), *settled, *safe)
    return Subprogram(
        "Fire_Whole",
        (Param("T", "in", "Firing"),),
        aspects=(Aspect("Pre", both(moves.ready("T"), room)), Aspect("Post", both(*facts))),
        declarations=declarations,
        body=tuple(body),
    )


def _more(count: Expr, by: int) -> Expr:
    return OperatorChain("+", (count, plain(by)))


def _noted(shape: RegionShape, count: Expr, items: DottedName | Attribute) -> list[Expr]:
    """The transition and its segments stand behind what was fired before."""
    item = _item("J")
    facts: list[Expr] = [
        ref("Self.Started"),
        equal(Indexed("Fired.Items", _more(count, 1)), ref("T")),
        ForAll("J", up_to(count), equal(item, Indexed(items, ref("J")))),
    ]
    if shape.passes:
        behind = Range(_more(count, 2), _COUNT)
        facts.append(ForAll("J", behind, call("Is_Segment", item)))
    return facts


def _note(fired: str) -> tuple[Stmt, ...]:
    """It is the last that has fired."""
    return (
        Assign(_COUNT, OperatorChain("+", (_COUNT, number(1)))),
        Assign(Indexed("Fired.Items", _COUNT), ref(fired)),
    )
