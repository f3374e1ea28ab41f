# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules for nodes with several cores: each has its own objects, and values cross in few ways."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.completion import driver_core, programs
from ravenchart.gen.derive.crossing import MAIN_CORE, Crossing, crossings, other_cores
from ravenchart.gen.derive.sharing import MAIN
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.component import PortKind
from ravenchart.gen.model.statechart import Overflow
from ravenchart.gen.model.system import System

SHARED = "RV-0711"


def shared_across_cores(system: System) -> Iterator[Diagnostic]:
    """Between cores there are the values of ports alone: a ceiling protects on one core only.

    ``system`` is completed. Of an instance or a bus on several cores that is all that is said:
    the rest follows from it.
    """
    if all(node.cores == 1 for node in system.nodes):
        return
    for part in programs(system):
        if other_cores(part):
            causes = [*_divided_instances(part), *_drivers(part)]
            yield from causes or (*_objects(part), *_crossing_values(part))


def _divided_instances(system: System) -> Iterator[Diagnostic]:
    """All rows of an instance run on one core."""
    for instance in system.instances:
        first, *others = system.slots_of(instance.name)
        home = system.processor_of(first.element).core
        homes = ((slot, system.processor_of(slot.element)) for slot in others)
        away = next(((slot, other) for slot, other in homes if other.core != home), None)
        if away is not None:
            slot, processor = away
            text = (
                f"{instance.name} runs on two cores: {slot.name} on core {processor.core}, "
                f"{first.name} on core {home}"
            )
            hint = "put all rows of an instance on one core"
            yield error(SHARED, processor.origin, text, hint=hint)


def _objects(system: System) -> Iterator[Diagnostic]:
    """The users of a protected object are on one core."""
    tasks = {task.element: task for task in system.tasks}
    for item in system.objects:
        homes = {user: tasks[user].core for user in item.users if user in tasks}
        homes |= {MAIN: MAIN_CORE} if MAIN in item.users else {}
        if not homes:
            continue
        first, *others = homes
        for other in others:
            if homes[other] != homes[first]:
                one, two = (
                    f"{'the main program' if user == MAIN else user} (core {homes[user]})"
                    for user in (first, other)
                )
                origin = (tasks.get(other) or tasks[first]).origin
                message = f"{item.element} is shared by {one} and {two}"
                hint = "put them on one core: only values of ports go from core to core"
                yield error(SHARED, origin, message, hint=hint)
                break


def _drivers(system: System) -> Iterator[Diagnostic]:
    """The drivers run where the main program does, which reads their counters."""
    for bus in system.buses:
        core = driver_core(system, bus, system.nodes[0].name)
        if core != MAIN_CORE:
            text = f"{bus.name} is served on core {core}, but its driver runs on core {MAIN_CORE}"
            hint = f"put what sends or receives on {bus.name} on core {MAIN_CORE}"
            yield error(SHARED, bus.origin, text, hint=hint)


def _crossing_values(system: System) -> Iterator[Diagnostic]:
    """One processor sends, and no value that was sent is taken back."""
    polled = {(poll.instance, poll.port) for poll in system.polls}
    for crossing in crossings(system):
        origin = system.processor_of(system.handler(crossing.target)).origin
        where = f"{crossing.element}, on core {crossing.taken_on},"
        for text, hint in _refused(system, crossing, polled):
            yield error(SHARED, origin, f"{where} {text}", hint=hint)


def _refused(
    system: System, crossing: Crossing, polled: set[tuple[str, str]]
) -> Iterator[tuple[str, str]]:
    """Why values of a crossing cannot go from core to core, each with a hint."""
    together = f"put sender and receiver on core {crossing.sent_on}"
    if len(crossing.senders) > 1:
        names = ", ".join(crossing.senders[:-1]) + f" and {crossing.senders[-1]}"
        yield f"gets values from {names}", "let one processor send to it, or " + together
    elif (crossing.target.instance, crossing.target.name) in polled:
        yield f"gets values from {crossing.senders[0]} and from a device", together
    if system.woken_by(crossing.target) is not None:
        text = f"releases a processor, but {crossing.senders[0]} sends on core {crossing.sent_on}"
        yield text, "release the processor by time, or " + together
    port = crossing.port
    if port.kind is PortKind.QUEUED and port.overflow is Overflow.DROP_OLDEST:
        text = f"drops its oldest value, but {crossing.senders[0]} sends on core {crossing.sent_on}"
        yield text, "give it `overflow: reject_newest`, or " + together
