# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Selection: the first enabled transition of a top-level or orthogonal region, as declared.

One loop goes over the transitions in the declared order and ends at the first that `Enabled`
holds for. `Enabled` looks at the source first, so a transition of another state needs one
comparison.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    Arg,
    Attribute,
    Call,
    Expr,
    ForAll,
    IfExpr,
    OperatorChain,
    Prefix,
    Range,
    RangeConstrained,
    both,
    call,
    chain,
    equal,
    member,
    number,
    result,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.statements import (
    Assign,
    ForLoop,
    IfStatement,
    Loop,
    Pragma,
    Return,
    Stmt,
)
from ravenchart.gen.emit.language.compound import PASSED
from ravenchart.gen.model.statechart import Lane

from .shape import PASSING, RegionShape

_ALL = "Transition"
_BOUNDS = (Param("First", "in", _ALL), Param("Last", "in", _ALL))
_SELECTED = "Selected"
_SEGMENT = "Next_Segment"


# --- the declared form


def enabled(shape: RegionShape, chosen: Expr, **replaced: Expr) -> Call:
    """A call of `Enabled`."""
    return Call("Enabled", (Arg(None, chosen), *shape.situation_args(**replaced)))


def is_selection(shape: RegionShape) -> Subprogram:
    """The condition that a transition is the first enabled one."""
    among = ref(_ALL) if shape.single else Range(ref("First"), ref("Last"))
    one, chosen = ref("T"), ref("Chosen")
    none = equal(chosen, ref("None"))
    rule = chain("or else", [none, both(member(chosen, among), enabled(shape, chosen))])
    earlier = OperatorChain("<", (one, chosen))
    denied = IfExpr(((earlier, Prefix("not", enabled(shape, one))),), None)
    bounds = () if shape.single else _BOUNDS
    return Subprogram(
        "Is_Selection",
        (Param("Chosen", "in", "Selection"), *bounds, *shape.situation),
        "Boolean",
        aspects=(Aspect("Ghost"),),
        expression=both(rule, ForAll("T", among, denied)),
    )


def is_selected(shape: RegionShape, chosen: Expr, lane: Lane, **replaced: Expr) -> Call:
    """A call of that function over the transitions of a region."""
    args = (Arg(None, chosen), *_bounds(shape, shape.transitions_of(lane)))
    return Call("Is_Selection", (*args, *shape.situation_args(**replaced)))


def _bounds(shape: RegionShape, among: str) -> tuple[Arg, ...]:
    """The first and the last of the transitions, where there are orthogonal regions."""
    ends = () if shape.single else ("First", "Last")
    return tuple(Arg(None, Attribute(among, end)) for end in ends)


# --- the code


def selectors(shape: RegionShape) -> list[Decl]:
    """The selection among transitions, of segments, and for all orthogonal regions."""
    return [_selected(shape), *_segments(shape), *([] if shape.single else [_choose(shape)])]


def whole(shape: RegionShape, lane: Lane) -> Call:
    """The selection of a top-level or orthogonal region."""
    bounds = _bounds(shape, shape.transitions_of(lane))
    return Call(_SELECTED, (*bounds, *shape.situation_args()))


def segment(shape: RegionShape) -> Expr:
    """The selection of a segment, over the state of the region."""
    return call(_SEGMENT, *(ref(p.name) for p in shape.situation if p.name != "Now"))


def _selected(shape: RegionShape) -> Subprogram:
    """The loop over the declared transitions."""
    bounds = () if shape.single else _BOUNDS
    params = (*bounds, *shape.situation)
    post = call("Is_Selection", result(_SELECTED), *(ref(p.name) for p in params))
    first: DottedName | Attribute = ref("First")
    among: DottedName | RangeConstrained = RangeConstrained(_ALL, Range(first, ref("Last")))
    if shape.single:
        first, among = Attribute(_ALL, "First"), ref(_ALL)
    one = ref("T")
    none_yet = ForAll("J", Range(first, one), Prefix("not", enabled(shape, ref("J"))))
    search = Loop(
        ForLoop("T", among),
        (
            IfStatement(((enabled(shape, one), (Return(one),)),)),
            Pragma("Loop_Invariant", (none_yet,)),
        ),
    )
    return Subprogram(
        _SELECTED,
        params,
        "Selection",
        aspects=(Aspect("Post", post),),
        body=(search, Return(ref("None"))),
    )


def _segments(shape: RegionShape) -> list[Decl]:
    """The function that says how to go on from a choice or history."""
    passed = [p.name for p in shape.region.pseudostates if p.kind in PASSED]
    if not passed:
        return []
    ways: list[Stmt] = []
    for pseudo in passed:
        out = [f.literal for f in shape.firings if f.sources[0] == pseudo]
        some = chain("or else", [enabled(shape, ref(name), Now=ref(PASSING)) for name in out])
        there = IfExpr(((shape.in_state(shape.held, pseudo), some),), None)
        ways.append(Pragma("Assert", (there,)))
    waits = OperatorChain(">", (call("Segments_Left", shape.held), number(0)))
    found = result(_SEGMENT)
    post = both(enabled(shape, found, Now=ref(PASSING)), call("Is_Segment", found))
    all_lanes = Call(_SELECTED, (*_bounds(shape, _ALL), *shape.situation_args(Now=ref(PASSING))))
    return [
        Subprogram(
            _SEGMENT,
            tuple(p for p in shape.situation if p.name != "Now"),
            _ALL,
            aspects=(Aspect("Pre", waits), Aspect("Post", post)),
            body=(*ways, Return(all_lanes)),
        )
    ]


def _choose(shape: RegionShape) -> Subprogram:
    """All regions; one around another selects only when the inner one does not."""
    steps: list[Stmt] = []
    for lane in shape.busy_lanes:
        take = Assign(ref("C", shape.lane_name(lane)), whole(shape, lane))
        idle = [equal(ref("C", shape.lane_name(n)), ref("None")) for n in shape.inner_lanes(lane)]
        steps.append(IfStatement(((chain("and then", idle), (take,)),)) if idle else take)
    return Subprogram(
        "Choose",
        shape.situation,
        "Choice",
        declarations=(Object("C", "Choice"),),
        body=(*steps, Return(ref("C"))),
    )
