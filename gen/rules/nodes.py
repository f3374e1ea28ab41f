# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of systems with several nodes: which elements may reach from one to another."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import answered_at_once, callers, devices_with_ends
from ravenchart.gen.derive.remote import is_across, obstacle
from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.commands import Device, Remote
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin
from ravenchart.gen.resolve.system import Resolved

ABSENT = "RV-0802"
"""Elements that cannot reach from one node to another yet."""

ROOM = "RV-0617"
"""Transmit buffers by priority that do not hold what a node sends."""

SILENCE = "RV-0712"
"""A reaction to silence without a supervision, or a supervision on several cores."""

UNHEARD = "RV-0713"
"""An event of the silence of a processor for which only that processor waits."""

START = "RV-1218"
"""Devices that take too long to start."""

LONGEST_START = Ns(100_000_000)
"""The time in ns that all devices of a node together have for `initialise` and `self_test`.

The first release is 200 ms behind the elaboration of the program; half of it is left for the
activation of tasks.
"""

BUFFERS = 8
"""Transmit buffers that the drivers with buffers by priority fill."""


def calls_can_be_carried(resolved: Resolved) -> Iterator[Diagnostic]:
    """A command of another node is one that messages can carry; a device is on one node."""
    system = resolved.system
    told: set[tuple[str, Origin]] = set()
    for binding in system.bindings:
        problem = obstacle(system, binding) if is_across(system, binding) else None
        if problem is not None and problem[:2] not in told:
            code, origin, text, hint = problem
            told.add((code, origin))
            yield error(code, origin, text, hint=hint)
    for device in system.devices:
        homes = {system.instance(row.instance).node: row for row in callers(system, device)}
        if len(homes) > 1:
            ends = " and ".join(f"{row} on {node}" for node, row in homes.items())
            text = f"the device {device.name} is called by {ends}"
            hint = "let one node call it, and forward the calls of others (`body: forward`)"
            yield error(ABSENT, device.origin, text, hint=hint)


def servers_call_once(resolved: Resolved) -> Iterator[Diagnostic]:
    """A row that serves several requests in one execution calls no command of another node.

    It may call once for each request, and a message carries one call in its period.
    """
    system = resolved.system
    for binding in system.bindings:
        component = system.instance(binding.instance).component
        for row in component.senders(binding.need.command.name):
            served = component.served_by(row.name)
            if isinstance(binding.provider, Remote) and served is not None and served.depth > 1:
                text = (
                    f"{row.name} serves up to {served.depth} requests in one execution, so "
                    f"{binding.provider.request} may be sent more often than once in its period"
                )
                notes = [(row.origin, f"{row.name} is declared here")]
                hint = f"give {served.name} `queue: 1`, or call from another activity"
                yield error("RV-0611", binding.origin, text, notes=notes, hint=hint)


def forwarded_replies_come_from_devices(resolved: Resolved) -> Iterator[Diagnostic]:
    """A row that forwards a request hands its reply back in the same execution.

    Only a device replies to a call at once: a task does when it has executed it.
    """
    system = resolved.system
    for binding in system.bindings:
        need, component = binding.need, system.instance(binding.instance).component
        for activity in component.activities:
            at_once = need.command.name in answered_at_once(component, activity)
            if at_once and not isinstance(binding.provider, Device):
                text = (
                    f"{binding.instance}.{activity.name} forwards {need.command.name}, whose "
                    "reply does not come at once: no single device gives it"
                )
                notes = [(activity.origin, f"{activity.name} is declared here")]
                hint = f"bind {need.interface} to a device; tasks call {need.command.name} directly"
                yield error("RV-1209", binding.origin, text, notes=notes, hint=hint)


def cores_exist(resolved: Resolved) -> Iterator[Diagnostic]:
    """The node of a processor has its core."""
    cores = {node.name: node.cores for node in resolved.system.nodes}
    for processor in resolved.system.processors:
        last = cores.get(processor.node)
        if last is not None and processor.core > last:
            text = f"{processor.name} is on core {processor.core}, but {processor.node} has {last}"
            hint = f"give the node `cores: {processor.core}`, or the processor another core"
            yield error("RV-0710", processor.origin, text, hint=hint)


def raised_events_are_near(resolved: Resolved) -> Iterator[Diagnostic]:
    """A processor raises events of instances on its node."""
    system = resolved.system
    for processor in system.processors:
        for instance, event in processor.raised_for_it:
            home = system.instance(instance).node
            if home != processor.node:
                text = (
                    f"{processor.name} is on {processor.node}, but raises {event} of {instance}, "
                    f"which is on {home}"
                )
                hint = "raise an event of an instance there; a port can notify others"
                yield error("RV-0707", processor.origin, text, hint=hint)


def silence_is_seen(resolved: Resolved) -> Iterator[Diagnostic]:
    """An event of a processor's silence needs a supervision, and a region of another processor."""
    system = resolved.system
    nodes = {node.name: node for node in system.nodes}
    for processor in system.processors:
        node = nodes.get(processor.node)
        if node is None or not processor.on_silence:
            continue
        if node.supervision is None:
            text = f"{processor.name} has `on_silence`, but nothing supervises {node.name}"
            hint = f"give {node.name} `supervision: {{period: ..., wcet: ..., margin: ...}}`"
            yield error(SILENCE, processor.origin, text, hint=hint)
        for instance, event in processor.on_silence:
            regions = system.instance(instance).component.regions
            waiting = {f"{instance}.{r.name}" for r in regions if event in r.events()}
            own = {slot.element for slot in processor.slots}
            if waiting and waiting <= own:
                text = (
                    f"the silence of {processor.name} raises {instance}.{event}, for which only "
                    f"{', '.join(sorted(waiting))} on {processor.name} itself waits"
                )
                hint = "raise an event of a region that another processor executes"
                yield warning(UNHEARD, processor.origin, text, hint=hint)


def supervision_has_one_core(resolved: Resolved) -> Iterator[Diagnostic]:
    """A supervisor calls the monitors of all processors: they are on its core."""
    for node in resolved.system.nodes:
        if node.supervision is not None and node.cores > 1:
            text = f"{node.name} has `supervision` and {node.cores} cores"
            hint = "leave `supervision` out: a supervisor sees the processors of one core only"
            yield error(SILENCE, node.origin, text, hint=hint)


def devices_start_in_time(resolved: Resolved) -> Iterator[Diagnostic]:
    """The devices of a node are initialised and tested before the first release."""
    system = resolved.system
    for node in system.nodes:
        own = [device for device in devices_with_ends(system) if _home(system, device) == node.name]
        time = sum(device.type.lifecycle.start for device in own if device.type is not None)
        if time > LONGEST_START:
            text = (
                f"the devices of {node.name} take {shown(time)} for `initialise` and `self_test`; "
                f"the limit is {shown(LONGEST_START)}"
            )
            notes = [(device.origin, f"{device.name} is one of them") for device in own]
            hint = "shorten them, or let a component do the rest by commands"
            yield error(START, node.origin, text, notes=notes, hint=hint)


def _home(system: System, device: Device) -> str | None:
    """The node whose rows call a device; None where none is known to."""
    rows = callers(system, device)
    return system.instance(rows[0].instance).node if rows else None


def sent_by(system: System, node: str, bus: Bus) -> list[Message]:
    """The messages that a node sends on a bus."""
    return [m for m in system.messages if m.bus == bus.name and system.sender(m) == node]


def buffers_hold_what_is_sent(resolved: Resolved) -> Iterator[Diagnostic]:
    """By priority, each message that a node sends has a transmit buffer for itself."""
    system = resolved.system
    for bus in system.buses:
        if not bus.by_priority:
            continue
        if bus.transmit_depth > BUFFERS:
            text = f"{bus.name} has {bus.transmit_depth} transmit buffers by priority; "
            text += f"a controller has at most {BUFFERS}"
            hint = f"write `transmit_depth: {BUFFERS}` or less"
            yield error(ROOM, bus.origin, text, hint=hint)
        sent = [m for m in system.messages if m.bus == bus.name and m.source is not None]
        for node in system.nodes:
            own = sent_by(system, node.name, bus)
            if len(own) > bus.transmit_depth:
                text = f"{node.name} sends {len(own)} messages on {bus.name}, but its controller"
                text += f" has {bus.transmit_depth} transmit buffers by priority"
                hint = "raise `transmit_depth`, or write `buffers: fifo`"
                yield error(ROOM, bus.origin, text, hint=hint)
        for message in sent:
            if message.limit > message.period:
                text = f"{message.name} may take longer than its period, so two of it may wait,"
                text += f" and {bus.name} has one transmit buffer by priority for each message"
                hint = f"give it a deadline of {shown(message.period)} or less"
                yield error(ROOM, message.origin, text, hint=hint)


NODE_RULES = (
    buffers_hold_what_is_sent,
    calls_can_be_carried,
    servers_call_once,
    forwarded_replies_come_from_devices,
    cores_exist,
    raised_events_are_near,
    silence_is_seen,
    supervision_has_one_core,
    devices_start_in_time,
)
