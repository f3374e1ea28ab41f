# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A client beside the protocol of its provider: the component with one data item more.

The item holds the state of the protocol. Each call of a command sets it. A call that the state
does not allow sets it to a value of its own, which it keeps: an invariant excludes that value.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from ravenchart.gen.language.terms import (
    BOOLEAN,
    Action,
    EnumerationType,
    Expression,
    Flow,
    If,
    Literal,
    Name,
    Operation,
    Reading,
    Send,
    Set,
)
from ravenchart.gen.model.commands import Device, Remote, RemoteRead, Server
from ravenchart.gen.model.component import Activity, Component, Data, Invariant
from ravenchart.gen.model.protocols import Protocol
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

ITEM = "state of the protocol"
"""The name of the data item: no model can have it."""


@dataclass(frozen=True, slots=True)
class Client:
    """A component whose instances call commands of one provider, which has a protocol."""

    component: Component
    protocol: Protocol
    commands: tuple[str, ...]
    """The commands of the protocol that go to the provider, through whichever interface."""

    @property
    def callers(self) -> tuple[Region | Activity, ...]:
        """The rows that call commands of the protocol, in model order."""
        rows = self.component.runnables()
        return tuple(row for row in rows if not set(self.commands).isdisjoint(row.sends))


def clients(system: System) -> tuple[Client, ...]:
    """The clients of providers with a protocol, each once for all of its instances."""
    found: dict[tuple[str, str], tuple[Protocol, list[str]]] = {}
    for one in system.bindings:
        known = _known(one.provider)
        if known is not None and one.need.name in known[1].commands:
            name, protocol = known
            found.setdefault((one.instance, name), (protocol, []))[1].append(one.need.name)
    made = (
        Client(system.instance(instance).component, protocol, tuple(commands))
        for (instance, _), (protocol, commands) in found.items()
    )
    return tuple(dict.fromkeys(made))


def _known(provider: Device | Server | Remote | RemoteRead | None) -> tuple[str, Protocol] | None:
    """A name of the provider, and its protocol; None where it has no protocol."""
    if isinstance(provider, Device):
        kind = provider.leaves()[0].type  # those of an array are of one kind
        protocol = None if kind is None else kind.protocol
        return None if protocol is None else (provider.name, protocol)
    server = provider.server if isinstance(provider, Remote) else provider
    if not isinstance(server, Server) or server.interface.protocol is None:
        return None
    return f"{server.instance}.{server.interface.name}", server.interface.protocol


@dataclass(frozen=True, slots=True)
class Misuse:
    """A command that is called in a state of the protocol which does not allow it."""

    state: str
    command: str

    @property
    def literal(self) -> str:
        """The value that the item has from then on."""
        return f"{self.command} in {self.state}"


def misuses(protocol: Protocol) -> tuple[Misuse, ...]:
    """Each command in each state that does not allow it."""
    return tuple(
        Misuse(state, command)
        for state in protocol.states
        for command in protocol.commands
        if protocol.after(state, command) is None
    )


def watched_client(client: Client, caller: Region | Activity) -> Component:
    """The component of a client with the item that ``caller`` sets, and invariants against misuse.

    The name of an invariant is the literal of a `Misuse`.
    """
    component, protocol = client.component, client.protocol
    wrong = [one.literal for one in misuses(protocol)]
    of_type = EnumerationType(ITEM, protocol.origin, (*protocol.states, *wrong))
    item = Data(ITEM, protocol.origin, of_type, protocol.initial)
    watch = _Watch(protocol, client.commands, of_type)
    return replace(
        component,
        data=(*component.data, item),
        regions=tuple(watch.region(r) if r is caller else r for r in component.regions),
        activities=tuple(watch.activity(a) if a is caller else a for a in component.activities),
        invariants=tuple(
            Invariant(literal, caller.origin, watch.is_at(literal)) for literal in wrong
        ),
    )


@dataclass(frozen=True, slots=True)
class _Watch:
    """Puts behind each call what it does to the item."""

    protocol: Protocol
    commands: tuple[str, ...]
    of_type: EnumerationType

    def is_at(self, literal: str) -> Expression:
        return Operation("=", (self._item(), Literal(literal, self.of_type)), BOOLEAN)

    def activity(self, one: Activity) -> Activity:
        assert one.flow is not None
        reads, writes = (*one.reads, ITEM), (*one.writes, ITEM)
        return replace(one, flow=self._flow(one.flow), reads=reads, writes=writes)

    def region(self, one: Region) -> Region:
        states = tuple(
            replace(
                state,
                entry=self._flow(state.entry),
                exit=self._flow(state.exit),
                regions=tuple(
                    replace(
                        inner,
                        initial=replace(inner.initial, effect=self._flow(inner.initial.effect)),
                    )
                    for inner in state.regions
                ),
            )
            for state in one.states
        )
        transitions = tuple(replace(t, effect=self._flow(t.effect)) for t in one.transitions)
        initial = replace(one.initial, effect=self._flow(one.initial.effect))
        return replace(
            one,
            initial=initial,
            states=states,
            transitions=transitions,
            reads=(*one.reads, ITEM),
            writes=(*one.writes, ITEM),
        )

    def _flow(self, flow: Flow) -> Flow:
        return tuple(self._actions(flow))

    def _actions(self, flow: Sequence[Action]) -> Iterator[Action]:
        for action in flow:
            if isinstance(action, If):
                then, otherwise = self._flow(action.then), self._flow(action.otherwise)
                yield replace(action, then=then, otherwise=otherwise)
                continue
            yield action
            if isinstance(action, Send) and action.port in self.commands:
                yield self._called(action.origin, action.port)

    def _called(self, origin: Origin, command: str) -> Set:
        """The item after a call: a value that says of a misuse stays."""
        value: Expression = self._item()
        for state in reversed(self.protocol.states):
            to = self.protocol.after(state, command) or Misuse(state, command).literal
            asked = self.is_at(state)
            value = Operation("if", (asked, Literal(to, self.of_type), value), self.of_type)
        return Set(origin, ITEM, None, value)

    def _item(self) -> Name:
        return Name(Reading.DATA, ITEM, None, self.of_type)
