# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Calls that record values: present only where the model has `record`."""

from __future__ import annotations

from ravenchart.gen.emit.ada.expressions import Attribute, Expr, StringLiteral, call
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import NUMBER, ada_case, constant_name, type_name
from ravenchart.gen.emit.ada.statements import Stmt, do
from ravenchart.gen.language.terms import IntegerType
from ravenchart.gen.model.recording import RecordedValue
from ravenchart.gen.model.system import System

UNIT = "Recording"
"""The package of the buffer of values and of their numbers, below the system's."""


def recording(system: System) -> bool:
    """Does the program record values?"""
    return bool(system.recorded_values)


def record_values(
    system: System, instance: str, item: str, holder: Named, *, simulated: bool
) -> tuple[Stmt, ...]:
    """One call for each value of an item that the Ada object ``holder`` has."""
    found: list[Stmt] = []
    for one in system.values_of(instance, item):
        given = _number(system, one, ref(holder) if one.field is None else ref(holder, _field(one)))
        if simulated:
            found.append(do("Ravenchart.Steps.Put_Value", StringLiteral(one.element), given))
        else:
            own = ref(UNIT, constant_name(one.element))
            found.append(do(ref(UNIT, "Values.Note"), given, own))
    return tuple(found)


def _field(one: RecordedValue) -> str:
    return ada_case(one.field or "")


def _number(system: System, one: RecordedValue, holder: DottedName) -> Expr:
    """A value as a number of the runtime: a literal by its position."""
    if not isinstance(one.type, IntegerType):
        return call(Attribute(type_name(system, one.type), "Pos"), holder)
    return holder if one.type.unit is None else call(NUMBER, holder)
