# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the units of a program declare, read for names that bar each other.

Units are read in their order: a child after its parent, a body after its spec.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from . import syntax as ada


class _Name(NamedTuple):
    """One declaration; ``profile`` tells overloaded ones apart, None where there are none."""

    text: str
    profile: tuple[str, ...] | None = None
    completes: bool = False

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


def _names(item: ada.Decl) -> Iterator[_Name]:
    """What one declaration declares in its scope."""
    match item:
        case ada.EnumType(name, literals):
            yield _Name(name)
            yield from (_Name(i, ("return", name)) for i in literals)
        case (
            ada.PlainType(name)
            | ada.RecordDeclaration(name)
            | ada.Object(name)
            | ada.GenericInstance(name)
        ):
            yield _Name(name)
        case ada.Package(name, is_body=is_body):
            if not is_body:  # that of a package that was declared before
                yield _Name(name)
        case ada.Subprogram(name, params, result):
            #  how a literal and a function without parameters look alike
            types = (*(p.type for p in params), "return", result or "")
            yield _Name(name, types, completes=item.body is not None)


def _loops(body: Sequence[ada.Stmt]) -> Iterator[_Name]:
    """The variables of the loops in a body."""
    for statement in body:
        match statement:
            case ada.Loop(head, inner):
                if head:
                    yield _Name(head.split()[1])
                yield from _loops(inner)
            case ada.IfStatement(branches, otherwise):
                for _, inner in branches:
                    yield from _loops(inner)
                yield from _loops(otherwise)
            case ada.Case(_, rows):
                for _, inner in rows:
                    yield from _loops(inner)


@dataclass(slots=True)
class _Unit:
    """The declarations of one unit, and the names in it that bar each other."""

    unit: ada.Unit
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

    def walk(self, items: Sequence[ada.Decl], outer: Sequence[_Name]) -> list[_Name]:
        """The declarations of a package, nested ones included; its own names."""
        names = [n for item in items for n in _names(item)]
        self.scope(names, _by_key(outer))
        around = _by_key([*outer, *names])
        for item in items:
            match item:
                case ada.Package(_, inner):
                    self.walk(inner, ())
                case ada.RecordDeclaration(_, components):
                    self.record(components)
                case ada.Subprogram():
                    self.inside(item, around)
        return names

    def record(self, components: Sequence[ada.RecordComponent]) -> None:
        """A component hides what the types after it begin with, and other components."""
        seen: set[str] = set()
        for name, of_type, _ in components:
            if name.lower() in seen:
                self.found.append(name)
            seen.add(name.lower())
            if of_type.split(".")[0].lower() in seen:
                self.found.append(of_type.split(".")[0])

    def inside(self, item: ada.Subprogram, around: _Known) -> None:
        """Parameters and local declarations; activities call none of their neighbours."""
        name = self.unit.item.name
        own = [_Name(p.name) for p in item.params]
        own += [n for d in item.declarations for n in _names(d)]
        apart = name.endswith((".Flows", ".Activities"))
        loops = list(_loops(item.body or ()))
        if loops:
            taken = {n.key for n in loops}
            self.deep += [n for n in (*own, *loops) if n.key in taken]
            own = [n for n in own if n.key not in taken]
        self.scope(own, {} if apart else around)
        for declaration in item.declarations:
            if isinstance(declaration, ada.Subprogram):
                self.inside(declaration, {})


def _of_item(unit: _Unit, outer: Sequence[_Name]) -> list[_Name]:
    match unit.unit.item:
        case ada.Package(_, items):
            return unit.walk(items, outer)
        case ada.Subprogram() as main:
            unit.inside(main, {})
    return []


@dataclass(frozen=True, slots=True)
class UnitReading:
    """What is left of a unit that was read."""

    name: str
    is_body: bool
    declared: frozenset[str]
    """The names that its spec declares, in lower case."""
    barred: tuple[str, ...]
    """Names that it could not have beside others."""


def readings(units: Sequence[ada.Unit], root: str) -> list[UnitReading]:
    """One for each unit; the parents of all but the children of ``root`` are among them."""
    specs: dict[str, list[_Name]] = {}
    made = []
    for unit in units:
        name = unit.item.name
        is_body = isinstance(unit.item, ada.Package) and unit.item.is_body
        parent = name.rpartition(".")[0]
        #  of what the parent declares, children name its types and packages by themselves
        outer = [n for n in specs.get(parent, ()) if n.profile is None and parent != root]
        outer = [n for n in outer if not n.text.endswith(("_Port", "_View"))]
        spec = specs.get(name, []) if is_body else []
        reading = _Unit(unit)
        own = _of_item(reading, [*outer, *spec])
        if not is_body:
            specs[name] = own
        declared = [*reading.deep, *spec, *(_Name(part) for part in name.split(".")[2:])]
        barred = (*reading.found, *_hidden(unit, declared, root))
        made.append(UnitReading(name, is_body, frozenset(n.key for n in own), barred))
    return made


def _hidden(unit: ada.Unit, declared: Sequence[_Name], root: str) -> Iterator[str]:
    """Names of other units that are used where something else is declared by that name."""
    others = {w.removeprefix(f"{root}.").split(".")[0].lower() for w in unit.withs}
    above = unit.item.name.split(".")[:2]  # a region's or activity's package never names itself
    others |= {part.lower() for part in above}
    taken = {n.text for n in declared if n.key in others}
    if taken:
        names = (*unit.withs, *ada.units_named_in(unit.item))
        owners = {name.partition(".")[0].lower() for name in names if "." in name}
        yield from sorted(hidden for hidden in taken if hidden.lower() in owners)
