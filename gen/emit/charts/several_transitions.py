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
from ravenchart.gen.model.statechart import TOP, RegionId

from .firing import Moves
from .selection import segment, whole
from .shape import START, RegionShape


def fire(moves: Moves, chosen: str) -> Do:
    names = (p.name for p in moves.fire_params())
    return do("Fire", *(ref(chosen if n == "Chosen" else n) for n in names))


# --- The contract ------------------------------------------------------------


def firing_list(shape: RegionShape) -> list[Decl]:
    """The list of the transitions that one step takes, with the segments that it may hold."""
    names = [f.literal for f in shape.firings if leaves_choice_or_history(shape, f)]
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


def declared_choice(shape: RegionShape) -> list[Decl]:
    """Choose, and the transitions of a choice that a step may take."""
    if shape.single:
        return []
    fired = Param("Fired", "in", LIST)
    params = shape.situation
    chosen = Call("Is_Choice", (Arg(None, result("Choose")), *shape.situation_args()))
    choice = Param("C", "in", "Choice")
    pre = (Aspect("Pre", one) for one in shape.begins)
    ghost = (Aspect("Ghost"),)
    return [
        Subprogram("Choose", params, "Choice", aspects=(*pre, Aspect("Post", chosen))),
        Comment("The transitions selected for one occurrence."),
        Subprogram(
            _IS_OF,
            (fired, choice, Param("Last", "in", "Selection")),
            "Boolean",
            aspects=ghost,
            expression=both(call("Firings.Is_Ordered", _FIRED), _of_choice(shape)),
        ),
        Comment(_ONLY_CHOSEN.format(", besides segments" if shape.passes else "")),
        Subprogram(
            "Follows", (fired, choice), "Boolean", aspects=ghost, expression=_follows(shape)
        ),
        Comment(_told(shape)),
    ]


def _of_choice(shape: RegionShape) -> Expr:
    """Each is selected for a region, or goes on from a choice or history."""
    chosen = (ref("C", shape.label(n)) for n in shape.busy_regions)
    due: Expr = both(OperatorChain("<=", (_ITEM, ref("Last"))), member(_ITEM, *chosen))
    if shape.passes:
        due = OperatorChain("or else", (call("Is_Segment", _ITEM), due))
    return ForAll("I", up_to(_COUNT), due)


def _is_of(shape: RegionShape, region: RegionId) -> Expr:
    last = Attribute(shape.transitions_of(region), "Last")
    return call(_IS_OF, _FIRED, ref("C"), last)


BEFORE = "Configuration_Before"
"""The configuration before any transition is taken."""

LIST = ref("Firings.List")
"""The type of the list of transitions that a step takes."""

_IS_OF = "Is_Of_Choice"
_FIRED = ref("Fired")
_COUNT = ref("Fired.Count")
_ITEM = Indexed("Fired.Items", ref("I"))
_SEGMENTS = "Whether T leaves a choice or history."
_NO_SEGMENTS = "True for None only: the chart has neither choices nor histories."
_ONLY_CHOSEN = (
    "Whether Fired holds only transitions of C, none after Last, in the order of the regions{}."
)
_FOLLOWS = "Whether Fired holds the transitions of C{}, in the order of the regions, and no others."
_ALONE = " A deferral is taken alone."
_DROPPED = (
    " Of two transitions that conflict only the earlier one is taken. Two conflict where one "
    "leaves a state that holds the region of the other."
)
_FIRST_ONLY = (
    " Only the first transition of C is taken for certain: the segments behind it can change the "
    "configuration before the others."
)


def _told(shape: RegionShape) -> str:
    """The comment on `Follows`."""
    found = _FOLLOWS.format(", with segments" if shape.passes else "")
    found += _ALONE if _deferring(shape) else ""
    if shape.passes:
        return found + _FIRST_ONLY
    return found + (_DROPPED if shape.watched else "")


def is_only(chosen: Expr) -> Expr:
    """That one is taken, with the segments of its way, and nothing else."""
    return call("Firings.Is_Only", _FIRED, chosen)


def leaves_choice_or_history(shape: RegionShape, firing: Firing) -> bool:
    """Whether it is a segment behind a choice or history."""
    return shape.region.pseudostate(firing.sources[0]) is not None


def _choice(shape: RegionShape, region: RegionId) -> Expr:
    return ref("C", shape.label(region))


def _follows(shape: RegionShape) -> Expr:
    facts = both(_is_of(shape, shape.busy_regions[-1]), *_asked(shape, shape.busy_regions))
    deferrals = tuple((call("Is_Deferral", one), is_only(one)) for one in _deferring(shape))
    return IfExpr(deferrals, facts) if deferrals else facts


def _deferring(shape: RegionShape) -> list[Expr]:
    """The selections for the regions that have deferrals."""
    regions = {f.region for f in shape.firings if f.kind is FiringKind.DEFERRAL}
    return [_choice(shape, n) for n in shape.busy_regions if n in regions]


def _asked(shape: RegionShape, regions: Sequence[RegionId]) -> list[Expr]:
    """That each transition selected for these regions is taken, unless it conflicts with an
    earlier one. Where ways go on from choices and histories, only the first selected one is."""
    if not shape.passes:
        return [fact for n in regions for fact in (_has(shape, n), *_apart(shape, n))]
    rows = (
        (OperatorChain("/=", (_choice(shape, n), ref("None"))), _fired(shape, n)) for n in regions
    )
    return [IfExpr(tuple(rows), None)]


def _has(shape: RegionShape, region: RegionId) -> Expr:
    """That the transition selected for a region is taken, unless one in conflict with it was."""
    asked: list[Expr] = [OperatorChain("/=", (_choice(shape, region), ref("None")))]
    before = shape.busy_regions[: shape.busy_regions.index(region)]
    asked += [Prefix("not", clash) for clash in _clashes(shape, region, before)]
    return IfExpr(((both(*asked), _fired(shape, region)),), None)


def _fired(shape: RegionShape, region: RegionId) -> Expr:
    return call("Firings.Has", _FIRED, _choice(shape, region))


def _clashes(shape: RegionShape, region: RegionId, others: Sequence[RegionId]) -> Iterator[Expr]:
    """For each of the others: it was taken, and one of both leaves a state around the other."""
    for other in others:
        leaving = [
            call(f"Leaves_{ada_case(state)}", _choice(shape, one))
            for state in shape.watched
            if {region, other} <= set(shape.busy_inside(state))
            for one in (other, region)
        ]
        if leaving:
            yield both(_fired(shape, other), chain("or else", leaving))


def _apart(shape: RegionShape, region: RegionId) -> Iterator[Expr]:
    """That the transition taken for a region conflicts with none taken for an earlier one."""
    before = shape.busy_regions[: shape.busy_regions.index(region)]
    for clash in _clashes(shape, region, before):
        yield Prefix("not", both(_fired(shape, region), clash))


def _unmoved(shape: RegionShape, done: Sequence[RegionId]) -> Iterator[Expr]:
    """That a region still to come is as it was, if it has a selection and no state around it was
    left. Of a region with one leaf the compiler knows that."""
    for region in () if shape.passes else shape.busy_regions[len(done) :]:
        around = [ada_case(s) for s in shape.watched if region in shape.busy_inside(s)]
        moving = [n for n in shape.enclosing(region) if len(shape.literals(n)) > 1]
        if around and moving:
            stays = [Prefix("not", call(f"Has_Left_{s}", _FIRED)) for s in around]
            some = OperatorChain("/=", (_choice(shape, region), ref("None")))
            same = [equal(shape.at(shape.held, n), shape.at(BEFORE, n)) for n in moving]
            yield IfExpr(((both(some, *stays), both(*same)),), None)


def _overtaken(shape: RegionShape, region: RegionId) -> bool:
    """Can the transitions of earlier regions disable that selected for this one?

    Where they go on from choices and histories this is tested rather than proved."""
    return shape.passes or any(region in shape.busy_inside(s) for s in shape.watched)


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


def concurrent_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """Every region's transition in order; one that conflicts with an earlier one is dropped."""
    work: tuple[Stmt, ...] = (
        *moves.safety.alone(),
        *(s for one in shape.busy_regions for s in (_take(shape, one), *_so_far(shape, one))),
    )
    if deferred := _deferring(shape):
        rows = [(call("Is_Deferral", one), (do("Fire_Whole", one),)) for one in deferred]
        work = (IfStatement(tuple(rows), work),)
    choose = Assign("C", Call("Choose", shape.situation_args()))
    declared: list[Decl] = [Object("C", "Choice")]
    if shape.watched and not shape.passes:
        held, ghost = shape.held, (Aspect("Ghost"),)
        declared.append(
            Object(BEFORE, shape.configuration_type, held, constant=True, aspects=ghost)
        )
    return _step(shape, moves, profile, declared, (choose, *work))


def passing_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """One transition, then the segments that its way passes."""
    pick = Assign("Chosen", whole(shape, TOP))
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


def _take(shape: RegionShape, region: RegionId) -> Stmt:
    """Take the transition of a region, unless an earlier one left its state, or it would leave a
    state in which an earlier one was taken. One that was dropped is no obstacle."""
    chosen = _choice(shape, region)
    free: list[Expr] = [OperatorChain("/=", (chosen, ref("None")))]
    around = [s for s in shape.watched if region in shape.busy_inside(s)]
    for state in around:
        inside = shape.busy_inside(state)
        earlier = inside[: inside.index(region)]
        if not earlier:
            continue
        name = ada_case(state)
        still = [Prefix("not", _fired(shape, n)) for n in earlier]
        stays = Prefix("not", call(f"Leaves_{name}", chosen))
        free.append(Prefix("not", call(f"Has_Left_{name}", _FIRED)))
        free.append(OperatorChain("or else", (stays, chain("and then", still))))
    if region != shape.busy_regions[0] and _overtaken(shape, region):
        free.append(call("In_Source", chosen, shape.held))
    return IfStatement(((chain("and then", free), (do("Fire_Whole", chosen),)),))


def _so_far(shape: RegionShape, region: RegionId) -> tuple[Pragma, ...]:
    """The transitions taken for the regions up to this one; types bound them when it is the last.

    After the last one provers need it only where transitions conflict.
    """
    done = shape.busy_regions[: shape.busy_regions.index(region) + 1]
    is_last = region == shape.busy_regions[-1]
    if is_last and (shape.passes or not shape.watched):
        return ()
    most = number(len(done) * (1 + shape.most_segments))
    few = () if is_last else (OperatorChain("<=", (_COUNT, most)),)
    facts = (*few, _is_of(shape, region), *_asked(shape, done), *_unmoved(shape, done))
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
