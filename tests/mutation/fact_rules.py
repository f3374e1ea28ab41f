# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Breaks of the facts that the timing certificate states and the code takes from it.

A fact is edited where the code uses it: a priority, a period, a row's divisor, an identifier.
In the certificate, terms are taken out of its sums, and what they suppose is edited.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import pairwise

from ravenchart.gen.emit.ada.declarations import Object, Subprogram, Unit
from ravenchart.gen.emit.ada.expressions import (
    Arg,
    Call,
    Expr,
    IntegerLiteral,
    Membership,
    OperatorChain,
    bits,
    chain,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.statements import NULL, Case
from ravenchart.gen.emit.certificate.certified import CERTIFICATE

from .mutants import Broken, Units
from .nodes import Spot, body_of, exchanged, put, whole
from .program_rules import args_named, certificates

OTHER_ID = bits(0x7E0)
"""An identifier that no message of the subjects has."""
_OF_TASKS = ("Task_Priority", "Driver_Priority", "Probe_Priority")


def is_fact(value: object) -> bool:
    """Is it a number of the certificate, as the program sees it?"""
    return isinstance(value, DottedName) and value.first == CERTIFICATE


def _more(value: Expr, by: int) -> Expr:
    return OperatorChain("+" if by > 0 else "-", (value, number(abs(by))))


def _twice(value: Expr) -> Expr:
    return OperatorChain("*", (number(2), value))


def _half(value: Expr) -> Expr:
    return OperatorChain("/", (value, number(2)))


def _given(unit: Unit, *names: str) -> Iterator[Spot[Expr]]:
    """The facts and numbers that are given to parameters or components of these names."""
    for arg in args_named(whole(unit), *names):
        if is_fact(arg.node.value) or isinstance(arg.node.value, IntegerLiteral):
            yield arg.at("value")


def _priorities(units: Units) -> dict[str, Spot[IntegerLiteral]]:
    """The priorities that tasks of this program are given, and their levels."""
    given = (spot.node for unit in units.values() for spot in _given(unit, *_OF_TASKS))
    used = {name.last for name in given if isinstance(name, DottedName)}
    return {
        one.node.name: one.at("value", "operands", 1)
        for unit in certificates(units)
        for one in whole(unit).within(Object)
        if one.node.name in used and isinstance(one.node.value, OperatorChain)
    }


def task(file: str, units: Units) -> Iterator[Broken]:
    """A task with another priority, period, deadline, separation or offset."""
    unit = units[file]
    for given in _given(unit, *_OF_TASKS):
        own = given.node
        if isinstance(own, DottedName):
            yield from _another_priority(given, own, units)
    for name in ("Period", "Deadline", "Minimum_Separation"):
        for given in _given(unit, name):
            yield name.lower(), "1_234_567", put(given, number(1_234_567))
            yield name.lower(), f"2 * {name}", put(given, _twice(given.node))
    for given in _given(unit, "Offset"):
        yield "offset", "later", put(given, number(1_000_000))


def _another_priority(given: Spot[Expr], own: DottedName, units: Units) -> Iterator[Broken]:
    levels = {name: spot.node.value for name, spot in _priorities(units).items()}
    yield "priority", "higher", put(given, _more(own, 1))
    yield "priority", "lower", put(given, _more(own, -1))
    for other, level in levels.items():
        if level != levels[own.last]:
            yield "priority", f"of {other}", put(given, ref(CERTIFICATE, other))
    yield "priority", "bottom", put(given, number(1))


def table(file: str, units: Units) -> Iterator[Broken]:
    """A row of a table in other releases."""
    unit = units[file]
    for name in ("Divisor", "Phase"):
        for given in _given(unit, name):
            yield "table", name.lower(), put(given, _more(given.node, 1))
    for given in _given(unit, "Cycle"):
        if given.node != number(1):
            yield "table", "cycle", put(given, _more(given.node, 1))


def bus(file: str, units: Units) -> Iterator[Broken]:
    """Another bit rate, or another identifier or length that is sent or expected."""
    unit = units[file]
    every = whole(unit)
    for given in _given(unit, "Bit_Rate"):
        yield "bus", "bit rate", put(given, _half(given.node))
    for given in _given(unit, "Id"):
        yield "bus", "id sent", put(given, OTHER_ID)
    for given in _given(unit, "Length"):
        yield "bus", "length sent", put(given, _more(given.node, 1))
    expected = [one.at("operands", 1) for one in every.within(OperatorChain) if _asks(one.node)]
    expected += [one.at("among", "choices", 0) for one in every.within(Membership)]
    for spot in expected:
        if _is_of(spot.node, "Id"):
            yield "bus", "id expected", put(spot, OTHER_ID)
    for call in every.within(Call):
        last = call.at("args", len(call.node.args) - 1) if call.node.args else None
        if last is not None and last.node.name is None and _is_of(last.node.value, "Length"):
            yield "bus", "length expected", put(last.at("value"), _more(last.node.value, 1))


def _asks(one: OperatorChain) -> bool:
    return one.operator == "="


def _is_of(value: object, letter: str) -> bool:
    """Is it the fact of an element that is called so?"""
    return isinstance(value, DottedName) and is_fact(value) and value.last.endswith(f"_{letter}")


def calls(file: str, units: Units) -> Iterator[Broken]:
    """A row that is executed twice, not at all, or in place of another one."""
    one = body_of(units[file], "Execute")
    rows = [
        case.at("branches", place, 1)
        for case in (one.inner.within(Case) if one is not None else ())
        for place in range(len(case.node.branches))
    ]
    for row in rows:
        yield "Execute", "twice", put(row, (*row.node, *row.node))
        yield "Execute", "not at all", put(row, (NULL,))
    for row, other in pairwise(rows):
        yield "Execute", "other row", put(row, other.node)


# --- the certificate


def _own(one: Spot[Object], *endings: str) -> str:
    """The element whose number it is, by what the number is called; "" where it is another."""
    own, _, what = one.node.name.rpartition("_")
    while what.isdigit():
        own, _, what = own.rpartition("_")
    return own if what in endings else ""


def sums(file: str, units: Units) -> Iterator[Broken]:
    """A term less in a sum of the certificate."""
    every = whole(units[file])
    for one in every.within(Object):
        value = one.node.value
        if (own := _own(one, "B")) and isinstance(value, DottedName):
            yield own, "blocking", put(one.at("value"), number(0))
        if isinstance(value, OperatorChain) and value.operator == "+":
            if own := _own(one, "Needs"):
                left = chain("+", value.operands[:-1])
                yield own, "interference", put(one.at("value"), left)
            if own := _own(one, "C"):
                yield own, "budget", put(one.at("value"), chain("+", value.operands[1:]))
    for function in every.within(Subprogram):
        for call in function.within(Call):
            match call.node:
                case Call(_, (_, *_, Arg(None, Call(_, (Arg(None, DottedName(("W",))),))))):
                    fewer = replace(call.node, args=call.node.args[:-1])
                    yield function.node.name, "interference", put(call, fewer)


def supposed(file: str, units: Units) -> Iterator[Broken]:
    """What the sums of the certificate suppose is edited: order, divisor, length, bit rate."""
    found = sorted(_priorities(units).items(), key=lambda pair: pair[1].node.value)
    for (name, level), (_, other) in pairwise(found):
        if level.node != other.node:
            yield name, "swapped", exchanged(level, other)
            yield name, "level", put(level, other.node)
    numbers = [
        one
        for one in whole(units[file]).within(Object)
        if isinstance(one.node.value, IntegerLiteral)
    ]
    for one in numbers:
        value = one.at("value")
        for what in ("Divisor", "Length"):
            if own := _own(one, what):
                yield own, what.lower(), put(value, number(value.node.value + 1))
        if one.node.name.endswith("_Bit_Rate"):
            yield one.node.name.removesuffix("_Bit_Rate"), "bit rate", put(value, _half(value.node))
    identifiers = [one for one in numbers if _own(one, "Id")]
    for first, second in pairwise(identifiers):
        yield _own(first, "Id"), "identifiers", exchanged(first.at("value"), second.at("value"))
