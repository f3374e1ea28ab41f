# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The root package: one Ada type per unit, one subtype or type per model type."""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import (
    ada_case,
    counted,
    default_name,
    type_name,
    unit_type,
    value,
)
from ravenchart.gen.emit.ada.syntax import (
    SPARK,
    Aspect,
    Comment,
    Decl,
    EnumType,
    Object,
    Package,
    PlainType,
    Ref,
    Unit,
)
from ravenchart.gen.emit.ada.syntax import RecordComponent as RecordComponent
from ravenchart.gen.emit.ada.syntax import RecordDeclaration as AdaRecord
from ravenchart.gen.language.terms import (
    BOOLEAN,
    EnumerationType,
    IntegerType,
    RecordType,
    Type,
    default,
)
from ravenchart.gen.model.system import System


def emit_root(system: System, header: str) -> Unit:
    """``package <System>``: pure, and visible from every other unit."""
    items: list[Decl] = []
    for unit in system.units:
        items.append(Comment(f"All values counted in {unit}."))
        items.append(PlainType(unit_type(system, unit).split(".")[-1], "new Ravenchart.Number"))
    scalars = [t for t in system.types if not isinstance(t, RecordType)]
    records = [t for t in system.types if isinstance(t, RecordType)]
    for item in (*scalars, *records):
        if item != BOOLEAN:
            items += _declare(system, item)
    withs = ("Ravenchart",)
    name = ada_case(system.name)
    return Unit(header, withs, Package(name, tuple(items), (SPARK, Aspect("Pure"))))


def _bound(value: int, unit: str | None) -> str:
    bound = counted(value, unit)
    return bound.text if unit is None and value < 0 and isinstance(bound, Ref) else f"{value:_}"


def _declare(system: System, item: Type) -> list[Decl]:
    name = ada_case(item.name)
    match item:
        case IntegerType(_, _, first, last, unit):
            bounds = f"{_bound(first, unit)} .. {_bound(last, unit)}"
            base = unit_type(system, unit).removeprefix(f"{ada_case(system.name)}.")
            return [PlainType(name, f"{base} range {bounds}", subtype=True)]
        case EnumerationType(_, _, literals):
            return [EnumType(name, tuple(ada_case(i) for i in literals))]
        case RecordType(_, _, fields):
            rows = tuple(
                RecordComponent(ada_case(f.name), type_name(system, f.type)) for f in fields
            )
            constant = default_name(system, item).split(".")[-1]
            start = value(system, item, default(item))
            return [
                AdaRecord(name, rows),
                Object(constant, name, start, constant=True),
            ]
