# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The charts of a model by name, with their states.

A chart is `instance.Region`, or `instance.Region.Nested` for a region of an orthogonal state: the
names that traces have.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from ravenchart.gen.model.statechart import PseudoKind, Region, RegionId
from ravenchart.gen.model.system import System


@dataclass(frozen=True, slots=True)
class NamedChart:
    """A region with its states, composite ones included."""

    name: str
    instance: str
    node: str
    """Where the instance runs."""
    states: Mapping[str, frozenset[str]]
    """Each state, and the leaf states that are inside it, or itself."""


def traced_chart(instance: str, region: str, orthogonal: str | None = None) -> str:
    """The name in traces of a top-level region, or of the orthogonal region of that name in it."""
    return ".".join((instance, region) if orthogonal is None else (instance, region, orthogonal))


def charts_of(system: System) -> dict[str, NamedChart]:
    """The charts of a model by their names, in its order."""
    found: dict[str, NamedChart] = {}
    for instance in system.instances:
        node = system.nodes[0].name if len(system.nodes) == 1 else instance.node
        for region in instance.component.regions:
            for one in reversed(region.concurrent_regions()):
                orthogonal = None if one.owner is None else one.name
                name = traced_chart(instance.name, region.name, orthogonal)
                found[name] = NamedChart(name, instance.name, node, dict(_states(region, one)))
    return found


def _states(region: Region, one: RegionId) -> Iterator[tuple[str, frozenset[str]]]:
    """Each state of a region with its leaves there: an orthogonal state is one of them."""
    own = [state for state in region.states if region.concurrent_region(state.name) == one]
    leaves = [state.name for state in own if len(state.regions) != 1]
    for state in own:
        inside = (leaf for leaf in leaves if state.name in region.ancestors(leaf))
        yield state.name, frozenset(inside)
    for end in region.pseudostates if one.owner is None else ():
        if end.kind is PseudoKind.TERMINATE:
            yield end.name, frozenset({end.name})
