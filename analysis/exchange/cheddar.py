# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Cheddar models (XML, version 3): each core and each bus checked on its own.

An item that another one releases has the inherited jitter that this analysis found. The
blocking is the one found here. A bus is a processor that does not preempt. Cheddar
reads 32-bit integers, so the unit of time is the largest in which all times are exact.
Where no such unit fits, C, J and B are rounded up, and T and D down: then start times
are left out.
The form follows published writers of it; the output was never read by Cheddar itself.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from xml.etree import ElementTree as Xml

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.chains import TimedChain
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task

from .shapes import (
    Unfit,
    dense,
    names,
    no_errors,
    of_one_epoch,
    remarks,
    seldom,
    spelled_out,
    unqueued,
    urgency,
)

LARGEST = 2**31 - 1
"""Cheddar's largest integer."""

PRIORITIES = 255
"""Cheddar's largest priority."""


@dataclass(frozen=True, slots=True)
class _Item:
    """A task of Cheddar, in ns."""

    name: str
    place: str
    priority: int
    period: int
    deadline: int
    capacity: int
    jitter: int
    blocking: int
    start: int

    @property
    def times(self) -> tuple[int, ...]:
        """All of its times."""
        return (
            self.period, self.deadline, self.capacity, self.jitter, self.blocking, self.start,
        )  # fmt: skip


def export(network: Network, chains: Sequence[TimedChain], title: str) -> str:
    """The model of ``network``; Cheddar has neither ``chains`` nor a name for the whole."""
    del title
    no_errors(network, "Cheddar")
    given = network
    network = spelled_out(unqueued(of_one_epoch(network)))
    items = tuple(_items(network))
    places = dict.fromkeys(item.place for item in items)
    unit = _unit(items)
    if any(time % unit for item in items for time in item.times):
        items = tuple(replace(item, start=0) for item in items)
    root = Xml.Element("cheddar")
    for line in (f"One unit of time is {unit} ns.", *remarks(given, chains), *seldom(given)):
        root.append(Xml.Comment(f" {line.replace('--', '- -')} "))
    numbers = iter(range(1, 3 * len(places) + len(items) + 1))
    cores = Xml.SubElement(root, "core_units")
    ids = {}
    for place in places:
        ids[place] = f"id_{next(numbers)}"
        _core(cores, ids[place], place, preemptive=place not in _buses(network))
    processors = Xml.SubElement(root, "processors")
    for place in places:
        _processor(processors, f"id_{next(numbers)}", place, ids[place])
    spaces = Xml.SubElement(root, "address_spaces")
    for place in places:
        _address_space(spaces, f"id_{next(numbers)}", place)
    tasks = Xml.SubElement(root, "tasks")
    for item in items:
        _task(tasks, f"id_{next(numbers)}", item, unit)
    Xml.indent(root, " ")
    text = Xml.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="utf-8"?>\n{text}\n'


def _buses(network: Network) -> set[str]:
    places = names([*dict.fromkeys(task.core for task in network.tasks), *network.buses])
    return {places[bus] for bus in network.frames}


def _items(network: Network) -> Iterator[_Item]:
    """The tasks and frames as Cheddar has them; `Unfit` for one without a bound."""
    found = holistic.analyse(network)
    plain = names(network.items())
    places = names([*dict.fromkeys(task.core for task in network.tasks), *network.buses])
    levels = {
        core: dense(task.priority for task in network.tasks if task.core == core)
        for core in {task.core for task in network.tasks}
    }
    for name, item in network.items().items():
        blocked = found.responses[name].blocked
        if name not in found.inherited and name in network.released_by:
            raise Unfit(f"the jitter of {name} has no bound, so there is none to export")
        late = item.jitter + found.inherited.get(name, 0)
        deadline = item.deadline - found.best[name]
        if isinstance(item, Task):
            place, level = item.core, levels[item.core][item.priority]
            longest, start = item.wcet, item.offset or 0
        else:
            place = next(bus for bus, some in network.frames.items() if item in some)
            level = urgency(network.frames[place])[name]
            longest, start = item.transmission_time, 0
        if level > PRIORITIES:
            raise Unfit(f"Cheddar has {PRIORITIES} priorities: {places[place]} needs {level}")
        yield _Item(
            plain[name],
            places[place],
            level,
            item.period,
            deadline,
            longest,
            late,
            blocked,
            start,
        )


def _unit(items: Sequence[_Item]) -> int:
    """The largest unit in which all times are exact, or the smallest in which all fit."""
    times = [time for item in items for time in item.times]
    unit = max(math.gcd(*times), -(-max(times) // LARGEST))
    for item in items:
        if min(item.period, item.deadline) < unit:
            raise Unfit(
                f"Cheddar's integers cannot hold both {max(times)} ns and the times of {item.name}"
            )
    return unit


def _fill(parent: Xml.Element, **texts: str | int) -> None:
    """Children with these names and texts, in order."""
    for name, text in texts.items():
        Xml.SubElement(parent, name).text = str(text)


def _scheduling(parent: Xml.Element, scheduler: str, preemptive: str) -> None:
    outer = Xml.SubElement(parent, "scheduling")
    _fill(
        Xml.SubElement(outer, "scheduling_parameters"),
        scheduler_type=scheduler,
        quantum=0,
        preemptive_type=preemptive,
        capacity=0,
        period=0,
        priority=0,
        start_time=0,
    )


def _core(parent: Xml.Element, number: str, place: str, *, preemptive: bool) -> None:
    core = Xml.SubElement(parent, "core_unit", id=number)
    _fill(core, object_type="CORE_OBJECT_TYPE", name=f"{place}_core")
    _scheduling(
        core,
        "POSIX_1003_HIGHEST_PRIORITY_FIRST_PROTOCOL",
        "PREEMPTIVE" if preemptive else "NOT_PREEMPTIVE",
    )
    _fill(core, speed="0.00000")


def _processor(parent: Xml.Element, number: str, place: str, core: str) -> None:
    processor = Xml.SubElement(parent, "mono_core_processor", id=number)
    _fill(
        processor,
        object_type="PROCESSOR_OBJECT_TYPE",
        name=place,
        processor_type="MONOCORE_TYPE",
        migration_type="NO_MIGRATION_TYPE",
    )
    Xml.SubElement(processor, "core", ref=core)


def _address_space(parent: Xml.Element, number: str, place: str) -> None:
    space = Xml.SubElement(parent, "address_space", id=number)
    _fill(
        space,
        object_type="ADDRESS_SPACE_OBJECT_TYPE",
        name=f"{place}_space",
        cpu_name=place,
        text_memory_size=0,
        stack_memory_size=0,
        data_memory_size=0,
        heap_memory_size=0,
    )
    _scheduling(space, "NO_SCHEDULING_PROTOCOL", "PREEMPTIVE")


def _task(parent: Xml.Element, number: str, item: _Item, unit: int) -> None:
    _fill(
        Xml.SubElement(parent, "periodic_task", id=number),
        object_type="TASK_OBJECT_TYPE",
        name=item.name,
        task_type="PERIODIC_TYPE",
        cpu_name=item.place,
        address_space_name=f"{item.place}_space",
        capacity=-(-item.capacity // unit),
        deadline=item.deadline // unit,
        start_time=item.start // unit,
        priority=item.priority,
        blocking_time=-(-item.blocking // unit),
        policy="SCHED_FIFO",
        text_memory_size=0,
        stack_memory_size=0,
        criticality=0,
        context_switch_overhead=0,
        period=item.period // unit,
        jitter=-(-item.jitter // unit),
        every=0,
    )
