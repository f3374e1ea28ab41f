# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Configurations in Ada: the types of the leaves, and the test for a state.

The leaves of a top-level or orthogonal region are one enumeration in tree order, and a composite
is the subtype of its leaves. A chart without orthogonal regions keeps its active leaf in one
value. Any other keeps a record, its *configuration*, with a component for each such region.
"""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import (
    Decl,
    EnumType,
    Package,
    RecordComponent,
    RecordDeclaration,
    SubtypeDeclaration,
)
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Expr,
    OperatorChain,
    Range,
    RangeConstrained,
    both,
    equal,
    member,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import ada_case, states_package, where
from ravenchart.gen.emit.ada.statements import Comment
from ravenchart.gen.model.statechart import TOP, PseudoKind, Region, RegionId
from ravenchart.gen.origins import Origin

from .compound import Enter, EntryStep, compounds_of
from .own_names import state_literal


class Configurations:
    """The configurations of one chart, as they are held and tested."""

    def __init__(self, region: Region) -> None:
        self.compounds = compounds_of(region)
        self.region = self.compounds.region  # triggers are compared by identity
        self.concurrent = region.concurrent_regions()

    @property
    def states(self) -> str:
        """Nested package of the leaf states."""
        return states_package(self.region)

    @property
    def single(self) -> bool:
        """No orthogonal regions: a leaf is the whole configuration."""
        return len(self.concurrent) == 1

    @property
    def configuration_type(self) -> DottedName:
        """The type of a configuration, from inside the component's packages."""
        return ref(self.states, "Leaf" if self.single else "Configuration")

    @property
    def configuration_name(self) -> str:
        """The parameter and component that hold a configuration."""
        return "Leaf" if self.single else "Configuration"

    def is_end(self, vertex: str) -> bool:
        """Whether it is a terminate, which ends the whole chart in whatever state it stands."""
        pseudo = self.region.pseudostate(vertex)
        return pseudo is not None and pseudo.kind is PseudoKind.TERMINATE

    def concurrent_region(self, vertex: str) -> RegionId:
        """The top-level or orthogonal region among whose leaves a vertex is."""
        return TOP if self.is_end(vertex) else self.region.concurrent_region(vertex)

    def ancestors(self, leaf: str) -> tuple[str, ...]:
        """A leaf and the states that are active around it, innermost first."""
        return (leaf,) if self.is_end(leaf) else self.region.ancestors(leaf)

    def leaves_type(self, region: RegionId) -> str:
        """The enumeration of a region's leaves, as its package names it."""
        return "Leaf" if region.owner is None else f"{ada_case(region.name)}_Leaf"

    def leaf_field(self, region: RegionId) -> str:
        """Its component of a configuration."""
        return "Top" if region.owner is None else f"In_{ada_case(region.name)}"

    def at(self, holder: Named, region: RegionId) -> DottedName:
        """The leaf of a region in the configuration that ``holder`` names."""
        return ref(holder) if self.single else ref(holder, self.leaf_field(region))

    def literals(self, region: RegionId) -> tuple[str, ...]:
        """The leaves of any region in tree order, passed pseudostates behind their siblings.

        The regions of an orthogonal state inside have their own.
        """
        return tuple(self._literals(region))

    def _literals(self, region: RegionId) -> Iterator[str]:
        for state in self.region.children(*region):
            if len(state.regions) == 1:
                yield from self._literals(state.region_ids[0])
            else:
                yield state.name
        yield from self.compounds.passed(region)

    def is_literal(self, vertex: str) -> bool:
        """Is it a leaf of its region, rather than a range of leaves?"""
        return (
            self.region.pseudostate(vertex) is not None
            or len(self.region.state(vertex).regions) != 1
        )

    def literal(self, vertex: str, component: str | None = None) -> DottedName:
        """A leaf or composite by its expanded name, as seen from inside ``component`` if given."""
        own = ref(self.states, state_literal(vertex))
        return own if component is None else ref(component, own)

    def in_state(self, holder: Named, vertex: str, component: str | None = None) -> Expr:
        """Is the configuration that ``holder`` names in a state, or inside it?"""
        region = self.concurrent_region(vertex)
        leaf, name = self.at(holder, region), self.literal(vertex, component)
        here = equal(leaf, name) if self.is_literal(vertex) else member(leaf, name)
        if region.owner is None:
            return here
        return both(*conjuncts([self.in_state(holder, region.owner, component), here]))

    def traced(self, region: RegionId) -> str:
        """The name of a top-level or orthogonal region in traces."""
        return self.region.name if region.owner is None else f"{self.region.name}.{region.name}"

    def compared_types(self, state: str) -> tuple[str, ...]:
        """The types whose equality the test for a state uses, without their package."""
        found: list[str] = []
        at: str | None = state
        while at is not None:
            region = self.region.concurrent_region(at)
            if self.is_literal(at):
                found.append(self.leaves_type(region))
            at = region.owner
        return tuple(found)

    def package_of_states(self, model: Origin) -> Package:
        """The enumerations, the composites, and the configuration of orthogonal regions.

        Each state has its location in the model, as seen from ``model``.
        """
        items: list[Decl] = []
        for region in reversed(self.concurrent):
            leaves = self.literals(region)
            names = tuple(map(state_literal, leaves))
            notes = tuple(self._where(name, model) for name in leaves)
            items.append(EnumType(self.leaves_type(region), names, notes))
        for state in self.region.states:
            if len(state.regions) == 1:
                leaves = self.literals(state.region_ids[0])
                bounds = Range(ref(state_literal(leaves[0])), ref(state_literal(leaves[-1])))
                base = RangeConstrained(self.parent_type(state.name), bounds)
                items.append(self._where(state.name, model))
                items.append(SubtypeDeclaration(state_literal(state.name), base))
        if not self.single:
            rows = tuple(
                RecordComponent(
                    self.leaf_field(region),
                    self.leaves_type(region),
                    ref(state_literal(self.region.default_of(region))),
                )
                for region in reversed(self.concurrent)
            )
            items.append(RecordDeclaration("Configuration", rows))
        return Package(self.states, tuple(items))

    def _where(self, vertex: str, model: Origin) -> Comment:
        """The state or pseudostate, and where it stands in the model."""
        found = self.region.pseudostate(vertex) or self.region.state(vertex)
        return where(found.name, (found.origin,), model)

    def parent_type(self, state: str) -> str:
        """The type that a composite's leaves are a range of."""
        region = self.region.concurrent_region(state)
        parent = self.region.state(state).parent
        if parent is None or parent == region.owner:
            return self.leaves_type(region)
        return state_literal(parent)

    def orthogonal_regions(self, state: str) -> tuple[RegionId, ...]:
        """The regions of an orthogonal state; none of any other."""
        return tuple(region for region in self.concurrent if region.owner == state)

    def after(self, entries: tuple[EntryStep, ...]) -> dict[RegionId, str]:
        """The leaves that entries lead to, by region; other regions keep theirs."""
        found: dict[RegionId, str] = {}
        for step in entries:
            if isinstance(step, Enter) and self.is_literal(step.vertex):
                found[self.region.concurrent_region(step.vertex)] = step.vertex
                inside = self.orthogonal_regions(step.vertex)
                found |= {region: self.region.default_of(region) for region in inside}
        return found

    def configuration(
        self, leaves: dict[RegionId, str], kept: Named | None, component: str | None = None
    ) -> Expr:
        """A configuration with these leaves; those of other regions come from ``kept``."""
        rows = tuple(
            Arg(self.leaf_field(region), self.literal(leaves[region], component))
            for region in reversed(self.concurrent)
            if region in leaves
        )
        base = None if kept is None or len(rows) == len(self.concurrent) else ref(kept)
        if not rows:
            assert base is not None
            return base
        return rows[0].value if self.single else Aggregate(rows, base=base)

    def initial(self, component: str | None = None) -> Expr:
        """The configuration before the region has started, seen from inside ``component``."""
        leaves = {region: self.region.default_of(region) for region in self.concurrent}
        return self.configuration(leaves, None, component)


def conjuncts(parts: list[Expr]) -> list[Expr]:
    """One conjunction instead of nested ones."""
    found: list[Expr] = []
    for part in parts:
        if isinstance(part, OperatorChain) and part.operator == "and then":
            found += conjuncts(list(part.operands))
        else:
            found.append(part)
    return found
