# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values that go from one core of a node to another, or become visible at a given instant.

No protected object holds them.

A ceiling protects an object on one core only. So an input port whose sender runs on another core
has a mailbox of atomic objects, with one task on each side: `Ravenchart.Crossing_Samples` or
`Ravenchart.Crossing_Queues`. The reports of another core come to the main program in the same way.
A port whose sender has a logical execution time has `Ravenchart.Logical_Samples`, on any core.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from ravenchart.gen.model.component import Port
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.logical import LogicalLink, links_by_port, logical_links
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System

MAIN_CORE = 1
"""The core of the main program, the drivers and the host probe."""


@dataclass(frozen=True, slots=True)
class Crossing:
    """An input port that gets values from another core, or at the instants of its sender."""

    target: End
    port: Port
    senders: tuple[str, ...]
    """The processors that put values into its mailbox."""
    sent_on: int
    """The core of the first of them."""
    taken_on: int
    """The core of the port's handler."""
    logical: LogicalLink | None = None
    """From when on its values are visible, where that does not follow from when they are sent."""

    @property
    def element(self) -> str:
        """``instance.port``"""
        return str(self.target)


def reporter(node: Node, core: int) -> str:
    """The task that hands the main program what it reports of another core."""
    return f"{node.name}.reporter_{core}"


def other_cores(system: System) -> tuple[int, ...]:
    """The cores with processors, but for that of the main program."""
    if all(node.cores == 1 for node in system.nodes):
        return ()
    return tuple(sorted({p.core for p in system.processors} - {MAIN_CORE}))


def core_of(system: System, instance: str) -> int:
    """The core of an instance: that of its rows."""
    if not other_cores(system):
        return MAIN_CORE
    return next(
        (system.processor_of(slot.element).core for slot in system.slots_of(instance)), MAIN_CORE
    )


def crossings(system: System) -> tuple[Crossing, ...]:
    """Every one of a program, in the order of the model."""
    links = links_by_port(system)
    return tuple(_crossings(system, links)) if links or other_cores(system) else ()


def has_slots(system: System) -> bool:
    """Whether a program of the system has mailboxes of slots."""
    return system.most_cores > 1 or bool(logical_links(system))


def crosses(system: System, end: End) -> bool:
    """Whether values for an end come to an input port by a mailbox of `crossings`.

    ``system`` is completed: the mailboxes of all other input ports are among its objects.
    """
    inputs = system.instance(end.instance).component.inputs()
    is_port = any(port.name == end.name for port in inputs)
    return is_port and not system.has_object(f"{end}.mailbox")


def senders_to(system: System, end: End) -> tuple[str, ...]:
    """The processors that put values into the mailbox of an input port."""
    found: list[str] = []
    for connection in system.connections:
        if connection.target == end:
            source = system.instance(connection.source.instance)
            for row in source.component.senders(connection.source.name):
                found.append(system.processor_of(f"{source.name}.{row.name}").name)
    for message in system.messages:
        if end in message.targets:
            found += [p.name for p in system.processors if p.released_by == message.bus]
    return tuple(dict.fromkeys(found))


def _crossings(system: System, links: Mapping[End, LogicalLink]) -> Iterator[Crossing]:
    cores = {processor.name: processor.core for processor in system.processors}
    for instance in system.instances:
        for port in instance.component.inputs():
            end = End(instance.name, port.name)
            home = system.processor_of(instance.handler(port.name)).core
            senders = senders_to(system, end)
            away = [cores[name] for name in senders if cores[name] != home]
            if away or end in links:
                yield Crossing(end, port, senders, (away or [home])[0], home, links.get(end))
