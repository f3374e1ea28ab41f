"""A chart's tree: where vertices stand, and what two of them have in common.

A *place* is a region of the chart: the state around it and its name, (None, "")
for the top-level region. Every state and pseudostate stands in one place.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ravenchart.gen.model.statechart import (
    Completion,
    PseudoKind,
    Pseudostate,
    Region,
    State,
    Transition,
)

RegionKey = tuple[str | None, str]
TOP: RegionKey = (None, "")


class ChartTree:
    """A top-level region, indexed."""

    def __init__(self, region: Region) -> None:
        """The tree of ``region``."""
        self.region = region
        self.states: dict[str, State] = {s.name: s for s in region.states}
        self.pseudo: dict[str, Pseudostate] = {p.name: p for p in region.pseudostates}
        self.leaving: dict[str, tuple[Transition, ...]] = {
            name: self._leaving(name) for name in (*self.states, *self.pseudo)
        }

    def _leaving(self, vertex: str) -> tuple[Transition, ...]:
        """In the order they are tried: model order, ``else`` last."""
        mine = [t for t in self.region.transitions if t.source == vertex]
        return (*(t for t in mine if not t.otherwise), *(t for t in mine if t.otherwise))

    def kind(self, vertex: str) -> PseudoKind | None:
        """What kind of pseudostate; None for a state."""
        return self.pseudo[vertex].kind if vertex in self.pseudo else None

    def place(self, vertex: str) -> RegionKey:
        """Where a vertex stands."""
        at = self.pseudo[vertex] if vertex in self.pseudo else self.states[vertex]
        return at.parent, at.region

    def places(self, vertex: str) -> list[RegionKey]:
        """All places that a vertex is in, innermost first."""
        found = [self.place(vertex)]
        while (owner := found[-1][0]) is not None:
            found.append(self.place(owner))
        return found

    def around(self, vertex: str) -> list[str]:
        """The states around a vertex, innermost first."""
        return [owner for owner, _ in self.places(vertex) if owner is not None]

    def nested(self, state: str) -> list[RegionKey]:
        """The places directly inside a state, in model order."""
        return [(state, region.name) for region in self.states[state].regions]

    def common(self, vertices: Sequence[str]) -> RegionKey:
        """The innermost place that all the vertices are in."""
        others = [self.places(vertex) for vertex in vertices[1:]]
        return next(p for p in self.places(vertices[0]) if all(p in other for other in others))

    def towards(self, place: RegionKey, vertex: str) -> str:
        """What stands in ``place`` and is, or is around, ``vertex``."""
        chain = (vertex, *self.around(vertex))
        return next(one for one in chain if self.place(one) == place)

    def fills_lane(self, state: str) -> bool:
        """Whether a state is a leaf of its lane: it has no region, or several."""
        return len(self.states[state].regions) != 1

    def lane(self, vertex: str) -> list[RegionKey]:
        """The places that a vertex is in, as far as the region of an orthogonal state around it."""
        found: list[RegionKey] = []
        for place in self.places(vertex):
            found.append(place)
            if place[0] is not None and len(self.states[place[0]].regions) > 1:
                break
        return found

    def into(self, vertex: str) -> list[Transition]:
        """The transitions that lead to a vertex, in model order."""
        return [t for t in self.region.transitions if t.target == vertex]

    def can_complete(self, state: str) -> bool:
        """Whether anything waits for the completion of a state."""
        return any(isinstance(t.trigger, Completion) for t in self.leaving[state])

    def default(self, places: Iterable[RegionKey] = (TOP,)) -> frozenset[str]:
        """The states that entering places by default makes active."""
        found: set[str] = set()
        for place in places:
            owner, name = place
            initial = (
                self.region.initial if owner is None else self.states[owner].nested(name).initial
            )
            path = [initial.target, *self.around(initial.target)]
            path = path[: path.index(owner)] if owner is not None else path
            found.update(path)
            for outer, inner in zip(path[1:], path, strict=False):
                others = [p for p in self.nested(outer) if p not in self.places(inner)]
                found |= self.default(others)
            found |= self.default(self.nested(initial.target))
        return frozenset(found)
