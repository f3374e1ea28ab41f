"""Models in which the compiler can decide conditions, and what keeps it from saying so.

A type of one value, a region of one leaf or a guard that ranges decide are
sound, and the compiler warns of each. Only programs of such models say that
these warnings are not wanted.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ravenchart.gen.emit.ada.syntax import Package, Pragma, Ref, Unit
from ravenchart.gen.language import terms as m
from ravenchart.gen.model.statechart import When
from ravenchart.gen.model.system import System

from .compound import Place
from .places import Places
from .terms import expressions_in

_WORDS = ("can only be", "can never be", "explicit membership test", "'Valid attribute")
_COMPUTED = "condition is always"
"""What it says where operators, and not types alone, decide."""


def quiet(unit: Unit, *, computed: bool) -> Unit:
    """The unit, with these warnings off; ``computed``: there are comparisons of results."""
    if not isinstance(unit.item, Package):
        return unit
    words = (*_WORDS, _COMPUTED) if computed else _WORDS
    pragmas = (Pragma("Warnings", (Ref("Off"), Ref(f'"*{word} *"'))) for word in words)
    return replace(unit, item=replace(unit.item, items=(*pragmas, *unit.item.items)))


def has_computed_conditions(system: System) -> bool:
    """Can the compiler decide a comparison of what operators yield?"""
    return any(_is_decided(e, computed=True) for e in _expressions(system))


def has_decided_conditions(system: System) -> bool:
    """Can the compiler decide a condition of the generated program?"""
    if any(_has_one_value(t) for t in system.types):
        return True
    regions = [r for c in system.components for r in c.regions]
    if any(not r.transitions or _has_whole_lane(Places(r)) for r in regions):
        return True
    return any(_is_decided(e) for e in _expressions(system))


def _has_whole_lane(places: Places) -> bool:
    """Is a lane a single leaf, or has it a composite that holds all its leaves?"""
    lanes = [places.literals(lane) for lane in places.lanes]
    nested = (s for s in places.region.states if len(s.regions) == 1)
    inside = (tuple(places.literals_in(Place(s.name, s.regions[0].name))) for s in nested)
    return any(len(leaves) == 1 for leaves in lanes) or any(leaves in lanes for leaves in inside)


def _has_one_value(of_type: m.Type) -> bool:
    match of_type:
        case m.IntegerType():
            return of_type.first == of_type.last
        case m.EnumerationType():
            return len(of_type.literals) == 1
        case _:
            return False


def _expressions(system: System) -> Iterator[m.Expression]:
    for component in system.components:
        for region in component.regions:
            for transition in region.transitions:
                yield from (e for e in (transition.guard,) if e is not None)
                if isinstance(transition.trigger, When):
                    yield transition.trigger.condition
                yield from expressions_in(transition.effect)
            for state in region.states:
                yield from (*expressions_in(state.entry), *expressions_in(state.exit))
        for activity in component.activities:
            yield from expressions_in(activity.flow or ())


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
    match expression:
        case m.Operation(_, operands):
            return frozenset(name for operand in operands for name in _names(operand))
        case m.Name():
            return frozenset((expression,))
        case _:
            return frozenset()


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
