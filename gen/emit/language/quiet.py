# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Models in which the compiler can decide conditions, and what keeps it from saying so.

A type of one value, a region of one leaf or a guard that ranges decide are
sound, and the compiler warns of each. Only the units in which such a condition
can stand say that these warnings are not wanted.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from ravenchart.gen.emit.ada.declarations import Package, Unit
from ravenchart.gen.emit.ada.expressions import StringLiteral
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.statements import Pragma
from ravenchart.gen.emit.ada.walking import compares
from ravenchart.gen.language import terms as m
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region, When
from ravenchart.gen.model.system import System

from .places import Places
from .terms import expressions_in

_DECIDED = ("can only be", "can never be")
_MEMBERSHIP = ("explicit membership test", "'Valid attribute")
"""What it says of a state that is always active."""
_COMPUTED = ("condition is always",)
"""What it says where operators, and not types alone, decide."""


def quiet(unit: Unit, words: Sequence[str]) -> Unit:
    """The unit, with the warnings of these words off where a comparison stands in it."""
    if not isinstance(unit.item, Package) or not words or not compares(unit.item):
        return unit
    pragmas = (Pragma("Warnings", (ref("Off"), StringLiteral(f"*{word} *"))) for word in words)
    return replace(unit, item=replace(unit.item, items=(*pragmas, *unit.item.items)))


class OfComponent:
    """What the compiler says of conditions that it can decide in the units of a component.

    ``types`` is what it says of the types of the system (`words_of_types`).
    """

    def __init__(self, component: Component, types: Sequence[str]) -> None:
        self.component, self.types = component, types
        self._states = {r.name: _words_of_states(r) for r in component.regions}

    def region(self, region: Region) -> tuple[str, ...]:
        """In the package of a region, which may ask for the states of others."""
        asked = (self._states[name] for name in region.reads if name in self._states)
        return _in_order(_words([*_of_region(region)], [region]), self.types, *asked)

    def activities(self) -> tuple[str, ...]:
        """In the packages of its activities."""
        own = _words([*_of_activities(self.component)], [])
        return _in_order(own, self.types, *self._states.values())


def words_of_system(system: System) -> tuple[str, ...]:
    """The same in the units that belong to no component."""
    regions = [r for c in system.components for r in c.regions]
    expressions = [e for c in system.components for e in _of_component(c)]
    return _in_order(_words(expressions, regions), words_of_types(system))


def words_of_types(system: System) -> tuple[str, ...]:
    """What it says of the only value of a type."""
    return _DECIDED if any(_has_one_value(t) for t in system.types) else ()


def _in_order(*found: Iterable[str]) -> tuple[str, ...]:
    wanted = {word for words in found for word in words}
    return tuple(word for word in (*_DECIDED, *_MEMBERSHIP, *_COMPUTED) if word in wanted)


def _words(expressions: Sequence[m.Expression], regions: Sequence[Region]) -> Iterator[str]:
    """The words for what stands in expressions, and for the places of regions."""
    if any(_is_decided(e) for e in expressions):
        yield from _DECIDED
    if any(_is_decided(e, computed=True) for e in expressions):
        yield from _COMPUTED
    if any(not region.transitions for region in regions):
        yield from _DECIDED
    for region in regions:
        yield from _words_of_states(region)


def _words_of_states(region: Region) -> tuple[str, ...]:
    """The words for a state that is active whatever its region does."""
    if _has_whole_state(region):
        return (*_DECIDED, *_MEMBERSHIP)
    return _DECIDED if _has_single_leaf(region) else ()


def _has_single_leaf(region: Region) -> bool:
    """Is a lane a single leaf?"""
    places = Places(region)
    return any(len(places.literals(lane)) == 1 for lane in places.lanes)


def _has_whole_state(region: Region) -> bool:
    """Holds a composite all the leaves of its lane?"""
    places = Places(region)
    lanes = [places.literals(lane) for lane in places.lanes]
    nested = (s for s in region.states if len(s.regions) == 1)
    inside = (tuple(places.literals_in(Place(s.name, s.regions[0].name))) for s in nested)
    return any(leaves in lanes for leaves in inside)


def _has_one_value(of_type: m.Type) -> bool:
    match of_type:
        case m.IntegerType():
            return of_type.first == of_type.last
        case m.EnumerationType():
            return len(of_type.literals) == 1
        case _:
            return False


def _of_component(component: Component) -> Iterator[m.Expression]:
    for region in component.regions:
        yield from _of_region(region)
    yield from _of_activities(component)


def _of_region(region: Region) -> Iterator[m.Expression]:
    for transition in region.transitions:
        yield from (e for e in (transition.guard,) if e is not None)
        if isinstance(transition.trigger, When):
            yield transition.trigger.condition
        yield from expressions_in(transition.effect)
    for state in region.states:
        yield from (*expressions_in(state.entry), *expressions_in(state.exit))


def _of_activities(component: Component) -> Iterator[m.Expression]:
    for activity in component.activities:
        yield from expressions_in(activity.flow or ())
        yield from (clause.condition for clause in (*activity.requires, *activity.ensures))


def _is_decided(expression: m.Expression, *, computed: bool = False) -> bool:
    """Holds it a comparison whose outcome, or one of whose halves, the ranges decide?

    With ``computed`` only comparisons with an operation count.
    """
    if not isinstance(expression, m.Operation):
        return isinstance(expression, m.Literal) and isinstance(expression.value, bool)
    if any(_is_decided(o, computed=computed) for o in expression.operands):
        return True
    if expression.operator not in ("=", "/=", "<", "<=", ">", ">="):
        return False
    if computed and not any(isinstance(o, m.Operation) for o in expression.operands):
        return False
    names = [_names(o) for o in expression.operands]
    if names[0] & names[1]:  # the compiler knows that `x - 1` is below `x`
        return True
    left, right = (_bounds(o) for o in expression.operands)
    return bool(left and right and (left[0] >= right[1] or right[0] >= left[1]))


def _names(expression: m.Expression) -> frozenset[m.Expression]:
    """Everything that an expression reads."""
    return frozenset(leaf for leaf in m.leaves(expression) if isinstance(leaf, m.Name))


def _bounds(expression: m.Expression) -> tuple[int, int] | None:
    match expression:
        case m.Literal(int(value)):
            return value, value
        case m.Operation(type=None):
            return expression.low, expression.high
        case m.Name(_, _, field, of_type):
            scalar = (
                of_type.field(field).type
                if isinstance(of_type, m.RecordType) and field
                else of_type
            )
            if isinstance(scalar, m.IntegerType):
                return scalar.first, scalar.last
    return None
