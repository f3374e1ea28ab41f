# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules on the faults of controllers that a bus reports to the model, and on their recovery."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.names import alike_in_databases
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import Slot, System, Work
from ravenchart.gen.resolve.authentication import AUTHENTICATION
from ravenchart.gen.resolve.layouts import DATABASE
from ravenchart.gen.resolve.protection import PROTECTION
from ravenchart.gen.resolve.system import Resolved
from ravenchart.gen.resolve.transport import TRANSPORT

FAULTS = "RV-0618"
"""A fault that cannot be noticed, or a recovery that no region can request."""

WATCH = "RV-0714"
"""A bus with `watch` that a node watches in no row, or in several."""


def buses_are_watched(resolved: Resolved) -> Iterator[Diagnostic]:
    """A bus with `watch` has that row once on each of its nodes, and on no other."""
    system = resolved.system
    if not {"processors", "messages"} <= resolved.sound_sections:
        return
    for bus in system.buses:
        joining = system.joining(bus.name)
        for node in system.nodes:
            rows: list[Slot] = [
                slot
                for processor in system.processors
                for slot in processor.slots
                if slot.work is Work.BUS_WATCH
                and (slot.owner, processor.node) == (bus.name, node.name)
            ]
            for slot in rows[1:]:
                message = f"{slot.element} is allocated twice"
                notes = [(rows[0].origin, "the first is here")]
                yield error(WATCH, slot.origin, message, notes=notes, hint="remove one of the rows")
            if rows and node.name not in joining:
                message = f"{rows[0].element} has nothing to watch: {node.name} neither sends nor "
                message += f"receives on {bus.name}"
                yield error(WATCH, rows[0].origin, message, hint="remove the row")
            if bus.watch is not None and node.name in joining and not rows:
                where = "" if len(system.nodes) == 1 else f" on {node.name}"
                message = f"no processor watches {bus.name}{where}"
                hint = f"add the row `{bus.name}.watch` to the table of a periodic processor{where}"
                yield error(WATCH, bus.origin, message, hint=hint)


def bus_events_can_come(resolved: Resolved) -> Iterator[Diagnostic]:
    """The events of a bus are of its nodes, and each of these can recover."""
    system = resolved.system
    if not {"processors", "messages", "instances"} <= resolved.sound_sections:
        return
    for bus in system.buses:
        joining = system.joining(bus.name)
        if not joining:
            continue  # all is on one node: nothing travels on it
        for instance, event in dict.fromkeys((*bus.raises, *bus.recovers_on)):
            home = system.instance(instance).node
            if home not in joining:
                message = f"{bus.name} names {instance}.{event}, but {instance} is on {home}, "
                message += f"which neither sends nor receives on {bus.name}"
                hint = f"name an event of an instance on {' or '.join(joining)}"
                yield error(FAULTS, bus.origin, message, hint=hint)
        able = {system.instance(instance).node for instance, _ in bus.recovers_on}
        for node in joining if bus.recovers_on else ():
            if node not in able:
                message = f"nothing on {node} can request recovery of its controller on {bus.name}"
                hint = f"add an event of an instance on {node} to `recovery: {{on: [...]}}`"
                yield error(FAULTS, bus.origin, message, hint=hint)


def protected_messages_differ(resolved: Resolved) -> Iterator[Diagnostic]:
    """No protected message has a data identifier that passes for that of another."""
    kept = [m for m in resolved.system.messages if m.protection is not None]
    for index, message in enumerate(kept):
        clash = next((other for other in kept[:index] if _passes(message, other)), None)
        if clash is not None:
            text = f"the CRC of {message.name} cannot distinguish its data identifier from that of "
            text += clash.name
            notes = [(clash.origin, f"`{clash.name}` is declared here")]
            hint = "give one of them another data identifier"
            yield error(PROTECTION, message.origin, text, notes=notes, hint=hint)


def _passes(message: Message, other: Message) -> bool:
    one, two = message.protection, other.protection
    return one is not None and two is not None and one.passes_for(two)


def authenticated_messages_differ(resolved: Resolved) -> Iterator[Diagnostic]:
    """No two messages of one key have the same data identifier."""
    first: dict[tuple[str, int], Message] = {}
    for message in resolved.system.messages:
        own = message.authentication
        if own is None:
            continue
        other = first.setdefault((own.key.lower(), own.data_id), message)
        if other is not message:
            text = f"{message.name} and {other.name} have the key {own.key} and the data "
            text += f"identifier {own.data_id}: a frame of one is authentic as the other"
            notes = [(other.origin, f"`{other.name}` is declared here")]
            hint = "give one of them another data identifier"
            yield error(AUTHENTICATION, message.origin, text, notes=notes, hint=hint)


def refusal_events_can_come(resolved: Resolved) -> Iterator[Diagnostic]:
    """The events of a message that is checked are of nodes that receive it."""
    system = resolved.system
    if not {"messages", "instances"} <= resolved.sound_sections:
        return
    for message in system.messages:
        homes = {system.home(end) for end in message.targets}
        for instance, event in () if message.check is None else message.check.on_error:
            home = system.instance(instance).node
            if home not in homes:
                text = f"{message.name} names {instance}.{event}, but {instance} is on {home}, "
                text += f"which does not receive {message.name}"
                where = " or ".join(sorted(homes)) or "a node that receives it"
                hint = f"name an event of an instance on {where}"
                code = PROTECTION if message.protection is not None else AUTHENTICATION
                yield error(code, message.origin, text, hint=hint)


def transports_have_two_ends(resolved: Resolved) -> Iterator[Diagnostic]:
    """A value in several frames goes to one port of another node; its flow control has a name."""
    system = resolved.system
    names = {message.name.lower(): message for message in system.frames}
    for message in system.messages:
        transport = message.transport
        if transport is None:
            continue
        if len(message.targets) > 1:
            ends = " and ".join(map(str, message.targets))
            text = f"{message.name} has `transport` and goes to {ends}: one receiver answers"
            hint = "give each receiver a message of its own"
            yield error(TRANSPORT, message.origin, text, hint=hint)
        other = names.get(transport.flow.lower())
        if other is not None and other.controls != message.name:
            text = f"the flow control of {message.name} is called {transport.flow}, like a message"
            notes = [(other.origin, f"{other.name} is declared here")]
            hint = "rename one of the messages"
            yield error(TRANSPORT, message.origin, text, notes=notes, hint=hint)


def names_in_databases(system: System) -> Iterator[Diagnostic]:
    """No two messages of a bus have one name in its database, those between nodes included."""
    for bus in system.buses:
        own = [message for message in system.frames if message.bus == bus.name]
        yield from _named_alike(own, f"the database of {bus.name}")


def _named_alike(elements: Sequence[Message | Node], place: str) -> Iterator[Diagnostic]:
    """An error for each with a `database_name` that another one of them has in databases."""
    for one, other in alike_in_databases(elements):
        if other is not None:
            text = f"{one.name} and {other.name} are both named `{one.in_database}` in {place}"
            notes = [(other.origin, f"{other.name} is declared here")]
            hint = "give one of them another `database_name`"
            yield error(DATABASE, one.origin, text, notes=notes, hint=hint)


def databases_tell_nodes_apart(resolved: Resolved) -> Iterator[Diagnostic]:
    """No two nodes have one name in the databases of their buses."""
    yield from _named_alike(resolved.system.nodes, "databases")


def databases_tell_messages_apart(resolved: Resolved) -> Iterator[Diagnostic]:
    """The same of the messages that the model declares."""
    yield from names_in_databases(resolved.system)


BUS_RULES = (
    databases_tell_nodes_apart,
    databases_tell_messages_apart,
    transports_have_two_ends,
    buses_are_watched,
    bus_events_can_come,
    protected_messages_differ,
    authenticated_messages_differ,
    refusal_events_can_come,
)
