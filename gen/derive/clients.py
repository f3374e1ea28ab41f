# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Clients of providers with a protocol: which rows call which commands, and in which order."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ravenchart.gen.model.commands import Device, Gathered, Remote, RemoteRead, Server
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.protocols import Protocol
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System


@dataclass(frozen=True, slots=True)
class Client:
    """Instances of a component that call the same commands of providers with one protocol."""

    component: Component
    protocol: Protocol
    commands: tuple[str, ...]
    """The commands of the protocol that go to the provider, through whichever interface."""
    instances: tuple[str, ...]
    provider: str
    """The provider of the first instance: a device, or ``instance.interface``."""

    @property
    def callers(self) -> tuple[Region | Activity, ...]:
        """The rows that call these commands, in model order."""
        rows = self.component.runnables()
        return tuple(row for row in rows if not set(self.commands).isdisjoint(row.sends))

    @property
    def in_order(self) -> tuple[str, ...]:
        """The commands in the order in which the program makes the calls of one step."""
        return tuple(port.name for port in self.component.ports if port.name in self.commands)


def clients(system: System) -> tuple[Client, ...]:
    """The clients of providers with a protocol."""
    calls: dict[tuple[str, str], tuple[Protocol, list[str]]] = {}
    for one in system.bindings:
        for name, protocol in _protocols(one.provider):
            if one.need.command.name in protocol.commands:
                known = calls.setdefault((one.instance, name), (protocol, []))
                known[1].append(one.need.command.name)
    alike: dict[tuple[str, Protocol, tuple[str, ...]], list[tuple[str, str]]] = {}
    for (instance, provider), (protocol, commands) in calls.items():
        key = system.instance(instance).component.name, protocol, tuple(commands)
        alike.setdefault(key, []).append((instance, provider))
    return tuple(
        Client(
            system.instance(found[0][0]).component,
            protocol,
            commands,
            tuple(instance for instance, _ in found),
            found[0][1],
        )
        for (_, protocol, commands), found in alike.items()
    )


def _protocols(
    provider: Device | Server | Remote | RemoteRead | Gathered | None,
) -> Iterator[tuple[str, Protocol]]:
    """Each provider that a call reaches, by a name, with its protocol: of an array each device."""
    if isinstance(provider, Device):
        for one in provider.leaves():
            if one.type is not None and one.type.protocol is not None:
                yield one.name, one.type.protocol
        return
    server = provider.server if isinstance(provider, Remote) else provider
    if isinstance(server, Server) and server.interface.protocol is not None:
        yield f"{server.instance}.{server.interface.name}", server.interface.protocol
