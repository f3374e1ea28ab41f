# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A chart as the model has it, and the lines of its declared form that follow.

The rules are those of docs/semantics.md (UML 2.5.1, 14.2.3). A line is one of these:

- a transition of a state, with the junctions, forks and joins on its way;
- a segment that leaves a choice or a history;
- the restoring of a history, or a deferral.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from .findings import UnusableError
from .model import Mapping

Region = tuple[str | None, str]
"""A region: the state it is in (None: the top-level one), and its name ("": the only one)."""

TOP: Region = (None, "")
PASSED = ("choice", "history", "deep_history")


@dataclass(frozen=True, slots=True)
class Vertex:
    """A state or pseudostate."""

    name: str
    kind: str
    """`state`, `final`, or the kind of a pseudostate."""
    region: Region
    inside: tuple[Region, ...]
    form: Mapping

    @property
    def is_state(self) -> bool:
        """A state, a final one included."""
        return self.kind in ("state", "final")

    @property
    def is_range(self) -> bool:
        """A composite state: a range of leaves."""
        return len(self.inside) == 1


@dataclass(frozen=True, slots=True)
class Transition:
    """A transition or segment."""

    name: str
    source: str
    target: str
    form: Mapping

    @property
    def kind(self) -> str:
        """`internal`, `local` or `external`."""
        if self.form.true("internal") or self.form.text("to") is None:
            return "internal"
        return "local" if self.form.true("local") else "external"

    @property
    def otherwise(self) -> bool:
        """Taken where no other segment is."""
        return (self.form.text("guard") or "").strip().lower() == "else"

    @property
    def guarded(self) -> bool:
        """It has a guard that can fail."""
        return self.form.text("guard") is not None and not self.otherwise


@dataclass(slots=True)
class Line:
    """One line of the declared form."""

    name: str
    sources: tuple[str, ...]
    triggers: tuple[str, ...]
    """The occurrences, in lower case."""
    target: dict[str, str] | None
    """The leaf of each region that is entered, by the name of its state; None: nothing moves."""
    place: Mapping
    """Where the model has it."""
    conditional: bool = False
    restores: str = ""
    """The function that restores a history."""
    guards: tuple[str, ...] = ()
    domain: str = "nothing"
    """The innermost region that holds all it leaves and enters, as the declared form names it."""


class Chart:
    """One region of a component."""

    def __init__(self, name: str, form: Mapping, activities: Mapping) -> None:
        self.name, self.form = name, form
        self.working = {
            (one.text("while") or "").rpartition(".")[2].lower()
            for _, one in activities.maps()
            if (one.text("while") or "").lower().startswith(f"{name}.".lower()) and _is_done(one)
        }
        self.vertices: dict[str, Vertex] = {}
        self._grow(form.map("states"), TOP)
        self.transitions = [
            Transition(
                key,
                self._named(one.text("from"), one),
                self._named(one.text("to") or one.text("from"), one),
                one,
            )
            for key, one in form.map("transitions").maps()
        ]

    def _grow(self, states: Mapping, region: Region) -> None:
        for name, form in states.maps():
            inside: list[tuple[Region, Mapping]] = []
            if "states" in form:
                inside.append(((name, ""), form.map("states")))
            for nested, own in form.map("regions").maps():
                inside.append(((name, nested), own.map("states")))
            regions = tuple(key for key, _ in inside)
            kind = form.text("kind") or "state"
            self.vertices[name.lower()] = Vertex(name, kind, region, regions, form)
            for key, own in inside:
                self._grow(own, key)

    def _named(self, text: str | None, near: Mapping) -> str:
        found = self.vertices.get((text or "").lower())
        if found is None:
            raise UnusableError(f"{near.file}:{near.line}: `{text}` is no state of {self.name}")
        return found.name

    # --- geometry

    def at(self, name: str) -> Vertex:
        """A vertex by its name."""
        return self.vertices[name.lower()]

    def around(self, name: str) -> list[Region]:
        """The regions around a vertex, innermost first."""
        found = [self.at(name).region]
        while found[-1][0] is not None:
            found.append(self.at(found[-1][0]).region)
        return found

    def concurrent_region(self, name: str) -> Region:
        """The innermost region around a vertex that is not the only one of its state."""
        for owner, nested in self.around(name):
            if owner is None or len(self.at(owner).inside) > 1:
                return owner, nested
        raise AssertionError

    def concurrent_regions(self) -> list[Region]:
        """All of these regions, those inside one before it, the top-level one last."""
        found: list[Region] = []

        def below(region: Region) -> None:
            for vertex in self.vertices.values():
                if vertex.region == region:
                    for nested in vertex.inside:
                        below(nested)
                        if len(vertex.inside) > 1:
                            found.append(nested)

        below(TOP)
        return [*found, TOP]

    def leaves(self, region: Region) -> Iterator[str]:
        """The leaves of a region, in the order of the tree, pseudostates behind."""
        inside = [v for v in self.vertices.values() if v.region == region]
        for vertex in inside:
            if vertex.is_range:
                yield from self.leaves(vertex.inside[0])
            elif vertex.is_state:
                yield vertex.name
        yield from (v.name for v in inside if v.kind in PASSED)
        if region == TOP:
            yield from (v.name for v in self.vertices.values() if v.kind == "terminate")

    def ends(self, name: str | None) -> bool:
        """Is it a terminate?"""
        return name is not None and self.at(name).kind == "terminate"

    # --- entries

    def enter(self, region: Region, targets: list[str], found: dict[str, str]) -> None:
        """Enter a region on the way to these targets, or by default where it holds none."""
        inside = [t for t in targets if region in self.around(t)]
        if not inside:
            inside = [self._initial(region)]
        top = inside[0]
        while self.at(top).region != region:
            top = str(self.at(top).region[0])
        vertex = self.at(top)
        if vertex.kind == "terminate":
            found[key_of(TOP)] = vertex.name
        elif not vertex.is_range:
            found[key_of(self.concurrent_region(top))] = vertex.name
        for nested in vertex.inside:
            self.enter(nested, [t for t in inside if t != top], found)

    def _initial(self, region: Region) -> str:
        owner, nested = region
        form = self.form if owner is None else self.at(owner).form
        if nested:
            form = form.map("regions").map(nested)
        return self._named(form.text("initial") or form.map("initial").text("to"), form)

    def entered(self, region: Region, targets: list[str]) -> dict[str, str]:
        """The leaves that are entered from a region on."""
        found: dict[str, str] = {}
        self.enter(region, targets, found)
        return found

    # --- lines

    def lines(self) -> list[Line]:
        """The declared form, in order of precedence."""
        found: list[Line] = []
        for region in self.concurrent_regions():
            own = self._lines(region)
            own.sort(key=lambda line: -max(len(self.around(s)) for s in line.sources))
            found += own
        return found

    def _lines(self, region: Region) -> list[Line]:
        found: list[Line] = []
        for one in self.transitions:
            if self.at(one.source).is_state and self.concurrent_region(one.source) == region:
                found += self._ways((one,))
        here = [v for v in self.vertices.values() if self.concurrent_region(v.name) == region]
        for vertex in here:
            for event in vertex.form.texts("defer"):
                name, on = f"Defer_{event}_In_{vertex.name}", f"on_{event}".lower()
                found.append(Line(name, (vertex.name,), (on,), None, vertex.form))
        for vertex in here:
            if vertex.kind in PASSED:
                found += self._passing(vertex)
        return found

    def _passing(self, vertex: Vertex) -> list[Line]:
        found: list[Line] = []
        own, out = (vertex.name,), self._out(vertex.name)
        if vertex.kind != "choice":
            label = vertex.region[1] or vertex.region[0] or ""
            how = f"{'deep' if vertex.kind == 'deep_history' else 'shallow'}_{label}".lower()
            line = Line(f"Restore_{vertex.name}", own, ("passing",), {}, vertex.form)
            line.conditional, line.restores = True, how
            line.domain = domain_of(vertex.region)
            found.append(line)
        for segment in out:
            found += self._ways((segment,))
        if vertex.kind != "choice" and not out:
            target = self.entered(vertex.region, [])
            name = f"Default_Of_{vertex.name}"
            line = Line(name, own, ("passing",), target, vertex.form)
            line.domain = domain_of(vertex.region)
            found.append(line)
        return found

    def _out(self, name: str) -> list[Transition]:
        return sorted((t for t in self.transitions if t.source == name), key=lambda t: t.otherwise)

    def _ways(self, path: tuple[Transition, ...]) -> list[Line]:
        """The lines of a transition, through junctions and joins."""
        kind = self.at(path[-1].target).kind
        if kind == "junction":
            return [x for way in self._out(path[-1].target) for x in self._ways((*path, way))]
        if kind == "join":
            coming = tuple(t for t in self.transitions if t.target == path[-1].target)
            if path[0] != coming[0]:
                return []
            ways = self._beyond(self._out(path[-1].target)[0])
            return [self._line((*coming, *way), coming) for way in ways]
        return [self._line(path, path[:1])]

    def _beyond(self, segment: Transition) -> list[tuple[Transition, ...]]:
        if self.at(segment.target).kind != "junction":
            return [(segment,)]
        ways = self._out(segment.target)
        return [(segment, *rest) for way in ways for rest in self._beyond(way)]

    def _line(self, path: tuple[Transition, ...], first: tuple[Transition, ...]) -> Line:
        main, last = path[0], path[-1]
        names = [main.name, *(t.name for t in path[1:] if t not in first)]
        sources = tuple(t.source for t in first)
        conditional = any(t.guarded for t in path) or main.form.text("when") is not None
        if len(first) > 1:  # a join waits for what does not complete by itself
            waits = (bool(self.at(s).inside) or s.lower() in self.working for s in sources)
            conditional = conditional or any(waits)
        triggers = tuple(self._trigger(t) for t in first)
        region, targets = self._way(main, sources, last)
        target = None if main.kind == "internal" else self.entered(region, targets)
        line = Line("_Then_".join(names), sources, triggers, target, main.form, conditional)
        guards = [t.form.text("guard") for t in path if t.guarded] + [main.form.text("when")]
        if target is not None:
            line.domain = "ending" if self.ends(last.target) else domain_of(region)
        line.guards = tuple(guard for guard in guards if guard is not None)
        return line

    def _trigger(self, one: Transition) -> str:
        form = one.form
        if not self.at(one.source).is_state:
            return "passing"
        if form.text("on"):
            return f"on_{form.text('on')}".lower()
        if form.text("after") or form.text("every"):
            return f"expiry_of_{one.name}".lower()
        if form.text("when") is not None:
            return "conditions"
        return f"completion_of_{one.source}".lower()

    def _way(
        self, main: Transition, sources: tuple[str, ...], last: Transition
    ) -> tuple[Region, list[str]]:
        """The innermost region that holds all that is left and entered, and the targets."""
        targets = [last.target]
        if self.at(last.target).kind == "fork":
            targets = [t.target for t in self._out(last.target)]
        if main.kind == "local":
            return next(r for r in self.around(targets[0]) if r[0] == main.source), targets
        others = [self.around(v) for v in (*sources, *targets)]
        return next(r for r in others[0] if all(r in other for other in others)), targets

    def timers(self) -> list[tuple[Transition, tuple[int, ...]]]:
        """Transitions with a time-out, each with its executions, twice where it repeats."""
        found: list[tuple[Transition, tuple[int, ...]]] = []
        period = self.form.time("period")
        for one in self.transitions:
            for key in ("after", "every"):
                if one.form.text(key):
                    count = -(-one.form.time(key) // period)
                    found.append((one, (count,) if key == "after" else (count, count)))
        return found


def _is_done(value: object) -> bool:
    """Whether an activity raises `done`, which completes its state."""
    if isinstance(value, Mapping):
        listed = (text.lower() for text in value.texts("raises"))
        raised = (value.text("raise") or "").lower() == "done"
        return raised or "done" in listed or any(_is_done(one) for one in value.values())
    return isinstance(value, list) and any(_is_done(one) for one in value)


def domain_of(region: Region) -> str:
    """A region as the declared form names it."""
    owner, nested = region
    return "everything" if owner is None else f"inside_{nested or owner}".lower()


def key_of(region: Region) -> str:
    """The component of a configuration that holds the leaf of a region."""
    return "top" if region[0] is None else f"in_{region[1]}".lower()
