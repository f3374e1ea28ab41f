# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names that would clash in the generated program, found in the program itself.

Model names become Ada names beside those that the generator adds, such as ``Step`` or
``Level_Board``. There is no list of these. The program is made (as constructs, not as text) and
its declarations are compared. Two of one name in one scope clash, as does one that hides a name
used inside it, or a unit. The elements that gave the name are reported.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ravenchart.gen.derive.calls import device_types
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.emit.ada.named import DottedName
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.text import WIDTH, print_unit
from ravenchart.gen.emit.commands.devices import device_states_package
from ravenchart.gen.emit.commands.registers import registers_package, units_package
from ravenchart.gen.language.names import LONG_NAME, path_name
from ravenchart.gen.language.terms import EnumerationType
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

from .program import MadeUnit, library_program, program, simulated_units

PROJECT_WORDS = frozenset({"project", "extends", "external", "external_as_list"})
"""Words that no GNAT project can have as its name, beside those of Ada."""


def _units(system: System) -> tuple[MadeUnit, ...]:
    """The units of the program and its simulated devices; claims are numbers, not names."""
    if system.is_library:
        return tuple(library_program(system))
    return (*program(system, Claims(), system), *simulated_units(system))


def _clashing(system: System) -> Iterator[tuple[str, DottedName]]:
    """(Ada name, unit) of each clash in the program of one node."""
    specs: dict[DottedName, frozenset[str]] = {}
    for made in _units(system):
        name = made.reading.name
        if name in specs and not made.reading.is_body:
            yield name.last, name
        yield from ((text, name) for text in made.reading.barred)
        if not made.reading.is_body:
            specs[name] = made.reading.declared
    for name in specs:
        if name.last.lower() in specs.get(name.parent, ()):
            yield name.last, name.parent


@dataclass(frozen=True, slots=True)
class _Element:
    kind: str
    name: str
    origin: Origin
    owner: str = ""

    @property
    def unit(self) -> str:
        """Its name as a part of those of the program, in lower case."""
        return path_name(self.name).lower()


def _elements(system: System) -> Iterator[_Element]:
    """Everything that has a name, the innermost first."""
    for component in system.components:
        yield from _members(component)
    for message in system.messages:
        yield _Element("message", message.name, message.origin)
        if message.authentication is not None:
            yield _Element("key", message.authentication.key, message.origin)
        several = (one for one in system.receptions(message) if one.several)
        yield from (
            _Element("message", f"{message.name}_{r.node}", r.message.origin) for r in several
        )
    for type_ in system.types:
        yield _Element("type", type_.name, type_.origin)
        if isinstance(type_, EnumerationType):
            yield from (_Element("literal", i, type_.origin) for i in type_.literals)
    for device_type in device_types(system):
        for one in device_type.provides:
            yield _Element("command", one.name, one.command.origin, device_type.name)
        for parameter in device_type.parameters:
            yield _Element("parameter", parameter.name, parameter.origin, device_type.name)
        for register in device_type.registers:
            yield _Element("register", register.name, register.origin, device_type.name)
        yield _Element("device type", device_type.name, device_type.origin)
    yield from (_Element("device", d.name, d.origin) for d in system.devices)
    yield from (_Element("instance", i.name, i.origin) for i in system.instances)
    for value in system.recorded_values:
        yield _Element("recorded value", value.element, value.of.origin)
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
    for item in component.ports:
        yield _Element("command" if item.is_command else "port", item.name, item.origin, own)
    for data in component.data:
        yield _Element("command" if data.is_command else "data item", data.name, data.origin, own)
    for need in component.needs:
        yield _Element("required interface", need.interface, need.origin, own)
    for provided in component.provides:
        yield _Element("provided interface", provided.name, provided.origin, own)
    yield from (_Element("parameter", p.name, p.origin, own) for p in component.parameters)


def _culprits(system: System, text: str, unit: DottedName) -> list[_Element]:
    """The elements that gave a name: it is theirs, or theirs is part of it."""
    words = f"_{text.lower()}_"
    near = [e for e in _elements(system) if f"_{e.unit}_" in words]
    kinds = {path_name(i.name).lower(): i.component.name.lower() for i in system.instances}
    kinds |= {d.name.lower(): d.type.name.lower() for d in system.devices if d.type is not None}
    for kind in device_types(system):
        own = device_states_package(system, kind).last, units_package(kind), registers_package(kind)
        kinds |= {package.lower(): kind.name.lower() for package in own}
    owners = {kinds.get(part, part) for part in map(str.lower, unit.parts)}
    apt = [e for e in near if e.owner.lower() in owners or not e.owner]
    apt = apt or near
    longest = max((len(e.name) for e in apt), default=0)
    return [e for e in apt if len(e.name) == longest]


def _too_long(system: System) -> Iterator[Diagnostic]:
    """An error when long names, joined as the program joins them, do not fit its lines."""
    long = [e for e in _elements(system) if len(e.name) > LONG_NAME]
    if not long:
        return
    reported: set[Origin] = set()
    for made in (made for part in _parts(system) for made in _units(part)):
        text = print_unit(made.unit, made.item)
        for line in text.splitlines():
            if len(line) <= WIDTH:
                continue
            #  where names stand below each other, the longest makes all their lines long
            apt = [e for e in long if e.unit in line.lower()]
            apt = apt or [e for e in long if e.unit in text.lower()]
            found = max(apt or long, key=lambda e: len(e.name))
            if found.origin in reported:
                continue
            reported.add(found.origin)
            message = (
                f"the {found.kind} `{found.name}` makes a line of {made.unit.name.text} too long"
            )
            hint = f"lines have {WIDTH} columns, and names stand joined in them: shorten it"
            yield error("RV-0304", found.origin, message, hint=hint)


def _parts(system: System) -> tuple[System, ...]:
    """The parts with a program of their own; a library is one part."""
    return (system,) if system.is_library else programs(system)


def clashes(system: System) -> Iterator[Diagnostic]:
    """An error for each name that the generated program could not have."""
    if system.name.lower() in PROJECT_WORDS:
        kind = "library" if system.is_library else "system"
        message = f"a {kind} cannot be named `{system.name}`, a word of GNAT projects"
        yield error("RV-0304", system.origin, message, hint="choose another name")
    yield from _too_long(system)
    reported: set[tuple[str, str]] = set()
    for text, unit in (found for part in _parts(system) for found in _clashing(part)):
        found = _culprits(system, text, unit)
        if not found or (found[0].name.lower(), found[0].owner) in reported:
            continue
        first = found[0]
        reported.add((first.name.lower(), first.owner))
        where = f"another `{ada_case(text)}` in {unit.text}"
        message = f"the {first.kind} `{first.name}` clashes with {where}"
        notes = [(e.origin, f"the {e.kind} `{e.name}` is here") for e in found[1:4]]
        hint = f"{unit.text} is a unit of the generated program: choose another name"
        yield error("RV-0304", first.origin, message, notes=notes, hint=hint)
