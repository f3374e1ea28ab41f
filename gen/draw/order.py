# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which way a chart is read: from its initial states onward.

Graphviz gets an arrow that leads back turned round. So a vertex stands above those that follow
it, whatever cycles the chart has.
"""

from __future__ import annotations

import networkx as nx

from ravenchart.gen.model.statechart import RegionId

from .picture import Area, Picture


class Arrangement:
    """Where each vertex stands: what is around it, and its position in its area."""

    def __init__(self, picture: Picture) -> None:
        self.regions = {vertex.name: around for vertex, around in picture.vertices()}
        self.follows = [
            pair
            for arrow in picture.arrows
            if (pair := self._siblings(arrow.source, arrow.target)) is not None
        ]
        self.position: dict[str, int] = {}
        for _, area in picture.areas():
            for index, name in enumerate(self._in_order(area)):
                self.position[name] = index

    def common(self, one: str, other: str) -> RegionId:
        """The innermost area around both."""
        return next(region for region in self.regions[one] if region in self.regions[other])

    def chain(self, name: str) -> tuple[str, ...]:
        """A vertex and the states around it, innermost first."""
        return (name, *(owner for owner, _ in self.regions[name] if owner is not None))

    def is_back(self, source: str, target: str) -> bool:
        """Does an arrow lead to what is read before its source?"""
        pair = self._siblings(source, target)
        return pair is not None and self.position[pair[0]] > self.position[pair[1]]

    def _siblings(self, source: str, target: str) -> tuple[str, str] | None:
        """The outermost states that an arrow leaves and enters; None within one of its ends."""
        one, other = (reversed(self.chain(name)) for name in (source, target))
        return next((pair for pair in zip(one, other, strict=False) if pair[0] != pair[1]), None)

    def _in_order(self, area: Area) -> list[str]:
        """The vertices of an area: each part in reverse postorder from where it begins."""
        names = [vertex.name for vertex in area.vertices]
        graph: nx.DiGraph[str] = nx.DiGraph()
        graph.add_nodes_from(names)
        graph.add_edges_from((a, b) for a, b in self.follows if a in graph and b in graph)
        begin = () if area.initial is None else self.chain(area.initial)
        found: list[str] = []
        for name in (*(n for n in begin if n in names), *names):
            if name in graph:
                part = list(nx.dfs_postorder_nodes(graph, name))
                found += reversed(part)
                graph.remove_nodes_from(part)
        return found
