# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The sensitivity of a system: factors of all execution times, and slack of single tasks.

Whether all deadlines are met is monotone in each execution time, so the last value
that meets them is found by halving. Rounding is safe: a scaled time is rounded up,
and each factor is one that was tried.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from . import holistic
from .blocking import Section
from .fixed_priority import analyse_tasks
from .holistic import Network
from .platform import Platform
from .responses import Response
from .tasks import TableRow, Task

FACTOR_STEPS = 10_000
"""Factors are whole multiples of 1 / this."""

FACTOR_LIMIT = 1_000
"""No larger factor is searched for."""


@dataclass(frozen=True, slots=True)
class Scaling:
    """The largest ``factor`` of all execution times and sections with every deadline met.

    Below 1 they must shrink. ``binding`` is the response that fails first, at the next
    step: the constraint that limits the system; None when `FACTOR_LIMIT` was reached.
    """

    factor: Fraction
    binding: Response | None


def scaling(
    tasks: Sequence[Task],
    sections: Sequence[Section] = (),
    platforms: Mapping[str, Platform] | None = None,
    ceilings: Mapping[str, int] | None = None,
    steps: int = FACTOR_STEPS,
) -> Scaling | None:
    """The largest factor of all execution times together, in steps of 1 / ``steps``.

    Overheads and jitter stay as they are. None when no factor above 0 meets all deadlines.
    """

    def failing(count: int) -> Response | None:
        factor = Fraction(count, steps)
        grown = [scaled(task, factor) for task in tasks]
        held = [replace(s, length=_up(s.length * factor)) for s in sections]
        return _first_failing(analyse_tasks(grown, held, platforms, ceilings))

    found = greatest(lambda count: failing(count) is None, 1, FACTOR_LIMIT * steps)
    if found is None:
        return None
    return Scaling(Fraction(found, steps), failing(found + 1))


@dataclass(frozen=True, slots=True)
class NetworkScaling:
    """As `Scaling`, over a network; ``binding`` is the task or frame that fails first."""

    factor: Fraction
    binding: str | None


def network_scaling(
    network: Network, names: Collection[str] | None = None, steps: int = FACTOR_STEPS
) -> NetworkScaling | None:
    """The largest factor of the times of all tasks and frames, or of those named, together.

    Frames scale as tasks do, as if they were longer. A deadline counts from the event
    of its item's chain. None when no factor above 0 meets all deadlines.
    """

    def grown(count: int) -> Network:
        return scaled_network(network, Fraction(count, steps), names)

    last = greatest(lambda count: holistic.met(grown(count)), 1, FACTOR_LIMIT * steps)
    if last is None:
        return None
    found = holistic.analyse(grown(last + 1))
    missed = [name for name in found.responses if not found.meets(name)]
    late = max(missed, key=lambda name: _lateness(found, name), default=None)
    return NetworkScaling(Fraction(last, steps), late)


def scaled_network(network: Network, factor: Fraction, names: Collection[str] | None) -> Network:
    """The network with the times of those named, or all, multiplied and rounded up."""

    def chosen(name: str) -> bool:
        return names is None or name in names

    return replace(
        network,
        tasks=tuple(scaled(t, factor) if chosen(t.name) else t for t in network.tasks),
        sections=tuple(
            replace(s, length=_up(s.length * factor)) if chosen(s.user) else s
            for s in network.sections
        ),
        frames={
            bus: tuple(
                replace(
                    f,
                    transmission_time=_up(f.transmission_time * factor),
                    best=_down(f.best, factor),
                )
                if chosen(f.name)
                else f
                for f in frames
            )
            for bus, frames in network.frames.items()
        },
    )


def _lateness(found: holistic.Holistic, name: str) -> tuple[bool, int]:
    """A key by the time past the deadline; an item without a bound is later than all."""
    needed = found.from_event(name)
    return needed is None, (needed or 0) - found.deadline(name)


def growth(
    name: str,
    tasks: Sequence[Task],
    sections: Sequence[Section] = (),
    platforms: Mapping[str, Platform] | None = None,
    ceilings: Mapping[str, int] | None = None,
) -> int | None:
    """The most ticks that every job of the task ``name`` may grow with all deadlines met.

    0 where the deadlines are met and one tick more would miss one. None where they are
    not met. KeyError where there is no such task.
    """
    chosen = {task.name: task for task in tasks}[name]

    def met(extra: int) -> bool:
        grown = [
            replace(task, wcet=task.wcet + extra) if task is chosen else task for task in tasks
        ]
        return all(r.met for r in analyse_tasks(grown, sections, platforms, ceilings))

    return greatest(met, 0, chosen.deadline)


def scaled(task: Task, factor: Fraction) -> Task:
    """The task with its own time and its rows multiplied by ``factor``, each rounded up."""
    rows = tuple(TableRow(r.name, _up(r.wcet * factor), r.every, r.phase) for r in task.rows)
    return replace(task, wcet=_up(task.wcet * factor), rows=rows, best=_down(task.best, factor))


def _down(best: int, factor: Fraction) -> int:
    """A best case that is never above the worst, and does not grow with it."""
    return min(best, int(best * factor))


def tightest(responses: Sequence[Response]) -> tuple[Response, ...]:
    """The responses by slack, smallest first, and before them those without a bound."""
    return tuple(sorted(responses, key=lambda r: (r.bound is not None, r.slack or 0)))


def greatest(holds: Callable[[int], bool], low: int, high: int) -> int | None:
    """The greatest number in ``low .. high`` up to which ``holds``; None where ``low`` fails.

    The search doubles the step first, so that it finds a small answer by small trials.
    """
    if not holds(low):
        return None
    step = 1
    while low + step <= high and holds(low + step):
        low += step
        step *= 2
    above = min(low + step, high + 1)
    while above - low > 1:
        middle = (low + above) // 2
        if holds(middle):
            low = middle
        else:
            above = middle
    return low


def _first_failing(responses: Sequence[Response]) -> Response | None:
    """The response that misses most, if any does."""
    worst = tightest([response for response in responses if not response.met])
    return worst[0] if worst else None


def _up(value: Fraction) -> int:
    """Rounded up to a whole tick."""
    return -(-value.numerator // value.denominator)
