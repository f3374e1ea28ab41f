# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Forms to a `System`: every name resolved, every type known, every location kept.

A wrong element is reported and left out. The element keeps its name, so that its uses are not
reported as well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from ravenchart.gen.derive.distribution import Carrier, with_nodes
from ravenchart.gen.derive.identifiers import identified
from ravenchart.gen.derive.macs import with_macs
from ravenchart.gen.derive.remote import calling
from ravenchart.gen.derive.transport import with_flows
from ravenchart.gen.files.schema import ComponentForm, ModelFile
from ravenchart.gen.files.schema_devices import DeviceForm, DeviceTypeForm
from ravenchart.gen.language.names import (
    CHILDREN,
    GNAT_PREFIXES,
    PREDEFINED_TYPES,
    Findings,
    NameScope,
    path_name,
)
from ravenchart.gen.language.terms import BOOLEAN, EnumerationType, Type
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.commands import Binding, DeviceType, Poll
from ravenchart.gen.model.instances import Connection, Instance
from ravenchart.gen.model.system import Shutdown, System
from ravenchart.gen.origins import Origin

from .bindings import bindings_of, event_wires, given_bindings, with_bindings
from .components import Parts, parts_of
from .composing import Components, is_composite
from .composites import Composite
from .deployment import (
    bus_of,
    chain_of,
    node_of,
    processor_of,
    shutdown_of,
    with_events,
)
from .devices import Devices, Provider, device_type_of
from .interfaces import command_of, declare_vectors
from .libraries import check_named
from .messages import message_of
from .paths import DeploymentNames, Owners
from .placing import connection_of, inner_connections, place_instance
from .recording import recorded_of
from .values import types_of


@dataclass(frozen=True, slots=True)
class Resolved:
    """A system as far as it is sound, and where it is not.

    ``damaged`` holds ``Component`` for a component that had any error and
    ``Component.Name`` for a region or activity; ``sound_sections`` the
    top-level sections in which no element was lost.
    """

    system: System
    damaged: frozenset[str]
    sound_sections: frozenset[str]


T = TypeVar("T")

NEEDED = {
    "components": "component",
    "nodes": "node",
    "instances": "instance",
    "processors": "processor",
}
"""Sections that a system must have, with the words for their elements."""


@dataclass(frozen=True, slots=True)
class Merged:
    """The sections of all files of a model, in the order read."""

    files: Sequence[ModelFile]

    def entries(self, section: str) -> list[tuple[str, Any]]:
        """The named elements of a section."""
        found: list[tuple[str, Any]] = []
        for file in self.files:
            found.extend((getattr(file, section) or {}).items())
        return found

    def dropped(self, section: str) -> list[str]:
        """The names of the elements that were wrong in form."""
        return [name for file in self.files for name in file.dropped(section)]

    def is_lost(self, section: str) -> bool:
        """Whether a whole section was wrong in form somewhere, or is missing where each has it."""
        missing = section in NEEDED and self.is_empty(section)
        return missing or any(file.lost(section) for file in self.files)

    def is_empty(self, section: str) -> bool:
        """Whether nothing stands in the section, and nothing was wrong in form there."""
        damaged = any(file.lost(section) for file in self.files) or self.dropped(section)
        return not self.entries(section) and not damaged

    def origin(self, section: str) -> Origin:
        """Where the section begins first; the beginning of the model without it."""
        given = [file.at_key(section) for file in self.files if file.has(section)]
        return given[0] if given else self.files[0].origin


def resolve(files: Sequence[ModelFile], whole: bool, digest: str, findings: Findings) -> Resolved:
    """The system that the files describe, main file first.

    ``whole`` tells that all files could be read.
    """
    model = Merged(files)
    main = files[0]
    kind = "system" if main.library is None else "library"
    name = main.system if main.library is None else main.library
    if name is None:
        if not (main.lost("system") or main.lost("library")):
            message = "the model has no name"
            hint = "begin with `system: Name_Of_The_System`"
            findings.error("RV-0801", main.origin, message, hint=hint)
        name = ""
    elif name.lower() in PREDEFINED_TYPES:
        message = f"a {kind} cannot be named `{name}`, like a unit or type of Ada"
        findings.error("RV-0304", main.at(kind), message, hint="choose another name")
    elif name.lower() in GNAT_PREFIXES:
        message = (
            f"a {kind} cannot be named `{name}`: GNAT keeps files `{name.lower()}-*` for itself"
        )
        findings.error("RV-0304", main.at(kind), message, hint="choose a longer name")
    for file in files[1:]:
        if file.system is not None:
            message = "only the main file names the system"
            notes = [(main.at("system"), "the system is named here")]
            findings.error("RV-0803", file.at_key("system"), message, notes=notes)
        if file.deployments is not None:
            message = "only the main file has deployments"
            hint = "move them there, with paths relative to it"
            findings.error("RV-0803", file.at_key("deployments"), message, hint=hint)
    check_named(files, findings)
    _check_sections(model, whole, findings)
    _check_units(model, name, findings)
    return _build(model, name, whole, digest, findings)


MOST_PROCESSORS = 30
"""Processors of a system at most: each has a priority of its own."""

MOST_BUSES = 8
"""Buses of a system at most: so many controllers one node has."""


def _check_sections(model: Merged, whole: bool, findings: Findings) -> None:
    """Sections that a system must have, and elements of which it has one or a limited number."""
    needed = NEEDED if model.files[0].library is None else {}
    for section, noun in needed.items():
        if whole and model.is_empty(section):
            hint = f"declare one under `{section}:`"
            findings.error("RV-0801", model.origin(section), f"the system has no {noun}", hint=hint)
    for _, form in model.entries("buses")[MOST_BUSES:]:
        message = f"a system has at most {MOST_BUSES} buses"
        hint = "another system may hold the others"
        findings.error("RV-0209", form.origin, message, hint=hint)
    for _, form in model.entries("processors")[MOST_PROCESSORS:]:
        message = f"a system has at most {MOST_PROCESSORS} processors"
        hint = "let one processor run more rows: each table holds many"
        findings.error("RV-0209", form.origin, message, hint=hint)
    shutdowns = [file for file in model.files if file.shutdown is not None]
    for file in shutdowns[1:]:
        message = "`shutdown` is given twice"
        notes = [(shutdowns[0].at_key("shutdown"), "the first is here")]
        findings.error("RV-0803", file.at_key("shutdown"), message, notes=notes)


def _check_units(model: Merged, system: str, findings: Findings) -> None:
    """Names that become child units of the system must differ from each other and from others."""
    taken = _Units(system, findings)
    for name, form in model.entries("device_types"):
        for ending, what in _parts_of_driver(form):
            unit = f"{name}_{ending}".lower()
            taken.known[unit] = (f"{what} of the device type", name, form.origin)
    for kind, name, origin in _units(model):
        taken.claim(kind, name, origin)


def _check_inner_units(model: Merged, system: str, site: DeploymentNames) -> None:
    """The units of instances inside others, whose names are their paths, must differ as well."""
    taken = _Units(system, site.findings)
    for kind, name, origin in _units(model):
        taken.known.setdefault(name.lower(), (kind, name, origin))
    for instance in site.instances.sound():
        if "." in instance.name:
            taken.claim("instance", instance.name, instance.origin)


UNITS = (
    ("components", "component"),
    ("buses", "bus"),
    ("instances", "instance"),
    ("processors", "processor"),
    ("device_types", "device type"),
    ("devices", "device"),
)
"""The sections whose elements become units, and how messages call one of them."""


def _units(model: Merged) -> Iterator[tuple[str, str, Origin]]:
    """The elements that become units; of a composite component those inside it do."""
    for section, kind in UNITS:
        for name, form in model.entries(section):
            if section != "components" or not is_composite(form):
                yield kind, name, form.origin


@dataclass(frozen=True, slots=True)
class _Units:
    """The child units of a system: the kind, the name in the model, and the location of each."""

    system: str
    findings: Findings
    known: dict[str, tuple[str, str, Origin]] = field(default_factory=dict)

    def claim(self, kind: str, name: str, origin: Origin) -> None:
        """Report an element whose unit is named like that of another, or of every system."""
        unit, other = path_name(name).lower(), None
        if unit == self.system.lower():
            other = f"the system {self.system}"
        elif unit in CHILDREN:
            other = CHILDREN[unit]
        elif unit in PREDEFINED_TYPES:
            other = "a unit or type of Ada"
        if other is not None:
            message = f"the {kind} `{name}` is named like {other}"
            self.findings.error("RV-0304", origin, message, hint="choose another name")
            return
        known = self.known.setdefault(unit, (kind, name, origin))
        if known[0] != kind or ("." in name and known[1] != name):
            message = f"the {kind} `{name}` is named like the {known[0]} `{known[1]}`"
            notes = [(known[2], f"the {known[0]} is here")]
            hint = "both become units of the generated program: rename one"
            self.findings.error("RV-0304", origin, message, notes=notes, hint=hint)


def _parts_of_driver(form: DeviceTypeForm) -> Iterator[tuple[str, str]]:
    """Ending and meaning of each unit that a device type has beside its driver."""
    yield "states", "state"
    if form.parameters or form.registers:
        yield "units", "list of devices"
    if form.registers:
        yield "registers", "register access"


@dataclass(slots=True)
class _Sections:
    """The sections as they are resolved; ``sound`` names those without an error."""

    model: Merged
    whole: bool
    findings: Findings
    sound: set[str] = field(default_factory=set)

    def named(self, section: str, kind: str, make: Callable[[str, Any], T | None]) -> NameScope[T]:
        """The named elements of a section, each made from its form."""
        scope = self.scope(section, kind)
        self.fill(section, scope, make)
        return scope

    def scope(self, section: str, kind: str) -> NameScope[Any]:
        """The names of what was wrong in form in a section."""
        scope: NameScope[Any] = NameScope(kind, open=self.model.is_lost(section) or not self.whole)
        for gone in self.model.dropped(section):
            scope.declare(gone, None, None)
        return scope

    def fill(self, section: str, scope: NameScope[T], make: Callable[[str, Any], T | None]) -> None:
        """Add the elements of a section to its scope."""
        before = self.findings.count()
        for name, form in self.model.entries(section):
            scope.declare(name, form.origin, make(name, form), self.findings)
        if self.findings.count() == before and not scope.has_lost():
            self.sound.add(section)

    def connections(self, site: DeploymentNames) -> tuple[Connection, ...]:
        """The connections, which have no names."""
        before, lost = self.findings.count(), False
        made: list[Connection] = []
        for file in self.model.files:
            for form in file.connections or ():
                made += connection_of(form, site)
            lost = lost or file.list_damaged("connections") or file.lost("connections")
        made += inner_connections(site)
        if self.whole and self.findings.count() == before and not lost:
            self.sound.add("connections")
        return tuple(made)

    def instances(self, site: DeploymentNames) -> None:
        """Add the instances, those inside composite ones by their paths."""
        before = self.findings.count()
        for name, form in self.model.entries("instances"):
            place_instance(name, form, site)
        if self.findings.count() == before and not site.owners.has_lost():
            self.sound.add("instances")

    def bindings(
        self,
        kinds: NameScope[DeviceType],
        site: DeploymentNames,
        types: NameScope[Type],
        damaged: frozenset[str],
    ) -> tuple[tuple[Binding, ...], tuple[Connection, ...], tuple[Poll, ...]]:
        """The bindings of commands, and the connections and polls that bring events.

        All are empty where a binding or device was lost.
        """
        count = self.findings.count()
        scope: NameScope[Provider] = self.scope("devices", "device")
        forms: NameScope[DeviceForm] = NameScope("device", open=scope.open)
        for name, form in self.model.entries("devices"):
            forms.declare(name, form.origin, form, self.findings)
        devices = Devices(forms, scope, kinds, site.owners, types, self.findings, damaged)
        given = given_bindings(
            (form for file in self.model.files for form in file.bindings or ()), devices, site
        )
        known = devices.all().names()
        lost = any(
            file.list_damaged("bindings") or file.lost("bindings") for file in self.model.files
        )
        lost = lost or any(one.is_damaged for one in site.composites())
        if lost or scope.has_lost() or self.findings.count() > count or not self.whole:
            self.sound.discard("connections")
            return (), (), ()
        instances = site.instances.sound()
        for one in (one for one in site.owners.sound() if "." not in one.name):
            known += [f"{one.name}.{interface}" for interface in devices.provided(one).names()]
        made = bindings_of(instances, given, known, types, self.findings)
        wires, polls = event_wires(instances, given, self.findings)
        if self.findings.count() > count:
            self.sound.discard("connections")
        return made, wires, polls

    def buses(self, site: DeploymentNames) -> tuple[Bus, ...]:
        """The buses, with the events that they raise and are asked by."""
        forms = dict(self.model.entries("buses"))
        found = [with_events(bus, forms[bus.name], site) for bus in site.buses.sound()]
        if not all(whole for _, whole in found):
            self.sound.discard("processors")
        return tuple(bus for bus, _ in found)

    def shutdown(self, site: DeploymentNames) -> Shutdown:
        """The effect of a request to stop."""
        given = [file.shutdown for file in self.model.files if file.shutdown is not None]
        lost = any(file.lost("shutdown") for file in self.model.files)
        if lost or any(form.list_damaged("raises") for form in given):
            self.sound.discard("processors")
        return shutdown_of(given[0] if given else None, site)


def _build(model: Merged, name: str, whole: bool, digest: str, findings: Findings) -> Resolved:
    """Section by section, in the order in which they refer to each other."""
    main = model.files[0]
    sections = _Sections(model, whole, findings)
    type_forms = [(key, form.origin, form) for key, form in model.entries("types")]
    types = types_of(type_forms, model.dropped("types"), name, findings)
    types.open = model.is_lost("types") or not whole
    dictionary = sections.named(
        "commands", "command", lambda key, form: command_of(key, form, types, findings)
    )
    declare_vectors(dictionary, _axes(model), types)
    literals = frozenset(
        literal.lower()
        for type_ in types.sound()
        if isinstance(type_, EnumerationType)
        for literal in type_.literals
    )
    forms: NameScope[ComponentForm] = sections.scope("components", "component")
    for key, form in model.entries("components"):
        forms.declare(key, form.origin, form)
    known = Components(
        forms,
        lambda key, form: parts_of(key, form, types, literals, dictionary, name, findings),
        types,
        dictionary,
        name,
        findings,
    )
    components: NameScope[Parts | Composite] = sections.named("components", "component", known.of)
    parts = [one for one in components.sound() if isinstance(one, Parts)]
    nodes = sections.named("nodes", "node", lambda key, form: node_of(key, form, findings))
    buses = sections.named("buses", "bus", lambda name, form: bus_of(name, form, findings))
    instances: NameScope[Instance] = sections.scope("instances", "instance")
    owners = Owners("instance", dict(instances.items), instances.open)
    site = DeploymentNames(nodes, buses, components, instances, owners, findings)
    sections.instances(site)
    _check_inner_units(model, name, site)
    connections = sections.connections(site)
    kinds = sections.named(
        "device_types",
        "device type",
        lambda key, form: device_type_of(key, form, dictionary, types, findings),
    )
    messages = sections.named("messages", "message", lambda key, form: message_of(key, form, site))
    processors = sections.named(
        "processors", "processor", lambda key, form: processor_of(key, form, site)
    )
    if any(
        made is None or len(made.slots) < len(form.activities) or form.damaged
        for made, form in ((processors.find(k), f) for k, f in model.entries("processors"))
    ):
        sections.sound.discard("processors")
    chains = sections.named(
        "chains", "chain", lambda key, form: chain_of(key, form, messages, site)
    )
    stop = sections.shutdown(site)
    lines = sections.buses(site)
    damaged = {part.component.name for part in parts if part.is_damaged}
    bindings, wires, polls = sections.bindings(kinds, site, types, frozenset(damaged))
    lost = any(part.is_damaged and _hears_or_tells(part.component.name, model) for part in parts)
    if lost or any(one.is_damaged for one in site.composites()):
        sections.sound.discard("connections")
    for part in parts:
        damaged |= {f"{part.component.name}.{one}" for one in part.damaged}
    carrier = Carrier({i.name: i for i in instances.sound()}, buses.sound())
    connections, carried = carrier.carried((*connections, *wires), messages.sound())
    system = System(
        name=name,
        origin=model.files[0].at_key("system" if main.library is None else "library"),
        version=main.version,
        digest=digest,
        types=_declared(types),
        components=tuple(part.component for part in parts),
        nodes=nodes.sound(),
        buses=tuple(_with_family(bus, carried) for bus in lines),
        instances=instances.sound(),
        connections=connections,
        messages=tuple(m for m in carried if not m.is_foreign),
        traffic=tuple(m for m in carried if m.is_foreign),
        processors=processors.sound(),
        shutdown=stop,
        chains=chains.sound(),
        recorded=recorded_of(model.files, site),
    )
    system = with_flows(calling(with_bindings(system, bindings, polls)))
    frames = identified(system.frames)
    system = replace(
        system,
        messages=tuple(m for m in frames if not m.is_foreign),
        traffic=tuple(m for m in frames if m.is_foreign),
    )
    system = with_macs(with_nodes(system))
    return Resolved(system, frozenset(damaged), frozenset(sections.sound))


def _with_family(bus: Bus, carried: Sequence[Message]) -> Bus:
    """The bus, once it is known whether CAN FD frames travel on it."""
    given = any(message.fd and message.bus == bus.name for message in carried)
    return replace(bus, takes_fd=given or bus.data_rate is not None)


def _hears_or_tells(component: str, model: Merged) -> bool:
    """Whether interfaces of a component have events, which become connections."""
    forms = [form for name, form in model.entries("components") if name == component]
    sides = (side for form in forms for side in (form.requires, form.provides) if side)
    return any(interface.events for side in sides for interface in side.values())


def _axes(model: Merged) -> list[int]:
    """The numbers of axes that interfaces and devices of the model have."""
    found = [form.axes for _, form in model.entries("device_types")]
    for _, form in model.entries("components"):
        sides = (*(form.requires or {}).values(), *(form.provides or {}).values())
        found += [side.axes for side in sides]
    return found


def _declared(types: NameScope[Type]) -> tuple[Type, ...]:
    """The types that the model declares, in model order."""
    return tuple(type_ for type_ in types.sound() if type_ is not BOOLEAN)
