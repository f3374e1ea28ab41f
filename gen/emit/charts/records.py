# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The types of a region's package: what a step reads, keeps, sends and remembers."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import (
    Decl,
    EnumType,
    IndexConstrained,
    RecordComponent,
    RecordDeclaration,
    SubtypeDeclaration,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    Range,
    RangeConstrained,
    plain,
    up_to,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    default_value,
    type_name,
    value,
    where,
)
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.emit.components.packages import reading_type

from .deferring import STORE, deferral_types
from .guards import guard_operators, guards_of
from .lasting import TIME_OUTS, domain_types, spans_of_states
from .safety import Safety
from .shape import START, RegionShape
from .summary import summary
from .working import done_types, work_fields

TIMED = (ref("Ravenchart.Timers.Timer"), ref("Ravenchart.Timers.Timer_Array"))
"""The types whose equality the contracts of time-outs use."""


def chart_types(shape: RegionShape) -> list[Decl]:
    """The occurrences and the transitions, and the operators that the chart uses."""
    names = tuple(f.literal for f in shape.firings)
    path = f"{shape.component.name}.{shape.region.name}"
    items: list[Decl] = _use_types(shape)
    items += [
        Comment(f"[{path}] the occurrences that a step can handle"),
        EnumType("Occurrence", shape.occurrences()),
        Comment(
            f"[{path}.transitions] in order of precedence, innermost source first:\n"
            + "\n".join(f"  {summary(firing)}" for firing in shape.firings)
        ),
        EnumType("Selection", (START, *names, "None"), _places(shape)),
        SubtypeDeclaration("Firing", _selection_of((START, *(names or ("None",))))),
        SubtypeDeclaration("Transition", _selection_of(names)),
    ]
    if not shape.single:
        items += _choice_types(shape)
    return items


def _places(shape: RegionShape) -> tuple[Comment, ...]:
    """The transition that each line of the chart is, and where it stands in the model."""
    model = shape.system.origin
    return (
        Comment(""),
        *(where(f.vertex or f.name, f.origins, model) for f in shape.firings),
        Comment(""),
    )


def _selection_of(names: Sequence[str]) -> RangeConstrained:
    """The range of these transitions; a chart without any has None, which is never enabled."""
    first, last = (names[0], names[-1]) if names else ("None", "None")
    return RangeConstrained("Selection", Range(ref(first), ref(last)))


def _use_types(shape: RegionShape) -> list[Decl]:
    """The types whose operators the declared chart uses."""
    region = shape.region
    own = {ref(shape.states, shape.leaves_type(r)) for r in shape.concurrent}
    if not shape.single:
        own.add(shape.configuration_type)
    leaf = ref(shape.states, "Leaf")
    ordered = [leaf, *sorted(own - {leaf})]
    return [
        UseType(n)
        for n in (
            *ordered,
            *(TIMED if shape.timers else ()),
            *sorted(guard_operators(region) | Safety(shape).operators()),
            *sorted(shape.compared_in(guards_of(region))),
        )
    ]


def _choice_types(shape: RegionShape) -> list[Decl]:
    items: list[Decl] = []
    fields: list[RecordComponent] = []
    for region in shape.busy_regions:
        own = [f.literal for f in shape.firings if f.region == region]
        name = shape.label(region)
        items.append(SubtypeDeclaration(shape.transitions_of(region), _selection_of(own)))
        fields.append(RecordComponent(name, "Selection", ref("None")))
    items += [
        Comment("The transitions selected for one occurrence: at most one in each region."),
        RecordDeclaration("Choice", tuple(fields)),
    ]
    return items


def memory(shape: RegionShape) -> list[Decl]:
    """The last leaves that histories restore, where there are histories."""
    if not shape.memories:
        return []
    past: list[RecordComponent] = []
    for one in shape.memories:
        first = shape.literals(one.region)[0]
        past.append(RecordComponent(one.last, shape.memory_type(one), shape.literal(first)))
        past.append(RecordComponent(one.known, "Boolean", FALSE))
    return [
        Comment("The last leaf left in each region that a history restores."),
        RecordDeclaration("Memory", tuple(past)),
    ]


def records(shape: RegionShape) -> list[Decl]:
    """The values that a step reads, keeps and sends."""
    region, component = shape.region, shape.component
    items: list[Decl] = []
    if region.writes:
        rows = tuple(
            RecordComponent(
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
            RecordComponent(ada_case(n), reading_type(shape.system, component, n))
            for n in shape.inputs
        )
        items += [
            Comment("The inputs of the region, copied in once per execution."),
            RecordDeclaration("Inputs", rows),
        ]
    if shape.has_box:
        sent: list[RecordComponent] = (
            [RecordComponent("Raised", "Event_Lists.List")] if region.raises else []
        )
        for port in component.outputs():
            if port.name in region.sends:
                name = ada_case(port.name)
                of_type = type_name(shape.system, port.type)
                if not port.is_void:
                    sent.append(
                        RecordComponent(name, of_type, default_value(shape.system, port.type))
                    )
                sent.append(RecordComponent(f"{name}_Sent", "Boolean", FALSE))
        items += [
            Comment("The values that one step sends, and the events that it raises."),
            RecordDeclaration("Outbox", tuple(sent)),
        ]
    if shape.timers:
        each = up_to(plain(len(shape.timers)))
        timers = IndexConstrained("Ravenchart.Timers.Timer_Array", each)
        items.append(SubtypeDeclaration(TIME_OUTS, timers))
    items += [*done_types(shape), *domain_types(shape)]
    if shape.deferring:
        items += deferral_types(shape, spans_of_states(shape))
    items += [
        Comment("The region's own state."),
        RecordDeclaration("Region", _region_fields(shape)),
    ]
    return items


def _region_fields(shape: RegionShape) -> tuple[RecordComponent, ...]:
    rows = [
        RecordComponent("Started", "Boolean", FALSE),
        RecordComponent(
            shape.configuration_name,
            shape.configuration_type,
            shape.initial() if shape.single else None,
        ),
    ]
    if shape.memories:
        rows.append(RecordComponent("Past", "Memory"))
    if shape.timers:
        rows.append(RecordComponent("Timers", TIME_OUTS))
    rows += [RecordComponent(shape.completed(s), "Boolean", FALSE) for s in shape.completing]
    rows += work_fields(shape)
    if shape.deferring:
        rows.append(RecordComponent("Deferred", STORE))
    if shape.region.writes:
        rows.append(RecordComponent("Data", "Variables"))
    return tuple(rows)
