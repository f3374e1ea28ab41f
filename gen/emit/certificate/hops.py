# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The steps of a chain that its claims are about, read from the model.

A row later in the same table, run as often, follows at once. Any other row samples at its own
times, and the handler of a queued port takes one value in a job. The driver and the frame follow
the sender, and a reception hands arrivals over.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from ravenchart.gen.derive.calls import calls_at_once
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.component import Activity, PortKind
from ravenchart.gen.model.instances import End, Events, Requests
from ravenchart.gen.model.logical import LogicalLink, links_by_port
from ravenchart.gen.model.nodes import InterruptLine
from ravenchart.gen.model.raising import more_events, raised_at_once, raises_for
from ravenchart.gen.model.samples import hidden_by
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Carried, Chain, Processor, Slot, Stop, System


@dataclass(frozen=True, slots=True)
class ClaimedHop:
    """One step of a chain: a row, a task, a message, or a message's handing over.

    ``how`` values come to it: ``released`` by the step before or the chain's event,
    ``sampled``, ``queued`` with so many at once, or ``woken`` by so many: they release it.
    ``open``: values may wait for as long as its region has other things to do, or as others fill
    the same queue, or as no value releases its processor. ``sure``: each of its jobs makes a new
    output, and it has a job in every period. ``rare``: it follows some
    of the jobs before it only, in whose period it has none. ``renewed``: the message that says
    how long its outputs stay at most, where that is longer than its period; "" where it is not.
    """

    element: str
    kind: str
    """``row``, ``item`` (a task or message), ``handed``, or ``transfer`` of several frames."""
    how: str
    at_once: int = 1
    open: bool = False
    sure: bool = True
    rare: bool = False
    renewed: str = ""
    link: LogicalLink | None = None
    """A row that samples: how its values become visible, where that is known to the instant."""


def hops_of(system: System, chain: Chain) -> tuple[ClaimedHop, ...]:
    """The steps of a chain, from its way; none where that is broken."""
    hops: list[ClaimedHop] = []
    #  whether the row before renews what stands between it and the next
    sure = not any(_seldom(system, place) for place in chain.way[:1])
    for number, place in enumerate(chain.way):
        following = next(iter(chain.way[number + 1 :]), None)
        if isinstance(place, Carried):
            hops += _message(system, place.message, following)
            continue
        component = system.instance(place.instance).component
        rows = {item.name: item for item in component.runnables()}
        handled = place.name in {port.name for port in component.inputs()}
        if not handled and place.name not in rows:
            continue
        if not sure:
            hops[-1] = replace(hops[-1], sure=False)
        sure = not raises_for(system, place, following)
        if handled:
            hops.append(_handler(system, place, hops))
        else:
            row = rows[place.name]
            line = system.processor_of(str(place)).released_by_interrupt
            if line is not None and not hops:
                hops.append(ClaimedHop(str(line), "item", "released"))
            hops.append(_row(system, str(place), row, hops))
            if sure and isinstance(following, End):
                sure = component.renews(row, following.name)
    if chain.of_call and hops:
        hops[0] = replace(hops[0], how="released", open=False)
    return tuple(_irregular(system, chain, hops))


def _irregular(system: System, chain: Chain, hops: list[ClaimedHop]) -> list[ClaimedHop]:
    """The steps, the first not sure where it is a sporadic message that something samples.

    A step that it releases runs as seldom as it comes. A step that samples it may find the
    same value any number of times.
    """
    rare = any(m.sporadic and chain.way[:1] == (Carried(m.name),) for m in system.messages)
    if hops and any(hops[0].element == str(p.released_by_interrupt) for p in system.processors):
        rare, hops = True, list(hops)
        passed = {"released", "woken"}
    else:
        passed = {"released"}
    if rare and any(hop.how not in passed for hop in hops[1:]):
        return [replace(hops[0], sure=False), *hops[1:]]
    return hops


def _seldom(system: System, place: Stop) -> bool:
    """Whether it is a message of which a row sends some in some of its jobs only."""
    if not isinstance(place, Carried):
        return False
    message = named(system.messages, place.message)
    if message.source is None or message.call is not None or message.transmission is not None:
        return False
    component, port = system.instance(message.source.instance).component, message.source.name
    return not all(component.renews(row, port) for row in component.senders(port))


def _message(system: System, name: str, following: Stop | None) -> Iterator[ClaimedHop]:
    """The driver's work and the frame, then its reception for the port that follows."""
    message = named(system.messages, name)
    mode = message.transmission
    hops: list[ClaimedHop] = []
    rare = mode is not None or message.transport is not None
    if message.source is not None:
        hops.append(ClaimedHop(message.sending, "item", "released", rare=rare))
    hops.append(ClaimedHop(message.element, "item", "released"))
    received = system.reception(message, following)
    if received is not None:
        hops.append(ClaimedHop(received.driver, "item", "released"))
        hops.append(ClaimedHop(received.element, "handed", "released"))
    if message.transport is not None:
        last = ClaimedHop(message.element, "transfer", "released", renewed=message.element)
        hops = [*hops[:-1], last]
    elif mode is not None and mode.longest is not None:
        hops = [replace(hop, renewed=message.element) for hop in hops]
    elif mode is not None:
        hops[-1] = replace(hops[-1], sure=False)
    yield from hops


def _row(
    system: System, element: str, row: Region | Activity, hops: list[ClaimedHop]
) -> ClaimedHop:
    """A region or activity."""
    follows = bool(hops) and _follows(system, hops[-1], element)
    waits = isinstance(row, Region) and row.takes_turns
    processor = system.processor_of(element)
    called = processor.released_by
    if isinstance(called, Requests) and hops and element == processor.slots[0].element:
        return ClaimedHop(element, "row", "woken", calls_at_once(system, called))
    if isinstance(called, InterruptLine) and hops and hops[-1].element == str(called):
        return ClaimedHop(element, "row", "woken")
    if isinstance(called, Events) and hops and element == str(called):
        raised = raised_at_once(system, called).get(hops[-1].element, 0)
        if raised:
            more = bool(more_events(system, called, hops[-1].element))
            return ClaimedHop(element, "row", "woken", raised, open=more)
    if not follows and processor.released_by_value is not None:
        return ClaimedHop(element, "row", "sampled", open=True, sure=False)
    return ClaimedHop(element, "row", "released" if follows else "sampled", open=waits)


def _handler(system: System, end: End, hops: list[ClaimedHop]) -> ClaimedHop:
    """The row that handles a port, as far as it does this."""
    element = system.handler(end)
    queued = system.instance(end.instance).component.port(end.name).kind is PortKind.QUEUED
    many = [
        row.steps_per_execution if isinstance(row, Region) else 1
        for connection in system.connections
        if connection.target == end
        for row in system.instance(connection.source.instance).component.runnables()
        if connection.source.name in row.sends
    ]
    if hops and system.woken_by(end) is not None:
        return ClaimedHop(element, "row", "woken", max(many))
    if queued and hops and sum(many) > 1:
        return ClaimedHop(element, "row", "queued", max(many), open=len(many) > 1)
    lost = bool(hops) and hops[-1].kind == "row" and hidden_by(system, hops[-1].element, end)
    if hops and _follows(system, hops[-1], element):
        return ClaimedHop(element, "row", "released", open=bool(lost))
    link = links_by_port(system).get(end)
    if link is not None and (not hops or hops[-1].element not in link.rows):
        link = None
    return ClaimedHop(
        element, "row", "queued" if queued and hops else "sampled", open=bool(lost), link=link
    )


def _follows(system: System, before: ClaimedHop, element: str) -> bool:
    """Whether a row runs in the same jobs as the one before, after it."""
    if before.kind != "row":
        return False
    processor = system.processor_of(element)
    if system.processor_of(before.element).name != processor.name:
        return False
    order = [slot.element for slot in processor.slots]
    one, other = (_slot(processor, name) for name in (before.element, element))
    alike = (one.divisor, one.phase) == (other.divisor, other.phase)
    return alike and order.index(before.element) < order.index(element)


def _slot(processor: Processor, name: str) -> Slot:
    return next(slot for slot in processor.slots if slot.element == name)
