# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A `System` as the records of `analysis.core`: the one place that knows both.

A processor is a task whose rows are those of its table; its context switches
and the timer come from the node's platform figures. The driver's work on a message
follows the job that sends it, or the frame that arrived; the frame follows the
driver. Every user of a protected object has a section of its own. A node's frames
leave in the order sent, by the contract of the controller, so they share a queue; the
driver may hand them over one by one. Periodic processors have their offsets: release k
is due at the node's epoch + offset + k periods, however late the one before was. The probe,
and the clocks of other nodes, are independent of that epoch.
"""

from __future__ import annotations

from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.frames import Bits, classic_bits, fd_bits, rank
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import TableRow, Task
from ravenchart.gen.model import buses, nodes
from ravenchart.gen.model import system as model
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System

SECOND = 10**9
"""Ticks are nanoseconds."""


def network_of(system: System) -> Network:
    """Tasks, frames, and the releases between them; names are those of the elements."""
    tasks = {task.element for task in system.tasks}
    released = {t.element: t.released_by for t in system.tasks if t.released_by is not None}
    for message in system.messages:
        if message.source is not None and message.sending in tasks:
            released[message.element] = message.sending
    return Network(
        tasks=tuple(_task(task, system) for task in system.tasks),
        frames={
            bus.name: tuple(_frame(m, bus, system) for m in system.frames if m.bus == bus.name)
            for bus in system.buses
        },
        buses={bus.name: _bus(bus) for bus in system.buses},
        released_by=released,
        sections=tuple(
            Section(item.element, user, item.section)
            for item in system.objects
            for user in item.users
            if item.section
        ),
        platforms={core: _platform(node) for node in system.nodes for core in node.core_names},
        ceilings={item.element: item.ceiling for item in system.objects},
    )


def _task(task: model.Task, system: System) -> Task:
    """A processor with its table, or a task whose jobs are all alike."""
    rows = tuple(
        TableRow(slot.element, slot.timing.wcet, slot.divisor, slot.phase) for slot in task.slots
    )
    return Task(
        name=task.element,
        priority=task.priority,
        period=task.period,
        deadline=task.deadline,
        wcet=0 if rows else task.wcet,
        jitter=task.jitter,
        core=system.node(task.node).core_name(task.core),
        rows=rows,
        timed=task.timed and system.node(task.node).tick is not None,
        sporadic=task.sporadic,
        suspensions=task.suspensions,
        offset=task.offset if task.slots and not task.sporadic else None,
    )


def _platform(node: nodes.Node) -> Platform:
    """The overheads of a node."""
    tick = node.tick
    period, wcet = (0, 0) if tick is None else (tick.period, tick.wcet)
    return Platform(node.context_switch, node.release, period, wcet)


def _frame(message: Message, bus: buses.Bus, system: System) -> Frame:
    """A message at its longest."""
    return Frame(
        name=message.element,
        rank=rank(message.identifier, extended=message.extended),
        period=message.period,
        deadline=message.limit,
        transmission_time=frame_length(message, bus).time(bus.bit_rate, bus.data_rate or 0),
        queue=system.queue(message),
        reloaded=system.queue(message) != "",
        sporadic=message.sporadic,
    )


def frame_length(message: Message, bus: buses.Bus) -> Bits:
    """The longest frame of a message, to the beginning of the next frame."""
    if message.fd:
        switched = bus.data_rate is not None
        return fd_bits(message.length, extended=message.extended, switched=switched)
    return classic_bits(message.length, extended=message.extended)


def _bus(bus: buses.Bus) -> Bus:
    """A bus; its bit time is rounded up."""
    errors = bus.errors
    model_of = None if errors is None else Errors(errors.period, errors.burst)
    return Bus(-(-SECOND // bus.bit_rate), errors=model_of)
