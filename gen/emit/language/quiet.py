# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Conditions that the compiler can decide, and pragmas against its warnings.

A type of one value, a region of one leaf or a guard that ranges decide are sound, and the
compiler warns of each. Only a unit that holds such a condition turns these warnings off. The
tests for states are read from the unit's constructs, and ranges from the terms of the model.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from ravenchart.gen.emit.ada.declarations import Package, Unit
from ravenchart.gen.emit.ada.expressions import ChoiceList, Membership, OperatorChain, StringLiteral
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import component_name
from ravenchart.gen.emit.ada.statements import Pragma
from ravenchart.gen.emit.ada.walking import nodes_in
from ravenchart.gen.language import terms as m
from ravenchart.gen.language.narrowing import COMPARISONS
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region, When

from .configurations import Configurations
from .terms import expressions_in

_DECIDED = "can * be"
"""The warning on a condition that ranges decide, "can only be" or "can never be"."""
_MEMBERSHIP = "explicit membership test"
"""The warning on the test for a state that is always active."""
_COMPUTED = "condition is always"
"""The warning where operators, and not types alone, decide."""
_IDLE = "formal parameter * is not referenced"
"""The warning on functions of a chart without transitions: they test no occurrence."""


class DecidedStates:
    """The states that are active whatever their regions do, as the units of Ada name them."""

    def __init__(self, components: Sequence[Component]) -> None:
        self._literals: set[DottedName] = set()
        self._composites: set[DottedName] = set()
        for component in components:
            for region in component.regions:
                self._add(component, Configurations(region))

    def _add(self, component: Component, chart: Configurations) -> None:
        leaves = [chart.literals(region) for region in chart.concurrent]
        single = [own[0] for own in leaves if len(own) == 1]
        for known, found in ((self._literals, single), (self._composites, _whole(chart, leaves))):
            known.update(chart.literal(name, component_name(component)) for name in found)

    def words(self, unit: Unit, component: Component | None) -> Iterator[str]:
        """The warnings on the states that a unit tests for."""
        if not self._literals and not self._composites:  # most models: no unit is walked
            return
        prefix = () if component is None else (component_name(component),)
        for node in nodes_in(unit.item):
            match node:
                case OperatorChain("=" | "/=", (_, DottedName() as asked)):
                    if ref(*prefix, asked) in self._literals:
                        yield _DECIDED
                case Membership(_, ChoiceList((DottedName() as asked,))):
                    if ref(*prefix, asked) in self._composites:
                        yield _MEMBERSHIP


def _whole(chart: Configurations, leaves: Sequence[tuple[str, ...]]) -> list[str]:
    """The composites that hold all the leaves of a concurrent region."""
    composites = (state for state in chart.region.states if len(state.regions) == 1)
    return [s.name for s in composites if chart.literals(s.region_ids[0]) in leaves]


def quiet(unit: Unit, words: Iterator[str]) -> Unit:
    """The unit, with the warnings of these words off."""
    if not isinstance(unit.item, Package):
        return unit
    wanted = set(words)
    ordered = (word for word in (_DECIDED, _MEMBERSHIP, _COMPUTED, _IDLE) if word in wanted)
    pragmas = (Pragma("Warnings", (ref("Off"), StringLiteral(f"*{word}*"))) for word in ordered)
    return replace(unit, item=replace(unit.item, items=(*pragmas, *unit.item.items)))


def warnings_of(expressions: Iterable[m.Expression], *, by_name: bool = False) -> Iterator[str]:
    """The warnings on these terms of the model.

    With ``by_name`` the names in them are parameters, of which the compiler knows that `x - 1`
    is below `x`.
    """
    for expression in expressions:
        if isinstance(expression, m.Operation):
            yield from warnings_of(expression.operands, by_name=by_name)
            if expression.operator in COMPARISONS:
                yield from _words(expression, by_name)


def warnings_of_idle(region: Region) -> Iterator[str]:
    """The warnings in the spec of a region without transitions."""
    if not Configurations(region).compounds.firings:
        yield from (_DECIDED, _COMPUTED, _IDLE)


def declared_in(component: Component, region: Region) -> list[m.Expression]:
    """The terms in the spec of a region: guards, conditions and invariants."""
    found = [t.guard for t in region.transitions if t.guard is not None]
    found += [t.trigger.condition for t in region.transitions if isinstance(t.trigger, When)]
    return found + [one.condition for one in component.invariants]


def done_in(region: Region) -> list[m.Expression]:
    """The terms in its body: those of behaviours."""
    flows = [t.effect for t in region.transitions]
    flows += [flow for state in region.states for flow in (state.entry, state.exit)]
    flows += [r.initial.effect for state in region.states for r in state.regions]
    return [e for flow in (*flows, region.initial.effect) for e in expressions_in(flow)]


def promised_in(component: Component) -> list[m.Expression]:
    """The terms of the contracts of activities."""
    clauses = (c for a in component.activities for c in (*a.requires, *a.ensures))
    return [clause.condition for clause in clauses]


def worked_in(component: Component) -> list[m.Expression]:
    """The terms of the activities that the model gives."""
    return [e for a in component.activities for e in expressions_in(a.flow or ())]


Range = tuple[float, float]
_ANY: Range = (-math.inf, math.inf)


def _words(comparison: m.Operation, by_name: bool) -> Iterator[str]:
    operator, (left, right) = comparison.operator, comparison.operands
    if _is_of_one_value(left) or _is_of_one_value(right):
        yield _DECIDED
    if by_name and _apart_by_a_number(left, right):
        yield from (_DECIDED, _COMPUTED)
    held = _range(left, valid=True), _range(right, valid=True)
    if held[0] is not None and held[1] is not None:
        if _tells(operator, held[0], held[1]):
            yield _DECIDED
        always = _range(left, valid=False), _range(right, valid=False)
        assert always[0] is not None
        assert always[1] is not None
        if _tells(operator, always[0], always[1], halves=False):
            yield _COMPUTED


def _is_of_one_value(side: m.Expression) -> bool:
    return isinstance(side, m.Name) and m.has_one_value(_type_of(side))


def _type_of(name: m.Name) -> m.Type:
    """The type of a name, or of the field that it selects."""
    if isinstance(name.type, m.RecordType) and name.field:
        return name.type.field(name.field).type
    return name.type


def _apart_by_a_number(left: m.Expression, right: m.Expression) -> bool:
    """Are both one name, with a number added or subtracted?"""
    names = [_name(side) for side in (left, right)]
    return names[0] is not None and names[0] == names[1]


def _name(side: m.Expression) -> m.Name | None:
    """The name of a sum of it and a number, or the name itself."""
    match side:
        case m.Name(field=None):
            return side
        case m.Operation("+" | "-", (m.Name(field=None) as name, m.Literal())):
            return name
    return None


def _tells(operator: str, left: Range, right: Range, *, halves: bool = True) -> bool:
    """Do the ranges of both sides decide a comparison, or one of the halves of `<=` and `>=`?"""
    apart = left[1] < right[0] or right[1] < left[0]
    above, below = left[0] >= right[1], left[1] <= right[0]
    match operator:
        case ">":
            return apart or below
        case "<":
            return apart or above
        case ">=":
            return apart or above or (below and halves)
        case "<=":
            return apart or below or (above and halves)
    return apart or (above and below)


def _range(expression: m.Expression, *, valid: bool) -> Range | None:
    """The range that the compiler knows of a number; ``valid``: it relies on the types of names.

    None: no range, as of attributes and conditional expressions.
    """
    match expression:
        case m.Literal(bool()):
            return None
        case m.Literal(int(value)):
            return value, value
        case m.Name():
            scalar = _type_of(expression)
            if isinstance(scalar, m.IntegerType):
                return (scalar.first, scalar.last) if valid else _ANY
        case m.Operation("+" | "-" | "*" | "/" | "neg" | "abs", operands):
            ranges = [_range(operand, valid=valid) for operand in operands]
            if all(ranges):
                known = [r for r in ranges if r is not None]
                if valid:
                    return expression.low, expression.high
                return _result(expression.operator, known)
    return None


def _result(operator: str, given: Sequence[Range]) -> Range:
    """The range of an operation on these; any where that is not simple."""
    match operator, given:
        case "+", [left, right]:
            return left[0] + right[0], left[1] + right[1]
        case "-", [left, right]:
            return left[0] - right[1], left[1] - right[0]
        case "neg", [only]:
            return -only[1], -only[0]
        case "abs", [only]:
            return max(0, only[0], -only[1]), max(-only[0], only[1])
    return _ANY
