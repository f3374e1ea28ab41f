"""A region's package spec: its types, and the chart as declared.

`Enabled`, `In_Source` and `Target` are to be read against the model, a line for
each transition; `Is_Selection` says what is chosen. All proofs are about them.
"""

from __future__ import annotations

from ...model import Component, System
from ...statechart import Region, When
from ..ada import (
    FALSE,
    SPARK,
    Aggregate,
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
    ForSome,
    IfExpr,
    Instance,
    Package,
    Param,
    PlainType,
    Prefix,
    RecordType,
    Ref,
    Subprogram,
    Unit,
    UseType,
    arguments,
    both,
    call,
    chain,
    equal,
    member,
    number,
)
from ..ada import Component as Field
from ..components import reading_type
from ..events import name_of, null_event
from ..naming import ada_case, default_value, type_name, value
from ..terms import emit_expression
from .compound import PASSED, Firing, Kind
from .history import restored_functions, restored_place
from .places import flat
from .shape import START, RegionShape, guard_operators, guards_of, plain_args
from .stepping import body_of
from .working import done_types, notices, work_fields


def emit_region(
    system: System, component: Component, region: Region, header: str, *, noted: bool = False
) -> tuple[Unit, ...]:
    """Spec and body of the package of one region; ``noted`` as in `Site`."""
    shape = RegionShape(system, component, region, noted=noted)
    withs = ["Ravenchart.Timers"] if shape.timers else []
    withs += ["Ravenchart.Event_Lists"] if shape.deferring else []
    spec = Package(shape.package, _spec(shape), (SPARK,))
    body = Package(shape.package, body_of(shape), (SPARK,), is_body=True)
    seen = ("Ravenchart.Steps",) if noted else ()
    return Unit(header, tuple(withs), spec), Unit(header, seen, body)


# --- Types -------------------------------------------------------------------


def _spec(shape: RegionShape) -> tuple[Decl, ...]:
    names = tuple(ada_case(f.name) for f in shape.firings)
    path = f"{shape.component.name}.{shape.region.name}"
    items: list[Decl] = _use_types(shape)
    items += [
        Comment(f"[{path}] what a step can be made for"),
        EnumType("Occurrence", shape.occurrences()),
        Comment(f"[{path}.transitions] in order of precedence, innermost source first"),
        EnumType("Selection", ("None", START, *names)),
        PlainType("Firing", f"Selection range {START} .. {names[-1]}", subtype=True),
        PlainType("Transition", f"Selection range {names[0]} .. {names[-1]}", subtype=True),
    ]
    if not shape.single:
        items += _lane_types(shape)
    items += _records(shape)
    items += _declared(shape)
    items += _operations(shape)
    return tuple(items)


def _use_types(shape: RegionShape) -> list[Decl]:
    """The types whose operators the declared chart uses."""
    region = shape.region
    own = {f"{shape.states}.{shape.lane_type(n)}" for n in shape.lanes}
    if not shape.single:
        own.add(shape.place_type)
    ordered = [f"{shape.states}.Leaf", *sorted(own - {f"{shape.states}.Leaf"})]
    return [
        UseType(n)
        for n in (
            *ordered,
            *sorted(guard_operators(region)),
            *sorted(shape.compared_in(guards_of(region))),
        )
    ]


def _lane_types(shape: RegionShape) -> list[Decl]:
    items: list[Decl] = []
    fields: list[Field] = []
    for lane in shape.busy_lanes:
        own = [ada_case(f.name) for f in shape.firings if f.lane == lane]
        name = shape.lane_name(lane)
        items.append(
            PlainType(f"{name}_Transition", f"Selection range {own[0]} .. {own[-1]}", subtype=True)
        )
        fields.append(Field(name, "Selection", Ref("None")))
    items += [
        Comment("What one occurrence fires: at most one transition in each lane."),
        RecordType("Choice", tuple(fields)),
    ]
    return items


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
    if shape.memories:
        past: list[Field] = []
        for one in shape.memories:
            first = next(iter(shape.literals_in(one.place)))
            past.append(Field(one.last, shape.memory_type(one), Ref(shape.literal(first))))
            past.append(Field(one.known, "Boolean", FALSE))
        items += [
            Comment("What histories ask for: the last leaf left in a region, if any."),
            RecordType("Memory", tuple(past)),
        ]
    if shape.deferring:
        items.append(
            Instance(
                "Deferrals",
                "Ravenchart.Event_Lists",
                arguments(
                    Event=Ref(f"{ada_case(component.name)}.Event"),
                    Null_Event=null_event(component),
                    Capacity=number(region.deferral_depth),
                ),
            )
        )
    if shape.listed:
        most = shape.most_firings
        none = Aggregate((Arg("others", Ref("None")),))
        items += [
            PlainType("Firing_Array", f"array (1 .. {most}) of Selection"),
            Comment("What one step has fired, in order; None behind the last."),
            RecordType(
                "Firing_List",
                (
                    Field("Count", f"Natural range 0 .. {most}", number(0)),
                    Field("Items", "Firing_Array", none),
                ),
            ),
        ]
    items += done_types(shape)
    items += [Comment("The region's own state."), RecordType("Region", _region_fields(shape))]
    return items


def _region_fields(shape: RegionShape) -> tuple[Field, ...]:
    rows = [
        Field("Started", "Boolean", FALSE),
        Field(shape.place, shape.place_type, shape.initial() if shape.single else None),
    ]
    if shape.memories:
        rows.append(Field("Past", "Memory"))
    if shape.timers:
        rows.append(Field("Timers", f"Ravenchart.Timers.Timer_Array (1 .. {len(shape.timers)})"))
    rows += [Field(shape.completed(s), "Boolean", FALSE) for s in shape.completing]
    rows += work_fields(shape)
    if shape.deferring:
        rows.append(Field("Deferred", "Deferrals.List"))
        rows.append(Field("Lost", "Boolean", FALSE))
    if shape.region.writes:
        rows.append(Field("Data", "Variables"))
    return tuple(rows)


# --- The chart as declared ---------------------------------------------------


def _declared(shape: RegionShape) -> list[Decl]:
    chosen = Param("T", "in", "Transition")
    params = shape.choice_params()
    lines = tuple((ada_case(f.name), _enabled(shape, f)) for f in shape.firings)
    sources = tuple((ada_case(f.name), shape.in_sources(f)) for f in shape.firings)
    start = shape.configuration(shape.after(shape.start), shape.place)
    targets = tuple((ada_case(f.name), _target(shape, f)) for f in shape.firings)
    items: list[Decl] = [
        Subprogram("Enabled", (chosen, *params), "Boolean", expression=CaseExpr(Ref("T"), lines)),
        Comment("The declared chart: source, trigger and guard of each transition."),
        Subprogram(
            "In_Source", (chosen, params[0]), "Boolean", expression=CaseExpr(Ref("T"), sources)
        ),
        Comment("Is its source the leaf, or around it?"),
        *restored_functions(shape),
        Subprogram(
            "Target",
            (Param("T", "in", "Firing"), *shape.target_params()),
            shape.place_type,
            expression=CaseExpr(Ref("T"), ((START, start), *targets)),
        ),
        Comment(
            "The leaf it leads to; that of a composite is its default."
            if shape.single
            else "The leaves it leads to; those of a composite are its defaults."
        ),
    ]
    items += _selections(shape, params)
    items += _passing(shape)
    if shape.deferring:
        items += _deferred(shape)
    return items


def _enabled(shape: RegionShape, firing: Firing) -> Expr:
    scope = shape.scope("Data")
    parts: list[Expr] = [shape.in_sources(firing)]
    triggers = shape.triggers(firing)
    if len(triggers) == 1:
        parts.append(equal(Ref("Now"), Ref(triggers[0])))
    else:
        parts.append(member(Ref("Now"), " | ".join(triggers)))
    parts += [emit_expression(scope, t.condition) for t in firing.triggers if isinstance(t, When)]
    if firing.kind is Kind.RESTORE:
        parts.append(Ref(f"Past.{shape.memory(shape.compounds.place(firing.sources[0])).known}"))
    parts += [emit_expression(scope, guard) for guard in firing.guards]
    if len(firing.sources) > 1:
        parts += [p for s in firing.sources if (p := shape.is_complete(s)) is not None]
    return both(*flat(parts))


def _target(shape: RegionShape, firing: Firing) -> Expr:
    if firing.kind is Kind.RESTORE:
        return restored_place(shape, firing.sources[0])
    if firing.kind in (Kind.INTERNAL, Kind.DEFERRAL):
        return Ref(shape.place)
    return shape.configuration(shape.leads_to(firing), shape.place)


def _selections(shape: RegionShape, params: tuple[Param, ...]) -> list[Decl]:
    if shape.single:
        return [
            _is_selection("Is_Selection", "Transition", len(shape.firings), params),
            Comment("The first transition that is enabled, or None when none is."),
        ]
    items: list[Decl] = []
    lines: list[Expr] = []
    for lane in shape.busy_lanes:
        name = shape.lane_name(lane)
        count = sum(f.lane == lane for f in shape.firings)
        items.append(_is_selection(f"Is_{name}_Selection", f"{name}_Transition", count, params))
        right: Expr = Call(
            f"Is_{name}_Selection", (Arg(None, Ref(f"C.{name}")), *plain_args(params))
        )
        if inner := shape.inner_lanes(lane):
            idle = [equal(Ref(f"C.{shape.lane_name(n)}"), Ref("None")) for n in inner]
            none = equal(Ref(f"C.{name}"), Ref("None"))
            right = IfExpr(((chain("and then", idle), right),), none)
        lines.append(right)
    items += [
        Comment("The first transition of the lane that is enabled, or None when none is."),
        Subprogram(
            "Is_Choice",
            (Param("C", "in", "Choice"), *params),
            "Boolean",
            aspects=(Aspect("Ghost"),),
            expression=both(*flat(lines)),
        ),
        Comment("Each lane's first; none where a lane inside it has one."),
    ]
    for state in shape.left_states:
        names = [ada_case(f.name) for f in shape.firings if state in shape.compounds.left(f)]
        items += [
            Subprogram(
                f"Leaves_{ada_case(state)}",
                (Param("T", "in", "Selection"),),
                "Boolean",
                expression=_one_of("T", names),
            ),
            Comment(f"Does it leave {state} from inside? Then it fires alone there."),
        ]
    for state in shape.watched:
        left = call(f"Leaves_{ada_case(state)}", Ref("Fired.Items (I)"))
        items.append(
            Subprogram(
                f"Has_Left_{ada_case(state)}",
                (Param("Fired", "in", "Firing_List"),),
                "Boolean",
                expression=ForSome("I", "Fired.Items'Range", left),
            )
        )
    return items


def _is_selection(name: str, domain: str, count: int, params: tuple[Param, ...]) -> Subprogram:
    def enabled(which: str) -> Expr:
        return Call("Enabled", (Arg(None, Ref(which)), *plain_args(params)))

    first: list[Expr] = [enabled("Chosen")]
    if count > 1:
        earlier = Chain("<", (Ref("T"), Ref("Chosen")))
        first.append(ForAll("T", domain, IfExpr(((earlier, Prefix("not", enabled("T"))),), None)))
    strangers: tuple[tuple[Expr, Expr], ...]
    if domain == "Transition":
        strangers = ((equal(Ref("Chosen"), Ref(START)), FALSE),)
    else:
        strangers = ((Chain("not in", (Ref("Chosen"), Ref(domain))), FALSE),)
    none = ForAll("T", domain, Prefix("not", enabled("T")))
    rule = IfExpr(((equal(Ref("Chosen"), Ref("None")), none), *strangers), both(*first))
    return Subprogram(
        name,
        (Param("Chosen", "in", "Selection"), *params),
        "Boolean",
        aspects=(Aspect("Ghost"),),
        expression=rule,
    )


def _one_of(what: str, names: list[str]) -> Expr:
    """Is it one of these? In a form that can go on to the next line."""
    return chain("or else", [equal(Ref(what), Ref(name)) for name in names])


def _passing(shape: RegionShape) -> list[Decl]:
    if not shape.passes:
        return []
    place = Param(shape.place, "in", shape.place_type)
    ranks: dict[int, list[Expr]] = {}
    for pseudo in shape.region.pseudostates:
        if pseudo.kind in PASSED:
            ranks.setdefault(shape.rank(pseudo.name), []).append(
                shape.in_state(shape.place, pseudo.name)
            )
    branches = tuple(
        (chain("or else", ranks[rank]), number(rank)) for rank in sorted(ranks, reverse=True)
    )
    return [
        Subprogram("Segments_Left", (place,), "Natural", expression=IfExpr(branches, number(0))),
        Comment("How many segments follow at most; none but in a choice or history."),
    ]


def _deferred(shape: RegionShape) -> list[Decl]:
    rows: list[tuple[str, Expr]] = []
    for event in shape.region.events():
        states = [s.name for s in shape.region.states if event in s.defers]
        if states:
            inside = [shape.in_state(shape.place, s) for s in states]
            rows.append((shape.event(event), chain("or else", inside)))
    if len(rows) < len(shape.component.events):
        rows.append(("others", FALSE))
    place = Param(shape.place, "in", shape.place_type)
    return [
        Subprogram(
            "Is_Deferred",
            (Param("Item", "in", "Event"), place),
            "Boolean",
            expression=CaseExpr(Ref(name_of(shape.component, "Item")), tuple(rows)),
        ),
        Comment("Does an active state defer it?"),
        Subprogram(
            "Is_Deferral",
            (Param("T", "in", "Selection"),),
            "Boolean",
            expression=_one_of(
                "T", [ada_case(f.name) for f in shape.firings if f.kind is Kind.DEFERRAL]
            ),
        ),
    ]


# --- Operations --------------------------------------------------------------


def _operations(shape: RegionShape) -> list[Decl]:
    self_out = Param("Self", "in out", "Region")
    held = f"Self.{shape.place}"
    same = both(
        equal(Ref(held), Ref(f"{held}'Old")),
        equal(Ref("Self.Started"), Ref("Self.Started'Old")),
    )
    items: list[Decl] = []
    if shape.timers:
        items += [
            Subprogram("Tick", (self_out,), aspects=(Aspect("Post", same),)),
            Comment("One more execution: the time-outs come nearer."),
        ]
    items += notices(shape, same)
    due = equal(equal(Ref("Now"), Ref("Start_Of_Region")), Prefix("not", Ref("Self.Started")))
    post: list[Expr] = [same, due] if shape.polls_out else [due]
    if shape.completing:
        rows = tuple(
            (
                Ref(f"Self.{shape.completed(s)}'Old"),
                equal(Ref("Now"), Ref(f"Completion_Of_{ada_case(s)}")),
            )
            for s in shape.completing
        )
        post.append(IfExpr(((Ref("Self.Started"), IfExpr(rows, None)),), None))
    items += [
        Subprogram(
            "Poll",
            shape.poll_params(),
            aspects=(Aspect("Post", both(*post)),),
        ),
        Comment(_POLLS if shape.polls_more else _POLLS_TIME),
    ]
    if shape.region.events():
        rows_of = tuple((shape.event(e), Ref(f"On_{ada_case(e)}")) for e in shape.region.events())
        if len(rows_of) < len(shape.component.events):
            rows_of += (("others", Ref("Conditions")),)
        items += [
            Subprogram(
                "To_Occurrence",
                (Param("Item", "in", "Event"),),
                "Occurrence",
                expression=CaseExpr(Ref(name_of(shape.component, "Item")), rows_of),
            ),
        ]
    fired = "Firing_List" if shape.listed else "Selection"
    params = shape.step_params()
    items += [
        Subprogram(
            "Step",
            (
                params[0],
                Param("Now", "in", "Occurrence"),
                *params[1:],
                Param("Fired", "out", fired),
            ),
            aspects=(
                Aspect("Pre", due),
                Aspect("Post", both(Ref("Self.Started"), *_stepped(shape))),
            ),
        ),
        Comment("One run-to-completion step."),
    ]
    return items


_POLLS_TIME = "Its start, or the time-out that is due; Conditions when there is neither."
_POLLS = (
    "Its start, a completion, the time-out that is due or a deferred event that is due again; "
    "Conditions when there is none."
)


def _stepped(shape: RegionShape) -> list[Expr]:
    """What a step achieves, in terms of the chart as declared."""
    held = f"Self.{shape.place}"
    kept = equal(Ref(held), Ref(f"{held}'Old"))
    if not shape.listed:
        chosen = Call("Is_Selection", (Arg(None, Ref("Fired")), *shape.choice_args(old=True)))
        none = equal(Ref("Fired"), Ref("None"))
        moved = equal(Ref(held), shape.target("Fired"))
        started = equal(Ref("Fired"), Ref(START))
        return [
            IfExpr(((equal(Ref("Now"), Ref("Start_Of_Region")), started),), chosen),
            IfExpr(((none, kept),), moved),
        ]
    facts: list[Expr] = [
        IfExpr(((equal(Ref("Fired.Count"), number(0)), kept),), None),
    ]
    if shape.passes:
        rests = equal(call("Segments_Left", Ref(f"{held}'Old")), number(0))
        still = equal(call("Segments_Left", Ref(held)), number(0))
        facts.append(IfExpr(((rests, still),), None))
    if shape.single:
        first = equal(Ref("Now"), Ref("Start_Of_Region"))
        chosen = Call(
            "Is_Selection", (Arg(None, Ref("Fired.Items (1)")), *shape.choice_args(old=True))
        )
        facts.append(IfExpr(((first, equal(Ref("Fired.Items (1)"), Ref(START))),), chosen))
    return facts
