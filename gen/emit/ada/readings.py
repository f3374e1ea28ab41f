# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The declarations of a program's units, read for names that bar each other.

Units are read in their order: a child after its parent, a body after its spec.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from .declarations import (
    Decl,
    EnumType,
    FunctionRenaming,
    GenericInstance,
    Object,
    ObjectRenaming,
    Package,
    RecordComponent,
    RecordDeclaration,
    SingleTask,
    Subprogram,
    SubtypeDeclaration,
    TypeDeclaration,
    Unit,
)
from .named import DottedName, ref
from .statements import Case, IfStatement, Loop, Stmt
from .walking import names_in


class _Name(NamedTuple):
    """One declaration; overloaded ones differ by ``profile``, which is None of all others."""

    text: str
    profile: tuple[object, ...] | None = None
    completes: bool = False
    behind_package: bool = False
    """Is its package always named before it?"""

    @property
    def key(self) -> str:
        return self.text.lower()

    def bars(self, other: _Name) -> bool:
        """Can the two not both be visible?"""
        if self.profile is None or other.profile is None:
            return True
        return self.profile == other.profile and not (self.completes or other.completes)


_Known = dict[str, list[_Name]]
"""Names by their keys."""


def _by_key(names: Sequence[_Name]) -> _Known:
    found: _Known = defaultdict(list)
    for name in names:
        found[name.key].append(name)
    return found


def _names(item: Decl) -> Iterator[_Name]:
    """The names that one declaration puts into its scope."""
    match item:
        case EnumType(name, literals):
            yield _Name(name)
            #  a literal is a function without parameters
            yield from (_Name(i, (ref(name),)) for i in literals)
        case FunctionRenaming(name, result):
            yield _Name(name, (result,))
        case TypeDeclaration(name) | RecordDeclaration(name) | Object(name) | ObjectRenaming(name):
            yield _Name(name)
        case SubtypeDeclaration(name) | GenericInstance(name):
            yield _Name(name, behind_package=item.behind_package)
        case Package(name, is_body=is_body):
            if not is_body:  # that of a package that was declared before
                yield _Name(name.last)
        case SingleTask(name, body=body):
            if body is None:
                yield _Name(name)
        case Subprogram(name, params, result):
            types = (*(p.type for p in params), result)
            yield _Name(name, types, completes=item.body is not None)


def _loops(body: Sequence[Stmt]) -> Iterator[_Name]:
    """The variables of the loops in a body."""
    for statement in body:
        match statement:
            case Loop(head, inner):
                if head is not None:
                    yield _Name(head.variable)
                yield from _loops(inner)
            case IfStatement(branches, otherwise):
                for _, inner in branches:
                    yield from _loops(inner)
                yield from _loops(otherwise)
            case Case(_, rows):
                for _, inner in rows:
                    yield from _loops(inner)


@dataclass(slots=True)
class _Unit:
    """The declarations of one unit, and the names in it that bar each other."""

    unit: Unit
    deep: list[_Name] = field(default_factory=list)
    """Every name declared in the unit, at any depth."""
    found: list[str] = field(default_factory=list)

    def scope(self, names: Sequence[_Name], outer: _Known) -> None:
        """One scope inside others whose names are used in it."""
        own: _Known = defaultdict(list)
        for name in names:
            key = name.key
            if any(name.bars(other) for other in (*outer.get(key, ()), *own[key])):
                self.found.append(name.text)
            own[key].append(name)
        self.deep += names

    def walk(self, package: Package, outer: Sequence[_Name]) -> list[_Name]:
        """The declarations of a package, nested ones included; its own names."""
        names = [n for item in package.items for n in _names(item)]
        self.scope(names, _by_key(outer))
        around = {} if package.independent else _by_key([*outer, *names])
        for item in package.items:
            match item:
                case Package():
                    self.walk(item, ())
                case RecordDeclaration(_, components):
                    self.record(components)
                case Subprogram():
                    self.inside(item, around)
        return names

    def record(self, components: Sequence[RecordComponent]) -> None:
        """A component hides the first names of the types after it, and other components."""
        seen: set[str] = set()
        for one in components:
            if one.name.lower() in seen:
                self.found.append(one.name)
            seen.add(one.name.lower())
            begins = next(names_in(one.type)).first
            if begins.lower() in seen:
                self.found.append(begins)

    def inside(self, item: Subprogram, around: _Known) -> None:
        """Parameters and local declarations, and the neighbours that may be called."""
        own = [_Name(p.name) for p in item.params]
        own += [n for d in item.declarations for n in _names(d)]
        loops = list(_loops(item.body or ()))
        if loops:
            taken = {n.key for n in loops}
            self.deep += [n for n in (*own, *loops) if n.key in taken]
            own = [n for n in own if n.key not in taken]
        self.scope(own, around)
        for declaration in item.declarations:
            if isinstance(declaration, Subprogram):
                self.inside(declaration, {})


def _of_item(unit: _Unit, outer: Sequence[_Name]) -> list[_Name]:
    match unit.unit.item:
        case Package() as package:
            return unit.walk(package, outer)
        case Subprogram() as main:
            unit.inside(main, {})
    return []


@dataclass(frozen=True, slots=True)
class UnitReading:
    """The result of reading a unit."""

    name: DottedName
    is_body: bool
    declared: frozenset[str]
    """The names that its spec declares, in lower case."""
    barred: tuple[str, ...]
    """Names that it could not have beside others."""


def readings(units: Sequence[Unit], root: str) -> list[UnitReading]:
    """One for each unit; the parents of all but the children of ``root`` are among them."""
    specs: dict[DottedName, list[_Name]] = {}
    made = []
    for unit in units:
        name, is_body = unit.name, unit.is_body
        #  of what the parent declares, children name its types and packages by themselves
        above = specs.get(name.parent, ()) if name.parent != ref(root) else ()
        outer = [n for n in above if n.profile is None and not n.behind_package]
        spec = specs.get(name, []) if is_body else []
        reading = _Unit(unit)
        own = _of_item(reading, [*outer, *spec])
        if not is_body:
            specs[name] = own
        declared = [*reading.deep, *spec, *(_Name(part) for part in name.parts[2:])]
        barred = (*reading.found, *_hidden(unit, declared, root))
        made.append(UnitReading(name, is_body, frozenset(n.key for n in own), barred))
    return made


def _hidden(unit: Unit, declared: Sequence[_Name], root: str) -> Iterator[str]:
    """Names of other units that are used where something else is declared by that name."""
    others = {_below(name, root).lower() for name in unit.withs}
    above = unit.name.parts[:2]  # a region's or activity's package never names itself
    others |= {part.lower() for part in above}
    taken = {n.text for n in declared if n.key in others}
    if taken:
        names = (*unit.withs, *names_in(unit.item))
        owners = {name.first.lower() for name in names if len(name.parts) > 1}
        yield from sorted(hidden for hidden in taken if hidden.lower() in owners)


def _below(name: DottedName, root: str) -> str:
    """The name of a unit where the units below the root are seen."""
    own = name.parts[1:] if name.first == root else ()
    return (*own, name.first)[0]
