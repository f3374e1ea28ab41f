# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of what a region selects: source, trigger, guard, precedence; as code and as declared."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from ravenchart.gen.emit.ada.declarations import EnumType, Unit
from ravenchart.gen.emit.ada.expressions import (
    COMPARISONS,
    TRUE,
    Arg,
    Call,
    CaseExpr,
    ChoiceList,
    Expr,
    IfExpr,
    Membership,
    OperatorChain,
    Prefix,
    RangeConstrained,
    both,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.statements import Assign, Case, IfStatement, Return
from ravenchart.gen.emit.charts.shape import PASSING

from .mutants import Broken, Units
from .nodes import (
    Body,
    Put,
    Spot,
    bodies,
    body_of,
    conjuncts,
    each_following,
    exchanged,
    names_of,
    put,
    statements,
    whole,
)

_IN_SOURCE, _ENABLED = ref("In_Source"), ref("Enabled")
_SELECTED, _SEGMENT = "Selected", "Next_Segment"
_NOW, _NONE = ref("Now"), ref("None")
_COMPARED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "=": "/=", "/=": "="}


def _calls(unit: Unit, function: str, called: DottedName) -> list[Spot[Call]]:
    """The calls of a function in the body of another one."""
    one = body_of(unit, function)
    every = one.inner.within(Call) if one is not None else ()
    return [call for call in every if call.node.name == called]


def _alternatives(unit: Unit, function: str) -> list[tuple[list[DottedName], Spot[Expr]]]:
    """The transitions and values of the case of an expression function."""
    one = body_of(unit, function)
    case = next(one.inner.within(CaseExpr), None) if one is not None else None
    if case is None:
        return []
    return [
        (
            [one for one in choices.choices if isinstance(one, DottedName)],
            case.at("branches", place, 1),
        )
        for place, (choices, _) in enumerate(case.node.branches)
    ]


# --- source


def source_in_code(file: str, units: Units) -> Iterator[Broken]:
    """The selection of another region; a transition that is found and forgotten."""
    unit = units[file]
    asked = [spot.at("value") for spot in _assigned(unit)]
    for _, puts in each_following([("Choose", call) for call in asked]):
        yield "Choose", "region", puts
    for one, alternatives in _searches(unit):
        for place in range(len(alternatives.node.branches) if one.name != _SEGMENT else 0):
            yield one.name, "forget", put(alternatives.at("branches", place, 1), _NONE)


def _assigned(unit: Unit) -> list[Spot[Assign]]:
    """What `Choose` assigns the selection of each region by."""
    choose = body_of(unit, "Choose")
    every = choose.inner.within(Assign) if choose is not None else ()
    return [one for one in every if isinstance(one.node.value, Call)]


def _searches(unit: Unit) -> Iterator[tuple[Body, Spot[IfExpr]]]:
    """Where a function asks one transition after the other whether it is enabled."""
    for one in bodies(unit):
        if one.name.split("_")[0] == _SELECTED or one.name == _SEGMENT:
            for gives in one.inner.within(Return):
                if isinstance(gives.node.value, IfExpr):
                    yield one, gives.at("value")


def source_declared(file: str, units: Units) -> Iterator[Broken]:
    """Another state as the source of a declared transition; none that is asked for."""
    for _, puts in each_following(_compared(units[file], _IN_SOURCE.text)):
        yield "In_Source", "source", puts
    for asked in _calls(units[file], _ENABLED.text, _IN_SOURCE):
        yield "Enabled", "source", put(asked, TRUE)


def _compared(unit: Unit, function: str) -> list[tuple[object, Spot[DottedName]]]:
    """The literals that the alternatives of a function compare, with what is alike in them."""
    found: list[tuple[object, Spot[DottedName]]] = []
    for _, row in _alternatives(unit, function):
        for part in conjuncts(row):
            match part.node:
                case OperatorChain("=", (DottedName() as left, DottedName())):
                    found.append((left, part.at("operands", 1)))
                case Membership(item, ChoiceList((*others, DottedName()))):
                    last = part.at("among", "choices", len(others))
                    found.append(((item, *others), last))
    return found


# --- trigger and guard


def trigger_in_code(file: str, units: Units) -> Iterator[Broken]:
    """Transitions that are selected for the occurrence of others; a segment for another one."""
    for one in bodies(units[file]):
        if one.name.split("_")[0] == _SELECTED:
            for case in one.inner.within(Case):
                last = len(case.node.branches) - 1  # `others`
                rows = [case.at("branches", place, 0) for place in range(last)]
                yield from ((one.name, "trigger", exchanged(*pair)) for pair in pairwise(rows))
    for one, alternatives in _searches(units[file]):
        for arg in alternatives.within(Arg) if one.name == _SEGMENT else ():
            if arg.node.value == ref(PASSING):
                yield one.name, "trigger", put(arg.at("value"), ref("Conditions"))


def trigger_declared(file: str, units: Units) -> Iterator[Broken]:
    """Another occurrence as the trigger of a declared transition."""
    asked = [
        (key, spot)
        for key, spot in _compared(units[file], "Enabled")
        if _NOW in (key, *(key if isinstance(key, tuple) else ()))
    ]
    for _, puts in each_following(asked):
        yield "Enabled", "trigger", puts


def guard_in_code(file: str, units: Units) -> Iterator[Broken]:
    """A transition is selected whether it is enabled or not, or when it is not."""
    for one, alternatives in _searches(units[file]):
        for place in range(len(alternatives.node.branches)):
            condition = alternatives.at("branches", place, 0)
            yield one.name, "drop guard", put(condition, TRUE)
            yield one.name, "deny guard", put(condition, Prefix("not", condition.node))


def guard_declared(file: str, units: Units) -> Iterator[Broken]:
    """A guard that is dropped, denied or shifted by one comparison."""
    for _, row in _alternatives(units[file], _ENABLED.text):
        for rule, puts in _guards(row):
            yield "Enabled", rule, puts


def _guards(condition: Spot[Expr]) -> Iterator[tuple[str, tuple[Put, ...]]]:
    parts = conjuncts(condition)
    for place, part in enumerate(parts[1:], 1):
        others = [one.node for one in (*parts[:place], *parts[place + 1 :])]
        yield "drop guard", put(condition, both(*others))
        yield "deny guard", put(part, Prefix("not", part.node))
        for chain in part.within(OperatorChain):
            if chain.node.operator in COMPARISONS:
                other = replace(chain.node, operator=_COMPARED[chain.node.operator])
                yield "shift guard", put(chain, other)


# --- precedence


def priority_in_code(file: str, units: Units) -> Iterator[Broken]:
    """A later transition that is asked first; an outer region that selects although an inner one
    does, or before it."""
    alike = {t: n for n, (ts, _) in enumerate(_alternatives(units[file], "In_Source")) for t in ts}
    for one, alternatives in _searches(units[file]):
        rows = [alternatives.at("branches", n) for n in range(len(alternatives.node.branches))]
        for first, second in pairwise(rows):
            if alike.get(first.node[1]) == alike.get(second.node[1]):
                yield one.name, "precede", exchanged(first, second)
    choose = body_of(units[file], "Choose")
    if choose is None:
        return
    for before, asks in pairwise(statements(choose.inner)):
        if isinstance(asks.node, IfStatement):
            condition = asks.at("branches", 0, 0)
            yield "Choose", "outer region", put(condition, TRUE)
            asked = set(names_of(condition.node))
            if isinstance(before.node, Assign) and before.node.target in asked:
                yield "Choose", "outer first", exchanged(before, asks)


def priority_declared(file: str, units: Units) -> Iterator[Broken]:
    """Two transitions of one source and trigger that are declared in the other order."""
    every = whole(units[file])
    listed = next((t for t in every.within(EnumType) if t.node.name == "Selection"), None)
    if listed is None:
        return
    triggers = {
        choice: conjuncts(row)[0].node
        for choices, row in _alternatives(units[file], _ENABLED.text)
        for choice in choices
    }
    at = {ref(name): listed.at("literals", n) for n, name in enumerate(listed.node.literals)}
    bounds = {name for one in every.within(RangeConstrained) for name in names_of(one.node.bounds)}
    for choices, _ in _alternatives(units[file], _IN_SOURCE.text):
        alike: dict[Expr, list[DottedName]] = {}
        for choice in choices:
            alike.setdefault(triggers[choice], []).append(choice)
        for pair in (pair for same in alike.values() for pair in pairwise(same)):
            if not bounds & set(pair):
                yield "Selection", "precede", exchanged(at[pair[0]], at[pair[1]])
