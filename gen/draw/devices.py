# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Interfaces, devices and bindings in the drawing of a system's structure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ravenchart.gen.derive.calls import called
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.commands import Device, Server
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.system import System

from .dot import Attributes, DotEdge, Html, html
from .dot import DotNode as Drawn
from .look import PAPER, SHADES

DASHED: Attributes = {"style": "dashed"}
"""Of a binding: who requires depends on who provides."""


@dataclass(frozen=True, slots=True)
class DeviceLink:
    """A required interface, and the device or provided interface that something of it is bound to.

    ``interface`` None: of a device. A provider on another node is reached by messages.
    """

    instance: str
    required: str
    provider: str
    interface: str | None


def device_links(system: System) -> tuple[DeviceLink, ...]:
    """The links that bindings make, each once, in model order."""
    found: dict[DeviceLink, None] = {}
    for binding in system.bindings:
        provider, own = binding.provider, (binding.instance, binding.need.interface)
        if isinstance(provider, Device):
            found[DeviceLink(*own, provider.name, None)] = None
        elif isinstance(provider, Server):
            found[DeviceLink(*own, provider.instance, provider.interface.name)] = None
    return tuple(found)


def required(instance: Instance) -> tuple[str, ...]:
    """The required interfaces of an instance."""
    component = instance.component
    names = [need.interface for need in component.needs] + [e.interface for e in component.hears]
    return tuple(dict.fromkeys(names))


def required_port(name: str) -> str:
    """Where a binding begins at an instance."""
    return f"requires {name}"


def provided_port(name: str) -> str:
    """Where a binding ends at an instance."""
    return f"provides {name}"


def end_port(system: System, message: Message, end: End) -> str:
    """Where a message begins or ends at an instance: a port, or the interface of a command."""
    component = system.instance(end.instance).component
    read = system.bound.get((end.instance, end.name))
    if read is not None:
        return required_port(read.need.interface)
    for need in component.needs:
        if end.name in (need.name, need.reply_item):
            return required_port(need.interface)
    if message.call is not None:
        return provided_port(message.call.server.interface.name)
    for provided in component.provides:
        if message.every and end.name in (one.item for one in provided.published):
            return provided_port(provided.name)
    return end.name


def interface_cell(port: str, name: str) -> str:
    """An interface among the ports of an instance, in slanted letters."""
    return f'<td port="{port}" bgcolor="{SHADES[1]}">{html(name, "i")}</td>'


def device_name(name: str) -> str:
    """The device as the drawing knows it."""
    return f"device {name}"


def devices(system: System, node: str) -> Iterator[Drawn]:
    """The devices that a node calls, each with the commands that it gives."""
    for device in devices_of(system, node):
        rows = [f"<tr><td>{html(device.name, 'b')} : {html(kind_of(device))}</td></tr>"]
        commands = ", ".join(one.name for one in called(system, device))
        if device.type is not None:
            rows.append(f"<tr><td>{html(commands)}</td></tr>")
        table = f'<table border="1" cellborder="0" cellspacing="2" bgcolor="{PAPER}"'
        label = Html(f'{table} style="rounded">{"".join(rows)}</table>')
        yield Drawn(device_name(device.name), {"label": label})


def kind_of(device: Device) -> str:
    """Its type, or how many axes an array has."""
    return device.type.name if device.type else f"array, {device.axes} axes"


def devices_of(system: System, node: str) -> Iterator[Device]:
    """Those that an instance there is bound to, and what they are made of."""
    bound = [
        binding.provider
        for binding in system.bindings
        if isinstance(binding.provider, Device) and system.instance(binding.instance).node == node
    ]
    here = {part for device in bound for part in _within(device)}
    yield from (device for device in system.devices if device in here)


def _within(device: Device) -> Iterator[Device]:
    yield device
    for member in device.members:
        yield from _within(member)


def parts(system: System) -> Iterator[DotEdge]:
    """From each array to what it is made of."""
    for device in system.devices:
        for member in device.members:
            look: Attributes = {"dir": "back", "arrowtail": "odiamond", "arrowsize": "0.9"}
            yield DotEdge(device_name(device.name), device_name(member.name), look)
