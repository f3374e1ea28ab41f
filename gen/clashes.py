"""Names that would clash in the generated program, found in the program itself.

Model names become Ada names beside those that the generator adds, such as
``Step`` or ``Level_Board``. Rather than keep lists of these, the program is
made (as constructs, not as text) and its declarations are compared: two of one
name in one scope, one that hides what is used inside it, one that hides a
unit. The elements that gave the name are reported.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from .claims import Claims
from .diagnostics import Diagnostic, error
from .emit import ada
from .emit.ada_text import WIDTH, print_unit
from .emit.naming import ada_case, root_package
from .generate import units
from .model import Component, System
from .terms import EnumerationType, Origin

PROJECT_WORDS = frozenset({"project", "extends", "external", "external_as_list"})
"""Words that no GNAT project can have as its name, beside those of Ada."""


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
        case ada.PlainType(name) | ada.RecordType(name) | ada.Object(name) | ada.Instance(name):
            yield _Name(name)
        case ada.Package(name):
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
            case ada.If(branches, otherwise):
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
                case ada.RecordType(_, components):
                    self.record(components)
                case ada.Subprogram():
                    self.inside(item, around)
        return names

    def record(self, components: Sequence[ada.Component]) -> None:
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


def _clashing(system: System) -> Iterator[tuple[str, str]]:
    """(Ada name, unit) of whatever clashes."""
    made = units(system, Claims())
    root = root_package(system)
    specs: dict[str, list[_Name]] = {}
    for unit in made:
        name = unit.item.name
        is_body = isinstance(unit.item, ada.Package) and unit.item.is_body
        if name in specs and not is_body:
            yield name.rpartition(".")[2], name
        parent = name.rpartition(".")[0]
        #  of what the parent declares, children name its types and packages by themselves
        outer = [n for n in specs.get(parent, ()) if n.profile is None and parent != root]
        outer = [n for n in outer if not n.text.endswith(("_Port", "_View"))]
        reading = _Unit(unit)
        own = _of_item(reading, [*outer, *(specs.get(name, ()) if is_body else ())])
        yield from ((text, name) for text in reading.found)
        if not is_body:
            specs[name] = own
        externals = {w.removeprefix(f"{root}.").split(".")[0].lower() for w in unit.withs}
        above = name.split(".")[:2]  # a region's or activity's package never names itself
        externals |= {part.lower() for part in above}
        declared = [*reading.deep, *(specs.get(name, ()) if is_body else ())]
        declared += [_Name(part) for part in name.split(".")[2:]]
        taken = {n.text for n in declared if n.key in externals}
        text = re.sub(r"--.*", "", print_unit(unit)) if taken else ""
        for hidden in sorted(taken):
            if re.search(rf"(?<![\w.]){hidden}\.", text, re.IGNORECASE):
                yield hidden, name
    for name in specs:
        parent, _, own_name = name.rpartition(".")
        if any(n.key == own_name.lower() for n in specs.get(parent, ())):
            yield own_name, parent


@dataclass(frozen=True, slots=True)
class _Element:
    kind: str
    name: str
    origin: Origin
    owner: str = ""


def _elements(system: System) -> Iterator[_Element]:
    """Everything that has a name, the innermost first."""
    for component in system.components:
        yield from _members(component)
    for message in system.messages:
        yield _Element("message", message.name, message.origin)
    for type_ in system.types:
        yield _Element("type", type_.name, type_.origin)
        if isinstance(type_, EnumerationType):
            yield from (_Element("literal", i, type_.origin) for i in type_.literals)
    yield from (_Element("instance", i.name, i.origin) for i in system.instances)
    yield from (_Element("processor", p.name, p.origin) for p in system.processors)
    yield from (_Element("bus", b.name, b.origin) for b in system.buses)
    yield from (_Element("component", c.name, c.origin) for c in system.components)
    yield from (_Element("node", n.name, n.origin) for n in system.nodes)
    yield _Element("system", system.name, system.origin)


def _members(component: Component) -> Iterator[_Element]:
    own = component.name
    for region in component.regions:
        for transition in region.transitions:
            yield _Element("transition", transition.name, transition.origin, own)
        for state in region.states:
            yield _Element("state", state.name, state.origin, own)
    yield from (_Element("region", r.name, r.origin, own) for r in component.regions)
    yield from (_Element("activity", a.name, a.origin, own) for a in component.activities)
    yield from (_Element("event", e.name, e.origin, own) for e in component.events)
    yield from (_Element("port", p.name, p.origin, own) for p in component.ports)
    yield from (_Element("data item", d.name, d.origin, own) for d in component.data)
    yield from (_Element("parameter", p.name, p.origin, own) for p in component.parameters)


def _culprits(system: System, text: str, unit: str) -> list[_Element]:
    """The elements that gave a name: it is theirs, or theirs is part of it."""
    words = f"_{text.lower()}_"
    near = [e for e in _elements(system) if f"_{e.name.lower()}_" in words]
    parts = unit.lower().split(".")
    instances = {i.name.lower(): i.component.name.lower() for i in system.instances}
    owners = {instances.get(part, part) for part in parts}
    apt = [e for e in near if e.owner.lower() in owners or not e.owner]
    apt = apt or near
    longest = max((len(e.name) for e in apt), default=0)
    return [e for e in apt if len(e.name) == longest]


LONG_NAME = 24
"""Names up to this length always fit the lines of the generated program."""


def _too_long(system: System) -> Iterator[Diagnostic]:
    """An error when long names, joined as the program joins them, do not fit its lines."""
    if all(len(e.name) <= LONG_NAME for e in _elements(system)):
        return
    reported: set[Origin] = set()
    for unit in units(system, Claims()):
        for line in print_unit(unit).splitlines():
            if len(line) <= WIDTH:
                continue
            everything = list(_elements(system))
            apt = [e for e in everything if e.name.lower() in line.lower()]
            found = max(apt or everything, key=lambda e: len(e.name))
            if found.origin in reported:
                continue
            reported.add(found.origin)
            message = f"the {found.kind} `{found.name}` makes a line of {unit.item.name} too long"
            hint = f"lines have {WIDTH} columns, and names stand joined in them: shorten it"
            yield error("RV-0304", found.origin, message, hint=hint)


def clashes(system: System) -> Iterator[Diagnostic]:
    """An error for each name that the generated program could not have."""
    if system.name.lower() in PROJECT_WORDS:
        message = f"a system cannot be named `{system.name}`, a word of GNAT projects"
        yield error("RV-0304", system.origin, message, hint="choose another name")
    yield from _too_long(system)
    reported: set[tuple[str, str]] = set()
    for text, unit in _clashing(system):
        found = _culprits(system, text, unit)
        if not found or (found[0].name.lower(), found[0].owner) in reported:
            continue
        first = found[0]
        reported.add((first.name.lower(), first.owner))
        message = (
            f"the {first.kind} `{first.name}` clashes with another `{ada_case(text)}` in {unit}"
        )
        notes = [(e.origin, f"the {e.kind} `{e.name}` is here") for e in found[1:4]]
        hint = f"{unit} is a unit of the generated program: choose another name"
        yield error("RV-0304", first.origin, message, notes=notes, hint=hint)
