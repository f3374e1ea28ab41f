# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The root package: one Ada type per unit, one subtype or type per model type."""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    DerivedDefinition,
    EnumType,
    Object,
    Package,
    RecordComponent,
    RecordDeclaration,
    SubtypeDeclaration,
    TypeDeclaration,
    Unit,
)
from ravenchart.gen.emit.ada.expressions import Expr, Range, RangeConstrained, signed
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import (
    NUMBER,
    RUNTIME,
    ada_case,
    counted,
    default_name,
    type_name,
    unit_type,
    value,
)
from ravenchart.gen.emit.ada.statements import Comment
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
        items.append(Comment(f"Values are counted in {unit}."))
        items.append(TypeDeclaration(unit_type(system, unit).last, DerivedDefinition(NUMBER)))
    scalars = [t for t in system.types if not isinstance(t, RecordType)]
    records = [t for t in system.types if isinstance(t, RecordType)]
    for item in (*scalars, *records):
        if item != BOOLEAN:
            items += _declare(system, item)
    name = ada_case(system.name)
    return Unit(header, (RUNTIME,), Package(name, tuple(items), (SPARK, Aspect("Pure"))))


def _bound(value: int, unit: str | None) -> Expr:
    return counted(value, unit) if unit is None else signed(value)


def _declare(system: System, item: Type) -> list[Decl]:
    name = ada_case(item.name)
    match item:
        case IntegerType(_, _, first, last, unit):
            bounds = Range(_bound(first, unit), _bound(last, unit))
            base = NUMBER if unit is None else ref(unit_type(system, unit).last)
            return [SubtypeDeclaration(name, RangeConstrained(base, bounds))]
        case EnumerationType(_, _, literals):
            return [EnumType(name, tuple(ada_case(i) for i in literals))]
        case RecordType(_, _, fields):
            rows = tuple(
                RecordComponent(ada_case(f.name), type_name(system, f.type)) for f in fields
            )
            constant = default_name(system, item).last
            start = value(system, item, default(item))
            return [
                RecordDeclaration(name, rows),
                Object(constant, name, start, constant=True),
            ]
