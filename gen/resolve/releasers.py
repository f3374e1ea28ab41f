# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Names after `released_by`: of a bus, a queue in an instance, or an interrupt."""

from __future__ import annotations

from ravenchart.gen.language.names import NameScope, meant
from ravenchart.gen.model.component import Direction, Port
from ravenchart.gen.model.instances import End, Events, Instance, Queue, Requests
from ravenchart.gen.model.nodes import InterruptLine
from ravenchart.gen.origins import Origin

from .components import Parts
from .composites import connectable, provided_by
from .paths import DeploymentNames, member_of

UNFIT_PORT = "RV-0715"
"""A port, interface or region that cannot release a processor."""


def releaser_of(
    text: str, origin: Origin, site: DeploymentNames
) -> str | Queue | InterruptLine | None:
    """The bus, input port, provided interface, region or interrupt of that name."""
    if "." not in text:
        return _bus(text, origin, site)
    first, _, rest = text.partition(".")
    if "." not in rest and site.nodes.knows(first) and not site.owners.knows(first):
        return _interrupt(first, rest, origin, site)
    found = member_of(text, "bus or instance.port", origin, site)
    if found is None:
        return None
    instance, parts, name = found
    ports = connectable(parts)
    if isinstance(parts, Parts) and not ports.knows(name):
        queue = _other_queue(instance, parts, name, origin, site)
        if queue is not None or _names_an_event(instance, parts, name, origin, site):
            return queue
    port = ports.look_up(name, origin, site.findings)
    return None if port is None else _port(End(instance.name, port.name), port, origin, site)


def _bus(text: str, origin: Origin, site: DeploymentNames) -> str | None:
    if not site.buses.knows(text):
        site.owners.used(text, origin, site.findings)  # the name of a bus or an instance
    if not site.buses.knows(text) and site.owners.find(text) is not None:
        message = f"`{text}` must have the form bus or instance.port"
        hint = f"add a queued port of it: `{text}.port`"
        site.findings.error("RV-0306", origin, message, hint=hint)
        return None
    if not site.buses.knows(text) and not site.owners.knows(text):
        site.buses.used(text, origin, site.findings)
        site.findings.lose()
        message = f"there is no bus or instance named `{text}`"
        near = meant(text, site.buses.names())
        hint = near or "name a bus, or a queued input port as `instance.port`"
        site.findings.error("RV-0305", origin, message, hint=hint)
        return None
    bus = site.buses.look_up(text, origin, site.findings)
    return None if bus is None else bus.name


def _interrupt(
    first: str, rest: str, origin: Origin, site: DeploymentNames
) -> InterruptLine | None:
    """An interrupt of a node."""
    node = site.nodes.look_up(first, origin, site.findings)
    if node is None:
        return None
    scope: NameScope[str] = NameScope(f"interrupt of {node.name}")
    for one in node.interrupts:
        scope.declare(one.name, one.origin, one.name)
    found = scope.look_up(rest, origin, site.findings)
    return None if found is None else InterruptLine(node.name, found)


def _port(end: End, port: Port, origin: Origin, site: DeploymentNames) -> End | None:
    """An input port."""
    if port.direction is Direction.IN:
        return end
    message = f"{end} is an output port: only an input port releases a processor"
    notes = [(port.origin, f"`{port.name}` is declared here")]
    hint = "name the queued input port that it is connected to"
    site.findings.error(UNFIT_PORT, origin, message, notes=notes, hint=hint)
    return None


def _other_queue(
    instance: Instance, parts: Parts, name: str, origin: Origin, site: DeploymentNames
) -> Requests | Events | None:
    """A provided interface or region; None where there is none of that name."""
    offered = provided_by(parts.component, damaged=False)
    regions: NameScope[str] = NameScope(parts.rows.kind)
    for region in parts.component.regions:
        regions.declare(region.name, region.origin, region.name)
    if offered.knows(name):
        served = offered.look_up(name, origin, site.findings)
        return None if served is None else Requests(instance.name, served.name)
    own = regions.find(name)
    for scope in (regions,) if own else (offered, regions):
        scope.used(name, origin, site.findings)
    return None if own is None else Events(instance.name, own)


def _names_an_event(
    instance: Instance, parts: Parts, name: str, origin: Origin, site: DeploymentNames
) -> bool:
    """Report an event in place of the region that takes it."""
    component = parts.component
    event = next((one for one in component.events if one.name.lower() == name.lower()), None)
    if event is None:
        return False
    own = instance.name
    message = f"`{own}.{event.name}` is an event: the queue of a region releases a processor"
    notes = [(event.origin, f"`{event.name}` is declared here")]
    region = next((one.name for one in component.regions if event.name in one.events()), None)
    hint = "let a region take the event, and name that region"
    if region is not None:
        hint = f"name the region that takes it: `{own}.{region}`"
    site.findings.error(UNFIT_PORT, origin, message, notes=notes, hint=hint)
    return True
