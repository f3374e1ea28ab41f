# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Selection: for one occurrence the transition of each lane, by small functions.

There is one for each composite state, with what its leaves select. A leaf has its own
among many: what the prover must see at a time stays small. A leaf asks for the transitions
of the states around it by a function of the innermost of them, which asks on.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Aspect, Decl, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    Arg,
    Attribute,
    Call,
    CaseExpr,
    Expr,
    ForAll,
    IfExpr,
    OperatorChain,
    Prefix,
    Qualified,
    Range,
    both,
    call,
    chain,
    equal,
    member,
    number,
    result,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, IfStatement, Return, Stmt
from ravenchart.gen.emit.language.compound import PASSED, TOP, Firing
from ravenchart.gen.emit.language.places import flat
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.statechart import Lane

from .safety import used
from .shape import PASSING, RegionShape

FEW = 8
"""Up to so many leaves are selected for by the function of the state around them."""
MANY = 80
"""A lane of more transitions has a function for each leaf beside composites: the prover sees
either one leaf or what its functions promise, and never both."""
WORTH = 2
"""So many transitions of the states around its leaves a state has a function for."""
_BOUNDS = (Param("First", "in", "Transition"), Param("Last", "in", "Transition"))


# --- the declared form


def enabled(shape: RegionShape, chosen: Expr, **replaced: Expr) -> Call:
    """A call of `Enabled`."""
    return Call("Enabled", (Arg(None, chosen), *shape.situation_args(**replaced)))


def is_selection(shape: RegionShape) -> Subprogram:
    """What it means that a transition is the first one enabled."""
    among = ref("Transition") if shape.single else Range(ref("First"), ref("Last"))
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
    """A call of that function over the transitions of a lane."""
    own = shape.transitions_of(lane)
    ends = () if shape.single else ("First", "Last")
    bounds = (Arg(None, Attribute(own, end)) for end in ends)
    return Call("Is_Selection", (Arg(None, chosen), *bounds, *shape.situation_args(**replaced)))


# --- the code


def selectors(shape: RegionShape) -> list[Decl]:
    """One function per state, leaves first; the last is the whole selection."""
    if shape.single:
        return [*_of_lane(shape, shape.lanes[0]), *_segments(shape)]
    lanes = [d for lane in shape.busy_lanes for d in _of_lane(shape, lane)]
    return [*lanes, *_segments(shape), _choose(shape)]


def whole(shape: RegionShape, lane: Lane) -> Call:
    """The selection of a lane."""
    return Call(_whole_name(shape, lane), shape.situation_args())


def segment(shape: RegionShape) -> Expr:
    """The selection of a segment, over the state of the region."""
    return call("Select_Segment", *(ref(p.name) for p in shape.situation if p.name != "Now"))


def _segments(shape: RegionShape) -> list[Decl]:
    """The function that says how to go on from a choice or history."""
    passed = [p.name for p in shape.region.pseudostates if p.kind in PASSED]
    if not passed:
        return []
    held = shape.held
    args = shape.situation_args(Now=ref(PASSING))
    rows = [(shape.in_state(held, p), Call(f"In_{ada_case(p)}", args)) for p in passed]
    chosen: Expr = IfExpr(tuple(rows[:-1]), rows[-1][1]) if rows[1:] else rows[0][1]
    waits = OperatorChain(">", (call("Segments_Left", held), number(0)))
    found = result("Select_Segment")
    post = both(enabled(shape, found, Now=ref(PASSING)), call("Is_Segment", found))
    return [
        Subprogram(
            "Select_Segment",
            tuple(p for p in shape.situation if p.name != "Now"),
            "Transition",
            aspects=(Aspect("Pre", waits), Aspect("Post", post)),
            expression=chosen,
        )
    ]


def _of_lane(shape: RegionShape, lane: Lane) -> list[Decl]:
    """The functions of the states around leaves, outermost first, and those of all that stands
    in the lane."""
    place = TOP if lane.owner is None else Place(lane.owner, lane.name)
    around: list[Decl] = []
    for state in shape.region.states:
        if shape.region.lane(state.name) == lane and _has_own(shape, lane, state.name):
            chosen = _selected(shape, lane, state.name)
            params = used(shape.situation, chosen)
            name = f"Around_{ada_case(state.name)}"
            around.append(Subprogram(name, params, "Selection", expression=chosen))
    return [*around, *_of_place(shape, lane, place)]


def _around(shape: RegionShape, lane: Lane, state: str) -> Expr:
    """A call of the function of a composite state."""
    params = used(shape.situation, _selected(shape, lane, state))
    return call(f"Around_{ada_case(state)}", *(ref(p.name) for p in params))


def _asked(shape: RegionShape, lane: Lane, state: str) -> list[Firing]:
    """The firings from a state and those around it, in order of precedence."""
    inside = shape.ancestors(state)
    return [f for f in shape.firings if f.lane == lane and f.sources[0] in inside]


def _has_own(shape: RegionShape, lane: Lane, state: str) -> bool:
    """Is there a function for what leaves of a composite state share?"""
    if shape.is_literal(state):
        return False
    leaves = list(shape.literals_in(Place(state, shape.region.state(state).regions[0].name)))
    return len(leaves) > 1 and len(_asked(shape, lane, state)) >= WORTH


def _selected(shape: RegionShape, lane: Lane, state: str) -> Expr:
    """What is selected when a leaf is active, or for the leaves of a composite state."""
    asked = _asked(shape, lane, state)
    otherwise: Expr = ref("None")
    for outer in shape.ancestors(state)[1:]:
        if shape.region.pseudostate(outer) is None and _has_own(shape, lane, outer):
            shared = _asked(shape, lane, outer)
            if asked[len(asked) - len(shared) :] == shared:
                otherwise = _around(shape, lane, outer)
                asked = asked[: len(asked) - len(shared)]
                break
    branches = [(_condition(shape, f), ref(f.literal)) for f in asked]
    return IfExpr(tuple(branches), otherwise) if branches else otherwise


def _of_place(shape: RegionShape, lane: Lane, place: Place) -> list[Decl]:
    """The functions of what stands in a region of a lane, then that of the region."""
    items: list[Decl] = []
    rows: list[tuple[DottedName, Expr]] = []
    children = [s.name for s in shape.region.children(place.owner, place.region)]
    literals = tuple(shape.literals_in(place))
    at_once = len(literals) <= FEW
    beside = sum(map(shape.is_literal, children)) <= FEW
    few = at_once or (beside and sum(f.lane == lane for f in shape.firings) <= MANY)
    for child in literals if at_once else (*children, *shape.compounds.passed(place)):
        passing = shape.region.pseudostate(child) is not None
        chosen: Expr = Call(f"In_{ada_case(child)}", shape.situation_args())
        if few and not passing and shape.is_literal(child):
            chosen = _selected(shape, lane, child)
        elif shape.is_literal(child):
            items.append(_function(shape, lane, child, _selected(shape, lane, child)))
        else:
            region = shape.region.state(child).regions[0].name
            items += _of_place(shape, lane, Place(child, region))
        rows.append((shape.literal(child), chosen))
    leaf = shape.at(shape.held, lane)
    if place != TOP and (place.owner != lane.owner or place.region != lane.name):
        owner = place.owner or ""
        chosen = CaseExpr(Qualified(shape.literal(owner), leaf), rows)
        return [*items, _function(shape, lane, owner, chosen)]
    chosen = CaseExpr(leaf, rows)
    if lane.owner is not None:
        active = shape.in_state(shape.held, lane.owner)
        chosen = IfExpr(((active, chosen),), ref("None"))
    name = _whole_name(shape, lane)
    right = Aspect("Post", is_selected(shape, result(name), lane))
    params = shape.situation
    return [*items, Subprogram(name, params, "Selection", aspects=(right,), expression=chosen)]


def _function(shape: RegionShape, lane: Lane, state: str, chosen: Expr) -> Subprogram:
    """The selection where a state is active."""
    name = f"In_{ada_case(state)}"
    active = Aspect("Pre", shape.in_state(shape.held, state))
    right = Aspect("Post", is_selected(shape, result(name), lane))
    aspects = (active, right)
    return Subprogram(name, shape.situation, "Selection", aspects=aspects, expression=chosen)


def _whole_name(shape: RegionShape, lane: Lane) -> str:
    return "Select_Transition" if shape.single else f"Select_{shape.lane_name(lane)}"


def _condition(shape: RegionShape, firing: Firing) -> Expr:
    """When a firing is enabled, given that its first source is active."""
    held = shape.held
    more = [shape.in_state(held, s) for s in firing.sources[1:]]
    return both(*flat([*more, shape.enabled_when[firing.literal]]))


def _choose(shape: RegionShape) -> Subprogram:
    """All lanes; one around another selects only when the inner one does not."""
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
