# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Procedures that put values and events into an instance's queues, and report losses."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.emit.ada.declarations import Decl, GenericInstance, Subprogram
from ravenchart.gen.emit.ada.expressions import Expr, arguments
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Stmt, do
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.emit.tables.trace_calls import FAULTS, element_constant
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.component import Component, Event, Port
from ravenchart.gen.model.statechart import Overflow, Region

from .site import Site

OFFERS, ANSWERED = ref("Ravenchart.Offers"), ref("Ravenchart.Answered_Offers")


def offers_of_port(site: Site, port: Port, of_type: DottedName) -> GenericInstance:
    """The procedures that put values into the queue of a port."""
    element = ref("Elements", element_constant(_element(site, port.name), "port"))
    return _offering(port.name, "Mailbox", of_type, port.overflow, element)


def offers_of_region(site: Site, region: Region, event: DottedName) -> list[Decl]:
    """The procedures that put events into the queue of a region, and answer a loss."""
    element = ref("Elements", element_constant(_element(site, region.name), "region"))
    given = region.name, "Queue", event, region.overflow, element
    offering = _offering(*given)
    if not _answers(site.instance.component, region):
        return [offering]
    answer = _answer_name(region)
    actual = arguments(Offers=ref(offering.name), On_Loss=ref(answer))
    return [
        offering,
        Subprogram(answer),
        GenericInstance(_name(region.name, ANSWERED), ANSWERED, actual),
    ]


def _element(site: Site, name: str) -> str:
    return f"{site.instance.name}.{name}"


def _offering(
    name: str,
    queue: str,
    of_type: DottedName,
    policy: Overflow,
    element: DottedName,
) -> GenericInstance:
    own = ada_case(name)
    return GenericInstance(
        _name(name),
        OFFERS,
        arguments(
            Element_Type=of_type,
            Put=ref(f"{own}_{queue}", "Put"),
            Policy=_policy(policy),
            Element=element,
            Report=ref(FAULTS, "Report"),
        ),
    )


def _name(queued: str, generic: DottedName = OFFERS) -> str:
    return f"{ada_case(queued)}_{generic.last}"


def _answer_name(region: Region) -> str:
    return f"{ada_case(region.name)}_Overflowed"


def _policy(overflow: Overflow) -> DottedName:
    return ref("Ravenchart.Queueing", ada_case(overflow.value))


def put(queued: str, item: Expr) -> Stmt:
    """Put a value into a queue."""
    return do(ref(_name(queued), "Offer"), item)


def enqueue(component: Component, region: Region, event: Event, item: Expr) -> Stmt:
    """Put an event into a region's queue, and answer a loss where the model does."""
    return _enqueue(region, event, item, ANSWERED if _answers(component, region) else OFFERS)


def _enqueue(region: Region, event: Event, item: Expr, by: DottedName) -> Stmt:
    args = [item]
    if event.overflow is not None and event.overflow is not region.overflow:
        args.append(_policy(event.overflow))
    return do(ref(_name(region.name, by), "Offer"), *args)


def overflowed(component: Component) -> Iterator[Decl]:
    """Raise the event of a loss; a loss that this causes is only reported."""
    for region in component.regions:
        name = region.on_overflow
        if name is not None and region.events() and _answers(component, region):
            event: Event = named(component.events, name)
            item = event_value(component, name)
            tell = [_enqueue(r, event, item, OFFERS) for r in _heard(component, name)]
            yield Subprogram(_answer_name(region), body=tuple(tell))


def _answers(component: Component, region: Region) -> bool:
    """Is there an event of a loss, and a region that it is for?"""
    return region.on_overflow is not None and bool(_heard(component, region.on_overflow))


def _heard(component: Component, event: str) -> list[Region]:
    """The regions that an event is for."""
    name = named(component.events, event).name
    return [r for r in component.regions if name in r.events()]
