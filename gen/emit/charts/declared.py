# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A region's package spec: its types, and the chart as declared.

`Enabled`, `In_Source` and `Target` are to be read against the model, a line for each transition.
`Is_Selection` tells which transition is selected. All proofs are about these functions.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    Package,
    Param,
    Subprogram,
    Unit,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    CaseExpr,
    Expr,
    ForSome,
    IfExpr,
    Indexed,
    both,
    call,
    chain,
    choice_of,
    equal,
    number,
    one_of,
    up_to,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.emit.language.compound import PASSED, Firing, FiringKind
from ravenchart.gen.emit.language.places import conjuncts
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System

from .history import restored_functions, restored_place
from .lanes import LIST, declared_lanes, firing_list
from .lasting import declared_lasting
from .operations import operations
from .records import chart_types, memory, records
from .safety import Safety
from .selection import is_selected, is_selection
from .shape import START, RegionShape
from .stepping import body_of


def emit_region(
    system: System, component: Component, region: Region, header: str, *, noted: bool = False
) -> tuple[Unit, ...]:
    """Spec and body of the package of one region; ``noted`` as in `Site`."""
    shape = RegionShape(system, component, region, noted=noted)
    withs = [ref("Ravenchart.Timers")] if shape.timers else []
    withs += [ref("Ravenchart.Deferrals")] if shape.deferring else []
    withs += [ref("Ravenchart.Firing_Lists")] if shape.listed else []
    spec = Package(shape.package, _spec(shape), (SPARK,))
    body = Package(shape.package, body_of(shape), (SPARK,), is_body=True)
    seen = (ref("Ravenchart.Steps"),) if noted else ()
    return Unit(header, tuple(withs), spec), Unit(header, seen, body)


def _spec(shape: RegionShape) -> tuple[Decl, ...]:
    return (
        *chart_types(shape),
        *_drawn(shape),
        *records(shape),
        *(firing_list(shape) if shape.listed else []),
        *_declared(shape),
        *Safety(shape).declared(),
        *operations(shape),
    )


# --- The chart as declared ---------------------------------------------------


MANY_LANES = 4
"""In charts with more busy regions a step calls In_Source. Inlined there, once for each region,
the function made the program grow with the square of the chart."""
INLINE, CALLED = (Aspect("Inline_Always"),), (Aspect("No_Inline"),)
"""Inlined in the selection, where the transition is known, one line of a function is left."""


def _drawn(shape: RegionShape) -> list[Decl]:
    """The chart as it is drawn: from where to where each transition leads."""
    place = Param(shape.place, "in", shape.place_type)
    sources = tuple((f.literal, shape.in_sources(f)) for f in shape.firings)
    start = shape.configuration(shape.after(shape.start), shape.place)
    targets = tuple((f.literal, _target(shape, f)) for f in shape.firings)
    return [
        Subprogram(
            "In_Source",
            (Param("T", "in", "Transition"), place),
            "Boolean",
            aspects=CALLED if len(shape.busy_lanes) > MANY_LANES else INLINE,
            expression=choice_of(ref("T"), sources or (("None", FALSE),)),
        ),
        Comment("The source of each transition: an active leaf, or an active state around it."),
        *memory(shape),
        *restored_functions(shape),
        Subprogram(
            "Target",
            (Param("T", "in", "Firing"), *shape.target_params()),
            shape.place_type,
            expression=choice_of(ref("T"), ((START, start), *(targets or (("None", start),)))),
        ),
        Comment(
            "The leaf that each transition leads to; that of a composite is its default."
            if shape.single
            else "The leaves that each transition leads to; those of a composite are its defaults."
        ),
    ]


def _declared(shape: RegionShape) -> list[Decl]:
    in_source = call("In_Source", ref("T"), ref("Self", shape.place))
    lines = tuple((f.literal, shape.enabled_when[f.literal]) for f in shape.firings)
    items: list[Decl] = [
        Subprogram(
            "Enabled",
            (Param("T", "in", "Transition"), *shape.situation),
            "Boolean",
            aspects=INLINE,
            expression=both(in_source, CaseExpr(ref("T"), lines or (("None", FALSE),))),
        ),
        Comment("The trigger and the guard of each transition."),
    ]
    items += declared_lasting(shape)
    items += _selections(shape)
    items += _passing(shape)
    if shape.listed:
        items += declared_lanes(shape)
    return items


def _target(shape: RegionShape, firing: Firing) -> Expr:
    if firing.kind is FiringKind.RESTORE:
        return restored_place(shape, firing.sources[0])
    if firing.kind in (FiringKind.INTERNAL, FiringKind.DEFERRAL):
        return ref(shape.place)
    return shape.configuration(shape.leads_to(firing), shape.place)


def _selections(shape: RegionShape) -> list[Decl]:
    first = "The first transition that is enabled, or None when none is."
    if shape.single:
        return [is_selection(shape), Comment(first)]
    lines: list[Expr] = []
    for lane in shape.busy_lanes:
        name = shape.lane_name(lane)
        right: Expr = is_selected(shape, ref("C", name), lane)
        if inner := shape.inner_lanes(lane):
            idle = [equal(ref("C", shape.lane_name(n)), ref("None")) for n in inner]
            none = equal(ref("C", name), ref("None"))
            right = IfExpr(((chain("and then", idle), right),), none)
        lines.append(right)
    items: list[Decl] = [
        is_selection(shape),
        Comment(first),
        Subprogram(
            "Is_Choice",
            (Param("C", "in", "Choice"), *shape.situation),
            "Boolean",
            aspects=(Aspect("Ghost"),),
            expression=both(*conjuncts(lines)),
        ),
        Comment("Each lane's first; none where a lane inside it has one."),
    ]
    for state in shape.left_states:
        names = [f.literal for f in shape.firings if state in shape.compounds.left(f)]
        items += [
            Subprogram(
                f"Leaves_{ada_case(state)}",
                (Param("T", "in", "Selection"),),
                "Boolean",
                expression=one_of(ref("T"), names),
            ),
            Comment(f"Does it leave {state} from inside? Then it fires alone there."),
        ]
    for state in shape.watched:
        left = call(f"Leaves_{ada_case(state)}", Indexed("Fired.Items", ref("I")))
        items.append(
            Subprogram(
                f"Has_Left_{ada_case(state)}",
                (Param("Fired", "in", LIST),),
                "Boolean",
                expression=ForSome("I", up_to(ref("Fired.Count")), left),
            )
        )
    return items


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
