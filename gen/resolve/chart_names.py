# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The names of a chart's vertices, which can be looked up before anything is resolved."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from ravenchart.gen.files.schema import NestedRegionForm, RegionForm, StateForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.model.statechart import PseudoKind
from ravenchart.gen.origins import Origin


class WrittenVertex(NamedTuple):
    """A vertex as it is written: its form, and the state and region that it stands in."""

    name: str
    form: StateForm
    parent: str | None
    region: str


def walk(
    states: Mapping[str, StateForm] | None, parent: str | None = None, region: str = ""
) -> Iterator[WrittenVertex]:
    """Every state and pseudostate, in tree order."""
    for name, form in (states or {}).items():
        yield WrittenVertex(name, form, parent, region)
        yield from walk(form.states, name)
        for nested, at in (form.regions or {}).items():
            yield from walk(at.states, name, nested)


def concurrent_states(states: Mapping[str, StateForm] | None) -> frozenset[str]:
    """The states in one of several regions of a state, at any depth, in lower case."""
    found: set[str] = set()
    for form in (states or {}).values():
        for nested in (form.regions or {}).values():
            found |= {row.name.lower() for row in walk(nested.states)}
        found |= concurrent_states(form.states)
    return frozenset(found)


@dataclass(frozen=True, slots=True)
class NamedVertex:
    """The vertex that a name in a chart stands for, as far as its kind tells."""

    name: str
    what: str
    """Its kind in words."""
    pseudo: PseudoKind | None = None
    is_state: bool = True
    is_composite: bool = False

    @property
    def is_final(self) -> bool:
        """A final state."""
        return self.is_state and self.what == FINAL_STATE

    @property
    def shown(self) -> str:
        """Kind and name."""
        return f"{self.what} {self.name}"


FINAL_STATE = "final state"
REGION_HINT = "name a state in it, or the state around it"
PSEUDO_WORDS = {
    PseudoKind.CHOICE: "choice",
    PseudoKind.JUNCTION: "junction",
    PseudoKind.HISTORY: "history",
    PseudoKind.DEEP_HISTORY: "deep history",
    PseudoKind.FORK: "fork",
    PseudoKind.JOIN: "join",
    PseudoKind.TERMINATE: "terminate pseudostate",
}


def vertex_of(name: str, form: StateForm) -> NamedVertex:
    """The vertex that a form under ``states`` declares."""
    if form.kind == "final":
        return NamedVertex(name, FINAL_STATE)
    if form.kind is not None:
        kind = PseudoKind(form.kind)
        return NamedVertex(name, PSEUDO_WORDS[kind], kind, is_state=False)
    return NamedVertex(name, "state", is_composite=bool(form.states or form.regions))


class _Stand(NamedTuple):
    """A vertex, the state around it, and the region of that state in which it stands."""

    vertex: str
    parent: str | None
    region: str


@dataclass(slots=True)
class States(NameScope[str]):
    """The states of a region; ``vertices`` holds pseudostates and nested regions too."""

    vertices: NameScope[NamedVertex] = field(default_factory=lambda: NameScope("state"))
    parents: dict[str, str | None] = field(default_factory=dict)
    """The state around each vertex, by its name in lower case."""
    nested: dict[str, str] = field(default_factory=dict)
    """The region of that state in which each vertex stands, by its name in lower case."""

    def is_beside(self, source: str, state: str) -> bool:
        """Whether nothing is known of a state where a vertex is active.

        It stands in another region of an orthogonal state around it, or further inside than one.
        """
        ways = [self._way(state.lower()), self._way(source.lower())]
        while all(ways) and ways[0][0] == ways[1][0]:
            ways = [way[1:] for way in ways]
        mine, other = ways
        if mine and other:  # the ways part in one state: in two regions of it, or in one
            return mine[0].region != other[0].region
        return any(self._is_orthogonal(stand.parent) for stand in mine)

    def _way(self, vertex: str) -> list[_Stand]:
        """Where a vertex and the states around it stand, from the top."""
        parent = self.parents.get(vertex)
        outer = [] if parent is None else self._way(parent.lower())
        return [*outer, _Stand(vertex, parent, self.nested.get(vertex, ""))]

    def _is_orthogonal(self, state: str | None) -> bool:
        inside = (vertex for vertex, parent in self.parents.items() if parent == state)
        return len({self.nested[vertex] for vertex in inside}) > 1

    def around(self, name: str) -> tuple[str, ...]:
        """The states around a vertex, innermost first."""
        parent = self.parents.get(name.lower())
        return () if parent is None else (parent, *self.around(parent))

    def look_up(self, name: str, origin: Origin, findings: Findings) -> str | None:
        """The state of that name; reported when there is none."""
        vertex = self.vertices.look_up(name, origin, findings)
        if vertex is None or vertex.is_state:
            return None if vertex is None else vertex.name
        message = f"expected a state, found the {vertex.what} `{vertex.name}`"
        hint = REGION_HINT if vertex.pseudo is None else "a step cannot end there: name a state"
        findings.error("RV-0514", origin, message, hint=hint)
        return None

    def vertex(self, name: str, origin: Origin, findings: Findings) -> NamedVertex | None:
        """The state or pseudostate of that name; reported when there is none."""
        found = self.vertices.look_up(name, origin, findings)
        if found is None or found.is_state or found.pseudo is not None:
            return found
        message = f"expected a state or pseudostate, found the {found.what} `{found.name}`"
        findings.error("RV-0514", origin, message, hint=REGION_HINT)
        return None


def names_of(region: str, form: RegionForm, findings: Findings) -> States:
    """The names of a region's states; open when some were lost."""
    scope = States(f"state of {region}")
    scope.vertices = NameScope(f"state of {region}")
    scope.open = _lost(form, "states", scope)
    for name, at, parent, nested_in in walk(form.states):
        vertex = vertex_of(name, at)
        scope.parents.setdefault(name.lower(), parent)
        scope.nested.setdefault(name.lower(), nested_in)
        _declare(vertex, at.origin, scope, findings)
        scope.open = _lost(at, "states", scope) or scope.open
        scope.open = at.lost("regions") or bool(at.dropped("regions")) or scope.open
        for nested, inner in (at.regions or {}).items():
            around = NamedVertex(nested, "region", is_state=False)
            _declare(around, inner.origin, scope, findings)
            scope.open = _lost(inner, "states", scope) or scope.open
    scope.vertices.open = scope.open
    return scope


def _declare(vertex: NamedVertex, origin: Origin, scope: States, findings: Findings) -> None:
    known = scope.vertices.items.get(vertex.name.lower())
    first = None if known is None else known[2]
    if known is not None and first is not None and first.what != vertex.what:
        message = f"the {vertex.what} `{vertex.name}` is named like the {first.what} `{first.name}`"
        notes = [] if known[1] is None else [(known[1], f"the {first.what} is here")]
        hint = "rename one of them; the names in a region are all different"
        findings.error("RV-0303", origin, message, notes=notes, hint=hint)
        return
    kind = scope.kind.replace("state", vertex.what, 1)
    NameScope(kind, scope.vertices.items).declare(vertex.name, origin, vertex, findings)
    if vertex.is_state:
        scope.declare(vertex.name, origin, vertex.name)


def _lost(form: RegionForm | StateForm | NestedRegionForm, key: str, scope: States) -> bool:
    """Whether states were taken out; those whose names are known are declared without a word."""
    for gone in form.dropped(key):
        scope.declare(gone, None, None)
        scope.vertices.declare(gone, None, None)
    return form.lost(key) or bool(form.dropped(key))
