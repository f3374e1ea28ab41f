# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The procedure of an instance that offers an event to the regions that it is for."""

from __future__ import annotations

from ravenchart.gen.emit.ada.expressions import Attribute, Expr, OperatorChain, call
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import NULL, Return, Stmt, case_of, do
from ravenchart.gen.emit.language.events import name_of, name_type
from ravenchart.gen.emit.language.own_names import event_literal
from ravenchart.gen.emit.tables.executions import ELEMENT_ID
from ravenchart.gen.emit.tables.trace_calls import element_constant, note_of
from ravenchart.gen.model.component import Event

from .offers import enqueue
from .releasing import by_events
from .site import Site


def offer_steps(site: Site) -> tuple[Stmt, ...]:
    """Offer an event to the regions that it is for, and trace it, once for all events.

    Where the event may release a processor it is traced first: that may run before the rest.
    """
    component = site.instance.component
    name = name_of(component, "Item")
    queued = {event.name: _queued(site, event) for event in component.events}
    noted = note_of(site.system, "Raised", _number(site, name))
    first = noted if any(by_events(site, region) for region in component.regions) else ()
    last = () if first else noted
    if len(set(queued.values())) == 1 and all(queued.values()):
        return (*first, *next(iter(queued.values())), *last)
    some = any(queued.values())
    unheard = (Return(),) if last and some else (NULL,)
    rows = [
        (
            ref(site.component, event_literal(event.name)),
            (*first, *queued[event.name]) if queued[event.name] else unheard,
        )
        for event in component.events
    ]
    return (case_of(name, rows), *(last if some else ()))


def _number(site: Site, name: DottedName) -> Expr:
    """The element number of an event: those of an instance follow each other."""
    component = site.instance.component
    element = f"{site.instance.name}.{component.events[0].name}"
    first = ref("Elements", element_constant(element, "event"))
    position = call(Attribute(ref(site.component, name_type(component)), "Pos"), name)
    return OperatorChain("+", (first, call(ELEMENT_ID, position)))


def _queued(site: Site, event: Event) -> tuple[Stmt, ...]:
    """Queue an event for each region that it is for, and ask buses to recover."""
    component = site.instance.component
    heard = [r for r in component.regions if event.name in r.events()]
    steps = [enqueue(component, region, event, ref("Item")) for region in heard]
    for bus in asked(site, event.name):
        steps.append(do(ref(ada_case(bus), "Controller.Request_Recovery")))
    return tuple(steps)


def asked(site: Site, event: str) -> tuple[str, ...]:
    """The buses that an event asks to recover."""
    pair = site.instance.name, event
    return tuple(bus.name for bus in site.system.buses if pair in bus.recovers_on)
