# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The operation of a queue by which the processor that it releases waits for what comes there."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.crossing import crosses
from ravenchart.gen.emit.ada.declarations import Decl, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import Expr, OperatorChain, Prefix, number
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Stmt, do
from ravenchart.gen.emit.charts.shape import RegionShape
from ravenchart.gen.emit.tables.executions import ELEMENT_ID
from ravenchart.gen.model.commands import Provided
from ravenchart.gen.model.component import Port
from ravenchart.gen.model.instances import End, Events, Requests
from ravenchart.gen.model.statechart import Region

from .site import Site


def releases(site: Site, port: Port) -> bool:
    """Whether the values of an input port release a processor."""
    return site.system.woken_by(End(site.instance.name, port.name)) is not None


def wakes(site: Site, provided: Provided) -> bool:
    """Whether the calls of a provided interface release a processor."""
    return site.system.called(Requests(site.instance.name, provided.name)) is not None


def by_events(site: Site, region: Region) -> bool:
    """Whether the events of a region release a processor."""
    return site.system.called(Events(site.instance.name, region.name)) is not None


def queue_units(site: Site, served: tuple[Provided, ...]) -> set[DottedName]:
    """The units of the queues of ports, of calls and of events."""
    component = site.instance.component
    regions = [region for region in component.regions if region.events()]
    ports, units = component.inputs(), set()
    others = [one for one in ports if not releases(site, one)]
    if len(others) < len(ports) or any(wakes(site, one) for one in served):
        units.add(ref("Ravenchart.Releasing_Queues"))  # no interface or region is there as well
        if any(not crosses(site.system, End(site.instance.name, one.name)) for one in others):
            units.add(ref("Ravenchart.Queues"))
    elif ports or served or any(not by_events(site, region) for region in regions):
        units.add(ref("Ravenchart.Queues"))
    if any(by_events(site, region) for region in regions):
        units.add(ref("Ravenchart.Releasing_Events"))
    return units


def wait_spec(site: Site, port: Port) -> Iterator[Decl]:
    """How the processor waits for a value; in a simulation, how one asks whether it would."""
    if releases(site, port):
        yield from _specs(site, port.name, "this port until a value waits")


def wait_body(site: Site, port: Port) -> Iterator[Decl]:
    """Their bodies."""
    if releases(site, port):
        yield from _bodies(site, port.name, "Mailbox")


def call_spec(site: Site, provided: Provided) -> Iterator[Decl]:
    """The same for the calls of an interface."""
    if wakes(site, provided):
        yield from _specs(site, provided.name, "this interface until a call waits")


def call_wait(site: Site, provided: Provided) -> Iterator[Decl]:
    """Their bodies."""
    if wakes(site, provided):
        yield from _bodies(site, provided.name, "Queue")


def event_spec(site: Site, region: Region) -> Iterator[Decl]:
    """The same for the events of a region."""
    if by_events(site, region):
        yield from _specs(site, region.name, "this region until an event or completion waits")


def event_wait(site: Site, region: Region) -> Iterator[Decl]:
    """Their bodies: the first call makes the start of the region, before the epoch."""
    if not by_events(site, region):
        return
    own = ada_case(region.name)
    shape = RegionShape(site.system, site.instance.component, region)
    held = f"{own}_Region"
    completed: list[Expr] = [ref(held, shape.completed(state)) for state in shape.completing]
    start = IfStatement(
        ((Prefix("not", ref(held, "Started")), (do(f"Run_{own}", ref("Unused")),)),)
    )
    wait: Stmt = do(ref(f"{own}_Queue", "Wait"))
    if completed:
        wait = IfStatement(((Prefix("not", _any(completed)), (wait,)),))
    unused = Object("Unused", ELEMENT_ID, number(0))
    yield Subprogram(f"Await_{own}", declarations=(unused,), body=(start, wait))
    if site.noted:
        waiting = _any([*completed, Prefix("not", ref(f"{own}_Queue", "Is_Empty"))])
        yield Subprogram(f"Ask_{own}", _ASKED, body=(Assign("Waiting", waiting),))


def _any(conditions: list[Expr]) -> Expr:
    first, *others = conditions
    return OperatorChain("or else", (first, *others)) if others else first


def _specs(site: Site, name: str, until: str) -> Iterator[Decl]:
    yield Subprogram(f"Await_{ada_case(name)}")
    yield Comment(f"[{site.instance.name}.{name}] suspend the processor of {until}.")
    if site.noted:
        yield Subprogram(f"Ask_{ada_case(name)}", _ASKED)


def _bodies(site: Site, name: str, queue: str) -> Iterator[Decl]:
    own = ada_case(name)
    yield Subprogram(f"Await_{own}", body=(do(ref(f"{own}_{queue}", "Wait")),))
    if site.noted:
        empty = Assign("Waiting", Prefix("not", ref(f"{own}_{queue}", "Is_Empty")))
        yield Subprogram(f"Ask_{own}", _ASKED, body=(empty,))


_ASKED = (Param("Waiting", "out", "Boolean"),)
