# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The queues of a system: the values that may wait in each, against its depth in the model.

Every bound of a response or latency supposes that no value is lost. Let a message be
in a queue for at most W after its event, and come no closer than T. Then ceil(W / T) of them
are in the queue at once. Where the reader takes one in each separation S, the last of n that
wait together waits (n - 1) S. So no more than W / S + 1 wait.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

from ravenchart.gen.derive.calls import callers_of, calls_from_afar
from ravenchart.gen.model.commands import Provided
from ravenchart.gen.model.component import Activity, Port, PortKind
from ravenchart.gen.model.instances import Connection, End, Events, Instance
from ravenchart.gen.model.raising import more_events, raised_at_once, raises_for, taking_region
from ravenchart.gen.model.statechart import Overflow
from ravenchart.gen.model.system import Carried, Stop
from ravenchart.gen.origins import Origin

from .commands import from_release
from .latencies import HopKind

if TYPE_CHECKING:
    from .timing import Analysis


@dataclass(frozen=True, slots=True)
class Depth:
    """A queue; ``needed`` is the depth with which no value is lost, None where none is known.

    ``what`` may wait in it, in words; ``key`` is the key of its depth in the model.
    """

    what: str
    key: str
    origin: Origin
    given: int
    needed: int | None

    @property
    def holds(self) -> bool:
        """Whether no value can be lost."""
        return self.needed is not None and self.needed <= self.given


def depths(analysis: Analysis) -> Iterator[Depth]:
    """Every queue between the parts of a system, with the depth that it needs.

    Queues of a bus are left out where its frames or their reception have no bound. A queue is
    also left out where the model declares the handling of values that do not fit, and no
    limit of a chain depends on the queue.
    """
    system = analysis.system
    for bus, node in product(system.buses, system.nodes):
        sent = [m for m in system.messages if (m.bus, system.sender(m)) == (bus.name, node.name)]
        times = [(analysis.found.from_event(m.element), m.period) for m in sent]
        needed = _together(times) if sent else None
        if needed is not None:
            place = "" if len(system.nodes) == 1 else f" by {node.name}"
            queue = f"frames may wait to be sent on {bus.name}{place}"
            yield Depth(queue, "transmit_depth", bus.origin, bus.transmit_depth, needed)
    for processor in system.processors:
        own = analysis.found.responses[processor.name].bound
        received = system.received(processor.released_by, processor.node)
        taken = [analysis.deliveries[one.element] for one in received]
        waits = [None if d.bound is None or own is None else d.bound - own for d in taken]
        if not waits or not isinstance(processor.released_by, str):
            continue
        needed = _together(list(zip(waits, (d.message.period for d in taken), strict=True)))
        if needed is None:
            continue
        needed = min(needed, max(w or 0 for w in waits) // processor.period + 1)
        bus = system.bus(processor.released_by)
        queue = f"frames of {bus.name} may wait for {processor.name}"
        yield Depth(queue, "receive_depth", bus.origin, bus.receive_depth, needed)
    for instance in system.instances:
        for port in instance.component.inputs():
            if port.kind is PortKind.QUEUED:
                yield from _of_port(instance, port, analysis)
        for provided in instance.component.provides:
            yield from _of_requests(instance, provided, analysis)
    for processor in system.processors:
        if isinstance(processor.released_by, Events):
            yield from _of_events(processor.released_by, analysis)


def _together(times: Sequence[tuple[int | None, int]]) -> int | None:
    """The number of values in a queue at once, from the stay and the period of each."""
    counts = [None if within is None else -(-within // period) for within, period in times]
    known = [count for count in counts if count is not None]
    return sum(known) if len(known) == len(counts) else None


def _of_port(instance: Instance, port: Port, analysis: Analysis) -> Iterator[Depth]:
    """The values that wait in a queued port for their handler."""
    system, place = analysis.system, End(instance.name, port.name)
    ways: list[tuple[Stop, ...]] = [
        (Carried(message.name), place) for message in system.messages if place in message.targets
    ]
    for connection in system.connections:
        if connection.target == place:
            ways += [(row, connection.source, place) for row in _senders(connection, analysis)]
    needed: int | None = 0
    for way in ways:
        hop = analysis.latency(way).hops[-1]
        one = hop.backlog if hop.step.hop in (HopKind.QUEUED, HopKind.WOKEN) else 1
        one = None if hop.step.waits else one
        needed = None if one is None or needed is None else max(needed, one)
    expected = port.overflow is Overflow.DROP_OLDEST or port.on_overflow is not None
    relied_on = any(place in chain.way for chain in system.chains)
    if ways and (relied_on or not expected):
        yield Depth(f"values may wait in {place}", "depth", port.origin, port.depth, needed)


def _of_requests(instance: Instance, provided: Provided, analysis: Analysis) -> Iterator[Depth]:
    """The requests of an interface; its server takes all that wait.

    Of a command of another node with a reply one call waits at most. Where other nodes call,
    no call may be lost, because the caller is not notified. Where none does, callers may
    declare the handling of a call that does not fit.
    """
    system = analysis.system
    afar = calls_from_afar(system, instance.name, provided)
    near = callers_of(system, instance.name, provided)
    expected = any(binding.need.on_full for binding in near)
    if not (afar or near) or (expected and not afar):
        return
    served = End(instance.name, str(provided.server))
    ways = [(Carried(m.name), m.period) for m in afar if m.call and m.call.reply is None]
    times = [(analysis.latency((way, served)).reaction, period) for way, period in ways]
    forwarding: set[End] = set()
    for binding in near:
        component = system.instance(binding.instance).component
        for row in component.senders(binding.need.command.name):
            if isinstance(row, Activity) and row.forwards:
                end = End(binding.instance, row.name)
                if end in forwarding:
                    continue  # each of its requests is one call, of whichever command
                forwarding.add(end)
            serves = component.served_by(row.name)
            once = serves.depth if serves else getattr(row, "steps_per_execution", 1)
            within = from_release(analysis, (End(binding.instance, row.name), served))
            times += [(within, row.timing.period)] * once
    together = _together(times)
    needed = None if together is None else together + len(afar) - len(ways)
    what = f"requests may wait in {instance.name}.{provided.name}"
    yield Depth(what, "queue", provided.origin, provided.depth, needed)


def _of_events(taken: Events, analysis: Analysis) -> Iterator[Depth]:
    """The events that wait for a region that they release, where one row raises all of them.

    Nothing is known of how often faults, buses or others raise them.
    """
    system, place = analysis.system, End(taken.instance, taken.name)
    region, rows = taking_region(system, taken), list(raised_at_once(system, taken))
    expected = region.overflow is Overflow.DROP_OLDEST or region.on_overflow is not None
    relied_on = any(place in chain.way for chain in system.chains)
    if len(rows) != 1 or more_events(system, taken, rows[0]) or (expected and not relied_on):
        return
    component = system.instance(taken.instance).component
    parts = (End(taken.instance, one.name) for one in (*component.runnables(), *component.inputs()))
    raiser = next(one for one in parts if raises_for(system, one, place))
    hop = analysis.latency((raiser, place)).hops[-1]
    needed = None if hop.step.waits else hop.backlog
    what = f"events may wait in the queue of {taken}"
    yield Depth(what, "queue", region.origin, region.queue_depth, needed)


def _senders(connection: Connection, analysis: Analysis) -> list[End]:
    source = analysis.system.instance(connection.source.instance)
    rows = source.component.senders(connection.source.name)
    return [End(source.name, row.name) for row in rows]
