# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A chart as it is drawn: shapes, areas and arrows whose words are text already.

Every back end draws a `Picture`. `picture` makes one of a region of the model;
`ada_chart` makes one of the declared form in generated Ada.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model import notation
from ravenchart.gen.model.component import Activity, Component, StateRef
from ravenchart.gen.model.statechart import (
    Initial,
    Region,
    RegionId,
    State,
    Transition,
    TransitionKind,
)


class Shape(Enum):
    """The look of a vertex; pseudostates have the values of `PseudoKind`."""

    STATE = "state"
    FINAL = "final"
    CHOICE = "choice"
    JUNCTION = "junction"
    HISTORY = "history"
    DEEP_HISTORY = "deep_history"
    FORK = "fork"
    JOIN = "join"
    TERMINATE = "terminate"


@dataclass(frozen=True, slots=True)
class Label:
    """``trigger [guard] / effect``; any part may be missing."""

    trigger: str = ""
    guard: str = ""
    effect: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The label in one line."""
        guard = f"[{self.guard}]" if self.guard else ""
        effect = f"/ {'; '.join(self.effect)}" if self.effect else ""
        return " ".join(filter(None, (self.trigger, guard, effect)))


@dataclass(frozen=True, slots=True)
class Arrow:
    """A transition between two vertices; a local one does not leave its source."""

    source: str
    target: str
    label: Label
    local: bool = False


@dataclass(frozen=True, slots=True)
class DrawnVertex:
    """A state or pseudostate; a composite state has areas.

    ``behaviours`` are entry, exit and do activities, internal transitions (with
    their trigger) and deferrals.
    """

    name: str
    shape: Shape
    behaviours: tuple[Label, ...] = ()
    areas: tuple[Area, ...] = ()

    @property
    def is_composite(self) -> bool:
        """Anything inside?"""
        return bool(self.areas)


@dataclass(frozen=True, slots=True)
class Area:
    """A region: where its initial pseudostate leads (None: not known), and its vertices."""

    name: str
    initial: str | None
    effect: Label
    vertices: tuple[DrawnVertex, ...]


@dataclass(frozen=True, slots=True)
class Picture:
    """A whole chart; ``remark`` is a line below its title."""

    title: str
    remark: str
    area: Area
    arrows: tuple[Arrow, ...]

    def vertices(self) -> Iterator[tuple[DrawnVertex, tuple[RegionId, ...]]]:
        """Every vertex, outer before inner, with the regions around it, innermost first."""

        def inside(
            area: Area, owner: str | None, around: tuple[RegionId, ...]
        ) -> Iterator[tuple[DrawnVertex, tuple[RegionId, ...]]]:
            regions = (RegionId(owner, area.name), *around)
            for vertex in area.vertices:
                yield vertex, regions
                for nested in vertex.areas:
                    yield from inside(nested, vertex.name, regions)

        return inside(self.area, None, ())

    def areas(self) -> Iterator[tuple[RegionId, Area]]:
        """Every area, outer before inner."""
        yield RegionId(None, self.area.name), self.area
        for vertex, _ in self.vertices():
            yield from ((RegionId(vertex.name, area.name), area) for area in vertex.areas)


# --- From the model --------------------------------------------------------------


def picture(component: Component, region: Region) -> Picture:
    """The chart of a top-level region."""
    remark = f"every {shown(region.timing.period)}"
    arrows = tuple(
        Arrow(t.source, t.target, label(t), t.kind is TransitionKind.LOCAL)
        for t in region.transitions
        if t.kind is not TransitionKind.INTERNAL
    )
    area = _area(component, region, None, region.name, region.initial)
    return Picture(f"{component.name}.{region.name}", remark, area, arrows)


def _area(
    component: Component, region: Region, owner: str | None, name: str, initial: Initial
) -> Area:
    nested = "" if owner is None else name
    states = [_state(component, region, s) for s in region.children(owner, nested)]
    pseudostates = [
        DrawnVertex(p.name, Shape(p.kind.value))
        for p in region.pseudostates
        if (p.parent, p.region) == (owner, nested)
    ]
    effect = Label(effect=notation.actions(initial.effect))
    return Area(name, initial.target, effect, (*states, *pseudostates))


def _state(component: Component, region: Region, state: State) -> DrawnVertex:
    areas = tuple(_area(component, region, state.name, r.name, r.initial) for r in state.regions)
    shape = Shape.FINAL if state.final else Shape.STATE
    return DrawnVertex(state.name, shape, tuple(_behaviours(component, region, state)), areas)


def _behaviours(component: Component, region: Region, state: State) -> Iterator[Label]:
    if state.entry:
        yield Label("entry", effect=notation.actions(state.entry))
    for activity in component.activities:
        if activity.while_in == StateRef(region.name, state.name):
            yield Label("do", effect=(_do(activity),))
    if state.exit:
        yield Label("exit", effect=notation.actions(state.exit))
    for transition in region.transitions:
        if transition.source == state.name and transition.kind is TransitionKind.INTERNAL:
            yield label(transition)
    for event in state.defers:
        yield Label(event, effect=("defer",))


def _do(activity: Activity) -> str:
    return f"{activity.name} (every {shown(activity.timing.period)})"


def label(transition: Transition) -> Label:
    """The trigger, guard and effect of a transition as text."""
    guard = "else" if transition.otherwise else ""
    if transition.guard is not None:
        guard = notation.shown_expression(transition.guard)
    return Label(notation.trigger(transition.trigger), guard, notation.actions(transition.effect))
