"""Selection: for one occurrence the first transition of each lane that is enabled.

The transitions of a lane are looked at in order of precedence, by the declared chart itself:
what is reviewed is what runs. The time grows with the number of transitions, each of which
costs a comparison or two where its source is not active.
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

from .shape import PASSING, RegionShape

SELECT = "Select_Transition"
_IS_SELECTION = "Is_Selection"
_BOUNDS = (Param("First", "in", "Transition"), Param("Last", "in", "Transition"))


def is_selection(shape: RegionShape) -> Subprogram:
    """What it means that a transition is the first one enabled."""
    none = equal(Ref("Chosen"), Ref("None"))
    among = member(Ref("Chosen"), _among(shape))
    rule = chain("or else", [none, both(among, enabled(shape, "Chosen"))])
    earlier = OperatorChain("<", (Ref("T"), Ref("Chosen")))
    denied = IfExpr(((earlier, Prefix("not", enabled(shape, "T"))),), None)
    return Subprogram(
        _IS_SELECTION,
        (Param("Chosen", "in", "Selection"), *_bounds(shape), *shape.situation()),
        "Boolean",
        aspects=(Aspect("Ghost"),),
        expression=both(rule, ForAll("T", _among(shape), denied)),
    )


def is_selected(shape: RegionShape, chosen: str, lane: str | None, **replaced: Expr) -> Call:
    """A call of that function, for a lane where there are several."""
    args = shape.situation_args(**replaced)
    return Call(_IS_SELECTION, (Arg(None, Ref(chosen)), *_bounds_of(lane), *args))


def enabled(shape: RegionShape, chosen: str, **replaced: Expr) -> Call:
    """A call of `Enabled`."""
    return Call("Enabled", (Arg(None, Ref(chosen)), *shape.situation_args(**replaced)))


def selected(shape: RegionShape, lane: str | None, **replaced: Expr) -> Call:
    """The selection among the transitions of a lane."""
    return Call(SELECT, (*_bounds_of(lane), *shape.situation_args(**replaced)))


def selectors(shape: RegionShape) -> list[Decl]:
    """The selection in a lane, that of a segment, and the choice of all lanes."""
    items: list[Decl] = [_select(shape), *_segments(shape)]
    return items if shape.single else [*items, _choose(shape)]


def _bounds(shape: RegionShape) -> tuple[Param, ...]:
    return () if shape.single else _BOUNDS


def _bounds_of(lane: str | None) -> tuple[Arg, ...]:
    if lane is None:
        return ()
    return tuple(Arg(None, Ref(f"{lane}Transition'{end}")) for end in ("First", "Last"))


def _among(shape: RegionShape) -> str:
    return "Transition" if shape.single else "First .. Last"


def _select(shape: RegionShape) -> Subprogram:
    """A search in order of precedence."""
    first = "Transition'First" if shape.single else "First"
    before = ForAll("E", f"{first} .. T", Prefix("not", enabled(shape, "E")))
    search = Loop(
        f"for T in {_among(shape)}",
        (
            IfStatement(((enabled(shape, "T"), (Return(Ref("T")),)),)),
            Pragma("Loop_Invariant", (before,)),
        ),
    )
    args = (
        Arg(None, Ref(f"{SELECT}'Result")),
        *(Arg(None, Ref(p.name)) for p in _bounds(shape)),
        *shape.situation_args(),
    )
    return Subprogram(
        SELECT,
        (*_bounds(shape), *shape.situation()),
        "Selection",
        aspects=(Aspect("Post", Call(_IS_SELECTION, args)),),
        body=(search, Return(Ref("None"))),
    )


def _segments(shape: RegionShape) -> list[Decl]:
    """The function that says how to go on from a choice or history."""
    passed = [p.name for p in shape.region.pseudostates if p.kind in PASSED]
    if not passed:
        return []
    held = f"Self.{shape.place}"
    rows = [(shape.in_state(held, name), chain("or else", _ways(shape, name))) for name in passed]
    goes_on = IfExpr(tuple(rows[:-1]), rows[-1][1]) if rows[1:] else rows[0][1]
    waits = OperatorChain(">", (call("Segments_Left", Ref(held)), number(0)))
    result = "Select_Segment'Result"
    post = both(enabled(shape, result, Now=Ref(PASSING)), call("Is_Segment", Ref(result)))
    return [
        Subprogram(
            "Select_Segment",
            tuple(p for p in shape.situation() if p.name != "Now"),
            "Transition",
            aspects=(Aspect("Pre", waits), Aspect("Post", post)),
            body=(
                Pragma("Assert", (goes_on,)),
                Return(selected(shape, None if shape.single else "", Now=Ref(PASSING))),
            ),
        )
    ]


def _ways(shape: RegionShape, pseudo: str) -> list[Expr]:
    """That one of the segments which go on from it is enabled."""
    segments = [f.literal for f in shape.firings if f.sources[0] == pseudo]
    return [enabled(shape, name, Now=Ref(PASSING)) for name in segments]


def segment(shape: RegionShape) -> Expr:
    """A call of that function over the state of the region."""
    return call("Select_Segment", *(Ref(p.name) for p in shape.situation() if p.name != "Now"))


def _choose(shape: RegionShape) -> Subprogram:
    """All lanes; one around another selects only when the inner one does not."""
    steps: list[Stmt] = []
    for lane in shape.busy_lanes:
        name = shape.lane_name(lane)
        take = Assign(f"C.{name}", selected(shape, f"{name}_"))
        idle = [equal(Ref(f"C.{shape.lane_name(n)}"), Ref("None")) for n in shape.inner_lanes(lane)]
        steps.append(IfStatement(((chain("and then", idle), (take,)),)) if idle else take)
    return Subprogram(
        "Choose",
        shape.situation(),
        "Choice",
        declarations=(Object("C", "Choice"),),
        body=(*steps, Return(Ref("C"))),
    )
