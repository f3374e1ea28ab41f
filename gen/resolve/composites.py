# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Composite components: instances inside a component, and the ends of its ports and interfaces.

A composite is resolved once, to the instances without others inside them, by their paths, and to
the connections and bindings between these. So each instance of it is that with its own path in
front, and no stage behind the resolver knows of composites.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from ravenchart.gen.files.schema_deployment import InnerInstanceForm
from ravenchart.gen.files.schema_devices import InnerBindingForm
from ravenchart.gen.language.names import NameScope
from ravenchart.gen.model.commands import InterfaceEvent, Need, Provided
from ravenchart.gen.model.component import Component, Parameter, Port
from ravenchart.gen.model.instances import Connection, End
from ravenchart.gen.origins import Origin

from .components import Parts
from .members import Members

MOST_INSTANCES = 1024
"""Instances inside a composite at most, at any depth."""

Ends = tuple[tuple[End, Port], ...]
"""Ports of instances without others inside them."""


@dataclass(frozen=True, slots=True)
class Interface:
    """An interface of an instance, and who requires or provides it in the end, by paths.

    ``requirers`` name their own interfaces; ``server`` is there of a provided one that is sound.
    ``axes`` are 0 where nothing depends on them. Of a damaged one some commands may be lost.
    """

    name: str
    axes: int
    commands: frozenset[str]
    requirers: tuple[tuple[str, str], ...] = ()
    server: tuple[str, Provided] | None = None
    is_damaged: bool = False

    def under(self, path: str) -> Interface:
        """The same, seen from outside of the instance at the path."""
        requirers = tuple((_joined(path, inner), own) for inner, own in self.requirers)
        server = self.server
        if server is not None:
            server = _joined(path, server[0]), server[1]
        return replace(self, requirers=requirers, server=server)


def _joined(path: str, inner: str) -> str:
    """A path inside the instance at another; that one itself where it is empty."""
    return f"{path}.{inner}" if inner else path


@dataclass(frozen=True, slots=True)
class InnerBinding:
    """A binding inside a composite: who requires, its interface, and who provides."""

    form: InnerBindingForm
    instance: str
    interface: str
    server: tuple[str, Provided]

    def under(self, path: str) -> InnerBinding:
        """The same in the instance at the path."""
        at = f"{path}.{self.instance}", self.interface
        return InnerBinding(self.form, *at, (f"{path}.{self.server[0]}", self.server[1]))


@dataclass(frozen=True, slots=True)
class Inside:
    """An instance inside a composite."""

    name: str
    form: InnerInstanceForm
    of: Parts | Composite


@dataclass(frozen=True, slots=True)
class Composite:
    """A composite component; a wrong element keeps its name.

    Connections and bindings are those of instances without others inside them.
    """

    name: str
    origin: Origin
    members: Members
    inside: NameScope[Inside]
    leads: Mapping[str, Ends]
    """The ends that each port leads to, by its name in lower case."""
    requires: NameScope[Interface]
    provides: NameScope[Interface]
    connections: tuple[Connection, ...]
    bindings: tuple[InnerBinding, ...]
    size: int
    """Instances without others inside them."""
    is_damaged: bool

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """Constants that each instance may set."""
        return self.members.parameters.sound()


def connectable(of: Parts | Composite) -> NameScope[Port]:
    """The ports that connections may name: no commands."""
    if isinstance(of, Composite):
        scope = NameScope(f"port of {of.name}", of.members.ports.items)
    else:
        items = of.members.ports.items.items()
        known = {key: at for key, at in items if at[2] is None or not at[2].is_command}
        scope = NameScope(f"port of {of.component.name}", known)
    scope.open = of.members.ports.open
    return scope


def within(path: str, of: Parts | Composite, port: Port) -> Ends:
    """The ends that a port of the instance at the path is, or leads to."""
    if isinstance(of, Parts):
        return ((End(path, port.name), port),)
    found = of.leads.get(port.name.lower(), ())
    return tuple((End(f"{path}.{end.instance}", end.name), own) for end, own in found)


def required_by(component: Component, *, damaged: bool) -> NameScope[Interface]:
    """The required interfaces of a component; of a damaged one some may be lost."""
    scope: NameScope[Interface] = NameScope(f"required interface of {component.name}")
    scope.open = damaged
    axes = {need.interface: need.axes for need in component.needs}
    names: dict[str, list[str]] = {}
    both: tuple[Need | InterfaceEvent, ...] = (*component.needs, *component.hears)
    for one in both:
        names.setdefault(one.interface, []).append(one.name)
    for name, commands in names.items():
        of = frozenset(commands)
        found = Interface(name, axes.get(name, 0), of, (("", name),), is_damaged=damaged)
        scope.declare(name, None, found)
    return scope


def provided_by(component: Component, *, damaged: bool) -> NameScope[Interface]:
    """The provided interfaces of a component; of a damaged one some may be lost."""
    scope: NameScope[Interface] = NameScope(f"provided interface of {component.name}")
    scope.open = damaged
    for one in component.provides:
        names = frozenset(
            (
                *(request.name for request in one.requests),
                *(published.name for published in one.published),
                *(event.name for event in one.events),
            )
        )
        made = Interface(one.name, one.axes, names, server=("", one), is_damaged=damaged)
        scope.declare(one.name, one.origin, made)
    return scope
