"""The types of a region's package: what a step reads, keeps, sends and remembers."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.naming import (
    ada_case,
    default_value,
    type_name,
    value,
    where,
)
from ravenchart.gen.emit.ada.syntax import (
    FALSE,
    Comment,
    Decl,
    EnumType,
    PlainType,
    RecordDeclaration,
    Ref,
    UseType,
)
from ravenchart.gen.emit.ada.syntax import RecordComponent as Field
from ravenchart.gen.emit.components.packages import reading_type

from .deferring import STORE, deferral_types
from .guards import guard_operators, guards_of
from .lasting import TIME_OUTS, domain_types, spans_of_states
from .safety import Safety
from .shape import START, RegionShape
from .working import done_types, work_fields

TIMED = ("Ravenchart.Timers.Timer", "Ravenchart.Timers.Timer_Array")
"""The types whose equality the contracts of time-outs use."""


def region_types(shape: RegionShape) -> list[Decl]:
    """All types of the package, and the operators that its chart uses."""
    names = tuple(f.literal for f in shape.firings)
    path = f"{shape.component.name}.{shape.region.name}"
    items: list[Decl] = _use_types(shape)
    items += [
        Comment(f"[{path}] what a step can be made for"),
        EnumType("Occurrence", shape.occurrences()),
        Comment(f"[{path}.transitions] in order of precedence, innermost source first"),
        EnumType("Selection", (START, *names, "None"), _places(shape)),
        PlainType(
            "Firing", f"Selection range {START} .. {names[-1] if names else 'None'}", subtype=True
        ),
        PlainType("Transition", _selection_of(names), subtype=True),
    ]
    if not shape.single:
        items += _lane_types(shape)
    return items + _records(shape)


def _places(shape: RegionShape) -> tuple[Comment, ...]:
    """The transition that each line of the chart is, and where it stands in the model."""
    model = shape.system.origin
    return (
        Comment(""),
        *(where(f.vertex or f.name, f.origins, model) for f in shape.firings),
        Comment(""),
    )


def _selection_of(names: Sequence[str]) -> str:
    """The range of these transitions; a chart without any has None, which is never enabled."""
    first, last = (names[0], names[-1]) if names else ("None", "None")
    return f"Selection range {first} .. {last}"


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
            *(TIMED if shape.timers else ()),
            *sorted(guard_operators(region) | Safety(shape).operators()),
            *sorted(shape.compared_in(guards_of(region))),
        )
    ]


def _lane_types(shape: RegionShape) -> list[Decl]:
    items: list[Decl] = []
    fields: list[Field] = []
    for lane in shape.busy_lanes:
        own = [f.literal for f in shape.firings if f.lane == lane]
        name = shape.lane_name(lane)
        items.append(PlainType(f"{name}_Transition", _selection_of(own), subtype=True))
        fields.append(Field(name, "Selection", Ref("None")))
    items += [
        Comment("What one occurrence fires: at most one transition in each lane."),
        RecordDeclaration("Choice", tuple(fields)),
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
        items += [
            Comment("The data that this region alone writes."),
            RecordDeclaration("Variables", rows),
        ]
    if shape.inputs:
        rows = tuple(
            Field(ada_case(n), reading_type(shape.system, component, n)) for n in shape.inputs
        )
        items += [
            Comment("What it reads, copied in once per execution."),
            RecordDeclaration("Inputs", rows),
        ]
    if shape.has_box:
        sent: list[Field] = [Field("Raised", "Event_Lists.List")] if region.raises else []
        for port in component.outputs():
            if port.name in region.sends:
                name = ada_case(port.name)
                of_type = type_name(shape.system, port.type)
                if not port.is_void:
                    sent.append(Field(name, of_type, default_value(shape.system, port.type)))
                sent.append(Field(f"{name}_Sent", "Boolean", FALSE))
        items += [
            Comment("What one step sends and raises."),
            RecordDeclaration("Outbox", tuple(sent)),
        ]
    if shape.memories:
        past: list[Field] = []
        for one in shape.memories:
            first = next(iter(shape.literals_in(one.place)))
            past.append(Field(one.last, shape.memory_type(one), Ref(shape.literal(first))))
            past.append(Field(one.known, "Boolean", FALSE))
        items += [
            Comment("What histories ask for: the last leaf left in a region, if any."),
            RecordDeclaration("Memory", tuple(past)),
        ]
    if shape.timers:
        all_of = f"Ravenchart.Timers.Timer_Array (1 .. {len(shape.timers)})"
        items.append(PlainType(TIME_OUTS, all_of, subtype=True))
    items += [*done_types(shape), *domain_types(shape)]
    if shape.deferring:
        items += deferral_types(shape, spans_of_states(shape))
    items += [
        Comment("The region's own state."),
        RecordDeclaration("Region", _region_fields(shape)),
    ]
    return items


def _region_fields(shape: RegionShape) -> tuple[Field, ...]:
    rows = [
        Field("Started", "Boolean", FALSE),
        Field(shape.place, shape.place_type, shape.initial() if shape.single else None),
    ]
    if shape.memories:
        rows.append(Field("Past", "Memory"))
    if shape.timers:
        rows.append(Field("Timers", TIME_OUTS))
    rows += [Field(shape.completed(s), "Boolean", FALSE) for s in shape.completing]
    rows += work_fields(shape)
    if shape.deferring:
        rows.append(Field("Deferred", STORE))
    if shape.region.writes:
        rows.append(Field("Data", "Variables"))
    return tuple(rows)
