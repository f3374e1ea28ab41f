"""The logic of one region: the declared chart, its selection and its firing.

Form and proof follow architecture's section on charts that prove fast: leaf
states are one enumeration in tree order and a composite is a subtype of it;
transitions are one enumeration in order of precedence; `Enabled`, `In_Source`
and `Target` are the declared chart, a line for each transition; selection is
one small function per state whose postcondition speaks of that chart only; a
ghost set of active states makes the order of exits, effects and entries a
matter of preconditions.
"""

from __future__ import annotations

from ..model import Component, System
from ..statechart import Region, Transition, TransitionKind, When
from .ada import (
    FALSE,
    SPARK,
    Arg,
    Aspect,
    Call,
    CaseExpr,
    Chain,
    Comment,
    Decl,
    EnumType,
    Expr,
    ForAll,
    IfExpr,
    Package,
    Param,
    PlainType,
    Prefix,
    RecordType,
    Ref,
    Subprogram,
    Unit,
    UseType,
    both,
    equal,
)
from .ada import Component as Field
from .components import reading_type
from .naming import ada_case, default_value, states_package, type_name, value
from .region_body import region_body
from .region_shape import (
    START,
    RegionShape,
    asked_states,
    choice_params,
    flat,
    guard_operators,
    plain_args,
    step_params,
)
from .terms import (
    emit_expression,
)


def emit_region(
    system: System, component: Component, region: Region, header: str
) -> tuple[Unit, ...]:
    """Spec and body of the package of one region."""
    shape = RegionShape(system, component, region)
    withs = ("Ravenchart.Timers",) if shape.timers else ()
    spec = Package(shape.package, _spec(shape), (SPARK,))
    body = Package(shape.package, region_body(shape), (SPARK,), is_body=True)
    return Unit(header, withs, spec), Unit(header, (), body)


# --- Spec: types and the declared chart --------------------------------------


def _spec(shape: RegionShape) -> tuple[Decl, ...]:
    region = shape.region
    order = region.precedence()
    names = tuple(ada_case(t.name) for t in order)
    path = f"{shape.component.name}.{region.name}"
    items: list[Decl] = [UseType(shape.leaf)]
    items += _use_types(shape)
    items += [
        Comment(f"[{path}] what a step can be made for"),
        EnumType("Occurrence", shape.occurrences()),
        Comment(f"[{path}.transitions] in order of precedence, innermost source first"),
        EnumType("Selection", ("None", START, *names)),
        PlainType("Firing", f"Selection range {START} .. {names[-1]}", subtype=True),
        PlainType("Transition", f"Selection range {names[0]} .. {names[-1]}", subtype=True),
    ]
    items += _records(shape)
    items += _declared(shape)
    items += _operations(shape)
    return tuple(items)


def _use_types(shape: RegionShape) -> list[Decl]:
    """The types whose operators the declared chart uses."""
    region = shape.region
    compared = {
        f"{states_package(shape.component.region(name))}.Leaf"
        for name, state in asked_states(region)
        if name != region.name and shape.component.region(name).state(state).is_leaf
    }
    return [UseType(n) for n in (*sorted(guard_operators(region)), *sorted(compared))]


def _records(shape: RegionShape) -> list[Decl]:
    region, component = shape.region, shape.component
    items: list[Decl] = []
    if region.writes:
        rows = tuple(
            Field(
                ada_case(d.name),
                type_name(shape.system, d.type),
                value(shape.system, d.type, d.initial),
            )
            for d in component.data
            if d.name in region.writes
        )
        items += [Comment("The data that this region alone writes."), RecordType("Variables", rows)]
    if shape.inputs:
        rows = tuple(
            Field(ada_case(n), reading_type(shape.system, component, n)) for n in shape.inputs
        )
        items += [
            Comment("What it reads, copied in once per execution."),
            RecordType("Inputs", rows),
        ]
    if shape.has_box:
        sent: list[Field] = [Field("Raised", "Event_Lists.List")] if region.raises else []
        for port in component.outputs():
            if port.name in region.sends:
                name = ada_case(port.name)
                of_type = type_name(shape.system, port.type)
                sent.append(Field(name, of_type, default_value(shape.system, port.type)))
                sent.append(Field(f"{name}_Sent", "Boolean", FALSE))
        items += [Comment("What one step sends and raises."), RecordType("Outbox", tuple(sent))]
    rows = (
        Field("Started", "Boolean", FALSE),
        Field(
            "Leaf",
            shape.leaf,
            Ref(f"{shape.states}.{ada_case(region.default_leaf(region.initial.target))}"),
        ),
    )
    if shape.timers:
        rows += (Field("Timers", f"Ravenchart.Timers.Timer_Array (1 .. {len(shape.timers)})"),)
    if region.writes:
        rows += (Field("Data", "Variables"),)
    items += [Comment("The region's own state."), RecordType("Region", rows)]
    return items


def _declared(shape: RegionShape) -> list[Decl]:
    """The chart as declared: to be read against the model, line by line."""
    region = shape.region
    order = region.precedence()
    chosen = Param("T", "in", "Transition")
    scope = shape.scope("Data")
    enabled = []
    for t in order:
        parts = [shape.in_state("Leaf", t.source), equal(Ref("Now"), Ref(shape.occurrence(t)))]
        if isinstance(t.trigger, When):
            parts.append(emit_expression(scope, t.trigger.condition))
        if t.guard is not None:
            parts.append(emit_expression(scope, t.guard))
        enabled.append((ada_case(t.name), both(*(flat(parts)))))
    sources = tuple((ada_case(t.name), shape.in_state("Leaf", t.source)) for t in order)
    targets = tuple((ada_case(t.name), _target(shape, t)) for t in order)
    params = choice_params(shape)
    initial = Ref(f"{shape.states}.{ada_case(region.default_leaf(region.initial.target))}")
    chosen_first: list[Expr] = [Call("Enabled", (Arg(None, Ref("Chosen")), *plain_args(params)))]
    if len(order) > 1:
        earlier = Chain("<", (Ref("T"), Ref("Chosen")))
        not_enabled = Prefix("not", Call("Enabled", (Arg(None, Ref("T")), *plain_args(params))))
        chosen_first.append(ForAll("T", "Transition", IfExpr(((earlier, not_enabled),), None)))
    is_selection = IfExpr(
        (
            (
                equal(Ref("Chosen"), Ref("None")),
                ForAll(
                    "T",
                    "Transition",
                    Prefix("not", Call("Enabled", (Arg(None, Ref("T")), *plain_args(params)))),
                ),
            ),
            (equal(Ref("Chosen"), Ref(START)), FALSE),
        ),
        both(*chosen_first),
    )
    return [
        Subprogram(
            "Enabled", (chosen, *params), "Boolean", expression=CaseExpr(Ref("T"), tuple(enabled))
        ),
        Comment("The declared chart: source, trigger and guard of each transition."),
        Subprogram(
            "In_Source", (chosen, params[0]), "Boolean", expression=CaseExpr(Ref("T"), sources)
        ),
        Comment("Is its source the leaf, or around it?"),
        Subprogram(
            "Target",
            (Param("T", "in", "Firing"), *shape.target_params()),
            shape.leaf,
            expression=CaseExpr(Ref("T"), ((START, initial), *targets)),
        ),
        Comment("The leaf it leads to; that of a composite is its default."),
        Subprogram(
            "Is_Selection",
            (Param("Chosen", "in", "Selection"), *params),
            "Boolean",
            aspects=(Aspect("Ghost"),),
            expression=is_selection,
        ),
        Comment("The first transition that is enabled, or None when none is."),
    ]


def _target(shape: RegionShape, transition: Transition) -> Expr:
    if transition.kind is TransitionKind.INTERNAL:
        return Ref("Leaf")
    return Ref(f"{shape.states}.{ada_case(shape.region.default_leaf(transition.target))}")


def _operations(shape: RegionShape) -> list[Decl]:
    self_in, self_out = Param("Self", "in", "Region"), Param("Self", "in out", "Region")
    same = both(
        equal(Ref("Self.Leaf"), Ref("Self.Leaf'Old")),
        equal(Ref("Self.Started"), Ref("Self.Started'Old")),
    )
    items: list[Decl] = []
    if shape.timers:
        items += [
            Subprogram("Tick", (self_out,), aspects=(Aspect("Post", same),)),
            Comment("One more execution: the time-outs come nearer."),
        ]
    due = equal(equal(Ref("Now"), Ref("Start_Of_Region")), Prefix("not", Ref("Self.Started")))
    post = both(same, due) if shape.timers else due
    items += [
        Subprogram(
            "Poll",
            (self_out if shape.timers else self_in, Param("Now", "out", "Occurrence")),
            aspects=(Aspect("Post", post),),
        ),
        Comment("Its start, or the time-out that is due; Conditions when there is neither."),
    ]
    if shape.region.events():
        rows = tuple((shape.event(e), Ref(f"On_{ada_case(e)}")) for e in shape.region.events())
        if len(rows) < len(shape.component.events):
            rows += (("others", Ref("Conditions")),)
        items += [
            Subprogram(
                "To_Occurrence",
                (Param("Item", "in", "Event"),),
                "Occurrence",
                expression=CaseExpr(Ref("Item"), rows),
            ),
        ]
    step = step_params(shape)
    old = tuple(
        Arg(None, Ref({"Leaf": "Self.Leaf'Old", "Data": "Self.Data'Old"}.get(p.name, p.name)))
        for p in choice_params(shape)
    )
    result = IfExpr(
        ((equal(Ref("Fired"), Ref("None")), equal(Ref("Self.Leaf"), Ref("Self.Leaf'Old"))),),
        equal(Ref("Self.Leaf"), shape.target("Fired", "Self.Leaf'Old")),
    )
    right = IfExpr(
        ((equal(Ref("Now"), Ref("Start_Of_Region")), equal(Ref("Fired"), Ref(START))),),
        Call("Is_Selection", (Arg(None, Ref("Fired")), *old)),
    )
    items += [
        Subprogram(
            "Step",
            step,
            aspects=(
                Aspect("Pre", due),
                Aspect("Post", both(Ref("Self.Started"), right, result)),
            ),
        ),
        Comment("One run-to-completion step."),
    ]
    return items
