# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Validity rules of a whole system: its elements, its connections and its tables.

Each rule is one function from the resolved system to its violations. A rule that needs
all of a section is silent where some of it was lost: the loss has been reported already.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator
from itertools import product

from ravenchart.gen.derive.distribution import carriers, which_bus
from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.language.names import path_name
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import EnumerationType
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.component import Component, Direction
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.signals import bits_of, room_of
from ravenchart.gen.model.system import Processor, Slot, System, Work
from ravenchart.gen.origins import Origin
from ravenchart.gen.parallel import MANY, made_by_all
from ravenchart.gen.resolve.system import Resolved

from .buses import BUS_RULES
from .components import COMPONENT_RULES
from .interrupts import INTERRUPT_RULES
from .nodes import NODE_RULES
from .recording import RECORDING_RULES
from .releases import RELEASE_RULES
from .tables import offsets_are_shorter_than_periods, periods_are_multiples

Rule = Callable[[Resolved], Iterator[Diagnostic]]

STANDARD_LAST, EXTENDED_LAST = 0x7FF, 0x1FFF_FFFF
"""Largest CAN identifiers of 11 and 29 bits."""


def violations(resolved: Resolved) -> Iterator[Diagnostic]:
    """Everything that breaks a rule."""
    components = resolved.system.components
    found, others = made_by_all(
        lambda n: [d for rule in COMPONENT_RULES for d in rule(components[n], resolved)],
        len(components),
        lambda: [d for rule in (*RULES, *NODE_RULES, *BUS_RULES) for d in rule(resolved)],
        worthwhile=sum(len(component.regions) for component in components) >= MANY,
    )
    yield from (diagnostic for own in found for diagnostic in own)
    yield from others


# --- Names -------------------------------------------------------------------------


def _one(kind: str) -> str:
    """A kind of element with its article."""
    return f"an {kind}" if kind[0] in "aeiou" else f"a {kind}"


def types_do_not_hide_units(resolved: Resolved) -> Iterator[Diagnostic]:
    """Types and literals stand in the system's package, beside its child units."""
    system = resolved.system
    kinds: tuple[tuple[str, tuple[Component | Bus | Instance | Processor, ...]], ...] = (
        ("component", system.components),
        ("bus", system.buses),
        ("instance", system.instances),
        ("processor", system.processors),
    )
    units = {
        path_name(item.name).lower(): (kind, item.origin) for kind, items in kinds for item in items
    }
    types = {type_.name.lower(): type_ for type_ in system.types}
    for type_ in system.types:
        kind, origin = units.get(type_.name.lower(), ("", type_.origin))
        if kind:
            message = f"the type `{type_.name}` is named like {_one(kind)}"
            notes = [(origin, f"the {kind} is here")]
            yield error("RV-0304", type_.origin, message, notes=notes, hint="rename one of them")
        literals = type_.literals if isinstance(type_, EnumerationType) else ()
        for literal in literals:
            kind, origin = units.get(literal.lower(), ("", type_.origin))
            if literal.lower() in types:
                kind, origin = "type", types[literal.lower()].origin
            elif literal.lower() == system.name.lower():
                kind, origin = "system", system.origin
            if kind:
                like = "the system" if kind == "system" else _one(kind)
                message = f"the literal `{literal}` of {type_.name} is named like {like}"
                notes = [(origin, f"the {kind} is here")]
                hint = "rename one of them"
                yield error("RV-0304", type_.origin, message, notes=notes, hint=hint)


# --- Connections and messages ------------------------------------------------------


def connected_ends_agree(resolved: Resolved) -> Iterator[Diagnostic]:
    """Both ends of a connection are of one type and on one node."""
    system = resolved.system
    for connection in system.connections:
        source = system.instance(connection.source.instance)
        target = system.instance(connection.target.instance)
        sent = source.component.port(connection.source.name).type
        taken = target.component.port(connection.target.name).type
        if sent != taken:
            message = (
                f"{connection.source} sends {sent.name}, but {connection.target} takes {taken.name}"
            )
            yield error("RV-0605", connection.origin, message)
        if source.node != target.node and "buses" in resolved.sound_sections:
            sender, _ = source.outside(connection.source.name)
            message = (
                f"{sender} is on {source.node}, but {target.outside(connection.target.name)[0]} "
                f"is on {target.node}"
            )
            if connection.bus is None and len(system.buses) > 1:
                message += f"; {carriers(system.buses)}"
                hint = which_bus(system.buses)
            elif system.buses:
                bus = connection.bus or system.buses[0].name
                hint = f"declare a message of {bus} with `from: {sender}`"
            else:
                hint = "declare a bus: between nodes, values travel as its messages"
            yield error("RV-0606", connection.origin, message, hint=hint)


def messages_agree(resolved: Resolved) -> Iterator[Diagnostic]:
    """A message's ports are of one type, and none of them could be connected instead."""
    system = resolved.system
    for item in system.messages:
        of_ports = item.call is None and not item.every and not item.controls
        for target in item.targets if of_ports else ():
            instance = system.instance(target.instance)
            taken = instance.component.port(target.name).type
            if taken != item.type:
                message = f"{item.name} carries {item.type.name}, but {target} takes {taken.name}"
                yield error("RV-0605", item.origin, message)
            source = None if item.source is None else system.instance(item.source.instance)
            if source is not None and source.node == instance.node:
                message = f"{item.source} and {target} are both on {source.node}"
                hint = "inside a node, write a connection: `- {from: ..., to: ...}`"
                yield error("RV-0606", item.origin, message, hint=hint)


def inputs_have_one_source(resolved: Resolved) -> Iterator[Diagnostic]:
    """Every input port is the target of one connection or message."""
    sources: defaultdict[tuple[str, str], list[Origin]] = defaultdict(list)
    for connection in resolved.system.connections:
        sources[connection.target.instance, connection.target.name].append(connection.origin)
    for item in resolved.system.messages:
        for target in item.targets:
            sources[target.instance, target.name].append(item.origin)
    for poll in resolved.system.polls:
        sources[poll.instance, poll.port].append(poll.origin)
    complete = {"connections", "messages", "instances"} <= resolved.sound_sections
    for instance in resolved.system.instances:
        for port in instance.component.inputs():
            found = sources[instance.name, port.name]
            for origin in found[1:]:
                message = f"{instance.name}.{port.name} has two sources"
                notes = [(found[0], "the first is here")]
                hint = "give the second an input port of its own"
                yield error("RV-0603", origin, message, notes=notes, hint=hint)
            if not found and complete and not _may_be_told(instance.component, resolved):
                unfed, at = instance.outside(port.name)
                message = f"{unfed} has no source"
                notes = [(port.origin, f"`{port.name}` is declared here")]
                hint = "connect it under `connections:`, or let a message lead to it"
                yield error("RV-0602", at, message, notes=notes, hint=hint)


def _may_be_told(component: Component, resolved: Resolved) -> bool:
    """Whether a port of it may have lost the event of a required interface."""
    return component.name in resolved.damaged and bool(component.needs or component.hears)


def outputs_lead_somewhere(resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning for each output port that nothing is connected to."""
    if not {"connections", "messages", "instances"} <= resolved.sound_sections:
        return
    used = {(one.source.instance, one.source.name) for one in resolved.system.connections}
    for item in resolved.system.messages:
        if item.source is not None:
            used.add((item.source.instance, item.source.name))
    for instance in resolved.system.instances:
        for port in instance.component.outputs():
            if (instance.name, port.name) not in used and not port.is_command:
                unused, at = instance.outside(port.name)
                message = f"{unused} is not connected: the values that it sends are lost"
                notes = [(port.origin, f"`{port.name}` is declared here")]
                yield warning("RV-0604", at, message, notes=notes)


def identifiers_are_unique(resolved: Resolved) -> Iterator[Diagnostic]:
    """Identifiers are within their range and differ on one bus."""
    first: dict[tuple[str, bool, int], Message] = {}
    for item in resolved.system.frames:
        last = EXTENDED_LAST if item.extended else STANDARD_LAST
        if item.identifier > last:
            bits = 29 if item.extended else 11
            message = (
                f"the identifier {item.identifier:#x} of {item.name} is above {last:#x}, the last "
                f"of {bits} bits"
            )
            hint = None if item.extended else "add `extended: true` for 29 bits"
            yield error("RV-0607", item.origin, message, hint=hint)
        other = first.setdefault((item.bus, item.extended, item.identifier), item)
        if other is not item:
            message = f"{item.name} and {other.name} both have the identifier {item.identifier:#x}"
            notes = [(other.origin, f"{other.name} is here")]
            yield error("RV-0607", item.origin, message, notes=notes, hint="change one of them")


def payloads_fit(resolved: Resolved) -> Iterator[Diagnostic]:
    """The signals of a message fit its CAN frame."""
    for item in (m for m in resolved.system.messages if not m.controls):
        bits = bits_of(item.signals)
        room = room_of(fd=item.fd or item.transport is not None)
        if bits > room:
            widths = ", ".join(f"{one.field or item.name} {one.width}" for one in item.signals)
            shortened = widths if len(widths) <= 200 else widths[:197] + "..."
            message = f"{item.name} needs {bits} bits for {item.type.name}; a frame has {room}"
            larger = "" if item.fd else ", or let its bus carry CAN FD (`format: fd`, `data_rate`)"
            hint = f"narrow its ranges or split it{larger}; bits by field: {shortened}"
            notes = [(item.type.origin, f"{item.type.name} is declared here")]
            yield error("RV-0610", item.origin, message, notes=notes, hint=hint)


def one_step_regions_send_messages(resolved: Resolved) -> Iterator[Diagnostic]:
    """A message's period is its sender's only when that sends once in an execution."""
    system = resolved.system
    for item in system.messages:
        if item.source is None or item.transmission is not None:
            continue  # of those with a mode one frame goes at the end of an execution
        component = system.instance(item.source.instance).component
        for region in component.regions:
            if item.source.name in region.sends and region.steps_per_execution > 1:
                message = (
                    f"{region.name} makes up to {region.steps_per_execution} steps in one "
                    f"execution, so {item.name} may be sent more often than once in its period"
                )
                notes = [(region.origin, f"{region.name} is declared here")]
                hint = "let the region make one step, or send from an activity"
                yield error("RV-0611", item.origin, message, notes=notes, hint=hint)


def messages_have_one_sender(resolved: Resolved) -> Iterator[Diagnostic]:
    """One region or activity sends a message: its period is that row's."""
    for item in resolved.system.messages:
        if item.source is None:
            continue
        component = resolved.system.instance(item.source.instance).component
        senders = [one for one in component.runnables() if item.source.name in one.sends]
        for other in senders[1:]:
            message = (
                f"{senders[0].name} and {other.name} both send {item.name}, so it may be sent more "
                "often than once in its period"
            )
            notes = [(one.origin, f"{one.name} is declared here") for one in (senders[0], other)]
            hint = "let one of them send, or give each a port and a message of its own"
            yield error("RV-0611", item.origin, message, notes=notes, hint=hint)


# --- Processors --------------------------------------------------------------------


def sections_are_part_of_work(resolved: Resolved) -> Iterator[Diagnostic]:
    """The time inside a protected operation is part of some worst-case execution time."""
    system = resolved.system
    for node in system.nodes:
        here = [p for p in system.processors if p.slots and p.node == node.name]
        runs = [(p.origin, f"all of {p.name}", p.wcet) for p in here]
        runs += [(bus.origin, f"the driver of {bus.name}", bus.driver_wcet) for bus in system.buses]
        if node.probe is not None:
            runs.append((node.origin, "the probe", node.probe.wcet))
        if node.supervision is not None:
            runs.append((node.origin, "the supervision", node.supervision.wcet))
        if node.stream is not None:
            runs.append((node.stream.origin, "the stream", node.stream.wcet))
        short = min(runs, key=lambda run: run[2], default=None)
        if short is not None and short[2] < node.critical_section:
            message = (
                f"the critical section of {node.name} may take {shown(node.critical_section)}, "
                f"longer than {short[1]}, {shown(short[2])}"
            )
            notes = [(short[0], "that is given here")]
            hint = "a worst-case execution time includes protected operations: raise it"
            yield error("RV-0709", node.origin, message, notes=notes, hint=hint)


def _rows(system: System) -> Iterator[tuple[Processor, Slot]]:
    for processor in system.processors:
        for slot in processor.slots:
            yield processor, slot


def rows_are_allocated_once(resolved: Resolved) -> Iterator[Diagnostic]:
    """Each region, activity and port region of each instance is in one table, once."""
    system = resolved.system
    first: dict[str, tuple[Processor, Slot]] = {}
    for processor, slot in _rows(system):
        if slot.of_bus:
            continue
        known, at = first.setdefault(slot.element, (processor, slot))
        if at is not slot:
            where = "twice" if known is processor else f"to {known.name} and {processor.name}"
            message = f"{slot.element} is allocated {where}"
            notes = [(at.origin, "the first is here")]
            yield error("RV-0702", slot.origin, message, notes=notes, hint="remove one of the rows")
    if not {"processors", "instances"} <= resolved.sound_sections:
        return
    for instance in system.instances:
        component = instance.component
        names = [*component.handlers(), *(item.name for item in component.runnables())]
        missing = [name for name in names if f"{instance.name}.{name}" not in first]
        if missing:
            listed = ", ".join(f"{instance.name}.{name}" for name in missing)
            verb = "is" if len(missing) == 1 else "are"
            hint = "add it to the `activities:` of a processor"
            hint = hint if len(missing) == 1 else hint.replace("it", "them", 1)
            message = f"{listed} {verb} not allocated to any processor"
            yield error("RV-0701", instance.origin, message, hint=hint)


def rows_are_on_their_node(resolved: Resolved) -> Iterator[Diagnostic]:
    """A processor runs only what is on its node."""
    system = resolved.system
    for processor, slot in _rows(system):
        if slot.of_bus:
            continue
        instance = system.instance(slot.owner)
        if instance.node != processor.node:
            message = (
                f"{slot.element} is on {instance.node}, but {processor.name} is on {processor.node}"
            )
            yield error("RV-0707", slot.origin, message)


def reception_has_its_processor(resolved: Resolved) -> Iterator[Diagnostic]:
    """A sporadic processor holds its bus's reception and nothing else."""
    system = resolved.system
    for processor in system.processors:
        if processor.released_by_value is not None:
            continue  # see `releases`
        for slot in processor.slots:
            is_reception = slot.work is Work.BUS_RECEIVE
            if processor.released_by is not None and (
                not is_reception or slot.owner != processor.released_by
            ):
                message = (
                    f"{processor.name} is released by {processor.released_by}, but holds "
                    f"{slot.element}"
                )
                hint = f"its table is `- {processor.released_by}.receive`, and nothing else"
                yield error("RV-0705", slot.origin, message, hint=hint)
    if not {"processors", "messages"} <= resolved.sound_sections:
        return
    for bus, node in product(system.buses, system.nodes):
        receives = bool(system.received(bus.name, node.name))
        serving = [
            (processor, slot)
            for processor, slot in _rows(system)
            if slot.work is Work.BUS_RECEIVE
            and (slot.owner, processor.node) == (bus.name, node.name)
        ]
        for _, slot in serving[1:]:
            message = f"{slot.element} is allocated twice"
            notes = [(serving[0][1].origin, "the first is here")]
            yield error("RV-0706", slot.origin, message, notes=notes, hint="remove one of the rows")
        if receives and not serving:
            where = "" if len(system.nodes) == 1 else f" on {node.name}"
            message = f"no processor receives the messages of {bus.name}{where}"
            hint = (
                f"add a processor with `released_by: {bus.name}` and the row `{bus.name}.receive`"
            )
            yield error("RV-0706", bus.origin, message, hint=hint)
        if serving and not receives:
            message = f"{serving[0][1].element} has nothing to do: no message comes in"
            yield error("RV-0706", serving[0][1].origin, message, hint="remove the processor")


def outputs_are_sent(resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning for each output port that no region or activity sends on."""
    for component in resolved.system.components:
        if component.name in resolved.damaged:
            continue
        sent = {name for item in component.runnables() for name in item.sends}
        for port in component.ports:
            if port.direction is Direction.OUT and port.name not in sent:
                verb = "calls" if port.is_command else "sends on"
                message = f"nothing in {component.name} {verb} `{port.name}`"
                yield warning("RV-0512", port.origin, message)


RULES: tuple[Rule, ...] = (
    types_do_not_hide_units,
    connected_ends_agree,
    messages_agree,
    inputs_have_one_source,
    outputs_lead_somewhere,
    outputs_are_sent,
    identifiers_are_unique,
    payloads_fit,
    one_step_regions_send_messages,
    messages_have_one_sender,
    sections_are_part_of_work,
    rows_are_allocated_once,
    rows_are_on_their_node,
    periods_are_multiples,
    offsets_are_shorter_than_periods,
    reception_has_its_processor,
    *RELEASE_RULES,
    *INTERRUPT_RULES,
    *RECORDING_RULES,
)
