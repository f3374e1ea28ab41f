"""Failed deadlines and overloaded buses as diagnostics, in the words of a compiler."""

from __future__ import annotations

from fractions import Fraction

from gen.diagnostics import Diagnostic, error
from gen.model import System
from gen.terms import Origin

from .bus_load import BusLoad, bus_loads
from .response_times import Analysis, Response, Verdict, more_urgent
from .units import duration, microseconds, percent

MISSED = "RV-0901"
"""A task may complete after its deadline."""

NO_BOUND = "RV-0902"
"""No bound of a task's response is known."""

BUS_OVERLOAD = "RV-0903"
"""The messages of a bus need more than all of its time."""

LARGEST = 3
"""How many interferers a diagnostic names."""


def findings(analysis: Analysis) -> tuple[Diagnostic, ...]:
    """One error for each task that may miss its deadline and each bus loaded over 100 %."""
    tasks = (_of_task(response, analysis.system) for response in analysis.failed())
    buses = (_of_bus(load) for load in bus_loads(analysis.system) if load.share > 1)
    return (*tasks, *buses)


def _of_task(response: Response, system: System) -> Diagnostic:
    """What is wrong with one task."""
    task = response.task
    if response.verdict is Verdict.NO_BOUND:
        return error(
            NO_BOUND,
            task.origin,
            f"{task.element} has no response-time bound: {response.reason}",
            notes=_notes(response, system),
            hint="shorten worst-case execution times, or lengthen periods",
        )
    return error(
        MISSED,
        task.origin,
        f"{task.element} needs over {duration(task.deadline)}: "
        f"it may take {microseconds(response.bound or 0)} us",
        notes=_notes(response, system),
        hint="lengthen its period, or move an activity to a slower processor",
    )


def _notes(response: Response, system: System) -> tuple[tuple[Origin, str], ...]:
    """Its own time, the largest interferers and the blocker, each where it is declared."""
    tasks = {t.element: t for t in system.tasks}
    task, blocking = response.task, response.blocking
    notes = [(task.origin, f"it runs for up to {duration(task.budget)} itself")]
    if response.verdict is Verdict.NO_BOUND:
        load = sorted(more_urgent(task, system.tasks), key=lambda t: -t.budget / t.period)
        notes += [
            (
                other.origin,
                f"it is preempted by {other.element}, period {duration(other.period)}: "
                f"{percent(Fraction(other.budget, other.period))} of the core",
            )
            for other in load[:LARGEST]
        ]
    for share in response.interference[:LARGEST]:
        other = tasks[share.element]
        notes.append(
            (
                other.origin,
                f"it is preempted by {share.element}, period {duration(other.period)}: "
                f"{share.releases} x {duration(other.budget)} = {duration(share.time)}",
            )
        )
    if blocking is not None:
        origin = tasks[blocking.user].origin if blocking.user in tasks else task.origin
        notes.append(
            (
                origin,
                f"{blocking.user} may hold it up for {duration(blocking.section)} "
                f"inside {blocking.element}",
            )
        )
    return tuple(notes)


def _of_bus(load: BusLoad) -> Diagnostic:
    """What is wrong with one bus."""
    largest = sorted(load.messages, key=lambda item: -item.share)[:LARGEST]
    return error(
        BUS_OVERLOAD,
        load.bus.origin,
        f"{load.bus.name} may be loaded to {percent(load.share)}",
        notes=[
            (
                item.message.origin,
                f"{item.message.name} takes {percent(item.share)}: "
                f"{item.bits} bits every {duration(item.message.period)}",
            )
            for item in largest
        ],
        hint="lengthen periods, or raise the bit rate",
    )
