# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for processors with a logical execution time: what leaves them does so at its instants.

Values of sampled ports alone become visible at given instants. All else that another processor of
the node sees of such a one would depend on when its rows happen to run.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.derive.calls import asking, serving
from ravenchart.gen.derive.completion import programs
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.commands import Server
from ravenchart.gen.model.component import PortKind
from ravenchart.gen.model.instances import Connection, End
from ravenchart.gen.model.logical import LogicalLink, logical_links
from ravenchart.gen.model.system import Carried, Processor, Stop, System

CODE = "RV-0717"

MOST_KEPT = 256
"""Values that a mailbox keeps at most."""


def visible_at_instants(system: System) -> Iterator[Diagnostic]:
    """Only values of sampled ports leave a processor that has a logical execution time.

    ``system`` is completed. Of an instance on several processors that is all that is said.
    """
    yield from _chains(system)
    asked = any(processor.logical is not None for processor in system.processors)
    if not (asked or logical_links(system)):
        return
    for part in programs(system):
        divided = list(_divided_instances(part))
        yield from divided or (*_connections(part), *_commands(part), *_depths(part))


def _chains(system: System) -> Iterator[Diagnostic]:
    """Values of a logical chain go between processors of a node by sampled ports."""
    chains = [chain for chain in system.chains if chain.logical]
    links = logical_links(system) if chains else ()
    rows = {slot.element for slot in system.slots}
    for chain in chains:
        before: Stop | None = None
        over: list[Stop] = []
        for stop in chain.way:
            if str(stop) not in rows:
                over.append(stop)
                continue
            carried = any(isinstance(one, Carried) for one in over)
            told = None if before is None or carried else _early(system, links, before, over, stop)
            told = told or _handled_elsewhere(system, over, stop)
            if told is not None:
                message = f"the chain {chain.name} has logical execution times, but {told}"
                yield error(CODE, chain.origin, message, hint=_BY_PORTS)
            before, over = stop, []


_BY_PORTS = "let a sampled port bring the values to a periodic processor, or use one processor"


def _early(
    system: System, links: Sequence[LogicalLink], before: Stop, over: Sequence[Stop], after: Stop
) -> str | None:
    """How values go from one row to another on its node before the end of a period."""
    sender, receiver = (system.processor_of(str(one)) for one in (before, after))
    known = any(str(before) in one.rows and one.connection.target in over for one in links)
    if known or sender.name == receiver.name:
        return None
    way = f"{before} on {sender.name} to {after} on {receiver.name}"
    return f"values go from {way} without instants"


def _handled_elsewhere(system: System, over: Sequence[Stop], row: Stop) -> str | None:
    """How another processor handles the port that a row reads."""
    port = over[-1] if over else None
    if not isinstance(port, End):
        return None
    inputs = system.instance(port.instance).component.inputs()
    if all(one.name != port.name for one in inputs):
        return None
    handler = system.handler(port)
    one, other = (system.processor_of(each).name for each in (handler, str(row)))
    told = f"{handler} on {one} takes the values that {row} on {other} reads"
    return None if one == other else told


def _divided_instances(system: System) -> Iterator[Diagnostic]:
    """All rows of an instance are on such a processor, or none."""
    for instance in system.instances:
        rows = [slot.element for slot in system.slots_of(instance.name)]
        homes = {row: system.processor_of(row) for row in rows}
        logical = next((p for p in homes.values() if p.logical is not None), None)
        away = next((e for e, p in homes.items() if logical and p.name != logical.name), None)
        if logical is not None and away is not None:
            message = (
                f"{instance.name} has rows on {logical.name}, which has a logical execution time, "
                f"and {away} on {homes[away].name}"
            )
            hint = "put all rows of the instance on one processor"
            yield error(CODE, homes[away].origin, message, hint=hint)


def _connections(system: System) -> Iterator[Diagnostic]:
    """Values of sampled ports, to periodic processors."""
    for connection in system.connections:
        sender = _logical(system, connection)
        receiver = system.processor_of(system.handler(connection.target))
        if sender is None or sender.name == receiver.name:
            continue
        name = f"{connection.target}, on {receiver.name},"
        port = system.instance(connection.target.instance).component.port(connection.target.name)
        if port.kind is PortKind.QUEUED:
            message = f"{name} is queued, but {sender.name} has a logical execution time"
            hint = "make the port sampled, or put it on the processor that sends"
            yield error(CODE, connection.origin, message, hint=hint)
        elif receiver.released_by is not None:
            message = f"{name} has no releases by time, and {sender.name} a logical execution time"
            hint = "let a periodic processor take the values"
            yield error(CODE, connection.origin, message, hint=hint)


def _logical(system: System, connection: Connection) -> Processor | None:
    """The processor with a logical execution time that sends on a connection."""
    source = system.instance(connection.source.instance)
    rows = source.component.senders(connection.source.name)
    homes = (system.processor_of(f"{source.name}.{row.name}") for row in rows)
    return next((home for home in homes if home.logical is not None), None)


def _commands(system: System) -> Iterator[Diagnostic]:
    """No call, reply or published item goes between such a processor and another one."""
    for binding in system.bindings:
        if not isinstance(binding.provider, Server):
            continue
        server = system.processor_of(str(serving(binding.provider)))
        for row in asking(system, binding):
            caller = system.processor_of(str(row))
            logical = next((p for p in (caller, server) if p.logical is not None), None)
            if logical is not None and caller.name != server.name:
                message = (
                    f"{row} on {caller.name} uses {binding.need.command.name} of "
                    f"{binding.provider.instance} on {server.name}, and {logical.name} has a "
                    "logical execution time"
                )
                hint = "put both on one processor, or give the values by a sampled port"
                yield error(CODE, binding.origin, message, hint=hint)
                break


def _depths(system: System) -> Iterator[Diagnostic]:
    """A mailbox keeps as many values as a slow receiver may find."""
    for link in logical_links(system):
        if link.depth > MOST_KEPT:
            yield error(CODE, link.connection.origin, _too_many(link), hint=_SHORTER)


_SHORTER = "give the receiver a shorter deadline, or let the sender send less often"


def _too_many(link: LogicalLink) -> str:
    return (
        f"{link.connection.target} would keep {link.depth} values, and may keep {MOST_KEPT}: "
        f"{link.receiver.name} has {shown(link.receiver.deadline)} to take one"
    )
