# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The picture of a chart as generated Ada text declares it.

It shows the declared form and no more: guards in Ada, targets down to the leaves. A composite
has no initial state of its own there, final and terminate are leaves like others, and
behaviours are elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise

from .ada_text import Declared, NotDeclaredError, declared
from .picture import Area, Arrow, DrawnVertex, Label, Picture, Shape

_TRIGGERS = (("On_", ""), ("Expiry_Of_", "time-out "), ("Completion_Of_", ""))
"""How an occurrence begins, and what is said instead."""


def picture_of_ada(file: str, text_of: Callable[[str], str | None]) -> Picture:
    """The chart in the spec ``file`` of a region; ``text_of`` gives what a file beside it holds."""
    component = re.sub(r"-[^-]*$", ".ads", file)
    spec, around = text_of(file), text_of(component)
    if spec is None or around is None or component == file:
        raise NotDeclaredError(f"{file}: the spec of a region and that of its component are needed")
    try:
        return _Chart(declared(spec, around)).picture()
    except NotDeclaredError as problem:
        raise NotDeclaredError(f"{file}: {problem}") from problem


class _Chart:
    """The picture that a declared form stands for."""

    def __init__(self, form: Declared) -> None:
        self.form = form
        self.type_of = {leaf: kind for kind, leaves in form.leaves.items() for leaf in leaves}
        self.component = {region.component: region.type for region in form.regions}
        self.sources = {name: self._sources(tests) for name, tests in form.conditions.items()}
        self.inner = self._inner_regions()
        self.shapes: dict[str, Shape] = {}
        self.bars: list[DrawnVertex] = []
        self.inside: dict[str, list[Label]] = {}
        self.arrows: list[Arrow] = []
        for name, move in form.moves.items():
            if name in form.conditions:
                self._add(name, move)

    def picture(self) -> Picture:
        """All of it."""
        start = self.form.moves.get("Initial_Entry")
        leaf = start.get("Top") if isinstance(start, dict) else start
        area = self._area("", "Leaf", leaf and _short(leaf))
        area = replace(area, vertices=(*area.vertices, *self.bars))
        return Picture(self.form.title, "as declared in Ada", area, tuple(self.arrows))

    # --- states

    def _inner_regions(self) -> Mapping[str, tuple[str, ...]]:
        """The types of the regions inside each leaf that a test of their leaves names first."""
        found: dict[str, dict[str, None]] = {}
        for tests in self.form.conditions.values():
            states = [s for s in map(self._tested, tests) if s is not None]
            for (_, outer), (kind, _) in pairwise(states):
                if kind != "Leaf":
                    found.setdefault(outer, {})[kind] = None
        return {state: tuple(kinds) for state, kinds in found.items()}

    def _area(self, name: str, within: str, initial: str | None) -> Area:
        """The vertices in the type of a region's leaves, or in a composite."""
        vertices: list[DrawnVertex] = []
        seen: set[str] = set()
        inner = {c.first: c for c in reversed(self.form.composites) if c.outer == within}
        for leaf in self._leaves(within):
            if leaf in inner:
                composite = inner[leaf]
                seen.update(self._leaves(composite.name))
                area = self._area("", composite.name, None)
                behaviours = tuple(self.inside.get(composite.name, ()))
                vertices.append(DrawnVertex(composite.name, Shape.STATE, behaviours, (area,)))
            elif leaf not in seen:
                vertices.append(self._leaf(leaf))
        return Area(name, initial, Label(), tuple(vertices))

    def _leaves(self, within: str) -> tuple[str, ...]:
        if within in self.form.leaves:
            return self.form.leaves[within]
        one = next(c for c in self.form.composites if c.name == within)
        leaves = self.form.leaves[self.type_of[one.first]]
        return leaves[leaves.index(one.first) : leaves.index(one.last) + 1]

    def _leaf(self, name: str) -> DrawnVertex:
        areas = tuple(
            self._area(region.component.removeprefix("In_"), region.type, region.default)
            for region in self.form.regions
            if region.type in self.inner.get(name, ())
        )
        shape = self.shapes.get(name, Shape.STATE)
        return DrawnVertex(name, shape, tuple(self.inside.get(name, ())), areas)

    # --- transitions

    def _tested(self, condition: str) -> tuple[str, str] | None:
        """The type of leaves and the state that a condition asks for."""
        test = re.fullmatch(r"(?:Leaf|Configuration\.(\w+)) (?:=|in) (?:\w+\.)?(\w+)", condition)
        return None if test is None else (self.component.get(test[1] or "", "Leaf"), test[2])

    def _sources(self, conditions: tuple[str, ...]) -> tuple[str, ...]:
        """The innermost states that the conditions ask for."""
        states = [s for s in map(self._tested, conditions) if s is not None]
        outer = {a[1] for a, b in pairwise(states) if b[0] != "Leaf"}
        return tuple(dict.fromkeys(state for _, state in states if state not in outer))

    def _label(self, name: str) -> Label:
        rest = [c for c in self.form.conditions[name] if self._tested(c) is None]
        occurrences = next((c for c in rest if re.match(r"Now (=|in) ", c)), "")
        guards = " and then ".join(c for c in rest if c != occurrences)
        if occurrences == "Now = Conditions":
            return Label(f"when {guards}")
        return Label(_trigger(occurrences), guards)

    def _add(self, name: str, move: str | Mapping[str, str]) -> None:
        """One transition: an arrow, a line in a state, or arrows by way of a bar."""
        label, sources = self._label(name), self.sources[name]
        targets = [_short(leaf) for leaf in _leaves_of(move)]
        if "Now = Passing" in self.form.conditions[name]:
            self.shapes.setdefault(sources[0], Shape.CHOICE)
        if restored := [leaf for leaf in targets if "(" in leaf]:  # calls: of no state's name
            deep = any(leaf.startswith("Deep_") for leaf in restored)
            self.shapes[sources[0]] = Shape.DEEP_HISTORY if deep else Shape.HISTORY
        elif not targets:
            defers = name in self.form.deferrals
            self.inside.setdefault(sources[0], []).append(
                replace(label, effect=("defer",)) if defers else label
            )
        else:
            targets = [t for t in targets if not self._is_around(t, targets)]
            source = self._joined(name, sources)
            target = self._forked(name, targets)
            self.arrows.append(Arrow(source, target, label))

    def _is_around(self, state: str, others: list[str]) -> bool:
        inside = self.inner.get(state, ())
        return any(self.type_of.get(other) in inside for other in others)

    def _joined(self, name: str, sources: tuple[str, ...]) -> str:
        if len(sources) == 1:
            return sources[0]
        self.bars.append(DrawnVertex(f"{name}_Join", Shape.JOIN))
        self.arrows += [Arrow(source, f"{name}_Join", Label()) for source in sources]
        return f"{name}_Join"

    def _forked(self, name: str, targets: list[str]) -> str:
        if len(targets) == 1:
            return targets[0]
        self.bars.append(DrawnVertex(f"{name}_Fork", Shape.FORK))
        self.arrows += [Arrow(f"{name}_Fork", target, Label()) for target in targets]
        return f"{name}_Fork"


def _leaves_of(move: str | Mapping[str, str]) -> tuple[str, ...]:
    """The leaves that a move gives, without those that stay as they were."""
    leaves = (move,) if isinstance(move, str) else move.values()
    return tuple(leaf for leaf in leaves if not re.match(r"(?:Configuration|Leaf)\b", leaf))


def _short(leaf: str) -> str:
    """A leaf without its package."""
    return re.sub(r"^\w+_States\.", "", leaf)


def _trigger(occurrences: str) -> str:
    """The triggers of a transition, of ``Now = ...`` or ``Now in ... | ...``."""
    found: list[str] = []
    for name in re.sub(r"Now (=|in) ", "", occurrences).split(" | "):
        for begin, words in _TRIGGERS:
            if name.startswith(begin) and begin != "Completion_Of_":
                found.append(words + name.removeprefix(begin))
    return ", ".join(found)
