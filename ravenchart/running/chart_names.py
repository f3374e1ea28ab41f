# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The charts of a model by name, with their states.

A chart is `instance.Region`, or `instance.Region.Nested` for a region of an orthogonal state: the
names that traces have.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from ravenchart.gen.model.statechart import Lane, PseudoKind, Region
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


def traced_chart(instance: str, region: str, lane: Lane) -> str:
    """The name in traces of a top-level or orthogonal region."""
    inside = "" if lane.owner is None else f".{lane.name}"
    return f"{instance}.{region}{inside}"


def charts_of(system: System) -> dict[str, NamedChart]:
    """The charts of a model by their names, in its order."""
    found: dict[str, NamedChart] = {}
    for instance in system.instances:
        node = system.nodes[0].name if len(system.nodes) == 1 else instance.node
        for region in instance.component.regions:
            for lane in reversed(region.lanes()):
                name = traced_chart(instance.name, region.name, lane)
                found[name] = NamedChart(name, instance.name, node, dict(_states(region, lane)))
    return found


def _states(region: Region, lane: Lane) -> Iterator[tuple[str, frozenset[str]]]:
    """Each state of a region with its leaves there: an orthogonal state is one of them."""
    own = [state for state in region.states if region.lane(state.name) == lane]
    leaves = [state.name for state in own if len(state.regions) != 1]
    for state in own:
        inside = (leaf for leaf in leaves if state.name in region.ancestors(leaf))
        yield state.name, frozenset(inside)
    for end in region.pseudostates if lane.owner is None else ():
        if end.kind is PseudoKind.TERMINATE:
            yield end.name, frozenset({end.name})
