"""The body of a region's package: selection, firing, and the step that joins them."""

from __future__ import annotations

from ..model import When
from .ada import (
    FALSE,
    TRUE,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Case,
    CaseExpr,
    Chain,
    Decl,
    Do,
    Expr,
    If,
    IfExpr,
    Object,
    Param,
    Prefix,
    Ref,
    Stmt,
    Subprogram,
    UseType,
    arguments,
    both,
    call,
    equal,
)
from .moves import Moves
from .naming import ada_case
from .region_shape import (
    START,
    RegionShape,
    behaviour_names,
    behaviour_operators,
    choice_params,
    flat,
    guard_operators,
    plain_args,
    step_params,
)
from .terms import (
    emit_expression,
)


def region_body(shape: RegionShape) -> tuple[Decl, ...]:
    """Selection, polling, firing, stepping."""
    more = sorted(behaviour_operators(shape.region) - guard_operators(shape.region))
    items: list[Decl] = [UseType(name) for name in more]
    items += _selectors(shape, None)
    items.append(Moves(shape.component, shape.region, shape.scope("Self.Data")).chart())
    items += _polling(shape)
    items.append(_fire(shape))
    items.append(_step(shape))
    return tuple(items)


def _selectors(shape: RegionShape, state: str | None) -> list[Decl]:
    """One function per state, leaves first; the last is the whole selection."""
    region = shape.region
    extra = (Param("Now", "in", "Occurrence"), *shape.extra())
    items: list[Decl] = []
    rows: list[tuple[str, Expr]] = []
    for child in region.children(state):
        name = f"In_{ada_case(child.name)}"
        qualified = f"{shape.states}.{ada_case(child.name)}"
        if child.is_leaf:
            items.append(_leaf_selector(shape, child.name, name, extra))
            rows.append((qualified, Call(name, plain_args(extra))))
        else:
            items += _selectors(shape, child.name)
            inner = Call(name, (Arg(None, Ref("Leaf")), *plain_args(extra)))
            rows.append((qualified, inner))
    own = "Select_Transition" if state is None else f"In_{ada_case(state)}"
    leaf_type = shape.leaf if state is None else f"{shape.states}.{ada_case(state)}"
    post = Call(
        "Is_Selection",
        (Arg(None, Ref(f"{own}'Result")), Arg(None, Ref("Leaf")), *plain_args(extra)),
    )
    items.append(
        Subprogram(
            own,
            (Param("Leaf", "in", leaf_type), *extra),
            "Selection",
            aspects=(Aspect("Post", post),),
            expression=CaseExpr(Ref("Leaf"), tuple(rows)),
        )
    )
    return items


def _leaf_selector(
    shape: RegionShape, leaf: str, name: str, extra: tuple[Param, ...]
) -> Subprogram:
    region = shape.region
    scope = shape.scope("Data")
    inside = region.ancestors(leaf)
    branches: list[tuple[Expr, Expr]] = []
    for t in region.precedence():
        if t.source in inside:
            parts: list[Expr] = [equal(Ref("Now"), Ref(shape.occurrence(t)))]
            if isinstance(t.trigger, When):
                parts.append(emit_expression(scope, t.trigger.condition))
            if t.guard is not None:
                parts.append(emit_expression(scope, t.guard))
            branches.append((both(*flat(parts)), Ref(ada_case(t.name))))
    post = Call(
        "Is_Selection",
        (
            Arg(None, Ref(f"{name}'Result")),
            Arg(None, Ref(f"{shape.states}.{ada_case(leaf)}")),
            *plain_args(extra),
        ),
    )
    chosen: Expr = IfExpr(tuple(branches), Ref("None")) if branches else Ref("None")
    return Subprogram(name, extra, "Selection", aspects=(Aspect("Post", post),), expression=chosen)


def _polling(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    now = Param("Now", "out", "Occurrence")
    if not shape.timers:
        start = If(
            ((Ref("Self.Started"), (Assign("Now", Ref("Conditions")),)),),
            (Assign("Now", Ref("Start_Of_Region")),),
        )
        return [Subprogram("Poll", (Param("Self", "in", "Region"), now), body=(start,))]
    rows = tuple(
        (str(shape.timer_index(t)), (Assign("Now", Ref(shape.occurrence(t))),))
        for t in shape.timers
    )
    due: tuple[Stmt, ...] = (
        Do("Ravenchart.Timers.Take_Due", arguments(Ref("Self.Timers"), Ref("Due"))),
        Case(Ref("Due"), (*rows, ("others", (Assign("Now", Ref("Conditions")),)))),
    )
    return [
        Subprogram(
            "Tick", (self_out,), body=(Do("Ravenchart.Timers.Tick", arguments(Ref("Self.Timers"))),)
        ),
        Subprogram(
            "Poll",
            (self_out, now),
            declarations=(Object("Due", "Natural"),),
            body=(
                If(
                    (
                        (
                            Prefix("not", Ref("Self.Started")),
                            (Assign("Now", Ref("Start_Of_Region")),),
                        ),
                    ),
                    due,
                ),
            ),
        ),
    ]


def _fire_params(shape: RegionShape) -> tuple[Param, ...]:
    idle = {"Now", "Fired"}
    if not behaviour_names(shape.region) & set(shape.inputs):
        idle.add("Ins")
    filled = Moves(shape.component, shape.region, shape.scope("Self.Data")).fills_outbox()
    kept = (
        p._replace(mode="out") if filled and p.name == "Box" else p
        for p in step_params(shape)
        if p.name not in idle
    )
    return (*kept, Param("Chosen", "in", "Firing"))


def _fire(shape: RegionShape) -> Subprogram:
    region = shape.region
    moves = Moves(shape.component, region, shape.scope("Self.Data"), shape.timers)
    rows: list[tuple[str, tuple[Stmt, ...]]] = [(START, moves.start())]
    rows += [(ada_case(t.name), moves.transition(t)) for t in region.precedence()]
    ready = IfExpr(
        ((equal(Ref("Chosen"), Ref(START)), Prefix("not", Ref("Self.Started"))),),
        both(Ref("Self.Started"), call("In_Source", Ref("Chosen"), Ref("Self.Leaf"))),
    )
    done = both(
        Ref("Self.Started"),
        equal(Ref("Self.Leaf"), shape.target("Chosen", "Self.Leaf'Old")),
    )
    before = IfExpr(
        ((Ref("Self.Started"), call("Chart.Configuration", Ref("Self.Leaf"))),),
        Aggregate((Arg("others", FALSE),)),
    )
    uses = (UseType("Chart.Node"), UseType("Chart.Node_Set"))
    active = Object("Active", "Chart.Node_Set", before, aspects=(Aspect("Ghost"),))
    return Subprogram(
        "Fire",
        _fire_params(shape),
        aspects=(Aspect("Pre", ready), Aspect("Post", done)),
        declarations=(*uses, active, *moves.procedures()),
        body=(
            Case(Ref("Chosen"), tuple(rows)),
            moves.claim(equal(Ref("Active"), call("Chart.Configuration", Ref("Self.Leaf")))),
            Assign("Self.Started", TRUE),
        ),
    )


def _step(shape: RegionShape) -> Subprogram:
    pick = Call(
        "Select_Transition",
        tuple(
            Arg(None, Ref({"Leaf": "Self.Leaf", "Data": "Self.Data"}.get(p.name, p.name)))
            for p in choice_params(shape)
        ),
    )
    fire = Do(
        "Fire",
        tuple(
            Arg(None, Ref("Fired" if p.name == "Chosen" else p.name)) for p in _fire_params(shape)
        ),
    )
    return Subprogram(
        "Step",
        step_params(shape),
        body=(
            If(
                ((equal(Ref("Now"), Ref("Start_Of_Region")), (Assign("Fired", Ref(START)),)),),
                (Assign("Fired", pick),),
            ),
            If(((Chain("/=", (Ref("Fired"), Ref("None"))), (fire,)),)),
        ),
    )
