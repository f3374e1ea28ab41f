# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cells: the ranges of values that the search distinguishes for each data item."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from ravenchart.gen.language.terms import (
    EnumerationType,
    Expression,
    If,
    IntegerType,
    Reading,
    ScalarType,
    Set,
)
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import When

from . import logic
from .logic import Term, Variable

Cell = tuple[int, int]
"""First and last value; Booleans count 0 and 1."""

MOST_CELLS = 12
"""The search does not distinguish the values of a variable with more cells."""


PROTOCOL = "state of the protocol"
"""The data item of a protocol (`protocols`): no model has this name. Control determines most of it,
so all of its values are distinguished."""


def expressions(component: Component) -> Iterator[Expression]:
    """Every expression that decides something, those in flows included."""
    yield from (invariant.condition for invariant in component.invariants)
    for region in component.regions:
        for transition in region.transitions:
            if isinstance(transition.trigger, When):
                yield transition.trigger.condition
            if transition.guard is not None:
                yield transition.guard
    for action in actions(component):
        if isinstance(action, If):
            yield action.condition


def actions(component: Component) -> Iterator[object]:
    """Every action of a component's flows."""
    for flow in flows(component):
        yield from every(flow)


def flows(component: Component) -> Iterator[Sequence[object]]:
    """Every flow of a component."""
    for region in component.regions:
        yield region.initial.effect
        for state in region.states:
            yield from (state.entry, state.exit)
            yield from (nested.initial.effect for nested in state.regions)
        yield from (transition.effect for transition in region.transitions)
    yield from (activity.flow for activity in component.activities if activity.flow is not None)


def every(flow: Iterable[object]) -> Iterator[object]:
    """The actions of a flow, including those inside others."""
    for action in flow:
        yield action
        if isinstance(action, If):
            yield from every((*action.then, *action.otherwise))


def partition(
    component: Component, types: dict[Variable, ScalarType], initial: dict[Variable, Term]
) -> dict[Variable, tuple[Cell, ...]]:
    """The cells of each data item whose values the search distinguishes."""
    deciding = _deciding(component)
    cuts: dict[Variable, set[int]] = {name: set() for name in initial if name in deciding}
    for expression in expressions(component):
        for name, number in logic.landmarks(expression):
            if name in cuts:
                cuts[name] |= {number, number + 1}
    found = {}
    for name in cuts:
        cells = _cells(types[name], cuts[name], initial[name])
        if len(cells) <= MOST_CELLS or name[1] == PROTOCOL:
            found[name] = cells
    return found


def _deciding(component: Component) -> set[Variable]:
    """The variables that decisions depend on, also through the values that others are set to."""
    found = set(_variables(expressions(component)))
    sets = [
        (logic.variable(Reading.DATA, action.data, action.field), action)
        for action in actions(component)
        if isinstance(action, Set)
    ]
    while True:
        more = {v for name, a in sets if name in found for v in _variables([a.value])} - found
        if not more:
            return found
        found |= more


def _variables(terms: Iterable[Expression]) -> Iterator[Variable]:
    for expression in terms:
        for name in logic.names(expression):
            yield logic.variable(name.kind, name.name, name.field)


def _cells(type_: ScalarType, cuts: set[int], initial: Term) -> tuple[Cell, ...]:
    if isinstance(type_, EnumerationType):
        return tuple((i, i) for i in range(len(type_.literals)))
    assert isinstance(type_, IntegerType)
    start = initial.as_long()
    firsts = sorted(
        {type_.first} | {n for n in {*cuts, start, start + 1} if type_.first < n <= type_.last}
    )
    return tuple(zip(firsts, [*(n - 1 for n in firsts[1:]), type_.last], strict=True))
