# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Steps that can take several transitions: one in each orthogonal region, with its segments.

`Follows` is the contract: a step takes the transitions selected for the regions, in the order of
these. A transition is dropped only when one that conflicts with it has been taken. Where ways go
on from choices and histories the contract is weaker: when an earlier region has taken one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.emit.ada.declarations import (
    Aspect,
    Decl,
    GenericInstance,
    Object,
    Param,
    Subprogram,
)
from ravenchart.gen.emit.ada.expressions import (
    Arg,
    Attribute,
    Call,
    Expr,
    ForAll,
    IfExpr,
    Indexed,
    OperatorChain,
    Prefix,
    arguments,
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
from ravenchart.gen.emit.ada.named import ref
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

from .firing import Moves
from .selection import segment, whole
from .shape import START, RegionShape


def fire(moves: Moves, chosen: str) -> Do:
    names = (p.name for p in moves.fire_params())
    return do("Fire", *(ref(chosen if n == "Chosen" else n) for n in names))


# --- The contract ------------------------------------------------------------


def firing_list(shape: RegionShape) -> list[Decl]:
    """The list of the transitions that one step takes, with the segments that it may hold."""
    names = [f.literal for f in shape.firings if is_segment(shape, f)]
    none = equal(ref("T"), ref("None"))
    chosen = Param("T", "in", "Selection")
    goes_on = one_of(ref("T"), names) if shape.passes else none
    return [
        Subprogram("Is_Segment", (chosen,), "Boolean", expression=goes_on),
        Comment(_SEGMENTS if shape.passes else _NO_SEGMENTS),
        GenericInstance(
            "Firings",
            "Ravenchart.Firing_Lists",
            arguments(
                Selection=ref("Selection"),
                No_Selection=ref("None"),
                Is_Segment=ref("Is_Segment"),
                Most_Segments=number(shape.most_segments),
                Capacity=number(shape.most_firings),
            ),
        ),
    ]


def declared_lanes(shape: RegionShape) -> list[Decl]:
    """Choose, and the transitions of a choice that a step may take."""
    if shape.single:
        return []
    fired = Param("Fired", "in", LIST)
    params = shape.situation
    chosen = Call("Is_Choice", (Arg(None, result("Choose")), *shape.situation_args()))
    choice = Param("C", "in", "Choice")
    ghost = (Aspect("Ghost"),)
    return [
        Subprogram("Choose", params, "Choice", aspects=(Aspect("Post", chosen),)),
        Comment("The transitions that one occurrence asks for."),
        Subprogram(
            _IS_OF,
            (fired, choice, Param("Last", "in", "Selection")),
            "Boolean",
            aspects=ghost,
            expression=both(call("Firings.Is_Ordered", _FIRED), _of_choice(shape)),
        ),
        Comment("Is what has fired chosen, in the order of the lanes, and none of it after Last?"),
        Subprogram(
            "Follows", (fired, choice), "Boolean", aspects=ghost, expression=_follows(shape)
        ),
        Comment(_FOLLOWS + (_DROPPED if shape.watched and not shape.passes else _OVERTAKEN)),
    ]


def _of_choice(shape: RegionShape) -> Expr:
    """Each is selected for a region, or goes on from a choice or history."""
    chosen = (ref("C", shape.lane_name(n)) for n in shape.busy_lanes)
    due: Expr = both(OperatorChain("<=", (_ITEM, ref("Last"))), member(_ITEM, *chosen))
    if shape.passes:
        due = OperatorChain("or else", (call("Is_Segment", _ITEM), due))
    return ForAll("I", up_to(_COUNT), due)


def _is_of(shape: RegionShape, lane: Lane) -> Expr:
    last = Attribute(shape.transitions_of(lane), "Last")
    return call(_IS_OF, _FIRED, ref("C"), last)


BEFORE = "Configuration_Before"
"""The configuration before any transition is taken."""

LIST = ref("Firings.List")
"""The type of the list of transitions that a step takes."""

_IS_OF = "Is_Of_Choice"
_FIRED = ref("Fired")
_COUNT = ref("Fired.Count")
_ITEM = Indexed("Fired.Items", ref("I"))
_SEGMENTS = "Does it go on from a choice or history?"
_NO_SEGMENTS = "None does: the chart has neither choices nor histories."
_FOLLOWS = (
    "A deferral is fired alone. Otherwise what is chosen is fired, lane by lane, and nothing else; "
)
_OVERTAKEN = "a lane inside a state that transitions leave may be overtaken by an earlier one."
_DROPPED = "of two that conflict, as one leaves a state in which the other fires, the earlier one."


def is_only(chosen: Expr) -> Expr:
    """That one is taken, with the segments of its way, and nothing else."""
    return call("Firings.Is_Only", _FIRED, chosen)


def is_segment(shape: RegionShape, firing: Firing) -> bool:
    """Does it go on from a choice or history?"""
    return shape.region.pseudostate(firing.sources[0]) is not None


def _choice(shape: RegionShape, lane: Lane) -> Expr:
    return ref("C", shape.lane_name(lane))


def _follows(shape: RegionShape) -> Expr:
    facts = both(_is_of(shape, shape.busy_lanes[-1]), *_asked(shape, shape.busy_lanes))
    deferrals = tuple((call("Is_Deferral", lane), is_only(lane)) for lane in _deferring(shape))
    return IfExpr(deferrals, facts) if deferrals else facts


def _deferring(shape: RegionShape) -> list[Expr]:
    """The selections for the regions that have deferrals."""
    lanes = {f.lane for f in shape.firings if f.kind is FiringKind.DEFERRAL}
    return [_choice(shape, n) for n in shape.busy_lanes if n in lanes]


def _asked(shape: RegionShape, lanes: Sequence[Lane]) -> list[Expr]:
    """That each transition selected for these regions is taken, unless it conflicts with an
    earlier one. Where ways go on from choices and histories, only the first selected one is."""
    if not shape.passes:
        return [fact for n in lanes for fact in (_has(shape, n), *_apart(shape, n))]
    rows = (
        (OperatorChain("/=", (_choice(shape, n), ref("None"))), _fired(shape, n)) for n in lanes
    )
    return [IfExpr(tuple(rows), None)]


def _has(shape: RegionShape, lane: Lane) -> Expr:
    """That the transition selected for a region is taken, unless one in conflict with it was."""
    asked: list[Expr] = [OperatorChain("/=", (_choice(shape, lane), ref("None")))]
    before = shape.busy_lanes[: shape.busy_lanes.index(lane)]
    asked += [Prefix("not", clash) for clash in _clashes(shape, lane, before)]
    return IfExpr(((both(*asked), _fired(shape, lane)),), None)


def _fired(shape: RegionShape, lane: Lane) -> Expr:
    return call("Firings.Has", _FIRED, _choice(shape, lane))


def _clashes(shape: RegionShape, lane: Lane, others: Sequence[Lane]) -> Iterator[Expr]:
    """For each of the others: it was taken, and one of both leaves a state around the other."""
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
    """That the transition taken for a region conflicts with none taken for an earlier one."""
    before = shape.busy_lanes[: shape.busy_lanes.index(lane)]
    for clash in _clashes(shape, lane, before):
        yield Prefix("not", both(_fired(shape, lane), clash))


def _unmoved(shape: RegionShape, done: Sequence[Lane]) -> Iterator[Expr]:
    """That a region still to come is as it was, if it has a selection and no state around it was
    left. Of a region with one leaf the compiler knows that."""
    for lane in () if shape.passes else shape.busy_lanes[len(done) :]:
        around = [ada_case(s) for s in shape.watched if lane in shape.lanes_in(s)]
        moving = [n for n in shape.lanes_around(lane) if len(shape.literals(n)) > 1]
        if around and moving:
            stays = [Prefix("not", call(f"Has_Left_{s}", _FIRED)) for s in around]
            asked: list[Expr] = [OperatorChain("/=", (_choice(shape, lane), ref("None"))), *stays]
            same = [equal(shape.at(shape.held, n), shape.at(BEFORE, n)) for n in moving]
            yield IfExpr(((both(*asked), both(*same)),), None)


def _overtaken(shape: RegionShape, lane: Lane) -> bool:
    """Can the transitions of earlier regions disable that selected for this one?

    Where they go on from choices and histories this is tested rather than proved."""
    return shape.passes or any(lane in shape.lanes_in(s) for s in shape.watched)


def followed(shape: RegionShape) -> Expr:
    """The postcondition of Step on the transitions that it has taken."""
    begun = equal(ref("Now"), ref("Start_Of_Region"))
    choice = Call("Choose", shape.situation_args(Self=old("Self")))
    only = is_only(ref(START))
    follows = call("Follows", _FIRED, choice)
    #  no `if`: 'Old behind a condition known on entry wants an exception handler
    goes_on = OperatorChain("/=", (ref("Now"), ref("Start_Of_Region")))
    return OperatorChain(
        "or", (OperatorChain("and", (begun, only)), OperatorChain("and", (goes_on, follows)))
    )


# --- The step ----------------------------------------------------------------


def lane_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """Every region's transition in order; one that conflicts with an earlier one is dropped."""
    work: tuple[Stmt, ...] = (
        *moves.safety.alone(),
        *(s for lane in shape.busy_lanes for s in (_lane(shape, lane), *_so_far(shape, lane))),
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
    """At the start of the region its initial entry; later ``work``, with its declarations."""
    begun = equal(ref("Now"), ref("Start_Of_Region"))
    return Subprogram(
        "Step",
        profile,
        declarations=(*declared, _fire_whole(shape, moves)),
        body=(
            Assign("Fired", ref("Firings.Nothing")),
            IfStatement(((begun, (do("Fire_Whole", ref(START)),)),), work),
        ),
    )


def _lane(shape: RegionShape, lane: Lane) -> Stmt:
    """Take the transition of a region, unless an earlier one left its state, or it would leave a
    state in which an earlier one was taken. One that was dropped is no obstacle."""
    chosen = _choice(shape, lane)
    free: list[Expr] = [OperatorChain("/=", (chosen, ref("None")))]
    around = [s for s in shape.watched if lane in shape.lanes_in(s)]
    for state in around:
        inside = shape.lanes_in(state)
        earlier = inside[: inside.index(lane)]
        if not earlier:
            continue
        name = ada_case(state)
        still = [Prefix("not", _fired(shape, n)) for n in earlier]
        stays = Prefix("not", call(f"Leaves_{name}", chosen))
        free.append(Prefix("not", call(f"Has_Left_{name}", _FIRED)))
        free.append(OperatorChain("or else", (stays, chain("and then", still))))
    if lane != shape.busy_lanes[0] and _overtaken(shape, lane):
        free.append(call("In_Source", chosen, shape.held))
    return IfStatement(((chain("and then", free), (do("Fire_Whole", chosen),)),))


def _so_far(shape: RegionShape, lane: Lane) -> tuple[Pragma, ...]:
    """The transitions taken for the regions up to this one; types bound them when it is the last.

    After the last one provers need it only where transitions conflict.
    """
    done = shape.busy_lanes[: shape.busy_lanes.index(lane) + 1]
    is_last = lane == shape.busy_lanes[-1]
    if is_last and (shape.passes or not shape.watched):
        return ()
    most = number(len(done) * (1 + shape.most_segments))
    few = () if is_last else (OperatorChain("<=", (_COUNT, most)),)
    facts = (*few, _is_of(shape, lane), *_asked(shape, done), *_unmoved(shape, done))
    return (Pragma("Assert", (both(*facts),)),)


def _fire_whole(shape: RegionShape, moves: Moves) -> Subprogram:
    """Take a transition with the segments that its way passes, and note each of them."""
    held = shape.held
    safe = moves.safety.holds()
    most = shape.most_segments
    before = shape.most_firings - 1 - most
    room = OperatorChain("<=" if before else "=", (_COUNT, number(before)))
    left = call("Segments_Left", held)
    body: list[Stmt] = [fire(moves, "T"), _note("T")]
    declarations: tuple[Decl, ...] = ()
    settled = equal(held, shape.target("T"))
    if most:
        ghost = (Aspect("Ghost"),)
        declarations = (
            Object("Before", LIST, _FIRED, constant=True, aspects=ghost),
            Object("Segment", "Selection"),
        )
        bound = OperatorChain("<=", (left, OperatorChain("-", (number(most + 1), ref("I")))))
        counted = equal(_COUNT, OperatorChain("+", (ref("Before.Count"), ref("I"))))
        added = call("Firings.Is_Added", ref("Before"), ref("T"), _FIRED)
        facts = both(counted, added, ref("Self.Started"), bound, *safe)
        body.append(
            Loop(
                ForLoop("I", up_to(plain(most))),
                (
                    Pragma("Loop_Invariant", (facts,)),
                    IfStatement(((equal(left, number(0)), (ExitStatement(),)),)),
                    Assign("Segment", segment(shape)),
                    fire(moves, "Segment"),
                    _note("Segment"),
                ),
            )
        )
        settled = equal(left, number(0))
    added = call("Firings.Is_Added", old(_FIRED), ref("T"), _FIRED)
    post = both(added, ref("Self.Started"), settled, *safe)
    return Subprogram(
        "Fire_Whole",
        (Param("T", "in", "Firing"),),
        aspects=(Aspect("Pre", both(moves.ready("T"), room)), Aspect("Post", post)),
        declarations=declarations,
        body=tuple(body),
    )


def _note(fired: str) -> Stmt:
    """Note a transition as the last one taken."""
    return do("Firings.Add", _FIRED, ref(fired))
