# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Calls that record values: present only where the model has `record`."""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import ada_case, constant_name, type_name
from ravenchart.gen.emit.ada.syntax import Expr, Ref, Stmt, call, do
from ravenchart.gen.language.terms import IntegerType
from ravenchart.gen.model.recording import RecordedValue
from ravenchart.gen.model.system import System

UNIT = "Recording"
"""The package of the buffer of values and of their numbers, below the system's."""


def recording(system: System) -> bool:
    """Does the program record values?"""
    return bool(system.recorded_values)


def record(
    system: System, instance: str, item: str, holder: str, *, simulated: bool
) -> tuple[Stmt, ...]:
    """One call for each value of an item that the Ada object ``holder`` has."""
    found: list[Stmt] = []
    for one in system.values_of(instance, item):
        given = _number(system, one, holder if one.field is None else f"{holder}.{_field(one)}")
        if simulated:
            found.append(do("Ravenchart.Steps.Put_Value", Ref(f'"{one.element}"'), given))
        else:
            own = Ref(f"{UNIT}.{constant_name(one.element)}")
            found.append(do(f"{UNIT}.Values.Note", given, own))
    return tuple(found)


def _field(one: RecordedValue) -> str:
    return ada_case(one.field or "")


def _number(system: System, one: RecordedValue, holder: str) -> Expr:
    """A value as a number of the runtime: a literal by its position."""
    if not isinstance(one.type, IntegerType):
        return call(f"{type_name(system, one.type)}'Pos", Ref(holder))
    return Ref(holder) if one.type.unit is None else call("Ravenchart.Number", Ref(holder))
