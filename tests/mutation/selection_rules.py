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
from ravenchart.gen.emit.ada.statements import IfStatement

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
    following,
    names_of,
    put,
    whole,
)

_SELECTION = ref("Selection")
_NOW = ref("Now")
_COMPARED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "=": "/=", "/=": "="}


def selectors(unit: Unit) -> Iterator[tuple[Body, Spot[IfExpr]]]:
    """The functions that select by the occurrence, with their branches."""
    for one in bodies(unit):
        inner = one.inner
        gives = one.spot.node.result == _SELECTION and isinstance(inner.node, IfExpr)
        if gives and _asked(inner.node.branches[0][0]) == _NOW:
            yield one, inner


def selecting(unit: Unit, transition: DottedName) -> list[str]:
    """The functions with a contract that select a transition by themselves."""
    return [
        one.name
        for one in bodies(unit)
        if one.is_expression
        and one.spot.node.result == _SELECTION
        and one.spot.node.aspects
        and transition in names_of(one.inner.node)
    ]


def _asked(condition: Expr) -> Expr | None:
    """What a condition asks for first."""
    match condition:
        case OperatorChain("and then", operands):
            return _asked(operands[0])
        case OperatorChain("=", (left, _)):
            return left
        case Membership(item):
            return item
    return None


def _heads(chosen: Spot[IfExpr]) -> list[Spot[Expr]]:
    return [chosen.at("branches", place, 0) for place in range(len(chosen.node.branches))]


def _rows(case: Spot[CaseExpr]) -> list[Spot[Expr]]:
    """The values of the alternatives of a case."""
    return [case.at("branches", place, 1) for place in range(len(case.node.branches))]


def declared_rows(unit: Unit, function: str) -> list[Spot[Expr]]:
    """The alternatives of the case of an expression function, whatever stands before it."""
    one = body_of(unit, function)
    case = next(one.inner.within(CaseExpr), None) if one is not None else None
    return [] if case is None else _rows(case)


# --- source


def source_in_code(file: str, units: Units) -> Iterator[Broken]:
    """A transition that its leaf forgets, and leaves whose functions are exchanged."""
    for one, chosen in selectors(units[file]):
        branches = chosen.node.branches
        for place in range(len(branches)):
            left = (*branches[:place], *branches[place + 1 :])
            rest = replace(chosen.node, branches=left) if left else chosen.node.otherwise
            yield one.name, "forget", put(chosen, rest)
    for one in bodies(units[file]):
        if one.is_expression and one.spot.node.result == _SELECTION:
            for case in one.inner.within(CaseExpr):
                for first, second in pairwise(_rows(case)):
                    yield one.name, "exchange", exchanged(first, second)


def source_declared(file: str, units: Units) -> Iterator[Broken]:
    """Another state as the source of a declared transition; none that is asked for."""
    for _, puts in each_following(_compared(units[file], "In_Source")):
        yield "In_Source", "source", puts
    one = body_of(units[file], "Enabled")
    for asked in one.inner.within(Call) if one is not None else ():
        if asked.node.name == ref("In_Source"):
            yield "Enabled", "source", put(asked, TRUE)


def _compared(unit: Unit, function: str) -> list[tuple[object, Spot[DottedName]]]:
    """The literals that the alternatives of a function compare, with what is alike in them."""
    found: list[tuple[object, Spot[DottedName]]] = []
    for row in declared_rows(unit, function):
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
    """Another occurrence in the condition of a selected transition."""
    found = [
        (one.name, first.at("operands", 1))
        for one, chosen in selectors(units[file])
        for head in _heads(chosen)
        for first in conjuncts(head)[:1]
        if isinstance(first.node, OperatorChain)
    ]
    for name, spot in found:
        other = following(spot.node, [each.node for _, each in found])
        if other is not None:
            yield name, "trigger", put(spot, other)


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
    """A guard that is dropped, denied or shifted by one comparison, in a leaf's function."""
    for one, chosen in selectors(units[file]):
        for head in _heads(chosen):
            for rule, puts in _guards(head):
                yield one.name, rule, puts


def guard_declared(file: str, units: Units) -> Iterator[Broken]:
    """A guard that is dropped, denied or shifted by one comparison."""
    for row in declared_rows(units[file], "Enabled"):
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
    """Two transitions of one trigger that are looked at in the other order; an outer lane that
    selects although an inner one does."""
    for one, chosen in selectors(units[file]):
        for place in _same_trigger(chosen):
            first, second = (chosen.at("branches", n) for n in (place, place + 1))
            yield one.name, "precede", exchanged(first, second)
    choose = body_of(units[file], "Choose")
    for asks in choose.inner.within(IfStatement) if choose is not None else ():
        if all(name.first != "C" for name in names_of(asks.node.branches[0][0])):
            continue
        yield "Choose", "outer lane", put(asks.at("branches", 0, 0), TRUE)


def _same_trigger(chosen: Spot[IfExpr]) -> Iterator[int]:
    """The positions of branches that the next one has the trigger of."""
    triggers = [conjuncts(head)[0].node for head in _heads(chosen)]
    for place, (first, second) in enumerate(pairwise(triggers)):
        if first == second:
            yield place


def priority_declared(file: str, units: Units) -> Iterator[Broken]:
    """Two transitions of one trigger that are declared in the other order."""
    body = units.get(f"{units[file].name.file_stem}.adb")
    every = whole(units[file])
    listed = next((t for t in every.within(EnumType) if t.node.name == "Selection"), None)
    if listed is None or body is None:
        return
    at = {name: listed.at("literals", n) for n, name in enumerate(listed.node.literals)}
    bounds = {name for one in every.within(RangeConstrained) for name in names_of(one.node.bounds)}
    done: set[tuple[str, str]] = set()
    for _, chosen in selectors(body):
        for place in _same_trigger(chosen):
            pair = [value for _, value in chosen.node.branches[place : place + 2]]
            names = [value.text for value in pair if isinstance(value, DottedName)]
            first, second = names
            if (first, second) not in done and not bounds & set(pair):
                done.add((first, second))
                yield "Selection", "precede", exchanged(at[first], at[second])
