# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Components on several nodes: the messages between nodes, and the part on each node.

A connection whose ends are on different nodes becomes a message of the bus; neither
component knows. The program of a node is that of a system which has this node only: a
message of another node is one from outside there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

from ravenchart.gen.language.names import path_name, problem_of
from ravenchart.gen.model.authentication import Authentication
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.commands import Remote, RemoteRead
from ravenchart.gen.model.instances import Connection, Instance, Queue
from ravenchart.gen.model.nodes import InterruptLine, Node
from ravenchart.gen.model.protection import Protection
from ravenchart.gen.model.signals import fits_classic, length_of, signals_of
from ravenchart.gen.model.system import (
    Processor,
    Shutdown,
    Slot,
    System,
    Work,
)

from .calls import called
from .identifiers import OPEN

Check = TypeVar("Check", Protection, Authentication)


@dataclass(frozen=True, slots=True)
class Carrier:
    """Makes messages of the connections between nodes.

    Each output port has one message on a bus, called like instance and port, with the period of
    its sender; on a further bus the name of that stands behind it. A message that the model has
    for the port there gets more targets instead. A value that no classic frame can carry goes by
    CAN FD where the bus has a rate for that.
    """

    instances: Mapping[str, Instance]
    buses: Sequence[Bus]

    def carried(
        self, connections: Sequence[Connection], messages: Sequence[Message]
    ) -> tuple[tuple[Connection, ...], tuple[Message, ...]]:
        """The connections that are left, and all messages.

        Connections inside a node are left, and those between nodes that no message can carry:
        the rules report why.
        """
        left: list[Connection] = []
        found = {message.name.lower(): message for message in messages}
        for connection in connections:
            bus = self._bus_of(connection, messages)
            own = next((m for m in found.values() if _carries(m, connection, bus)), None)
            if not self._is_across(connection):
                left.append(connection)
            elif own is not None:
                targets = (*own.targets, connection.target)
                found[own.name.lower()] = replace(own, targets=targets)
            else:
                made = self._message(connection, bus, found)
                if made is None:
                    left.append(connection)
                else:
                    found[made.name.lower()] = made
        return tuple(left), tuple(found.values())

    def _bus_of(self, connection: Connection, messages: Sequence[Message]) -> Bus | None:
        """The bus of a connection: the one that it names, the only one, or that of a message.

        That is the only bus on which the model has a message with its source.
        """
        named = bus_named(self.buses, connection.bus)
        on = {message.bus for message in messages if message.source == connection.source}
        return named or (bus_named(self.buses, *on) if len(on) == 1 else None)

    def _is_across(self, connection: Connection) -> bool:
        source, target = connection.source.instance, connection.target.instance
        return self.instances[source].node != self.instances[target].node

    def _message(
        self, connection: Connection, bus: Bus | None, found: Mapping[str, Message]
    ) -> Message | None:
        """A message with the value of the connection's source, laid out as small as it is."""
        end = connection.source
        component = self.instances[end.instance].component
        name, type_ = f"{path_name(end.instance)}_{end.name}", component.port(end.name).type
        period = component.send_period(end.name)
        if bus is None or period is None:
            return None
        other = found.get(name.lower())
        if other is not None and other.source == end:
            name += f"_{bus.name}"
        if name.lower() in found or problem_of(name) is not None:
            return None
        signals = signals_of(type_)
        fd = bus.data_rate is not None and not fits_classic(signals)
        return Message(
            name=name,
            origin=connection.origin,
            bus=bus.name,
            identifier=OPEN,
            extended=False,
            type=type_,
            signals=signals,
            length=length_of(signals, fd=fd),
            source=end,
            targets=(connection.target,),
            period=period,
            fd=fd,
        )


def _carries(message: Message, connection: Connection, bus: Bus | None) -> bool:
    """Whether a message has the source of a connection, on its bus."""
    return bus is not None and (message.source, message.bus) == (connection.source, bus.name)


def bus_named(buses: Sequence[Bus], name: str | None) -> Bus | None:
    """The bus of that name; without one, the only bus there is."""
    if name is None:
        return buses[0] if len(buses) == 1 else None
    return next((bus for bus in buses if bus.name == name), None)


def carriers(buses: Sequence[Bus]) -> str:
    """The buses of a system with more than one, as a clause."""
    *first, last = (bus.name for bus in buses)
    return f"{', '.join(first)} or {last} may carry it"


def which_bus(buses: Sequence[Bus]) -> str:
    """The hint where the model does not say which of several buses carries something."""
    return f"name the bus: `bus: {buses[0].name}`"


def with_nodes(system: System) -> System:
    """The system with a node for each of its processors.

    Without `node` a processor is where the instance of its first row is. A processor that a
    bus releases is on every node that receives from that bus. Where there are several such
    nodes, the node's name stands behind that of the processor.
    """
    found: list[Processor] = []
    for processor in system.processors:
        own = next((slot.owner for slot in processor.slots if not slot.of_bus), None)
        if processor.node:
            found.append(processor)
        elif own is not None:
            found.append(replace(processor, node=system.instance(own).node))
        else:
            bus = processor.released_by
            if bus is not None:
                homes = _receiving(system, bus)
            else:
                homes = system.joining(processor.slots[0].owner)
            found += [_on(processor, home, several=len(homes) > 1) for home in homes]
    named_rows = (_with_rows_of_buses(system, processor) for processor in found)
    return replace(system, processors=tuple(p for p in named_rows if p.slots))


def _with_rows_of_buses(system: System, processor: Processor) -> Processor:
    """The processor with each row of a bus named after its node where the bus has several.

    The watch of a bus that carries nothing falls away.
    """
    slots: list[Slot] = []
    for slot in processor.slots:
        homes: Sequence[str] = ()
        if slot.work is Work.BUS_WATCH:
            homes = system.joining(slot.owner)
        elif slot.work is Work.BUS_RECEIVE:
            homes = _receiving(system, slot.owner)
        if len(homes) > 1:
            slots.append(replace(slot, name=f"{slot.work.value}_{processor.node}"))
        elif homes or slot.work is not Work.BUS_WATCH:
            slots.append(slot)
    return replace(processor, slots=tuple(slots))


def _receiving(system: System, bus: str | Queue | InterruptLine) -> list[str]:
    """The nodes that receive from a bus."""
    return [node.name for node in system.nodes if system.received(bus, node.name)]


def _on(processor: Processor, node: str, *, several: bool) -> Processor:
    """The copy on a node of a processor that only serves a bus."""
    if not several:
        return replace(processor, node=node)
    return replace(processor, name=f"{processor.name}_{node}", node=node)


def _heard_here(bus: Bus, here: set[str]) -> Bus:
    """The bus, with the events of these instances."""
    return replace(
        bus,
        on_error_passive=tuple(pair for pair in bus.on_error_passive if pair[0] in here),
        on_bus_off=tuple(pair for pair in bus.on_bus_off if pair[0] in here),
        on_recovered=tuple(pair for pair in bus.on_recovered if pair[0] in here),
        recovers_on=tuple(pair for pair in bus.recovers_on if pair[0] in here),
    )


def _raised_here(check: Check | None, here: set[str]) -> Check | None:
    """The protection or authentication, with the events of these instances."""
    if check is None:
        return None
    return replace(check, on_error=tuple(pair for pair in check.on_error if pair[0] in here))


def without_idle_buses(system: System) -> System:
    """The system without the buses on which its only node sends and receives nothing.

    A bus that the node watches stays.
    """
    used = {m.bus for m in system.messages if m.source is not None or m.targets}
    used |= {bus.name for bus in system.buses if bus.watch is not None}
    buses = tuple(bus for bus in system.buses if bus.name in used)
    return system if buses == system.buses else replace(system, buses=buses)


def part_of(system: System, node: Node) -> System:
    """The part of a system on a node, as a system of its own, without tasks, objects and chains."""
    here = {instance.name for instance in system.instances if instance.node == node.name}
    messages = tuple(
        replace(
            message,
            source=message.source if system.sender(message) == node.name else None,
            targets=tuple(end for end in message.targets if end.instance in here),
            protection=_raised_here(message.protection, here),
            authentication=_raised_here(message.authentication, here),
        )
        for message in system.messages
        if system.sender(message) == node.name
        or any(end.instance in here for end in message.targets)
    )
    used = {message.bus for message in messages}
    bindings = tuple(b for b in system.bindings if b.instance in here)
    raises = tuple(pair for pair in system.shutdown.raises if pair[0] in here)
    part = replace(system, bindings=bindings)
    return replace(
        part,
        nodes=(node,),
        buses=tuple(_heard_here(bus, here) for bus in system.buses if bus.name in used),
        instances=tuple(i for i in system.instances if i.name in here),
        connections=tuple(c for c in system.connections if c.source.instance in here),
        messages=messages,
        traffic=(),
        processors=tuple(p for p in system.processors if p.node == node.name),
        shutdown=Shutdown(raises, system.shutdown.grace),
        recorded=tuple(one for one in system.recorded if one.instance in here),
        chains=(),
        devices=tuple(device for device in system.devices if called(part, device)),
        polls=tuple(poll for poll in system.polls if poll.instance in here),
        tasks=(),
        objects=(),
    )


def as_one(system: System) -> System:
    """The same components on one node: what messages carry between them, connections do."""
    if len(system.nodes) == 1:
        return system
    node = system.nodes[0]
    wires = tuple(
        Connection(message.origin, message.source, target)
        for message in system.messages
        if message.source is not None
        and message.call is None
        and not message.every
        and not message.controls
        for target in message.targets
    )
    bindings = (
        replace(b, provider=b.provider.server) if isinstance(b.provider, Remote | RemoteRead) else b
        for b in system.bindings
    )
    return replace(
        system,
        nodes=(node,),
        bindings=tuple(bindings),
        instances=tuple(replace(instance, node=node.name) for instance in system.instances),
        connections=(*system.connections, *wires),
        processors=tuple(replace(processor, node=node.name) for processor in system.processors),
        tasks=tuple(replace(task, node=node.name) for task in system.tasks),
    )
