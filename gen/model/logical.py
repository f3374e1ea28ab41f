# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Connections whose values become visible when a logical execution time ends.

A row of a processor with a logical execution time L, released at r, makes its values visible at
r + L. A row reads the values that are visible at its own release. See Henzinger, Horowitz, Kirsch,
Giotto: a time-triggered language for embedded programming, Proceedings of the IEEE 91, 2003. So
times of execution, priorities and cores decide nothing. Between rows of one processor the order
of the table decides, as always.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns

from .component import PortKind
from .instances import Connection, End
from .system import Processor, Slot, System


@dataclass(frozen=True, slots=True)
class LogicalLink:
    """Such a connection: the sending rows, and the handler of the sampled port that it ends at."""

    connection: Connection
    sender: Processor
    receiver: Processor
    lasting: Ns
    """The logical execution time."""
    handler: str
    """The element of the row that takes the values."""
    rows: tuple[str, ...]
    """The elements of the rows that send."""
    depth: int
    """Values that the mailbox keeps.

    The handler runs at most D after its release r. By then the sender may have put in values that
    become visible after r: those of releases from r - L on, and before r + D. Each row has one in
    each of its periods, all rows together one for a release. One more is visible.
    """
    by_releases: bool
    """Whether the releases of the sender are fewer than the executions of its rows together."""


def logical_links(system: System) -> tuple[LogicalLink, ...]:
    """Every one of a system, in the order of its connections."""
    asked = any(processor.logical is not None for processor in system.processors)
    asked = asked or any(connection.logical for connection in system.connections)
    return tuple(_links(system)) if asked else ()


def links_by_port(system: System) -> dict[End, LogicalLink]:
    """The same by the ports at which they end: each port has one source."""
    return {link.connection.target: link for link in logical_links(system)}


def logical_of(system: System, element: str) -> Ns | None:
    """The logical execution time of a processor that has one; None for any other task.

    A chain gives it to the processors that send on its way: their period.
    """
    own = next((one.logical for one in system.processors if one.name == element), None)
    if own is not None:
        return own
    links = (one for one in logical_links(system) if one.sender.name == element)
    return next((link.lasting for link in links), None)


def period_of(processor: Processor, slot: Slot) -> Ns:
    """The time between two executions of a row of a periodic processor."""
    return Ns(slot.divisor * processor.period)


def first_of(processor: Processor, slot: Slot) -> Ns:
    """The release of its first execution, from the epoch."""
    return Ns(processor.offset + slot.phase * processor.period)


def timed_row(system: System, element: str) -> tuple[Processor, Slot]:
    """A row, and the processor that runs it; KeyError where none does."""
    processor = system.processor_of(element)
    return processor, next(slot for slot in processor.slots if slot.element == element)


def saved_wait(one: tuple[Processor, Slot], other: tuple[Processor, Slot], lasting: int) -> int:
    """How much less than its period a row waits at most for what another one makes visible.

    Both count from one epoch. The instants at which values become visible are in steps of g, the
    gcd of both periods, and so are the releases of the reader. Let d be the distance of the two
    grids. The longest wait is T - g + d, so g - d is saved. In the same way the value that is read
    became visible at most T - g + d ago, with the period T of the sender.
    """
    grid = math.gcd(period_of(*one), period_of(*other))
    return grid - (first_of(*other) - first_of(*one) - lasting) % grid


def _timed_sender(connection: Connection, senders: Sequence[Processor]) -> Processor | None:
    """The processor that decides when the values of a connection become visible.

    Where a chain asks for that, one processor sends, with releases by time.
    """
    own = next((one for one in senders if one.logical is not None), None)
    if own is not None or not connection.logical or not senders:
        return own
    first = senders[0]
    together = all(one.name == first.name for one in senders)
    return first if together and first.released_by is None else None


def _links(system: System) -> Iterator[LogicalLink]:
    for connection in system.connections:
        source = system.instance(connection.source.instance)
        rows = tuple(
            f"{source.name}.{row.name}" for row in source.component.senders(connection.source.name)
        )
        places = [timed_row(system, row) for row in rows]
        port = system.instance(connection.target.instance).component.port(connection.target.name)
        logical = _timed_sender(connection, [processor for processor, _ in places])
        if logical is None or port.kind is not PortKind.SAMPLED:
            continue
        lasting = logical.period if logical.logical is None else logical.logical
        handler = system.handler(connection.target)
        receiver = system.processor_of(handler)
        if receiver.name == logical.name or receiver.released_by is not None:
            continue
        ahead = lasting + receiver.deadline
        of_rows = sum(-(-ahead // period_of(processor, slot)) for processor, slot in places)
        of_releases = -(-ahead // logical.period)
        depth, fewer = 1 + min(of_rows, of_releases), of_releases < of_rows
        ends = connection, logical, receiver
        yield LogicalLink(*ends, lasting, handler, rows, depth, fewer)
