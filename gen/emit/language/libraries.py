# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The parts of a system that a library declares, as the system's own units see them.

Types keep their names: the root package of the system has a subtype of each type of a library, and
renames the literals. A package of a component of a library is renamed below the root; its children
are named in context clauses as the library has them, and are then visible behind that renaming.
So no other unit knows which component a library declares.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Set
from dataclasses import replace

from ravenchart.gen.emit.ada.declarations import PackageRenaming, Unit
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import component_package, library_of_unit
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.language.terms import IntegerType, Type
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.system import System


def emitted_components(system: System) -> list[Component]:
    """The components that a program has units of: those in use, and all of a library's own."""
    used = {instance.component.name for instance in system.instances}
    return [c for c in system.own_components if system.is_library or c.name in used]


def counts_by_itself(system: System, of_type: Type) -> bool:
    """Whether the declaration of a type in the system's root names a type of the runtime."""
    if not isinstance(of_type, IntegerType) or system.library_of(of_type) is not None:
        return False
    return of_type.unit is None or library_of_unit(system, of_type.unit) is None


def renamed_packages(system: System) -> dict[DottedName, DottedName]:
    """Packages of the components in use that a library declares, with what they rename."""
    used = {instance.component.name: instance.component for instance in system.instances}
    found = ((c, system.library_of(c)) for c in used.values())
    return {
        component_package(system, c): component_package(library, c)
        for c, library in found
        if library is not None
    }


def library_units(renamed: Mapping[DottedName, DottedName], header: str) -> Iterator[Unit]:
    """A unit for each component in use that a library declares: its package, renamed."""
    for name, there in renamed.items():
        yield Unit(header, (there,), PackageRenaming(name, there))


def in_libraries(unit: Unit, renamed: Mapping[DottedName, DottedName]) -> Unit:
    """The unit with children of a library's component named as the library has them."""
    found: dict[DottedName, None] = {}
    for name in unit.withs:
        package = DottedName(name.parts[:2])
        if len(name.parts) > 2 and package in renamed:
            found[package] = None
            found[ref(renamed[package], *name.parts[2:])] = None
        else:
            found[name] = None
    changed = tuple(found) != unit.withs
    withs = sorted(found, key=lambda name: name.text.lower()) if changed else unit.withs
    return replace(unit, withs=tuple(withs))


def only_prefixes(unit: Unit, renamed: Mapping[DottedName, DottedName]) -> frozenset[DottedName]:
    """Renamed packages in the context of a unit that only stand before the names of children."""
    idle = set(renamed) & set(unit.withs)
    for package in tuple(idle):
        children = {n.parts[2] for n in unit.withs if n.parts[:2] == renamed[package].parts}
        if any(_is_in_itself(name, package, children) for name in names_in(unit.item)):
            idle.remove(package)
    return frozenset(idle)


def _is_in_itself(name: DottedName, package: DottedName, children: Set[str]) -> bool:
    """Whether a name is that of a declaration in a package, not in a child of it."""
    root, own = package.parts
    parts = name.parts[1:] if name.first == root else name.parts
    return parts[:1] == (own,) and (len(parts) == 1 or parts[1] not in children)
