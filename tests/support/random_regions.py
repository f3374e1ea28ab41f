# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random top-level regions: their tree, then behaviours, then transitions.

Every vertex can be reached, as far as the graph tells; what completes by itself
leads to what does not; data stay in their range.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from random import Random
from typing import Any

Json = dict[str, Any]
Place = tuple[str | None, str]

PLAIN_EVENTS = ("Go", "Halt", "Turn", "Ring")
SMALL, MOST = "Small", 7
"""The type of all data, 0 .. MOST."""
RANGES = {SMALL: (0, MOST), "Turned": (-20, 40)}
VALUED_EVENTS = {"Level": SMALL, "Dial": "Turned"}
"""The type of the value of each: those of two events differ."""
STABLE, COMPOSITE, FINAL = "state", "composite", "final"


# --- Vertices ---------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Vertex:
    """A state or pseudostate with the places around it, innermost first."""

    name: str
    kind: str
    places: tuple[Place, ...]

    @property
    def place(self) -> Place:
        """Where it stands."""
        return self.places[0]

    def is_inside(self, state: str) -> bool:
        """Whether ``state`` is around it."""
        return any(owner == state for owner, _ in self.places)


@dataclass(slots=True)
class Chart:
    """A top-level region as it is drawn."""

    name: str
    rng: Random
    data: tuple[str, ...]
    flag: str
    vertices: dict[str, Vertex] = field(default_factory=dict)
    forms: dict[str, Json] = field(default_factory=dict)
    """What stands under each name in ``states``."""
    orthogonal: dict[str, tuple[str, ...]] = field(default_factory=dict)
    """The regions of each orthogonal state."""
    transitions: dict[str, Json] = field(default_factory=dict)
    top: Json = field(default_factory=dict)
    readable: list[str] = field(default_factory=list)
    """Integers that guards may read, those of other regions too."""
    elsewhere: list[str] = field(default_factory=list)
    """``Region.State`` of other regions."""
    completing: set[str] = field(default_factory=set)
    taken: set[tuple[str, str]] = field(default_factory=set)
    """(source, event) that a transition without guard always takes."""
    asking: Random = field(init=False)
    """Draws which guards ask for states of their own region."""

    def __post_init__(self) -> None:
        """Draw the vertices."""
        self.top = self.region((), depth=2, of=self.rng.randint(2, 3))
        self.asking = Random(f"{self.name} {sorted(self.vertices)}")

    # --- the tree

    def named(self, letter: str) -> str:
        """A new name."""
        known = [*self.vertices, *(r for rs in self.orthogonal.values() for r in rs)]
        return f"{letter}{sum(name[0] == letter for name in known) + 1}"

    def add(self, letter: str, kind: str, places: tuple[Place, ...], form: Json) -> str:
        """A new vertex."""
        name = self.named(letter)
        self.vertices[name] = Vertex(name, kind, places)
        self.forms[name] = form
        return name

    def region(
        self, around: tuple[Place, ...], depth: int, of: int, own: Place = (None, "")
    ) -> Json:
        """A region: its states, then its pseudostates."""
        places = (own, *around)
        names = [self.state(places, depth) for _ in range(of)]
        initial = names[0]
        chance = self.rng.random
        if own != (None, "") and chance() < 0.5:
            names.append(self.add("F", FINAL, places, {"kind": "final"}))
        if chance() < 0.35:
            names.append(self.add("P", "choice", places, {"kind": "choice"}))
        if chance() < 0.25:
            names.append(self.add("J", "junction", places, {"kind": "junction"}))
        if own != (None, "") and chance() < 0.5:
            kind = self.rng.choice(("history", "deep_history"))
            names.append(self.add("H", kind, places, {"kind": kind}))
        if own == (None, "") and chance() < 0.15:
            names.append(self.add("X", "terminate", places, {"kind": "terminate"}))
        for name in [n for n in names if n in self.orthogonal]:
            for letter, kind in (("K", "fork"), ("N", "join")):
                if chance() < 0.5:
                    made = self.add(letter, kind, places, {"kind": kind})
                    self.forms[made]["of"] = name
                    names.append(made)
        return {"initial": initial, "states": names}

    def state(self, places: tuple[Place, ...], depth: int) -> str:
        """A leaf, a composite or an orthogonal state."""
        chance = self.rng.random()
        if chance > 0.22 * depth:
            return self.add("S", STABLE, places, {})
        if chance < 0.1 * depth:
            name = self.add("C", COMPOSITE, places, {})
            inside = self.region(places, depth - 1, self.rng.randint(2, 3), (name, ""))
            self.forms[name] |= inside
            return name
        name = self.add("O", COMPOSITE, places, {"regions": {}})
        self.orthogonal[name] = ()
        for _ in range(self.rng.choice((2, 2, 3))):
            nested = self.named("R")
            self.orthogonal[name] = (*self.orthogonal[name], nested)
            inside = self.region(places, depth - 1, self.rng.randint(2, 3), (name, nested))
            self.forms[name]["regions"][nested] = inside
        return name

    def at(self, place: Place) -> list[Vertex]:
        """What stands in a place."""
        return [v for v in self.vertices.values() if v.place == place]

    def states(self) -> list[Vertex]:
        """All states but final ones."""
        return [v for v in self.vertices.values() if v.kind in (STABLE, COMPOSITE)]

    def agree(self, one: Vertex, other: Vertex) -> bool:
        """Whether no orthogonal state has them in two of its regions."""
        mine: dict[str | None, str] = {o: r for o, r in one.places if o in self.orthogonal}
        return all(mine.get(owner, region) == region for owner, region in other.places)

    # --- expressions and flows

    def condition(self, event_value: str | None = None) -> str:
        """A condition over data, states of other regions and the event's value, of that type."""
        rng = self.rng
        pick = rng.random()
        if event_value and pick < 0.4:
            low, high = RANGES[event_value]
            other = rng.choice((*self.readable, str(rng.randint(low + 1, high))))
            return f"event {rng.choice(('<', '>='))} {other}"
        if self.elsewhere and pick < 0.55:
            return f"{rng.choice(('', 'not '))}in({rng.choice(self.elsewhere)})"
        if pick < 0.65:
            return rng.choice((self.flag, f"not {self.flag}"))
        one, other = rng.choice(self.readable), rng.choice(self.readable)
        return rng.choice(
            (
                f"{one} < {rng.randint(1, MOST)}",
                f"{one} >= {rng.randint(1, MOST)}",
                f"{one} /= {rng.randint(0, MOST)}",
                f"{one} + {other} > {rng.randint(2, 2 * MOST - 2)}",
                f"{one} / 2 * 2 = {one}",
                f"abs({one} - {other}) <= 3 or {one} = 0",
            )
        )

    def value(self, event_value: str | None = None) -> str:
        """An expression of 0 .. MOST."""
        rng = self.rng
        one, other = rng.choice(self.readable), rng.choice(self.readable)
        if event_value and rng.random() < 0.5:
            return f"clamp({one} + event, 0, {MOST})"
        return rng.choice(
            (
                str(rng.randint(0, MOST)),
                f"min({one} + {rng.randint(1, 3)}, {MOST})",
                f"max({one} - {rng.randint(1, 3)}, 0)",
                f"clamp(2 * {one} - {other}, 0, {MOST})",
                f"{MOST} - {one}" if one == other else f"if {one} < {other} then {other} else 0",
            )
        )

    def flow(self, raising: float, event_value: str | None = None) -> list[Json]:
        """Up to two actions."""
        actions: list[Json] = []
        for _ in range(self.rng.choice((0, 1, 1, 2))):
            pick = self.rng.random()
            if pick < raising:
                actions.append(self.raising(event_value))
            elif pick < raising + 0.1:
                actions.append({"set": self.flag, "to": f"not {self.flag}"})
            elif pick < raising + 0.2:
                then, other = self.setting(event_value), self.setting(event_value)
                actions.append({"if": self.condition(), "then": [then], "else": [other]})
            else:
                actions.append(self.setting(event_value))
        return actions

    def setting(self, event_value: str | None) -> Json:
        """Set a data item of the region."""
        return {"set": self.rng.choice(self.data), "to": self.value(event_value)}

    def raising(self, event_value: str | None) -> Json:
        """Raise an event."""
        event = self.rng.choice((*PLAIN_EVENTS, *VALUED_EVENTS))
        valued = {"with": self.value(event_value)} if event in VALUED_EVENTS else {}
        return {"raise": event} | valued

    # --- transitions

    def connect(self) -> None:
        """Draw behaviours and transitions; first those without which a vertex is unreachable."""
        for vertex in self.states():
            self.behave(vertex)
        self.completions()
        for place in dict.fromkeys(v.place for v in self.vertices.values()):
            inside = self.at(place)
            for index, vertex in enumerate(inside[1:], 1):
                if vertex.kind != "join":
                    sources = [v for v in inside[:index] if v.kind in (STABLE, COMPOSITE)]
                    self.triggered(self.rng.choice(sources), vertex)
        for vertex in list(self.vertices.values()):
            self.segments(vertex)
        for _ in range(len(self.states()) // 2 + 2):
            self.extra(self.rng.choice(self.states()))

    def extra(self, source: Vertex) -> None:
        """One transition more: back to its source, inside it, into a history, or anywhere."""
        known = [
            v
            for v in self.vertices.values()
            if v.kind not in (FINAL, "fork", "join", "terminate") and self.agree(source, v)
        ]
        inside = [v for v in known if v.is_inside(source.name)]
        past = [v for v in known if v.kind.endswith("history") and v not in inside]
        choices = [group for group in ([source], inside, past, known) if group]
        self.triggered(source, self.rng.choice(self.rng.choice(choices)))

    def behave(self, vertex: Vertex) -> None:
        """Entry, exit, deferral, and an internal transition."""
        form, chance = self.forms[vertex.name], self.rng.random
        for key in ("entry", "exit"):
            actions = self.flow(raising=0.1)
            if actions and chance() < 0.5:
                form[key] = actions
        if chance() < 0.12:
            form["defer"] = [self.rng.choice((*PLAIN_EVENTS, *VALUED_EVENTS))]
        initials = [form] if "initial" in form else list(form.get("regions", {}).values())
        for initial in initials:
            if chance() < 0.4:
                actions = [self.setting(None)]
                initial["initial"] = {"to": initial["initial"], "effect": actions}

    def completions(self) -> None:
        """Completion transitions and joins; nothing that they lead to completes by itself."""
        ends = {v.place for v in self.vertices.values() if v.kind == FINAL}
        finals = {
            v.name
            for v in self.states()
            if all((v.name, region) in ends for region in self.orthogonal.get(v.name, ("",)))
        }
        joined = [v for v in self.vertices.values() if v.kind == "join"]
        for vertex in self.states():
            likely = 0.8 if vertex.name in finals else 0.0 if vertex.kind == COMPOSITE else 0.08
            if self.rng.random() < likely:
                self.completing.add(vertex.name)
        parts = {join.name: self.parts(join) for join in joined}
        self.completing.update(v.name for part in parts.values() for v in part)
        for name in sorted(self.completing):
            own = not any(v.name == name for part in parts.values() for v in part)
            target = self.stable(self.vertices[name])
            if own and target is not None:
                made = self.guarded({"from": name, "to": target.name}, 0.3)
                self.transition(made | self.effect(None))
        for join in joined:
            target = self.stable(join)
            sources = parts[join.name]
            if target is None or len(sources) < 2:
                self.drop(join)
                continue
            for source in sources:
                self.transition({"from": source.name, "to": join.name} | self.effect(None))
            self.transition({"from": join.name, "to": target.name} | self.effect(None))

    def parts(self, join: Vertex) -> list[Vertex]:
        """A leaf in each of two regions of the orthogonal state that a join is for."""
        owner = self.forms[join.name].pop("of")
        regions = self.orthogonal[owner][:2]
        leaves = [[v for v in self.at((owner, r)) if v.kind == STABLE] for r in regions]
        return [self.rng.choice(found) for found in leaves if found]

    def stable(self, source: Vertex) -> Vertex | None:
        """A leaf that does not complete by itself, to go to."""
        found = [
            v
            for v in self.vertices.values()
            if v.kind == STABLE and v.name not in self.completing and self.agree(source, v)
        ]
        return self.rng.choice(found) if found else None

    def drop(self, vertex: Vertex) -> None:
        """Take out a pseudostate again."""
        del self.vertices[vertex.name]
        del self.forms[vertex.name]

    def triggered(self, source: Vertex, target: Vertex) -> None:
        """A transition of a state with a trigger."""
        pick = self.rng.random()
        made: Json = {"from": source.name, "to": target.name}
        valued = None
        if pick < 0.72:
            free = [
                e for e in (*PLAIN_EVENTS, *VALUED_EVENTS) if (source.name, e) not in self.taken
            ]
            if not free:
                return self.timed(made, source)
            event = self.rng.choice(free)
            made["on"] = event
            valued = VALUED_EVENTS.get(event)
            deferred = event in self.forms[source.name].get("defer", ())
            made = self.guarded(made, 1.0 if deferred else 0.35, valued)
            if "guard" not in made:
                self.taken.add((source.name, event))
        elif pick < 0.92:
            return self.timed(made, source)
        else:
            item = self.rng.choice(self.data)
            made["when"] = f"{item} = {self.rng.randint(1, MOST)}"
            made["effect"] = [{"set": item, "to": "0"}]
            self.transition(made)
            return None
        is_plain = target.kind != "junction"
        if is_plain and target.is_inside(source.name) and self.rng.random() < 0.5:
            made["local"] = True
        elif target is source and self.rng.random() < 0.5:
            del made["to"]
        self.transition(made | self.effect(valued))
        return None

    def timed(self, made: Json, source: Vertex) -> None:
        """A transition triggered by time."""
        repeats = self.rng.random() < 0.4
        made["every" if repeats else "after"] = f"{self.rng.randint(1, 12) * 5} ms"
        if repeats and self.rng.random() < 0.5 and self.vertices[made["to"]] is source:
            del made["to"]
        self.transition(self.guarded(made, 0.3) | self.effect(None))

    def guarded(self, made: Json, likely: float, event_value: str | None = None) -> Json:
        """With a guard, or without."""
        if self.rng.random() < likely:
            made["guard"] = self.asked(made["from"], self.condition(event_value))
        return made

    def asked(self, source: str, guard: str) -> str:
        """A guard, or one that asks for a state of the own region as well, or for that alone."""
        states = [v.name for v in self.states() if self.is_beside(v, self.vertices[source])]
        if not states or self.asking.random() < 0.5:
            return guard
        asks = f"{self.asking.choice(('', 'not '))}in({self.name}.{self.asking.choice(states)})"
        return self.asking.choice((asks, f"({guard}) and {asks}", f"({guard}) or {asks}"))

    def is_beside(self, state: Vertex, source: Vertex) -> bool:
        """Whether a state may be active or not while another vertex is."""
        if state.is_inside(source.name):
            around = [owner for owner, _ in state.places]
            return any(o in self.orthogonal for o in around[: around.index(source.name) + 1])
        return not self.agree(state, source)

    def effect(self, event_value: str | None) -> Json:
        """An effect, or none."""
        actions = self.flow(0.25, event_value)
        return {"effect": actions} if actions else {}

    def segments(self, vertex: Vertex) -> None:
        """What leaves a pseudostate."""
        match vertex.kind:
            case "choice" | "junction":
                targets = [
                    v
                    for v in self.vertices.values()
                    if v.kind in (STABLE, COMPOSITE) and self.agree(vertex, v)
                ]
                for _ in range(self.rng.randint(1, 2)):
                    made = {"from": vertex.name, "to": self.rng.choice(targets).name}
                    guard = self.condition()
                    if vertex.kind == "junction":
                        guard = self.asked(vertex.name, guard)
                    self.transition(made | {"guard": guard} | self.effect(None))
                if vertex.kind == "choice" or self.rng.random() < 0.6:
                    made = {"from": vertex.name, "to": self.rng.choice(targets).name}
                    self.transition(made | {"guard": "else"} | self.effect(None))
            case "history" | "deep_history" if self.rng.random() < 0.5:
                states = [v for v in self.at(vertex.place) if v.kind == STABLE]
                if states:
                    made = {"from": vertex.name, "to": self.rng.choice(states).name}
                    self.transition(made | self.effect(None))
            case "fork":
                owner = self.forms[vertex.name].pop("of")
                for region in self.orthogonal[owner][:2]:
                    inside = [v for v in self.states() if (owner, region) in v.places]
                    inside = [v for v in inside if v.place == (owner, region)]
                    made = {"from": vertex.name, "to": self.rng.choice(inside).name}
                    self.transition(made | self.effect(None))

    def transition(self, form: Json) -> None:
        """Another transition."""
        self.transitions[f"T{len(self.transitions) + 1}"] = form

    # --- the form

    def form(self) -> Json:
        """The region as the model has it."""
        rng = self.rng
        made: Json = {
            "period": rng.choice(("5 ms", "10 ms", "10 ms", "20 ms")),
            "wcet": "1 us",
            "queue": rng.randint(2, 6),
            "overflow": rng.choice(("reject_newest", "drop_oldest")),
            "steps": rng.choice((1, 1, 2, 3)),
        }
        if any("defer" in form for form in self.forms.values()):
            made["deferred"] = rng.randint(1, 3)
        initial: object = self.top["initial"]
        if rng.random() < 0.4:
            initial = {"to": initial, "effect": [self.setting(None)]}
        return (
            made
            | self.written({**self.top, "initial": initial})
            | {"transitions": self.transitions}
        )

    def written(self, region: Json) -> Json:
        """A region with the forms of its vertices instead of their names."""
        states: Json = {}
        for name in region["states"]:
            if name in self.vertices:
                form = dict(self.forms[name])
                if "regions" in form:
                    form["regions"] = {n: self.written(r) for n, r in form["regions"].items()}
                elif "states" in form:
                    form |= self.written(form)
                states[name] = form
        return {"initial": region["initial"], "states": states}
