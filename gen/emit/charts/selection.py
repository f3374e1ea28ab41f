"""Selection: the first transition of a lane that is enabled, as the chart declares it.

One loop goes over the transitions in the declared order and ends at the first that `Enabled`
holds for. `Enabled` looks at the source first, so a transition of another state costs one
comparison.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.syntax import (
    Arg,
    Aspect,
    Assign,
    Call,
    Decl,
    Expr,
    ForAll,
    IfExpr,
    IfStatement,
    Loop,
    Object,
    OperatorChain,
    Param,
    Pragma,
    Prefix,
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
from ravenchart.gen.emit.language.compound import PASSED
from ravenchart.gen.model.statechart import Lane

from .shape import PASSING, RegionShape

_BOUNDS = (Param("First", "in", "Transition"), Param("Last", "in", "Transition"))
_SELECTED = "Selected"


# --- the declared form


def enabled(shape: RegionShape, chosen: str, **replaced: Expr) -> Call:
    """A call of `Enabled`."""
    return Call("Enabled", (Arg(None, Ref(chosen)), *shape.situation_args(**replaced)))


def is_selection(shape: RegionShape) -> Subprogram:
    """What it means that a transition is the first one enabled."""
    among = "Transition" if shape.single else "First .. Last"
    none = equal(Ref("Chosen"), Ref("None"))
    rule = chain("or else", [none, both(member(Ref("Chosen"), among), enabled(shape, "Chosen"))])
    earlier = OperatorChain("<", (Ref("T"), Ref("Chosen")))
    denied = IfExpr(((earlier, Prefix("not", enabled(shape, "T"))),), None)
    bounds = () if shape.single else _BOUNDS
    return Subprogram(
        "Is_Selection",
        (Param("Chosen", "in", "Selection"), *bounds, *shape.situation),
        "Boolean",
        aspects=(Aspect("Ghost"),),
        expression=both(rule, ForAll("T", among, denied)),
    )


def is_selected(shape: RegionShape, chosen: str, lane: Lane, **replaced: Expr) -> Call:
    """A call of that function over the transitions of a lane."""
    args = (Arg(None, Ref(chosen)), *_bounds(shape, f"{shape.lane_name(lane)}_Transition"))
    return Call("Is_Selection", (*args, *shape.situation_args(**replaced)))


def _bounds(shape: RegionShape, among: str) -> tuple[Arg, ...]:
    """The first and the last of the transitions, where there are lanes."""
    ends = () if shape.single else ("First", "Last")
    return tuple(Arg(None, Ref(f"{among}'{end}")) for end in ends)


# --- the code


def selectors(shape: RegionShape) -> list[Decl]:
    """The selection among transitions, of segments, and for all lanes."""
    return [_selected(shape), *_segments(shape), *([] if shape.single else [_choose(shape)])]


def whole(shape: RegionShape, lane: Lane, **replaced: Expr) -> Call:
    """The selection of a lane."""
    bounds = _bounds(shape, f"{shape.lane_name(lane)}_Transition")
    return Call(_SELECTED, (*bounds, *shape.situation_args(**replaced)))


def segment(shape: RegionShape) -> Expr:
    """The selection of a segment, over the state of the region."""
    return call("Next_Segment", *(Ref(p.name) for p in shape.situation if p.name != "Now"))


def _selected(shape: RegionShape) -> Subprogram:
    """The loop over the declared transitions."""
    first, last = ("Transition'First", "Transition'Last") if shape.single else ("First", "Last")
    result = Arg(None, Ref(f"{_SELECTED}'Result"))
    bounds = () if shape.single else _BOUNDS
    params = (*bounds, *shape.situation)
    post = Call("Is_Selection", (result, *(Arg(None, Ref(p.name)) for p in params)))
    none_yet = ForAll("J", f"{first} .. T", Prefix("not", enabled(shape, "J")))
    among = "Transition" if shape.single else f"Transition range {first} .. {last}"
    search = Loop(
        f"for T in {among}",
        (
            IfStatement(((enabled(shape, "T"), (Return(Ref("T")),)),)),
            Pragma("Loop_Invariant", (none_yet,)),
        ),
    )
    return Subprogram(
        _SELECTED,
        params,
        "Selection",
        aspects=(Aspect("Post", post),),
        body=(search, Return(Ref("None"))),
    )


def _segments(shape: RegionShape) -> list[Decl]:
    """The function that says how to go on from a choice or history."""
    passed = [p.name for p in shape.region.pseudostates if p.kind in PASSED]
    if not passed:
        return []
    held = f"Self.{shape.place}"
    ways: list[Stmt] = []
    for pseudo in passed:
        out = [f.literal for f in shape.firings if f.sources[0] == pseudo]
        some = chain("or else", [enabled(shape, name, Now=Ref(PASSING)) for name in out])
        there = IfExpr(((shape.in_state(held, pseudo), some),), None)
        ways.append(Pragma("Assert", (there,)))
    waits = OperatorChain(">", (call("Segments_Left", Ref(held)), number(0)))
    result = "Next_Segment'Result"
    post = both(enabled(shape, result, Now=Ref(PASSING)), call("Is_Segment", Ref(result)))
    all_lanes = Call(
        _SELECTED, (*_bounds(shape, "Transition"), *shape.situation_args(Now=Ref(PASSING)))
    )
    return [
        Subprogram(
            "Next_Segment",
            tuple(p for p in shape.situation if p.name != "Now"),
            "Transition",
            aspects=(Aspect("Pre", waits), Aspect("Post", post)),
            body=(*ways, Return(all_lanes)),
        )
    ]


def _choose(shape: RegionShape) -> Subprogram:
    """All lanes; one around another selects only when the inner one does not."""
    steps: list[Stmt] = []
    for lane in shape.busy_lanes:
        take = Assign(f"C.{shape.lane_name(lane)}", whole(shape, lane))
        idle = [equal(Ref(f"C.{shape.lane_name(n)}"), Ref("None")) for n in shape.inner_lanes(lane)]
        steps.append(IfStatement(((chain("and then", idle), (take,)),)) if idle else take)
    return Subprogram(
        "Choose",
        shape.situation,
        "Choice",
        declarations=(Object("C", "Choice"),),
        body=(*steps, Return(Ref("C"))),
    )
