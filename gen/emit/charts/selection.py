"""Selection: for one occurrence the transition of each lane, by small functions.

There is one for each composite state, with what its leaves select. A leaf has its own
among many: what the prover must see at a time stays small.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import (
    Arg,
    Aspect,
    Assign,
    Call,
    CaseExpr,
    Decl,
    Expr,
    IfExpr,
    IfStatement,
    Object,
    OperatorChain,
    Ref,
    Return,
    Stmt,
    Subprogram,
    both,
    call,
    chain,
    equal,
    member,
    number,
)
from ravenchart.gen.emit.language.compound import PASSED, TOP, Firing, FiringKind
from ravenchart.gen.emit.language.places import flat
from ravenchart.gen.emit.language.terms import emit_expression
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.statechart import Lane, When

from .shape import HELD, PASSING, RegionShape, plain_args

FEW = 8
"""Up to so many leaves are selected for by the function of the state around them."""


def selectors(shape: RegionShape) -> list[Decl]:
    """One function per state, leaves first; the last is the whole selection."""
    if shape.single:
        return [*_of_place(shape, shape.lanes[0], TOP), *_segments(shape)]
    items: list[Decl] = []
    for lane in shape.busy_lanes:
        place = TOP if lane.owner is None else Place(lane.owner, lane.name)
        items += _of_place(shape, lane, place)
    return [*items, *_segments(shape), _choose(shape)]


def _segments(shape: RegionShape) -> list[Decl]:
    """The function that says how to go on from a choice or history."""
    passed = [p.name for p in shape.region.pseudostates if p.kind in PASSED]
    if not passed:
        return []
    params = tuple(p for p in shape.choice_params() if p.name != "Now")
    all_args = tuple(
        Arg(None, Ref(PASSING if p.name == "Now" else p.name)) for p in shape.choice_params()
    )
    args = all_args[1:] if shape.single else all_args
    rows = [(shape.in_state(shape.place, p), Call(f"In_{ada_case(p)}", args)) for p in passed]
    chosen: Expr = IfExpr(tuple(rows[:-1]), rows[-1][1]) if rows[1:] else rows[0][1]
    waits = OperatorChain(">", (call("Segments_Left", Ref(shape.place)), number(0)))
    result = Ref("Select_Segment'Result")
    post = both(
        Call("Enabled", (Arg(None, result), *all_args)),
        call("Is_Segment", result),
    )
    return [
        Subprogram(
            "Select_Segment",
            params,
            "Transition",
            aspects=(Aspect("Pre", waits), Aspect("Post", post)),
            expression=chosen,
        )
    ]


def segment(shape: RegionShape, holder: str) -> Expr:
    """A call of that function over the state of the region."""
    names = [p.name for p in shape.choice_params() if p.name != "Now"]
    return call("Select_Segment", *(Ref(f"{holder}{n}" if n in HELD else n) for n in names))


def _of_place(shape: RegionShape, lane: Lane, place: Place) -> list[Decl]:
    """The functions of what stands in a region of a lane, then that of the region."""
    params = shape.choice_params()
    beyond = params[1:] if shape.single else params
    items: list[Decl] = []
    rows: list[tuple[str, Expr]] = []
    children = [s.name for s in shape.region.children(place.owner, place.region)]
    passed = shape.compounds.passed(place)
    literals = tuple(shape.literals_in(place))
    whole = len(literals) <= FEW
    few = whole or sum(map(shape.is_literal, children)) <= FEW
    for child in literals if whole else (*children, *passed):
        name = f"In_{ada_case(child)}"
        passing = shape.region.pseudostate(child) is not None
        if few and not passing and shape.is_literal(child):
            rows.append((shape.literal(child), _in_leaf(shape, lane, child)))
        elif shape.is_literal(child):
            items.append(_of_leaf(shape, lane, child))
            rows.append((shape.literal(child), Call(name, plain_args(beyond))))
        else:
            region = shape.region.state(child).regions[0].name
            items += _of_place(shape, lane, Place(child, region))
            rows.append((shape.literal(child), Call(name, plain_args(params))))
    is_lane = place == TOP or (place.owner == lane.owner and place.region == lane.name)
    own = _whole_name(shape, lane) if is_lane else f"In_{ada_case(place.owner or '')}"
    leaf_type = shape.place_type if is_lane else shape.literal(place.owner or "")
    leaf = shape.at(shape.place, lane)
    if shape.single:
        params = (params[0]._replace(type=leaf_type), *params[1:])
    elif not is_lane:
        leaf = f"{leaf_type}'({leaf})"
    chosen: Expr = CaseExpr(Ref(leaf), tuple(rows))
    if is_lane and lane.owner is not None:
        chosen = IfExpr(((shape.in_state(shape.place, lane.owner), chosen),), Ref("None"))
    aspects = [Aspect("Post", _is_right(shape, lane, own, shape.place))]
    if not shape.single and not is_lane:
        ready = shape.in_state(shape.place, place.owner or "")
        aspects.insert(0, Aspect("Pre", ready))
    items.append(Subprogram(own, params, "Selection", aspects=tuple(aspects), expression=chosen))
    return items


def _whole_name(shape: RegionShape, lane: Lane) -> str:
    return "Select_Transition" if shape.single else f"Select_{shape.lane_name(lane)}"


def _is_right(shape: RegionShape, lane: Lane, function: str, place: str) -> Expr:
    name = "Is_Selection" if shape.single else f"Is_{shape.lane_name(lane)}_Selection"
    beyond = plain_args(shape.choice_params()[1:])
    return Call(name, (Arg(None, Ref(f"{function}'Result")), Arg(None, Ref(place)), *beyond))


def _in_leaf(shape: RegionShape, lane: Lane, leaf: str) -> Expr:
    """What is selected when this leaf is active."""
    inside = shape.ancestors(leaf)
    branches = [
        (_condition(shape, f, leaf), Ref(f.literal))
        for f in shape.firings
        if f.lane == lane and f.sources[0] in inside
    ]
    return IfExpr(tuple(branches), Ref("None")) if branches else Ref("None")


def _of_leaf(shape: RegionShape, lane: Lane, leaf: str) -> Subprogram:
    params = shape.choice_params()
    chosen = _in_leaf(shape, lane, leaf)
    name = f"In_{ada_case(leaf)}"
    if shape.single:
        post = _is_right(shape, lane, name, shape.literal(leaf))
        return Subprogram(
            name, params[1:], "Selection", aspects=(Aspect("Post", post),), expression=chosen
        )
    post = _is_right(shape, lane, name, shape.place)
    ready = shape.in_state(shape.place, leaf)
    return Subprogram(
        name,
        params,
        "Selection",
        aspects=(Aspect("Pre", ready), Aspect("Post", post)),
        expression=chosen,
    )


def _condition(shape: RegionShape, firing: Firing, leaf: str) -> Expr:
    """When a firing is enabled, given that its first source is active."""
    scope = shape.scope("Data")
    triggers = shape.triggers(firing)
    parts: list[Expr] = [
        equal(Ref("Now"), Ref(triggers[0]))
        if len(triggers) == 1
        else member(Ref("Now"), " | ".join(triggers))
    ]
    parts += [emit_expression(scope, t.condition) for t in firing.triggers if isinstance(t, When)]
    if firing.kind is FiringKind.RESTORE:
        parts.append(Ref(f"Past.{shape.memory(shape.compounds.place(leaf)).known}"))
    parts += [emit_expression(scope, guard) for guard in firing.guards]
    if len(firing.sources) > 1:
        parts += [shape.in_state(shape.place, s) for s in firing.sources[1:]]
        parts += [p for s in firing.sources if (p := shape.is_complete(s)) is not None]
    return both(*flat(parts))


def _choose(shape: RegionShape) -> Subprogram:
    """All lanes; one around another selects only when the inner one does not."""
    params = shape.choice_params()
    args = plain_args(params)
    steps: list[Stmt] = []
    for lane in shape.busy_lanes:
        name = shape.lane_name(lane)
        take = Assign(f"C.{name}", Call(f"Select_{name}", args))
        idle = [equal(Ref(f"C.{shape.lane_name(n)}"), Ref("None")) for n in shape.inner_lanes(lane)]
        steps.append(IfStatement(((chain("and then", idle), (take,)),)) if idle else take)
    return Subprogram(
        "Choose",
        params,
        "Choice",
        declarations=(Object("C", "Choice"),),
        body=(*steps, Return(Ref("C"))),
    )
