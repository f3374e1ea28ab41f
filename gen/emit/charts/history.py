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
from ravenchart.gen.model.statechart import PseudoKind, RegionId

from .shape import HistoryMemory, RegionShape


def _wanted(shape: RegionShape) -> list[tuple[HistoryMemory, bool]]:
    """Each memory with the depth to which it is restored."""
    found: dict[tuple[HistoryMemory, bool], None] = {}
    for pseudo in shape.region.pseudostates:
        if pseudo.kind in PASSED and pseudo.kind is not PseudoKind.CHOICE:
            own = shape.region.region_of(pseudo.name)
            deep = pseudo.kind is PseudoKind.DEEP_HISTORY
            found[(shape.memory(own), deep)] = None
            if deep:
                below = (m for m in shape.memories if m.region != own)
                found |= {
                    (m, True): None
                    for m in below
                    if own in shape.region.regions_around(m.region.owner or "")
                }
    #  inner regions first: a function is declared before its use
    around = shape.region.regions_around
    return sorted(found, key=lambda k: -len(around(k[0].region.owner or "")))


def _function(memory: HistoryMemory, deep: bool) -> str:
    return f"{'Deep' if deep else 'Shallow'}_{memory.label}"


def restored_functions(shape: RegionShape) -> list[Decl]:
    """For each memory the leaf that is entered again."""
    items: list[Decl] = []
    for memory, deep in _wanted(shape):
        rows = tuple(
            (shape.literal(leaf), shape.literal(_again(shape, memory.region, leaf, deep)))
            for leaf in shape.literals(memory.region)
        )
        result = shape.memory_type(memory)
        items += [
            Subprogram(
                _function(memory, deep),
                (Param("Past", "in", "Memory"),),
                result,
                expression=IfExpr(
                    ((ref("Past", memory.known), choice_of(ref("Past", memory.last), rows)),),
                    shape.literal(shape.region.default_of(memory.region)),
                ),
            ),
            Comment(
                f"The leaf that {'deep' if deep else 'shallow'} history enters in {memory.label}."
            ),
        ]
    return items


def _target(shape: RegionShape, region: RegionId, leaf: str, deep: bool) -> str | None:
    """The vertex that is entered for a remembered leaf; None: the region by default."""
    if shape.region.pseudostate(leaf) is not None:
        return None
    if not deep:
        child = shape.compounds.below(region, leaf)[0]
        return None if shape.region.state(child).final else child
    if not shape.region.state(leaf).final:
        return leaf
    return None if shape.region.region_of(leaf) == region else shape.region.state(leaf).parent


def _again(shape: RegionShape, region: RegionId, leaf: str, deep: bool) -> str:
    target = _target(shape, region, leaf, deep)
    if target is None:
        return shape.region.default_of(region)
    return shape.region.default_leaf(target)


def restored_configuration(shape: RegionShape, history: str) -> Expr:
    """The configuration that a history restores."""
    restored = shape.region.region_of(history)
    deep = shape.region.pseudostate(history).kind is PseudoKind.DEEP_HISTORY  # type: ignore[union-attr]
    memory = shape.memory(restored)
    leaf = call(_function(memory, deep), ref("Past"))
    if shape.single:
        return leaf
    own = shape.region.concurrent_region(history)
    rows = []
    for region in reversed(shape.concurrent):
        here: Expr | None = None
        if region == own:
            here = leaf
        elif region.owner and restored in shape.region.regions_around(region.owner):
            here = _leaf_again(shape, memory, region, deep)
        if here is not None:
            rows.append(Arg(shape.leaf_field(region), here))
    whole = len(rows) == len(shape.concurrent)
    return Aggregate(tuple(rows), base=None if whole else ref(shape.configuration_name))


def _leaf_again(shape: RegionShape, memory: HistoryMemory, region: RegionId, deep: bool) -> Expr:
    """The leaf of a region below: remembered, by default, or as it was when not entered."""
    assert region.owner is not None
    default = shape.literal(shape.region.default_of(region))
    kept = shape.at(shape.configuration_name, region)
    outer = shape.region.concurrent_region(region.owner)
    owner = shape.literal(region.owner)
    if outer == shape.concurrent_around(memory.region):
        entered = equal(call(_function(memory, deep), ref("Past")), owner)
        remembered: Expr = _all_remembered(shape, memory, region)
    else:
        above = shape.memory(outer) if deep else None
        entered = equal(_leaf_again(shape, memory, outer, deep), owner)
        remembered = FALSE
        if above is not None:
            remembered = _all_remembered(shape, memory, region)
    if not deep:
        return IfExpr(((entered, default),), kept)
    own = shape.memory(region)
    return IfExpr(((remembered, call(_function(own, True), ref("Past"))), (entered, default)), kept)


def _all_remembered(shape: RegionShape, memory: HistoryMemory, region: RegionId) -> Expr:
    assert region.owner is not None
    outer = shape.region.concurrent_region(region.owner)
    owner = shape.literal(region.owner)
    if outer == shape.concurrent_around(memory.region):
        return both(ref("Past", memory.known), equal(ref("Past", memory.last), owner))
    above = shape.memory(outer)
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

    def statements(self, region: RegionId, deep: bool) -> tuple[Stmt, ...]:
        """Entries below ``region`` for the leaf that its memory holds, or by default."""
        memory = self.shape.memory(region)
        rows = tuple(
            (self.shape.literal(leaf), self._row(region, leaf, deep))
            for leaf in self.shape.literals(region)
        )
        default = self._steps(self.shape.compounds.default(region))
        known = (case_of(ref("Past", memory.last), rows),)
        return (IfStatement(((ref("Past", memory.known), known),), default),)

    def _steps(self, steps: tuple[EntryStep, ...]) -> tuple[Stmt, ...]:
        return self.run(steps)

    def _row(self, region: RegionId, leaf: str, deep: bool) -> tuple[Stmt, ...]:
        compounds = self.shape.compounds
        target = _target(self.shape, region, leaf, deep)
        if target is None:
            return self._steps(compounds.default(region))
        state = self.shape.region.state(target)
        if not (deep and state.is_orthogonal and target == leaf):
            return self._steps(compounds.into(region, [target]))
        path = tuple(Enter(v) for v in compounds.below(region, target))
        inner = [s for nested in state.region_ids for s in self.statements(nested, True)]
        return (*self._steps(path), *inner)
