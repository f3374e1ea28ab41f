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
from ravenchart.gen.emit.language.configurations import conjuncts
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System

from .history import restored_configuration, restored_functions
from .lasting import declared_lasting
from .operations import operations
from .records import chart_types, memory, records
from .safety import Safety
from .selection import is_selected, is_selection
from .several_transitions import LIST, declared_choice, firing_list
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


MANY_REGIONS = 4
"""In charts with more busy regions a step calls In_Source. Inlined there, once for each region,
the function made the program grow with the square of the chart."""
INLINE, CALLED = (Aspect("Inline_Always"),), (Aspect("No_Inline"),)
"""Inlined in the selection, where the transition is known, one line of a function is left."""


def _drawn(shape: RegionShape) -> list[Decl]:
    """The chart as it is drawn: from where to where each transition leads."""
    sources = tuple((f.literal, shape.in_sources(f)) for f in shape.firings)
    start = shape.configuration(shape.after(shape.start), shape.configuration_name)
    targets = tuple((f.literal, _target(shape, f)) for f in shape.firings)
    return [
        Subprogram(
            "In_Source",
            (Param("T", "in", "Transition"), shape.configuration_param),
            "Boolean",
            aspects=CALLED if len(shape.busy_regions) > MANY_REGIONS else INLINE,
            expression=choice_of(ref("T"), sources or (("None", FALSE),)),
        ),
        Comment("Whether the source of T is active; of a join, whether all its sources are."),
        *memory(shape),
        *restored_functions(shape),
        Subprogram(
            "Target",
            (Param("T", "in", "Firing"), *shape.target_params()),
            shape.configuration_type,
            expression=choice_of(ref("T"), ((START, start), *(targets or (("None", start),)))),
        ),
        Comment(
            "The leaf that T leads to; for a composite state, its default leaf."
            if shape.single
            else "The leaves that T leads to; for a composite state, its default leaves."
        ),
    ]


def _declared(shape: RegionShape) -> list[Decl]:
    in_source = call("In_Source", ref("T"), ref("Self", shape.configuration_name))
    lines = tuple((f.literal, shape.enabled_when[f.literal]) for f in shape.firings)
    items: list[Decl] = [
        Subprogram(
            "Enabled",
            (Param("T", "in", "Transition"), *shape.situation),
            "Boolean",
            aspects=INLINE,
            expression=both(in_source, CaseExpr(ref("T"), lines or (("None", FALSE),))),
        ),
        Comment(
            "Whether T is enabled: its source is active, Now triggers it, and its guard holds."
        ),
    ]
    items += declared_lasting(shape)
    items += _selections(shape)
    items += _passing(shape)
    if shape.listed:
        items += declared_choice(shape)
    return items


def _target(shape: RegionShape, firing: Firing) -> Expr:
    if firing.kind is FiringKind.RESTORE:
        return restored_configuration(shape, firing.sources[0])
    if firing.kind in (FiringKind.INTERNAL, FiringKind.DEFERRAL):
        return ref(shape.configuration_name)
    return shape.configuration(shape.leads_to(firing), shape.configuration_name)


def _selections(shape: RegionShape) -> list[Decl]:
    first = "Whether Chosen is the first enabled transition{}, or None when none is enabled."
    if shape.single:
        return [is_selection(shape), Comment(first.format(""))]
    lines: list[Expr] = []
    for region in shape.busy_regions:
        name = shape.label(region)
        right: Expr = is_selected(shape, ref("C", name), region)
        if inner := shape.inner_regions(region):
            idle = [equal(ref("C", shape.label(r)), ref("None")) for r in inner]
            none = equal(ref("C", name), ref("None"))
            right = IfExpr(((chain("and then", idle), right),), none)
        lines.append(right)
    items: list[Decl] = [
        is_selection(shape),
        Comment(first.format(" from First to Last")),
        Subprogram(
            "Is_Choice",
            (Param("C", "in", "Choice"), *shape.situation),
            "Boolean",
            aspects=(Aspect("Ghost"),),
            expression=both(*conjuncts(lines)),
        ),
        Comment(
            "Whether C has the first enabled transition of each region, and None where a region "
            "inside it has one."
        ),
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
            Comment(
                f"Whether T leaves {state} from inside. The step then takes no other transition "
                f"in {state}."
            ),
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
    ranks: dict[int, list[Expr]] = {}
    for pseudo in shape.region.pseudostates:
        if pseudo.kind in PASSED:
            ranks.setdefault(shape.rank(pseudo.name), []).append(
                shape.in_state(shape.configuration_name, pseudo.name)
            )
    branches = tuple(
        (chain("or else", ranks[rank]), number(rank)) for rank in sorted(ranks, reverse=True)
    )
    return [
        Subprogram(
            "Segments_Left",
            (shape.configuration_param,),
            "Natural",
            expression=IfExpr(branches, number(0)),
        ),
        Comment("The most segments that follow; 0 unless a choice or history is active."),
    ]
