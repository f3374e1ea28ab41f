# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Histories: the states that they restore, as declared and as code.

The memory of a region is the last leaf left in it. Deep history enters that leaf again, with the
remembered leaves of the orthogonal regions below it. Shallow history enters the state directly in
the region that holds the leaf, by default inside.
"""

from __future__ import annotations

from collections.abc import Callable

from ravenchart.gen.emit.ada.declarations import Decl, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    Aggregate,
    Arg,
    Expr,
    IfExpr,
    both,
    call,
    choice_of,
    equal,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Comment, IfStatement, Stmt, case_of
from ravenchart.gen.emit.language.compound import PASSED, Enter, EntryStep
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.statechart import Lane, PseudoKind

from .shape import HistoryMemory, RegionShape


def _wanted(shape: RegionShape) -> list[tuple[HistoryMemory, bool]]:
    """Each memory with the depth to which it is restored."""
    found: dict[tuple[HistoryMemory, bool], None] = {}
    for pseudo in shape.region.pseudostates:
        if pseudo.kind in PASSED and pseudo.kind is not PseudoKind.CHOICE:
            own = shape.compounds.place(pseudo.name)
            deep = pseudo.kind is PseudoKind.DEEP_HISTORY
            found[(shape.memory(own), deep)] = None
            if deep:
                below = (m for m in shape.memories if m.place != own)
                found |= {
                    (m, True): None
                    for m in below
                    if own in shape.compounds.places(m.place.owner or "")
                }
    #  inner regions first: a function is declared before its use
    return sorted(found, key=lambda k: -len(shape.compounds.places(k[0].place.owner or "")))


def _function(memory: HistoryMemory, deep: bool) -> str:
    return f"{'Deep' if deep else 'Shallow'}_{memory.label}"


def restored_functions(shape: RegionShape) -> list[Decl]:
    """For each memory the leaf that is entered again."""
    items: list[Decl] = []
    for memory, deep in _wanted(shape):
        rows = tuple(
            (shape.literal(leaf), shape.literal(_again(shape, memory.place, leaf, deep)))
            for leaf in shape.literals_in(memory.place)
        )
        result = shape.memory_type(memory)
        items += [
            Subprogram(
                _function(memory, deep),
                (Param("Past", "in", "Memory"),),
                result,
                expression=IfExpr(
                    ((ref("Past", memory.known), choice_of(ref("Past", memory.last), rows)),),
                    shape.literal(_default(shape, memory.place)),
                ),
            ),
            Comment(
                f"The leaf that {'deep' if deep else 'shallow'} history enters in {memory.label}."
            ),
        ]
    return items


def _default(shape: RegionShape, place: Place) -> str:
    return shape.region.default_of(place.owner, place.region)


def _target(shape: RegionShape, place: Place, leaf: str, deep: bool) -> str | None:
    """The vertex that is entered for a remembered leaf; None: the region by default."""
    if shape.region.pseudostate(leaf) is not None:
        return None
    if not deep:
        child = shape.compounds.below(place, leaf)[0]
        return None if shape.region.state(child).final else child
    if not shape.region.state(leaf).final:
        return leaf
    return None if shape.compounds.place(leaf) == place else shape.region.state(leaf).parent


def _again(shape: RegionShape, place: Place, leaf: str, deep: bool) -> str:
    target = _target(shape, place, leaf, deep)
    if target is None:
        return _default(shape, place)
    regions = shape.region.state(target).regions
    return shape.region.default_of(target, regions[0].name) if len(regions) == 1 else target


def restored_place(shape: RegionShape, history: str) -> Expr:
    """The configuration that a history restores."""
    place = shape.compounds.place(history)
    deep = shape.region.pseudostate(history).kind is PseudoKind.DEEP_HISTORY  # type: ignore[union-attr]
    memory = shape.memory(place)
    leaf = call(_function(memory, deep), ref("Past"))
    if shape.single:
        return leaf
    own = shape.region.lane(history)
    rows = []
    for lane in reversed(shape.lanes):
        here: Expr | None = None
        if lane == own:
            here = leaf
        elif lane.owner is not None and place in shape.compounds.places(lane.owner):
            here = _lane_again(shape, memory, lane, deep)
        if here is not None:
            rows.append(Arg(shape.lane_field(lane), here))
    return Aggregate(tuple(rows), base=ref(shape.place) if len(rows) < len(shape.lanes) else None)


def _lane_again(shape: RegionShape, memory: HistoryMemory, lane: Lane, deep: bool) -> Expr:
    """The leaf of a region below: remembered, by default, or as it was when not entered."""
    assert lane.owner is not None
    default = shape.literal(shape.default_leaf(lane))
    kept = shape.at(shape.place, lane)
    outer = shape.region.lane(lane.owner)
    owner = shape.literal(lane.owner)
    if outer == shape.lane_of(memory.place):
        entered = equal(call(_function(memory, deep), ref("Past")), owner)
        remembered: Expr = _all_remembered(shape, memory, lane)
    else:
        above = shape.memory(Place(outer.owner, outer.name)) if deep else None
        entered = equal(_lane_again(shape, memory, outer, deep), owner)
        remembered = FALSE
        if above is not None:
            remembered = _all_remembered(shape, memory, lane)
    if not deep:
        return IfExpr(((entered, default),), kept)
    own = shape.memory(Place(lane.owner, lane.name))
    return IfExpr(((remembered, call(_function(own, True), ref("Past"))), (entered, default)), kept)


def _all_remembered(shape: RegionShape, memory: HistoryMemory, lane: Lane) -> Expr:
    assert lane.owner is not None
    outer = shape.region.lane(lane.owner)
    owner = shape.literal(lane.owner)
    if outer == shape.lane_of(memory.place):
        return both(ref("Past", memory.known), equal(ref("Past", memory.last), owner))
    above = shape.memory(Place(outer.owner, outer.name))
    return both(
        _all_remembered(shape, memory, outer),
        ref("Past", above.known),
        equal(ref("Past", above.last), owner),
    )


class Restoring:
    """The statements that enter the states that a history restores."""

    def __init__(
        self, shape: RegionShape, run: Callable[[tuple[EntryStep, ...]], tuple[Stmt, ...]]
    ) -> None:
        self.shape = shape
        self.run = run

    def statements(self, place: Place, deep: bool) -> tuple[Stmt, ...]:
        """Entries below ``place`` for the leaf that its memory holds, or by default."""
        memory = self.shape.memory(place)
        rows = tuple(
            (self.shape.literal(leaf), self._row(place, leaf, deep))
            for leaf in self.shape.literals_in(place)
        )
        default = self._steps(self.shape.compounds.default(place))
        known = (case_of(ref("Past", memory.last), rows),)
        return (IfStatement(((ref("Past", memory.known), known),), default),)

    def _steps(self, steps: tuple[EntryStep, ...]) -> tuple[Stmt, ...]:
        return self.run(steps)

    def _row(self, place: Place, leaf: str, deep: bool) -> tuple[Stmt, ...]:
        compounds = self.shape.compounds
        target = _target(self.shape, place, leaf, deep)
        if target is None:
            return self._steps(compounds.default(place))
        state = self.shape.region.state(target)
        if not (deep and state.is_orthogonal and target == leaf):
            return self._steps(compounds.into(place, [target]))
        path = tuple(Enter(v) for v in compounds.below(place, target))
        inner = [s for r in state.regions for s in self.statements(Place(target, r.name), True)]
        return (*self._steps(path), *inner)
