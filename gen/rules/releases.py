# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for processors that a queued port or an interface releases: these, and their tables.

A value of one periodic row releases the processor. Its table handles that value and nothing
else, so no row of it counts executions as time, and none waits for a value that another port has.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ravenchart.gen.derive.calls import asking, callers_of
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.terms import named
from ravenchart.gen.model.commands import Binding, Device, Gathered, Provided, Remote, Server
from ravenchart.gen.model.component import PortKind
from ravenchart.gen.model.instances import Connection, End, Instance, Requests
from ravenchart.gen.model.system import Processor, System, Work
from ravenchart.gen.resolve.releasers import UNFIT_PORT
from ravenchart.gen.resolve.system import Resolved

from .event_releases import events_can_release
from .released_tables import TABLE, Problem, other_period


def ports_can_release(resolved: Resolved) -> Iterator[Diagnostic]:
    """The port is queued, one periodic row sends to it, and its instance has nothing else."""
    system = resolved.system
    for processor in system.processors:
        port = processor.released_by_port
        if port is None:
            continue
        instance = system.instance(port.instance)
        if instance.component.name in resolved.damaged:
            continue
        whole = {"processors", "messages", "connections"} <= resolved.sound_sections
        whole = whole and _is_queued(instance, port)
        senders = _of_senders(system, port) if whole else iter(())
        at = processor.released_at or processor.origin
        for problem in (*_of_port(instance, port), *_of_instance(system, instance, port), *senders):
            message, declared, words, hint = problem
            notes = [(declared, words)]
            yield error(UNFIT_PORT, at, message, notes=notes, hint=hint)


def tables_handle_the_port(resolved: Resolved) -> Iterator[Diagnostic]:
    """The port region of the instance first, then activities of it, in each release."""
    for processor in resolved.system.processors:
        port = processor.released_by_port
        if port is None or "processors" not in resolved.sound_sections:
            continue
        if not _is_queued(resolved.system.instance(port.instance), port):
            continue  # that is an error of its own, and perhaps another port is meant
        handler = resolved.system.handler(port)
        if not processor.slots or processor.slots[0].element != handler:
            message = f"{processor.name} is released by {port}, but does not handle it first"
            yield error(TABLE, processor.origin, message, hint=f"begin its table with `{handler}`")
        for slot in processor.slots:
            fits = slot.work is Work.ACTIVITY or slot.element == handler
            if slot.owner != port.instance or not fits:
                message = f"{processor.name} is released by {port}, but holds {slot.element}"
                hint = "move it to a periodic processor"
                if slot.work is Work.BUS_RECEIVE:
                    hint = f"move it to a processor with `released_by: {slot.owner}`"
                if not slot.of_bus and slot.owner != port.instance:
                    hint += f"; the table of {processor.name} has rows of {port.instance} only"
                yield error(TABLE, slot.origin, message, hint=hint)
            else:
                yield from other_period(processor, slot)


def _is_queued(instance: Instance, end: End) -> bool:
    return instance.component.port(end.name).kind is PortKind.QUEUED


def _of_port(instance: Instance, end: End) -> Iterator[Problem]:
    """The errors of the port itself."""
    port = instance.component.port(end.name)
    declared = port.origin, f"`{port.name}` is declared here"
    if not _is_queued(instance, end):
        message = f"{end} is sampled: only the values of a queued port release a processor"
        yield message, *declared, "add `kind: queued` and a `depth` to the port"
    if port.max_age is not None:
        message = f"{end} has `max_age`, but nothing looks at it while no value comes"
        yield message, *declared, "remove `max_age`, or let a periodic processor handle the port"


def _of_instance(system: System, instance: Instance, end: End) -> Iterator[Problem]:
    """Other elements of the component that need time or another port."""
    component = instance.component
    cannot = f"{end} cannot release a processor"
    apart = "put it into a component of its own, on a periodic processor"
    for region in component.regions:
        message = f"{cannot}: {component.name} has the region {region.name}, which counts time"
        yield message, region.origin, f"{region.name} is declared here", apart
    for invariant in component.invariants:
        message = f"{cannot}: {component.name} has the invariant {invariant.name}"
        words = f"{invariant.name} is declared here"
        yield (
            message,
            invariant.origin,
            words,
            "remove it: `check` proves it for periodic rows only",
        )
    called = any(one.name == end.name for one in component.provides)
    row = component.handler(end.name)
    for port in component.inputs() if called else component.handled(row):
        if port.name != end.name:
            words, hint = f"{component.name} has", apart
            if not called:
                words, hint = f"its row {row} handles", f"put `{end.name}` into a group of its own"
            message = f"{cannot}: {words} another input port, `{port.name}`"
            yield message, port.origin, f"`{port.name}` is declared here", hint
    for provided in component.provides:
        if provided.name == end.name:
            continue
        message = f"{cannot}: {component.name} provides the interface `{provided.name}`"
        yield message, provided.origin, f"`{provided.name}` is declared here", apart
    for activity in component.activities:
        if activity.while_in is not None:
            message = f"{cannot}: {activity.name} has `while`, so it is periodic"
            yield message, activity.origin, f"{activity.name} is declared here", apart
    for binding in system.bindings:
        provider = binding.provider
        if binding.instance == instance.name and not isinstance(provider, Device | Gathered | None):
            need = binding.need.command.name
            message = f"{cannot}: {instance.name} calls `{need}` of another component"
            yield message, binding.origin, "that is bound here", "bind it to a device"
    for sent in system.messages:
        if sent.source is not None and sent.source.instance == instance.name:
            message = f"{cannot}: {sent.source} is sent as the message {sent.name}"
            words = f"{sent.name} is declared here"
            yield message, sent.origin, words, "let a periodic activity send the message"


def _of_senders(system: System, end: End) -> Iterator[Problem]:
    """The sender to the port must be one activity or region of a periodic processor."""
    cannot = f"{end} cannot release a processor"
    periodic = "let one row of a periodic processor send to it over a connection"
    for message in system.messages:
        if end in message.targets:
            text = f"{cannot}: its values are those of the message {message.name}"
            yield text, message.origin, f"{message.name} is declared here", periodic
    for poll in system.polls:
        if (poll.instance, poll.port) == (end.instance, end.name):
            text = f"{cannot}: its values are those of the device {poll.device.name}"
            yield text, poll.origin, "that is bound here", periodic
    for connection in system.connections:
        if connection.target == end:
            yield from _of_connection(system, connection, cannot, periodic)


def _of_connection(
    system: System, connection: Connection, cannot: str, periodic: str
) -> Iterator[Problem]:
    source = system.instance(connection.source.instance)
    senders = source.component.senders(connection.source.name)
    if len(senders) > 1:
        names = " and ".join(f"{source.name}.{one.name}" for one in senders)
        yield (
            f"{cannot}: {names} both send to it",
            connection.origin,
            "over this connection",
            periodic,
        )
        return
    for sender in senders:
        element = f"{source.name}.{sender.name}"
        words = f"{sender.name} is declared here"
        if (processor := _runs(system, element)) is not None and processor.released_by:
            text = f"{cannot}: {element} sends to it, which {processor.released_by} releases"
            yield text, processor.origin, f"{processor.name} runs it", periodic
        elif source.component.served_by(sender.name) is not None:
            text = f"{cannot}: {element} sends to it, which serves calls"
            yield text, sender.origin, words, periodic


def _runs(system: System, element: str) -> Processor | None:
    """The processor of a row, if one has it."""
    rows = ((slot.element, one) for one in system.processors for slot in one.slots)
    return next((one for name, one in rows if name == element), None)


# --- Calls of an interface -------------------------------------------------------------


def calls_can_release(resolved: Resolved) -> Iterator[Diagnostic]:
    """One periodic row calls the interface, and its instance has nothing that needs time."""
    system = resolved.system
    for processor in system.processors:
        called = processor.released_by
        if not isinstance(called, Requests):
            continue
        instance = system.instance(called.instance)
        if instance.component.name in resolved.damaged:
            continue
        at = processor.released_at or processor.origin
        provided = named(instance.component.provides, called.name)
        end = End(called.instance, called.name)
        problems = [*_of_instance(system, instance, end)]
        if not problems and {"processors", "instances"} <= resolved.sound_sections:
            problems += _of_callers(system, instance, provided)
        for message, declared, words, hint in problems:
            yield error(UNFIT_PORT, at, message, notes=[(declared, words)], hint=hint)
        if "processors" in resolved.sound_sections and provided.server is not None:
            yield from _serves(processor, instance, provided.server)


def _serves(processor: Processor, instance: Instance, server: str) -> Iterator[Diagnostic]:
    """The row that executes the calls first, then activities of the instance, in each release."""
    first = f"{instance.name}.{server}"
    if not processor.slots or processor.slots[0].element != first:
        message = f"{processor.name} is released by {processor.released_by}, but does not begin "
        message += f"with {first}, which executes its calls"
        yield error(TABLE, processor.origin, message, hint=f"begin its table with `{first}`")
    for slot in processor.slots:
        if slot.owner != instance.name or slot.work is not Work.ACTIVITY:
            message = f"{processor.name} is released by {processor.released_by}, but holds "
            message += slot.element
            hint = "move it to a periodic processor"
            yield error(TABLE, slot.origin, message, hint=hint)
        else:
            yield from other_period(processor, slot)


def _of_callers(system: System, instance: Instance, provided: Provided) -> Iterator[Problem]:
    """The calls come from one row of a periodic processor of the same node."""
    cannot = f"{instance.name}.{provided.name} cannot release a processor"
    periodic = "let one row of a periodic processor call it"
    for binding in system.bindings:
        remote = binding.provider
        if isinstance(remote, Remote) and remote.server == Server(instance.name, provided):
            message = f"{cannot}: {binding.instance} calls it from another node"
            yield message, binding.origin, "that is bound here", periodic
    rows: dict[str, Binding] = {}
    for binding in callers_of(system, instance.name, provided):
        for place in asking(system, binding):
            rows.setdefault(str(place), binding)
    for row, binding in list(rows.items())[1:]:
        message = f"{cannot}: {next(iter(rows))} and {row} both call it"
        yield message, binding.origin, "that is bound here", periodic
    for row, binding in rows.items():
        caller, _, name = row.rpartition(".")
        component = system.instance(caller).component
        processor = _runs(system, row)
        if processor is not None and processor.released_by is not None:
            message = f"{cannot}: {row} calls it, which {processor.released_by} releases"
            yield message, binding.origin, "that is bound here", periodic
        elif component.served_by(name) is not None:
            message = f"{cannot}: {row} calls it, which serves calls itself"
            yield message, binding.origin, "that is bound here", periodic


RELEASE_RULES: tuple[Callable[[Resolved], Iterator[Diagnostic]], ...] = (
    ports_can_release,
    tables_handle_the_port,
    calls_can_release,
    events_can_release,
)
