# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Consequences of a valid model: tables, priorities, tasks and shared objects.

All times are in ns, and every figure is on the safe side.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import lru_cache

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.nodes import PROBE, SUPERVISOR, Node
from ravenchart.gen.model.system import (
    Processor,
    SharedObject,
    Slot,
    System,
    Task,
)

from .distribution import as_one, part_of, without_idle_buses
from .executive import spread
from .senders import sender_of, sending_rows
from .sharing import objects_on_node
from .ways import routed

# --- Tables ------------------------------------------------------------------------


def table_period(slots: Iterable[Slot], *, cyclic: bool = False) -> Ns | None:
    """The shortest period in a table, of a cyclic executive the minor cycle; None for an empty one.

    The minor cycle is the longest time that divides all periods.
    """
    periods = [slot.timing.period for slot in slots]
    return min(periods, default=None) if not cyclic or not periods else Ns(math.gcd(*periods))


def table_deadline(slots: Iterable[Slot], period: Ns) -> Ns:
    """The shortest deadline in a table, at most the processor's period."""
    return min((slot.timing.deadline for slot in slots), default=period)


def _with_divisors(processor: Processor) -> Processor:
    """Each row's divisor: how many releases lie between two of its runs, and its phase."""
    period = processor.period
    slots = tuple(
        replace(slot, divisor=slot.timing.period // period, phase=slot.after // period)
        for slot in processor.slots
    )
    deadline = min(processor.deadline, processor.period)
    found = replace(processor, slots=slots, deadline=deadline)
    return spread(found) if processor.cyclic else found


# --- Priorities --------------------------------------------------------------------


def prioritised(processors: Sequence[Processor]) -> tuple[Processor, ...]:
    """The processors with priorities: given ones kept, the others deadline-monotonic.

    The shorter the deadline the larger the number; of two with one deadline
    the earlier in the model has the larger. Numbers count from 1 and step over
    given ones.
    """
    taken = {processor.priority for processor in processors if processor.priority}
    free = (number for number in range(1, len(processors) + len(taken) + 1) if number not in taken)
    order = sorted(
        (index for index, processor in enumerate(processors) if not processor.priority),
        key=lambda index: (-processors[index].deadline, -index),
    )
    chosen = dict(zip(order, free, strict=False))
    return tuple(
        replace(processor, priority=chosen.get(index, processor.priority))
        for index, processor in enumerate(processors)
    )


# --- Tasks -------------------------------------------------------------------------


def tasks_of(system: System) -> tuple[Task, ...]:
    """Processors in model order, then for each message the driver's work on it.

    A driver has two tasks, one that receives and one that transmits, both of the priority
    above all processors. Each serves one frame at a time, so one entry for each message, at
    the message's period, describes its work. The processor that sends the frame, or the
    frame's arrival, releases the entry.
    """
    tasks = [
        Task(
            element=processor.name,
            origin=processor.origin,
            node=processor.node,
            period=processor.period,
            offset=processor.offset,
            deadline=processor.deadline,
            wcet=processor.wcet,
            priority=processor.priority,
            slots=processor.slots,
            sporadic=processor.released_by is not None,
            timed=True,
            core=processor.core,
        )
        for processor in system.processors
    ]
    top = max((processor.priority for processor in system.processors), default=0)
    for message in system.messages:
        bus = system.bus(message.bus)
        ways: list[tuple[str, str, str | None]] = []
        home = system.sender(message)
        if home is not None:
            ways.append((message.sending, home, sender_of(system, message)))
        ways += [(one.driver, one.node, message.element) for one in system.receptions(message)]
        tasks += [
            Task(
                element=driver,
                origin=message.origin,
                node=node,
                period=message.period,
                offset=Ns(0),
                deadline=message.limit,
                wcet=bus.driver_wcet,
                priority=top + 1,
                released_by=releaser,
                core=driver_core(system, bus, node),
                driver_of=bus.name,
            )
            for driver, node, releaser in ways
        ]
    above = top + (2 if system.messages else 1)
    for released in system.processors:
        if (line := released.released_by_interrupt) is not None:
            host, interrupt = system.node(line.node), system.node(line.node).interrupt(line.name)
            level = above + (host.supervision is not None) + (host.probe is not None)
            times = released.period, released.period, interrupt.wcet
            made = _own_task(host, interrupt.name, *times, level)
            tasks.append(replace(made, origin=interrupt.origin, timed=False, sporadic=True))
    for host in system.nodes:
        if (one := host.supervision) is not None:
            tasks.append(_own_task(host, SUPERVISOR, one.period, one.period, one.wcet, above))
        if (probe := host.probe) is not None:
            priority = above + (host.supervision is not None)
            tasks.append(_own_task(host, PROBE, probe.period, probe.deadline, probe.wcet, priority))
    return tuple(tasks)


def _own_task(host: Node, name: str, period: Ns, deadline: Ns, wcet: Ns, priority: int) -> Task:
    """A periodic task of the node itself."""
    return Task(
        element=f"{host.name}.{name}",
        origin=host.origin,
        node=host.name,
        period=period,
        offset=Ns(0),
        deadline=deadline,
        wcet=wcet,
        priority=priority,
        timed=True,
    )


def driver_core(system: System, bus: Bus, node: str) -> int:
    """The core of a bus's driver on a node: that of its reception, or else of the first sender."""
    for processor in system.processors:
        if processor.released_by == bus.name and processor.node == node:
            return processor.core
    for message in system.messages:
        if message.bus == bus.name and system.sender(message) == node:
            for row in sending_rows(system, message):
                return system.processor_of(row).core
    return 1


# --- Programs ----------------------------------------------------------------------


def programs(system: System) -> tuple[System, ...]:
    """The part of the system on each node, as a system of its own; with one node all of it.

    Nodes without a processor have no program, and a bus that the node only knows has no code.
    """
    return (without_idle_buses(system),) if len(system.nodes) == 1 else _programs(system)


@lru_cache(maxsize=1)
def _programs(system: System) -> tuple[System, ...]:
    busy = {processor.node for processor in system.processors}
    return tuple(_program(system, node) for node in system.nodes if node.name in busy)


def _program(system: System, node: Node) -> System:
    """The part of a system on a node, with its tasks and objects."""
    part = part_of(system, node)
    part = replace(part, tasks=tuple(task for task in system.tasks if task.node == node.name))
    return replace(part, objects=objects_on_node(part))


def on_one_node(system: System) -> System:
    """The same components on one node, with the objects that they share there."""
    one = as_one(system)
    return one if one is system else replace(one, objects=objects_on_node(one))


def on_one_core(system: System) -> System:
    """The same with all tasks of its only node on one core, and the objects that they share."""
    if all(task.core == 1 for task in system.tasks):
        return system
    one = replace(
        system,
        nodes=tuple(replace(node, cores=1) for node in system.nodes),
        processors=tuple(replace(processor, core=1) for processor in system.processors),
        tasks=tuple(replace(task, core=1) for task in system.tasks),
    )
    return replace(one, objects=objects_on_node(one))


def objects_of(system: System) -> tuple[SharedObject, ...]:
    """Every protected object of the generated programs, with its users and ceiling.

    ``system`` has its tasks. Where there are several nodes, an object of which each may have one
    of the same name has the node's name in front.
    """
    parts = programs(system)
    if len(parts) == 1:
        return objects_on_node(parts[0])
    return tuple(
        replace(item, element=f"{item.node}.{item.element}") if item.on_each_node else item
        for part in parts
        for item in objects_on_node(part)
    )


def completed(system: System) -> System:
    """A valid system with divisors, priorities, tasks, shared objects and the ways of chains."""
    processors = prioritised([_with_divisors(processor) for processor in system.processors])
    told = replace(system, processors=processors)
    told = routed(replace(told, tasks=tasks_of(told)))
    return replace(told, objects=objects_of(told))
