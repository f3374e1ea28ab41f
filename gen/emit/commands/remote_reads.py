# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Read commands between nodes: how an instance publishes, and the copies of its readers."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import publications
from ravenchart.gen.emit.ada.declarations import Decl, GenericInstance, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import arguments, number
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, priority, type_name, value
from ravenchart.gen.emit.ada.statements import Comment, Do, IfStatement, Stmt, do
from ravenchart.gen.emit.tables.trace_calls import fault_units
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.commands import Need, RemoteRead
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System

from .remote_calls import CALLS


def copies(system: System, instance: Instance) -> tuple[RemoteRead, ...]:
    """The read commands that an instance has from other nodes."""
    own = (b.provider for b in system.bindings if b.instance == instance.name)
    return tuple(provider for provider in own if isinstance(provider, RemoteRead))


def published_afar(system: System, instance: Instance) -> tuple[Message, ...]:
    """The messages by which an instance publishes to other nodes."""
    rows = instance.component.runnables()
    return tuple(m for row in rows for m in publications(system, instance.name, row))


def read_units(system: System, instance: Instance) -> Iterator[DottedName]:
    """The units that the body of an instance needs for all of this."""
    root = ada_case(system.name)
    if copies(system, instance):
        yield from (CALLS, ref("Ravenchart.Remote_Reads"))
        yield from fault_units(root)
    for message in published_afar(system, instance):
        yield ref(root, ada_case(message.bus))
        if message.every > 1:
            yield from (ref("Ravenchart"), CALLS)


def copy_name(need: Need) -> str:
    """The object that keeps the value that came last."""
    return f"{ada_case(need.name)}_Copy"


def copy_objects(system: System, instance: Instance) -> Iterator[Decl]:
    """The values that came last, and the turns of what is published."""
    for read in copies(system, instance):
        assert read.need.reply is not None
        element = f"{instance.name}.{read.need.name}"
        yield Comment(f"[{element}] the last value from another node")
        args = arguments(
            Element_Type=type_name(system, read.need.reply),
            Initial=value(system, read.need.reply, read.initial),
            Limit=number(read.executions),
            Ceiling=priority(system.object(f"{element}.read").ceiling),
        )
        yield GenericInstance(copy_name(read.need), "Ravenchart.Remote_Reads", args)
    for message in published_afar(system, instance):
        if message.every > 1:
            yield Comment(f"[{message.name}] the executions until the message is sent")
            yield Object(_left(message), "Ravenchart.Execution_Count", number(0))


def _left(message: Message) -> str:
    return f"{ada_case(message.name)}_Left"


def kept(system: System, instance: Instance) -> Iterator[tuple[Subprogram, Subprogram]]:
    """For each value that comes from another node, spec and body of the procedure that keeps it."""
    for read in copies(system, instance):
        assert read.need.reply is not None
        params = (Param("Item", "in", type_name(system, read.need.reply)),)
        name = f"Put_{ada_case(read.need.name)}"
        put = do(ref(copy_name(read.need), "Put"), ref("Item"))
        yield Subprogram(name, params), Subprogram(name, params, body=(put,))


def publishes(
    system: System, instance: Instance, row: Region | Activity, declarations: list[Decl]
) -> Iterator[Stmt]:
    """The last statements of a row that writes published data: it sends those whose turn it is."""
    for message in publications(system, instance.name, row):
        assert message.source is not None
        item = ada_case(message.source.name)
        held = ref(f"{item}_Own")
        if isinstance(row, Region):
            held = ref(f"{ada_case(row.name)}_Region", "Data", item)
        sent = do(ref(ada_case(message.bus), f"Send_{ada_case(message.name)}"), held)
        if message.every == 1:
            yield sent
            continue
        due = f"{ada_case(message.name)}_Due"
        declarations.append(Object(due, "Boolean"))
        turn = arguments(ref(_left(message)), Every=number(message.every), Is_Due=ref(due))
        yield Do(ref(CALLS, "Take_Turn"), turn)
        yield IfStatement(((ref(due), (sent,)),))
