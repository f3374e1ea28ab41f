# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Selection: the first enabled transition of a top-level or orthogonal region, as declared.

A case over the occurrence gives the transitions with that trigger; `Enabled` is asked of each, in
the declared order. The compiler knows the transition and the occurrence there, so that a
comparison of the state and the guard are left.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    OTHERS,
    Arg,
    Attribute,
    Call,
    Choice,
    Expr,
    ForAll,
    IfExpr,
    OperatorChain,
    Prefix,
    Range,
    both,
    call,
    chain,
    equal,
    member,
    number,
    result,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import (
    Assign,
    IfStatement,
    Pragma,
    Return,
    Stmt,
    case_of,
)
from ravenchart.gen.emit.language.compound import PASSED, Firing
from ravenchart.gen.model.statechart import RegionId

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


def is_selected(shape: RegionShape, chosen: Expr, region: RegionId, **replaced: Expr) -> Call:
    """A call of that function over the transitions of a region."""
    args = (Arg(None, chosen), *_bounds(shape, shape.transitions_of(region)))
    return Call("Is_Selection", (*args, *shape.situation_args(**replaced)))


def _bounds(shape: RegionShape, among: str) -> tuple[Arg, ...]:
    """The first and the last of the transitions, where there are orthogonal regions."""
    ends = () if shape.single else ("First", "Last")
    return tuple(Arg(None, Attribute(among, end)) for end in ends)


# --- the code


def selectors(shape: RegionShape) -> list[Decl]:
    """The selection for each region, of segments, and for all orthogonal regions."""
    each = [_selected(shape, region) for region in shape.busy_regions]
    return [*each, *_segments(shape), *([] if shape.single else [_choose(shape)])]


def whole(shape: RegionShape, region: RegionId) -> Call:
    """The selection of a top-level or orthogonal region."""
    return Call(_name(shape, region), shape.situation_args())


def segment(shape: RegionShape) -> Expr:
    """The selection of a segment, over the state of the region."""
    return call(_SEGMENT, *(ref(p.name) for p in shape.situation if p.name != "Now"))


def _name(shape: RegionShape, region: RegionId) -> str:
    return _SELECTED if shape.single else f"{_SELECTED}_{shape.label(region)}"


def _selected(shape: RegionShape, region: RegionId) -> Subprogram:
    """The first enabled transition of a region. Segments are none: `_segments` has them."""
    own = [f for f in shape.firings if f.region == region]
    none = Return(ref("None"))
    rows: list[tuple[Choice | str, tuple[Stmt, ...]]] = []
    for occurrence in shape.occurrences():
        asked = [f for f in own if occurrence in shape.triggers(f)]
        if asked and occurrence != PASSING:
            rows.append((occurrence, (Return(_first(shape, asked)),)))
    name = _name(shape, region)
    pre = (Aspect("Pre", one) for one in shape.begins)
    return Subprogram(
        name,
        shape.situation,
        "Selection",
        aspects=(*pre, Aspect("Post", is_selected(shape, result(name), region))),
        body=(case_of(ref("Now"), [*rows, (OTHERS, (none,))]) if rows else none,),
    )


def _first(
    shape: RegionShape, among: Sequence[Firing], rest: str = "None", **replaced: Expr
) -> Expr:
    """The first of these that is enabled, or the rest."""
    literals = [ref(firing.literal) for firing in among]
    rows = tuple((enabled(shape, t, **replaced), t) for t in literals)
    return IfExpr(rows, ref(rest)) if rows else ref(rest)


def _segments(shape: RegionShape) -> list[Decl]:
    """The function that says how to go on from a choice or history."""
    passed = [p.name for p in shape.region.pseudostates if p.kind in PASSED]
    if not passed:
        return []
    lines = [f for f in shape.firings if f.sources[0] in passed]
    ways: list[Stmt] = []
    for pseudo in passed:
        out = [ref(f.literal) for f in lines if f.sources[0] == pseudo]
        some = chain("or else", [enabled(shape, t, Now=ref(PASSING)) for t in out])
        there = IfExpr(((shape.in_state(shape.held, pseudo), some),), None)
        ways.append(Pragma("Assert", (there,)))
    waits = OperatorChain(">", (call("Segments_Left", shape.held), number(0)))
    found = result(_SEGMENT)
    post = both(enabled(shape, found, Now=ref(PASSING)), call("Is_Segment", found))
    *others, last = lines
    return [
        Subprogram(
            _SEGMENT,
            tuple(p for p in shape.situation if p.name != "Now"),
            _ALL,
            aspects=(Aspect("Pre", waits), Aspect("Post", post)),
            body=(*ways, Return(_first(shape, others, last.literal, Now=ref(PASSING)))),
        )
    ]


def _choose(shape: RegionShape) -> Subprogram:
    """All regions; one around another selects only when the inner one does not."""
    steps: list[Stmt] = []
    for region in shape.busy_regions:
        take = Assign(ref("C", shape.label(region)), whole(shape, region))
        idle = [equal(ref("C", shape.label(r)), ref("None")) for r in shape.inner_regions(region)]
        steps.append(IfStatement(((chain("and then", idle), (take,)),)) if idle else take)
    return Subprogram(
        "Choose",
        shape.situation,
        "Choice",
        declarations=(Object("C", "Choice"),),
        body=(*steps, Return(ref("C"))),
    )
