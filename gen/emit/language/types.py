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
    FunctionRenaming,
    Object,
    ObjectRenaming,
    Package,
    RecordComponent,
    RecordDeclaration,
    SubtypeDeclaration,
    TypeDeclaration,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    Expr,
    Range,
    RangeConstrained,
    StringLiteral,
    signed,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import (
    NUMBER,
    RUNTIME,
    ada_case,
    counted,
    default_name,
    library_of_unit,
    literal,
    root_package,
    type_name,
    unit_type,
    value,
)
from ravenchart.gen.emit.ada.statements import Comment, Pragma
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
        library = library_of_unit(system, unit)
        name = unit_type(system, unit).last
        items.append(Comment(f"Values are counted in {unit}."))
        if library is None:
            items.append(TypeDeclaration(name, DerivedDefinition(NUMBER)))
        else:
            items += _seen(name, unit_type(library, unit))
    scalars = [t for t in system.types if not isinstance(t, RecordType)]
    records = [t for t in system.types if isinstance(t, RecordType)]
    for item in (*scalars, *records):
        if item != BOOLEAN:
            library = system.library_of(item)
            items += _declare(system, item) if library is None else _shared(system, library, item)
    if system.libraries:
        items.insert(0, _FOR_CHILDREN)
    name = ada_case(system.name)
    withs = (*(ref(root_package(one)) for one in system.libraries), RUNTIME)
    return Unit(header, withs, Package(name, tuple(items), (SPARK, Aspect("Pure"))))


_FOR_CHILDREN = Pragma("Warnings", (ref("Off"), StringLiteral("use clause for type*")))
"""The operators of a library's types are used in the children of the package."""


def _seen(name: str, type_: DottedName) -> list[Decl]:
    """A type of a library under the name that the system has for it, with its operators."""
    return [SubtypeDeclaration(name, type_), UseType(type_)]


def _shared(system: System, library: System, item: Type) -> list[Decl]:
    """The type of a library, under the names that one of the system's own would have."""
    name, there = ada_case(item.name), type_name(library, item)
    match item:
        case IntegerType():
            return [SubtypeDeclaration(name, there)]
        case EnumerationType(_, _, literals):
            given = ((ada_case(i), literal(library, item, i)) for i in literals)
            same = (FunctionRenaming(own, name, renamed) for own, renamed in given)
            return [*_seen(name, there), *same]
        case RecordType():
            constant = default_name(system, item).last
            start = default_name(library, item)
            return [*_seen(name, there), ObjectRenaming(constant, name, start)]


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
