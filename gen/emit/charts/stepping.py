"""The body of a region's package: selection, occurrences, firing, and the step that joins them."""

from __future__ import annotations

from ...statechart import Lane
from ..ada import (
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Case,
    Chain,
    Decl,
    Do,
    Expr,
    If,
    IfExpr,
    Loop,
    Object,
    Param,
    Pragma,
    Prefix,
    Ref,
    Say,
    Stmt,
    Subprogram,
    UseType,
    arguments,
    both,
    call,
    chain,
    do,
    equal,
    number,
)
from ..events import null_event
from ..naming import ada_case
from ..terms import expressions_in
from .compound import PASSED
from .firing import Moves
from .selection import segment, selectors
from .shape import (
    START,
    RegionShape,
    behaviour_operators,
    flows_of,
    guard_operators,
    guards_of,
)
from .working import notice_bodies


def body_of(shape: RegionShape) -> tuple[Decl, ...]:
    """All of the package's body."""
    region = shape.region
    flows = [e for flow in flows_of(region) for e in expressions_in(flow)]
    more = sorted(behaviour_operators(region) - guard_operators(region))
    more += ["Ravenchart.Event_Count"] if shape.working else []
    more += sorted(shape.compared_in(flows) - shape.compared_in(guards_of(region)))
    moves = Moves(shape)
    return (
        *(UseType(name) for name in more),
        *selectors(shape),
        moves.chart(),
        *notice_bodies(shape),
        *_polling(shape),
        moves.fire(),
        _step(shape, moves),
    )


# --- the next occurrence -----------------------------------------------------


def _polling(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    items: list[Decl] = []
    if shape.timers:
        tick = Do("Ravenchart.Timers.Tick", arguments(Ref("Self.Timers")))
        items.append(Subprogram("Tick", (self_out,), body=(tick,)))
    branches: list[tuple[Expr, tuple[Stmt, ...]]] = [
        (Prefix("not", Ref("Self.Started")), (Assign("Now", Ref("Start_Of_Region")),))
    ]
    for state in shape.completing:
        done = f"Self.{shape.completed(state)}"
        occurs = Assign("Now", Ref(f"Completion_Of_{ada_case(state)}"))
        branches.append((Ref(done), (Assign(done, Ref("False")), occurs)))
    declarations: list[Decl] = [Object("Due", "Natural")] if shape.timers else []
    params = shape.poll_params()
    before: tuple[Stmt, ...] = ()
    if len(params) > 2:
        before = (Assign("Item", null_event(shape.component)),)
    rest = _deferred(shape) if shape.deferring else (Assign("Now", Ref("Conditions")),)
    if shape.timers:
        rows = [
            (str(i), (Assign("Now", Ref(f"Expiry_Of_{ada_case(t.name)}")),))
            for i, t in enumerate(shape.timers, 1)
        ]
        rest = (
            Do("Ravenchart.Timers.Take_Due", arguments(Ref("Self.Timers"), Ref("Due"))),
            Case(Ref("Due"), (*rows, ("others", rest))),
        )
    items.append(
        Subprogram(
            "Poll",
            params,
            declarations=tuple(declarations),
            body=(*before, If(tuple(branches), rest)),
        )
    )
    return items


def _deferred(shape: RegionShape) -> tuple[Stmt, ...]:
    """The oldest deferred event that no active state defers any more."""
    item = call("Deferrals.Element", Ref("Self.Deferred"), Ref("I"))
    taken = (Assign("Item", item),) if shape.takes_item else ()
    free = Prefix("not", call("Is_Deferred", item, Ref(f"Self.{shape.place}")))
    return (
        Assign("Now", Ref("Conditions")),
        Loop(
            "for I in 1 .. Deferrals.Count (Self.Deferred)",
            (
                If(
                    (
                        (
                            free,
                            (
                                Assign("Now", call("To_Occurrence", item)),
                                *taken,
                                Do("Deferrals.Remove", arguments(Ref("Self.Deferred"), Ref("I"))),
                                Say("exit"),
                            ),
                        ),
                    )
                ),
            ),
        ),
    )


# --- the step ----------------------------------------------------------------


def _step(shape: RegionShape, moves: Moves) -> Subprogram:
    params = shape.step_params()
    profile = (
        params[0],
        Param("Now", "in", "Occurrence"),
        *params[1:],
        Param("Fired", "out", "Firing_List" if shape.listed else "Selection"),
    )
    if not shape.listed:
        return Subprogram("Step", profile, body=_plain_step(shape, moves))
    if shape.single:
        return Subprogram("Step", profile, body=_passing_step(shape, moves))
    return _lane_step(shape, moves, profile)


def _fire(moves: Moves, chosen: str) -> Do:
    names = (p.name for p in moves.fire_params())
    return Do("Fire", arguments(*(Ref(chosen if n == "Chosen" else n) for n in names)))


def _plain_step(shape: RegionShape, moves: Moves) -> tuple[Stmt, ...]:
    pick = Call("Select_Transition", shape.choice_args())
    begun = equal(Ref("Now"), Ref("Start_Of_Region"))
    return (
        If(((begun, (Assign("Fired", Ref(START)),)),), (Assign("Fired", pick),)),
        If(((Chain("/=", (Ref("Fired"), Ref("None"))), (_fire(moves, "Fired"),)),)),
    )


def _ranks(shape: RegionShape) -> int:
    ranks = (shape.rank(p.name) for p in shape.region.pseudostates if p.kind in PASSED)
    return max(ranks, default=0)


def _passing_step(shape: RegionShape, moves: Moves) -> tuple[Stmt, ...]:
    """One transition, then the segments that its way passes."""
    pick = Call("Select_Transition", shape.choice_args())
    begun = equal(Ref("Now"), Ref("Start_Of_Region"))
    first = Ref("Fired.Items (1)")
    most = _ranks(shape)
    left = call("Segments_Left", Ref(f"Self.{shape.place}"))
    bound = Chain("<=", (left, Chain("-", (number(most + 2), Ref("I")))))
    counted = equal(Ref("Fired.Count"), Chain("-", (Ref("I"), number(1))))
    fired = (_fire(moves, "Fired.Items (1)"), Assign("Fired.Count", number(1)))
    loop = Loop(
        f"for I in 2 .. {most + 1}",
        (
            Pragma("Loop_Invariant", (both(Ref("Self.Started"), counted, bound),)),
            If(((equal(left, number(0)), (Say("exit"),)),)),
            Assign("Fired.Items (I)", segment(shape, "Self.")),
            _fire(moves, "Fired.Items (I)"),
            Assign("Fired.Count", Ref("I")),
        ),
    )
    return (
        Assign("Fired", _nothing()),
        If(
            ((begun, (Assign("Fired.Items (1)", Ref(START)),)),),
            (Assign("Fired.Items (1)", pick),),
        ),
        If(((Chain("/=", (first, Ref("None"))), (*fired, loop)),)),
    )


def _nothing() -> Aggregate:
    """An empty list of firings."""
    return Aggregate(
        (Arg("Count", number(0)), Arg("Items", Aggregate((Arg("others", Ref("None")),))))
    )


def _lane_step(shape: RegionShape, moves: Moves, profile: tuple[Param, ...]) -> Subprogram:
    """Every lane's transition in order; what conflicts with an earlier one is dropped."""
    choose = Call("Choose", shape.choice_args())
    begun = equal(Ref("Now"), Ref("Start_Of_Region"))
    work: tuple[Stmt, ...] = tuple(_lane(shape, lane) for lane in shape.busy_lanes)
    if shape.deferring:
        fields = [f"C.{shape.lane_name(n)}" for n in shape.busy_lanes]
        rows = [(call("Is_Deferral", Ref(f)), (do("Fire_Whole", Ref(f)),)) for f in fields]
        work = (If(tuple(rows), work),)
    return Subprogram(
        "Step",
        profile,
        declarations=(Object("C", "Choice"), *_fire_whole(shape, moves)),
        body=(
            Assign("Fired", _nothing()),
            If(((begun, (do("Fire_Whole", Ref(START)),)),), (Assign("C", choose), *work)),
        ),
    )


def _lane(shape: RegionShape, lane: Lane) -> Stmt:
    """Fire the transition of a lane, unless an earlier one left its state, or it would leave
    a state in which an earlier one moved."""
    chosen = Ref(f"C.{shape.lane_name(lane)}")
    free: list[Expr] = [Chain("/=", (chosen, Ref("None")))]
    around = [s for s in shape.watched if lane in shape.lanes_in(s)]
    for state in around:
        inside = shape.lanes_in(state)
        earlier = inside[: inside.index(lane)]
        if not earlier:
            continue
        name = ada_case(state)
        still = [equal(Ref(f"C.{shape.lane_name(n)}"), Ref("None")) for n in earlier]
        stays = Prefix("not", call(f"Leaves_{name}", chosen))
        free.append(Prefix("not", call(f"Has_Left_{name}", Ref("Fired"))))
        free.append(Chain("or else", (stays, chain("and then", still))))
    if around:
        free.append(call("In_Source", chosen, Ref(f"Self.{shape.place}")))
    return If(((chain("and then", free), (do("Fire_Whole", chosen),)),))


def _fire_whole(shape: RegionShape, moves: Moves) -> list[Decl]:
    """A transition with the segments that its way passes, and note what fired."""
    held = Ref(f"Self.{shape.place}")
    started = IfExpr(
        ((equal(Ref("T"), Ref(START)), Prefix("not", Ref("Self.Started"))),),
        both(Ref("Self.Started"), call("In_Source", Ref("T"), held)),
    )
    room = Chain("<", (Ref("Fired.Count"), number(shape.most_firings)))
    grow = Assign("Fired.Count", Chain("+", (Ref("Fired.Count"), number(1))))
    keep = Assign("Fired.Items (Fired.Count)", Ref("T"))
    some = Chain(">", (Ref("Fired.Count"), number(0)))
    note = Subprogram(
        "Note",
        (Param("T", "in", "Firing"),),
        aspects=(Aspect("Post", some),),
        body=(If(((room, (grow, keep)),)),),
    )
    most = _ranks(shape)
    body: list[Stmt] = [_fire(moves, "T"), do("Note", Ref("T"))]
    declarations: list[Decl] = []
    facts: list[Expr] = [Ref("Self.Started"), some]
    if most:
        left = call("Segments_Left", held)
        bound = Chain("<=", (left, Chain("-", (number(most + 1), Ref("I")))))
        declarations.append(Object("Segment", "Selection"))
        body.append(
            Loop(
                f"for I in 1 .. {most}",
                (
                    Pragma("Loop_Invariant", (both(*facts, bound),)),
                    If(((equal(left, number(0)), (Say("exit"),)),)),
                    Assign("Segment", segment(shape, "Self.")),
                    _fire(moves, "Segment"),
                    do("Note", Ref("Segment")),
                ),
            )
        )
        facts.append(equal(left, number(0)))
    whole = Subprogram(
        "Fire_Whole",
        (Param("T", "in", "Firing"),),
        aspects=(Aspect("Pre", started), Aspect("Post", both(*facts))),
        declarations=tuple(declarations),
        body=tuple(body),
    )
    return [note, whole]
