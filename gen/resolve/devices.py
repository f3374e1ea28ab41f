# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Device types, devices and their composites: their forms resolved.

An array and a facade are decided here: their callers call the pieces.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

from ravenchart.gen.files.schema_devices import BindingForm, DeviceForm, DeviceTypeForm
from ravenchart.gen.language.names import Findings, NameScope, meant
from ravenchart.gen.language.terms import Ns, Type
from ravenchart.gen.model.commands import (
    Command,
    CommandKind,
    Device,
    DeviceType,
    DriverCommand,
    InterfaceEvent,
    Server,
)
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.origins import Origin

from .composites import Interface, provided_by, required_by
from .equipment import (
    address_of,
    apart,
    device_parameters,
    lifecycle_of,
    parameter_values,
    registers_of,
)
from .interfaces import at_axes
from .paths import Owners, Placed, owner_at, reached, split
from .protocols import protocol_of

SHOWN = 3
"""The elements of an array without a name that a message lists."""


@dataclass(frozen=True, slots=True)
class Facade:
    """Several providers as one; each command belongs to one of them."""

    name: str
    members: tuple[Provider, ...]
    chosen: tuple[tuple[str, Provider], ...]


@dataclass(frozen=True, slots=True)
class Array:
    """Providers as one, each with its part of the axes: tasks, or devices of several kinds."""

    name: str
    members: tuple[Provider, ...]


Provider = Device | Server | Facade | Array


def provider_name(provider: Provider) -> str:
    """How a model calls it."""
    if isinstance(provider, Server):
        return provider.outside or f"{provider.instance}.{provider.interface.name}"
    return provider.name


def offered(provider: Provider) -> tuple[str, ...]:
    """The names of the commands that it provides."""
    if isinstance(provider, Device):
        return tuple(one.name for one in provider.provides if not one.is_event)
    if isinstance(provider, Server):
        own = provider.interface
        return (*(one.name for one in own.requests), *(one.name for one in own.published))
    if isinstance(provider, Array):
        first, *others = (offered(one) for one in provider.members)
        return tuple(name for name in first if all(name in names for names in others))
    return tuple(dict.fromkeys(name for one in provider.members for name in offered(one)))


def device_type_of(
    name: str,
    form: DeviceTypeForm,
    dictionary: NameScope[Command],
    types: NameScope[Type],
    findings: Findings,
) -> DeviceType | None:
    """A device type whose commands are in the dictionary."""
    found: NameScope[DriverCommand] = NameScope("command")
    for text, wcet in form.provides.items():
        at = form.entry_at("provides", text)
        command = dictionary.look_up(text, at, findings)
        if command is not None:
            made = DriverCommand(command, *at_axes(command, form.axes, types), Ns(wcet))
            found.declare(command.name, at, made, findings)
    parameters, registers = device_parameters(form, types, findings), registers_of(form, findings)
    before = findings.count()
    commands = (one.command for one in found.sound())
    lost = form.damaged or len(found.sound()) < len(form.provides)
    protocol = protocol_of(name, form.protocol, commands, findings, damaged=lost)
    lost = lost or parameters is None or registers is None or findings.count() > before
    if lost:
        return None
    simulated = form.body == "simulated"
    return DeviceType(
        name,
        form.origin,
        form.axes,
        simulated,
        found.sound(),
        parameters or (),
        () if simulated else registers or (),
        lifecycle_of(form),
        protocol,
    )


def _seen(scope: NameScope[Interface], path: str) -> NameScope[Interface]:
    """Interfaces of the instance at a path, seen from outside of it."""
    items = {
        key: (name, at, None if one is None else one.under(path))
        for key, (name, at, one) in scope.items.items()
    }
    return NameScope(scope.kind, items, scope.open)


@dataclass(slots=True)
class Devices:
    """The devices of a model, each resolved when it is asked for first."""

    forms: NameScope[DeviceForm]
    scope: NameScope[Provider]
    """Those that are known already; a name in it without an item is wrong."""
    kinds: NameScope[DeviceType]
    owners: Owners
    types: NameScope[Type]
    findings: Findings
    damaged: frozenset[str]
    """Components that had errors: interfaces of theirs may be lost."""
    under_way: list[str] = field(default_factory=list)

    def all(self) -> NameScope[Provider]:
        """Every device."""
        for name in self.forms.names():
            self._make(name)
        apart((one for one in self.scope.sound() if isinstance(one, Device)), self.findings)
        return self.scope

    def provider(self, text: str, origin: Origin) -> Provider | None:
        """The device, or the provided interface `instance.interface`, of that name."""
        if "." not in text:
            return self.look_up(text, origin)
        pair = split(text, "instance.interface", origin, self.owners, self.findings)
        owner = None if pair is None else owner_at(pair[0], origin, self.owners, self.findings)
        if pair is None or owner is None or not reached(owner, origin, "interface", self.findings):
            return None
        found = self.provided(owner).look_up(pair[1], origin, self.findings)
        if found is None or found.server is None:
            return None
        return Server(*found.server, f"{owner.name}.{found.name}")

    def provided(self, owner: Instance | Placed) -> NameScope[Interface]:
        """The provided interfaces of an instance, as they are seen from outside."""
        if isinstance(owner, Placed):
            of = owner.composite.provides
        else:
            damaged = owner.component.name in self.damaged
            of = provided_by(owner.component, damaged=damaged)
        return _seen(of, owner.name)

    def required(self, owner: Instance | Placed) -> NameScope[Interface]:
        """The required interfaces of an instance, as they are seen from outside."""
        if isinstance(owner, Placed):
            of = owner.composite.requires
        else:
            damaged = owner.component.name in self.damaged
            of = required_by(owner.component, damaged=damaged)
        return _seen(of, owner.name)

    def look_up(self, name: str, origin: Origin) -> Provider | None:
        """The device of that name."""
        key = name.lower()
        if key in self.under_way:
            ring = " -> ".join((*self.under_way[self.under_way.index(key) :], key))
            message = f"the device {name} is part of itself: {ring}"
            self.findings.error("RV-1210", origin, message, hint="take it out of one of them")
            return None
        if key not in self.scope.items and not self.forms.knows(name):
            self.forms.look_up(name, origin, self.findings)
            return None
        self._make(name)
        return self.scope.look_up(name, origin, self.findings)

    def _make(self, name: str) -> None:
        """Make the device of that name, where there is one, once."""
        form = self.forms.find(name)
        if form is None or name.lower() in self.scope.items:
            return
        declared = self.forms.items[name.lower()][0]
        self.under_way.append(name.lower())
        made = self._made(declared, form)
        self.under_way.pop()
        self.scope.declare(declared, form.origin, made)

    def _made(self, name: str, form: DeviceForm) -> Provider | None:
        given = [key for key in ("type", "array", "facade") if form.has(key)]
        if any(form.lost(key) for key in ("type", "array", "facade")):
            return None
        if len(given) != 1:
            told = " and ".join(f"`{key}`" for key in given) or "none"
            wanted = "must have exactly one of `type`, `array`, `facade`"
            message = f"the device {name} {wanted}; found {told}"
            at = form.at_key(given[1]) if given else form.origin
            hint = "a piece of equipment has a type; composites are devices of their own"
            self.findings.error("RV-1210", at, message, hint=hint)
            return None
        if form.has("choose") and not form.has("facade"):
            message = "`choose` has no meaning without `facade`"
            hint = f"remove `choose`: a binding to {name} gets all that {name} provides"
            self.findings.error("RV-1210", form.at_key("choose"), message, hint=hint)
        if form.type is not None:
            kind = self.kinds.look_up(form.type, form.at("type"), self.findings)
            if kind is None:
                return None
            values = parameter_values(name, form, kind, self.findings)
            if not address_of(name, form, kind, self.findings) or values is None:
                return None
            address = form.address if kind.registers else None
            return Device(name, form.origin, kind, (), kind.provides, kind.axes, address, values)
        for key in ("address", "parameters"):
            if form.has(key):
                message = f"`{key}` has no meaning for {name}, which is made of other devices"
                hint = "give it to the devices that have a `type`"
                self.findings.error("RV-1210", form.at_key(key), message, hint=hint)
        key = "array" if form.has("array") else "facade"
        members = self._members(form, key)
        if members is None:
            return None
        return (
            self._array(name, form, members)
            if key == "array"
            else self._facade(form, name, members)
        )

    def _members(self, form: DeviceForm, key: str) -> list[Provider] | None:
        """The members of an array or facade; None where one is wrong."""
        return self._each((form.array if key == "array" else form.facade) or [], form, key)

    def _each(
        self, texts: Sequence[str], form: DeviceForm | BindingForm, key: str
    ) -> list[Provider] | None:
        """The providers that a list names, each once; None where one is wrong."""
        found: list[Provider] = []
        for index, text in enumerate(texts):
            at = form.item_at(key, index)
            member = self.provider(text, at)
            if member is None:
                continue
            if member in found:
                message = f"{provider_name(member)} appears twice in `{key}`"
                self.findings.error("RV-1210", at, message, hint="remove one of them")
            found.append(member)
        whole = len(found) == len(texts) and not form.list_damaged(key)
        return found if whole else None

    def bound_to(self, form: BindingForm) -> Provider | None:
        """The provider that a binding names, or several as one."""
        if isinstance(form.to, str):
            return self.provider(form.to, form.at("to"))
        members = self._each(form.to, form, "to")
        if members is None:
            return None
        self._pieces_apart(members, form, "to")
        names = form.to if len(form.to) <= SHOWN else [form.to[0], "...", form.to[-1]]
        return Array(f"[{', '.join(names)}]", tuple(members))

    def _pieces_apart(
        self, members: Sequence[Provider], form: DeviceForm | BindingForm, key: str
    ) -> None:
        """Report what is in two members of an array."""
        places: dict[str, str] = {}
        for index, member in enumerate(members):
            at = form.item_at(key, index)
            for piece in pieces_of(member):
                first = places.setdefault(piece, provider_name(member))
                if first != provider_name(member):
                    where = f"in {first}, {provider_name(member)}"
                    message = f"{piece} appears twice in `{key}`: {where}"
                    hint = "a piece of equipment has its axes once: remove one of them"
                    self.findings.error("RV-1210", at, message, hint=hint)

    def _array(self, name: str, form: DeviceForm, members: list[Provider]) -> Provider | None:
        """Providers as one: per axis commands are joined, others go to all.

        Devices of one kind are a device again.
        """
        self._pieces_apart(members, form, "array")
        pieces = [member for member in members if isinstance(member, Device)]
        if len(pieces) < len(members) or any(_kind(p) is not _kind(pieces[0]) for p in pieces):
            return Array(name, tuple(members))
        axes = sum(piece.axes for piece in pieces)
        joined = [
            DriverCommand(
                one.command,
                *at_axes(one.command, axes, self.types),
                Ns(sum(piece.command(one.name).wcet for piece in pieces)),
            )
            for one in pieces[0].provides
            if not one.is_event and (one.command.per_axis or one.reply is None)
        ]
        return Device(name, form.origin, None, tuple(pieces), tuple(joined), axes)

    def _facade(self, form: DeviceForm, name: str, members: list[Provider]) -> Facade | None:
        """Several kinds as one, and who is meant where two provide a command."""
        chosen: list[tuple[str, Provider]] = []
        for command, text in (form.choose or {}).items():
            at = form.entry_at("choose", command)
            names = [provider_name(member) for member in members]
            member = next((m for m in members if provider_name(m).lower() == text.lower()), None)
            if member is None:
                message = f"`{text}` is no member of {name}"
                value = form.place("choose", command).origin
                self.findings.error("RV-1212", value, message, hint=meant(text, names))
            elif command.lower() not in map(str.lower, (*offered(member), *told_by(member))):
                message = f"{provider_name(member)} does not provide `{command}`"
                hint = meant(command, (*offered(member), *told_by(member)))
                self.findings.error("RV-1212", at, message, hint=hint)
            else:
                chosen.append((command.lower(), member))
        wrong = len(chosen) < len(form.choose or ()) or form.dropped("choose")
        return None if wrong else Facade(name, tuple(members), tuple(chosen))


def pieces_of(provider: Provider) -> tuple[str, ...]:
    """The names of the devices and interfaces in it."""
    if isinstance(provider, Device):
        return tuple(leaf.name for leaf in provider.leaves())
    if isinstance(provider, Server):
        return (provider_name(provider),)
    return tuple(name for member in provider.members for name in pieces_of(member))


def _kind(device: Device) -> DeviceType:
    """The type of the pieces of a device."""
    kind = device.leaves()[0].type
    assert kind is not None
    return kind


Report = Callable[[str, str, str | None], None]
"""Takes code, message and hint of what is wrong with a binding."""


def found_in(provider: Provider, command: str, report: Report) -> Device | Server | Array | None:
    """The part of a provider that has a command; None when no part has, or it was reported.

    Of an array, all of its members have it.
    """
    if isinstance(provider, Array):
        parts: list[Provider] = []
        for member in provider.members:
            part = found_in(member, command, report)
            if part is None:
                return None
            parts += part.members if isinstance(part, Array) else (part,)
        return Array(provider.name, tuple(parts))
    if not isinstance(provider, Facade):
        return provider if command in offered(provider) else None
    meant_by = dict(provider.chosen).get(command.lower())
    if meant_by is not None:
        return found_in(meant_by, command, report)
    having = [member for member in provider.members if command in offered(member)]
    if len(having) > 1:
        names = " and ".join(provider_name(member) for member in having[:2])
        message = f"{names} of {provider.name} both provide {command}"
        hint = f"say which is meant: `choose: {{{command}: {provider_name(having[0])}}}`"
        report("RV-1212", message, hint)
    return found_in(having[0], command, report) if having else None


Teller = tuple[Server, InterfaceEvent] | tuple[Device, DriverCommand]
"""Who raises an event, and by which port; a device is asked for it."""


def tells(provider: Provider, event: str) -> tuple[Teller, ...]:
    """Who raises an event; of a facade whoever is chosen, or all."""
    if isinstance(provider, Server):
        return tuple((provider, one) for one in provider.interface.events if one.name == event)
    if isinstance(provider, Device):
        return tuple(
            (provider, one) for one in provider.provides if one.is_event and one.name == event
        )
    if isinstance(provider, Array):
        return ()
    meant_by = dict(provider.chosen).get(event.lower())
    members = provider.members if meant_by is None else (meant_by,)
    return tuple(one for member in members for one in tells(member, event))


def told_by(provider: Provider) -> tuple[str, ...]:
    """The names of the events that it provides."""
    if isinstance(provider, Server):
        return tuple(one.name for one in provider.interface.events)
    if isinstance(provider, Device):
        return tuple(one.name for one in provider.provides if one.is_event)
    members = provider.members if isinstance(provider, Facade) else ()
    return tuple(name for member in members for name in told_by(member))


def ungathered(provider: Provider, command: str) -> Device | None:
    """The array in a provider whose pieces have a command that they cannot give as one."""
    if isinstance(provider, Facade | Array):
        arrays: Iterable[Device | None] = (ungathered(one, command) for one in provider.members)
        return next((one for one in arrays if one is not None), None)
    if not isinstance(provider, Device) or provider.type is not None:
        return None
    return provider if command in (one.name for one in _kind(provider).provides) else None


def lacking(provider: Provider, command: str) -> tuple[str, ...]:
    """The members of an array in it that do not have a command that others have."""
    if isinstance(provider, Facade):
        return tuple(name for one in provider.members for name in lacking(one, command))
    members = provider.members if isinstance(provider, Array) else ()
    without = tuple(provider_name(one) for one in members if command not in offered(one))
    return without if len(without) < len(members) else ()


def provided_axes(provider: Provider) -> int:
    """The number of axes that a provider has."""
    if isinstance(provider, Facade | Array):
        return sum(provided_axes(part) for part in provider.members)
    return provider.axes if isinstance(provider, Device) else provider.interface.axes


def has_tasks(provider: Provider) -> bool:
    """Whether a task provides something of it."""
    members = provider.members if isinstance(provider, Facade | Array) else ()
    return isinstance(provider, Server) or any(has_tasks(one) for one in members)


def is_read(command: Command) -> bool:
    """Whether nothing but a reply comes of it."""
    return command.kind is CommandKind.READ
