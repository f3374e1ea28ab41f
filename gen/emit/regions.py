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

from dataclasses import dataclass

from .. import terms as m
from ..model import After, Component, OnEvent, Region, System, Transition, TransitionKind, When
from .ada import (
    FALSE,
    SPARK,
    TRUE,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Case,
    CaseExpr,
    Chain,
    Comment,
    Decl,
    Do,
    EnumType,
    Expr,
    ForAll,
    If,
    IfExpr,
    Object,
    Package,
    Param,
    PlainType,
    Prefix,
    RecordType,
    Ref,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
    both,
    call,
    equal,
    member,
)
from .ada import Component as Field
from .components import reading_type
from .moves import Moves
from .naming import ada_case, default_value, region_package, states_package, type_name, value
from .terms import (
    Scope,
    emit_expression,
    flow_names,
    flow_operators,
    names_in,
    operators_in,
    raise_in_list,
    states_in,
)

START = "Initial_Entry"


def guard_names(region: Region) -> set[str]:
    """What the guards and conditions of a region read, by name as declared."""
    return {name for guard in _guards(region) for name in names_in(guard)}


def _guards(region: Region) -> list[m.Expression]:
    guards = [t.guard for t in region.transitions if t.guard is not None]
    return guards + [t.trigger.condition for t in region.transitions if isinstance(t.trigger, When)]


def behaviour_names(region: Region) -> set[str]:
    """What its effects, entries and exits read."""
    return {name for flow in _behaviours(region) for name in flow_names(flow)}


def _behaviours(region: Region) -> list[m.Flow]:
    flows = [t.effect for t in region.transitions]
    return flows + [flow for s in region.states for flow in (s.entry, s.exit)]


@dataclass(frozen=True, slots=True)
class RegionShape:
    """What a region's package consists of; asked by its emitter and by the instances'."""

    system: System
    component: Component
    region: Region

    @property
    def package(self) -> str:
        """Full name of the region's package."""
        return region_package(self.system, self.component, self.region)

    @property
    def states(self) -> str:
        """Nested package of the leaf states."""
        return states_package(self.region)

    @property
    def leaf(self) -> str:
        """The leaf type, from inside the component's packages."""
        return f"{self.states}.Leaf"

    @property
    def inputs(self) -> tuple[str, ...]:
        """What it copies in: everything read that it does not itself write."""
        return tuple(n for n in self.region.reads if n not in self.region.writes)

    @property
    def timers(self) -> tuple[Transition, ...]:
        """The transitions with a time-out, in model order."""
        return tuple(t for t in self.region.transitions if isinstance(t.trigger, After))

    @property
    def has_box(self) -> bool:
        """Does a step send or raise anything?"""
        return bool(self.region.sends or self.region.raises)

    def extra(self) -> tuple[Param, ...]:
        """The parameters that guards are evaluated over."""
        named = guard_names(self.region)
        params = []
        if named & set(self.region.writes):
            params.append(Param("Data", "in", "Variables"))
        if named & set(self.inputs):
            params.append(Param("Ins", "in", "Inputs"))
        return tuple(params)

    def target_params(self) -> tuple[Param, ...]:
        """Target looks at the leaf only when a transition can stay where it is."""
        stays = any(t.kind is TransitionKind.INTERNAL for t in self.region.transitions)
        return (Param("Leaf", "in", self.leaf),) if stays else ()

    def target(self, chosen: str, leaf: str) -> Expr:
        """A call of Target."""
        return call("Target", Ref(chosen), *(Ref(leaf) for _ in self.target_params()))

    def scope(self, data: str) -> Scope:
        """Names in guards (``data`` = Data) and in behaviours (``data`` = Self.Data)."""
        writes = {n.lower() for n in self.region.writes}

        def variable(name: str) -> str:
            prefix = data if name.lower() in writes else "Ins"
            return f"{prefix}.{ada_case(name)}"

        raised = f"{ada_case(self.component.name)}"
        return Scope(
            self.system,
            self.component,
            variable,
            lambda name: f"{data}.{ada_case(name)}",
            lambda port: (f"Box.{ada_case(port)}", f"Box.{ada_case(port)}_Sent"),
            lambda event: raise_in_list("Event_Lists", "Box.Raised", f"{raised}.{ada_case(event)}"),
        )

    def in_state(self, leaf: str, state: str) -> Expr:
        """Is the leaf that ``leaf`` holds the state, or inside it?"""
        name = f"{self.states}.{ada_case(state)}"
        if self.region.state(state).is_leaf:
            return equal(Ref(leaf), Ref(name))
        return member(Ref(leaf), name)

    def occurrence(self, transition: Transition) -> str:
        """The occurrence that triggers it."""
        match transition.trigger:
            case OnEvent(event):
                return f"On_{ada_case(event)}"
            case After():
                return f"Expiry_Of_{ada_case(transition.name)}"
            case When():
                return "Conditions"

    def occurrences(self) -> tuple[str, ...]:
        """All occurrences of the region."""
        events = [f"On_{ada_case(e)}" for e in self.region.events()]
        expiries = [self.occurrence(t) for t in self.timers]
        return ("Start_Of_Region", *events, *expiries, "Conditions")

    def timer_index(self, transition: Transition) -> int:
        """Position of its timer, from 1."""
        return self.timers.index(transition) + 1


def emit_region(
    system: System, component: Component, region: Region, header: str
) -> tuple[Unit, ...]:
    """Spec and body of the package of one region."""
    shape = RegionShape(system, component, region)
    withs = ("Ravenchart.Timers",) if shape.timers else ()
    spec = Package(shape.package, _spec(shape), (SPARK,))
    body = Package(shape.package, _body(shape), (SPARK,), is_body=True)
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


def _guard_operators(region: Region) -> set[str]:
    return {name for guard in _guards(region) for name in operators_in(guard)}


def _asked_states(region: Region) -> set[tuple[str, str]]:
    return {pair for guard in _guards(region) for pair in states_in(guard)}


def _behaviour_operators(region: Region) -> set[str]:
    return {name for flow in _behaviours(region) for name in flow_operators(flow)}


def _use_types(shape: RegionShape) -> list[Decl]:
    """The types whose operators the declared chart uses."""
    region = shape.region
    compared = {
        f"{states_package(shape.component.region(name))}.Leaf"
        for name, state in _asked_states(region)
        if name != region.name and shape.component.region(name).state(state).is_leaf
    }
    return [UseType(n) for n in (*sorted(_guard_operators(region)), *sorted(compared))]


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
            Ref(f"{shape.states}.{ada_case(region.default_leaf(region.initial))}"),
        ),
    )
    if shape.timers:
        rows += (Field("Timers", f"Ravenchart.Timers.Timer_Array (1 .. {len(shape.timers)})"),)
    if region.writes:
        rows += (Field("Data", "Variables"),)
    items += [Comment("The region's own state."), RecordType("Region", rows)]
    return items


def _choice_params(shape: RegionShape) -> tuple[Param, ...]:
    return (Param("Leaf", "in", shape.leaf), Param("Now", "in", "Occurrence"), *shape.extra())


def _args(params: tuple[Param, ...], **replaced: str) -> tuple[Arg, ...]:
    return tuple(Arg(None, Ref(replaced.get(p.name, p.name))) for p in params)


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
        enabled.append((ada_case(t.name), both(*(_flat(parts)))))
    sources = tuple((ada_case(t.name), shape.in_state("Leaf", t.source)) for t in order)
    targets = tuple((ada_case(t.name), _target(shape, t)) for t in order)
    params = _choice_params(shape)
    initial = Ref(f"{shape.states}.{ada_case(region.default_leaf(region.initial))}")
    chosen_first: list[Expr] = [Call("Enabled", (Arg(None, Ref("Chosen")), *_args(params)))]
    if len(order) > 1:
        earlier = Chain("<", (Ref("T"), Ref("Chosen")))
        not_enabled = Prefix("not", Call("Enabled", (Arg(None, Ref("T")), *_args(params))))
        chosen_first.append(ForAll("T", "Transition", IfExpr(((earlier, not_enabled),), None)))
    is_selection = IfExpr(
        (
            (
                equal(Ref("Chosen"), Ref("None")),
                ForAll(
                    "T",
                    "Transition",
                    Prefix("not", Call("Enabled", (Arg(None, Ref("T")), *_args(params)))),
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


def _flat(parts: list[Expr]) -> list[Expr]:
    """One conjunction instead of nested ones."""
    flat: list[Expr] = []
    for part in parts:
        if isinstance(part, Chain) and part.operator == "and then":
            flat += _flat(list(part.operands))
        else:
            flat.append(part)
    return flat


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
        rows = tuple((f"{ada_case(e)}", Ref(f"On_{ada_case(e)}")) for e in shape.region.events())
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
        for p in _choice_params(shape)
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


def step_params(shape: RegionShape) -> tuple[Param, ...]:
    """The profile of Step, which its callers follow too."""
    params = [Param("Self", "in out", "Region"), Param("Now", "in", "Occurrence")]
    if shape.inputs:
        params.append(Param("Ins", "in", "Inputs"))
    if shape.has_box:
        params.append(Param("Box", "in out", "Outbox"))
    return (*params, Param("Fired", "out", "Selection"))


# --- Body --------------------------------------------------------------------


def _body(shape: RegionShape) -> tuple[Decl, ...]:
    more = sorted(_behaviour_operators(shape.region) - _guard_operators(shape.region))
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
            rows.append((qualified, Call(name, _args(extra))))
        else:
            items += _selectors(shape, child.name)
            rows.append((qualified, Call(name, (Arg(None, Ref("Leaf")), *_args(extra)))))
    own = "Select_Transition" if state is None else f"In_{ada_case(state)}"
    leaf_type = shape.leaf if state is None else f"{shape.states}.{ada_case(state)}"
    post = Call(
        "Is_Selection", (Arg(None, Ref(f"{own}'Result")), Arg(None, Ref("Leaf")), *_args(extra))
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
            branches.append((both(*_flat(parts)), Ref(ada_case(t.name))))
    post = Call(
        "Is_Selection",
        (
            Arg(None, Ref(f"{name}'Result")),
            Arg(None, Ref(f"{shape.states}.{ada_case(leaf)}")),
            *_args(extra),
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
    kept = (p for p in step_params(shape) if p.name not in idle)
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
            for p in _choice_params(shape)
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
