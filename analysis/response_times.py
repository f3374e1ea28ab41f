"""Worst-case response times under fixed priorities and ceiling locking.

The recurrence for job q of the level-i busy period (jobs counted from 0):

    w(q) = B + (q + 1) C + sum over j of ceil((J_j + w(q)) / T_j) C_j
    R    = max over q of  J + w(q) - q T

where j runs over the other tasks of higher or equal priority. R counts from the
event that releases the task, so it includes the task's own release jitter, and
so does the deadline D. B is the longest section of a lower-priority task inside
an object whose ceiling reaches the task: taken once per busy period. Joseph and
Pandya 1986; Audsley et al. 1993; Lehoczky 1990 for deadlines beyond the period;
ceilings: Ada RM D.3. All times are integers in nanoseconds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction

from gen.model import SharedObject, System, Task
from gen.terms import Ns

from .units import percent

EVALUATION_LIMIT = 200_000
"""Evaluations of the recurrence that one task may take; past it there is no bound."""

ENVIRONMENT_PRIORITY = 0
"""Of a user of an object that is no task: the environment, below every task."""

GROWTH_SCALE = 1000
"""Growth margins are counted in 1/1000 of the budgets."""

GROWTH_LIMIT = 100 * GROWTH_SCALE
"""No margin above 100 times the budgets is looked for."""


class Verdict(Enum):
    """What the analysis says of one task."""

    MET = "met"
    MISSED = "missed"
    NO_BOUND = "no bound"


@dataclass(frozen=True, slots=True)
class Blocking:
    """The longest section of a less urgent ``user`` that can hold a task up."""

    element: str
    user: str
    section: Ns


@dataclass(frozen=True, slots=True)
class Interference:
    """What one other task takes from the worst job: ``releases`` times its budget."""

    element: str
    releases: int
    time: Ns


@dataclass(frozen=True, slots=True)
class Response:
    """The worst-case response of one task, and what it is made of.

    ``bound`` is R from the releasing event, or None with the ``reason``. The
    breakdown belongs to job ``worst_job`` of the ``jobs`` in the busy period:
    jitter + blocking + own + interference - worst_job * period = bound.
    """

    task: Task
    blocking: Blocking | None
    bound: Ns | None
    jobs: int
    worst_job: int
    interference: tuple[Interference, ...]
    reason: str = ""

    @property
    def verdict(self) -> Verdict:
        """Met when R is at most D."""
        if self.bound is None:
            return Verdict.NO_BOUND
        return Verdict.MET if self.bound <= self.task.deadline else Verdict.MISSED

    @property
    def slack(self) -> Ns | None:
        """D - R, negative when the deadline is missed; None without a bound."""
        return None if self.bound is None else Ns(self.task.deadline - self.bound)

    @property
    def blocked(self) -> Ns:
        """B: the longest time that a less urgent task holds this one up."""
        return Ns(0) if self.blocking is None else self.blocking.section

    @property
    def own(self) -> Ns:
        """Execution of the task itself, from the start of the busy period to the worst job."""
        return Ns((self.worst_job + 1) * self.task.budget)

    @property
    def utilisation(self) -> Fraction:
        """Share of the processor core that the task may need."""
        return Fraction(self.task.budget, self.task.period)


@dataclass(frozen=True, slots=True)
class Analysis:
    """The responses of a system's tasks, in the system's order."""

    system: System
    responses: tuple[Response, ...]

    @property
    def schedulable(self) -> bool:
        """Every task meets its deadline."""
        return all(r.verdict is Verdict.MET for r in self.responses)

    def worst_first(self) -> tuple[Response, ...]:
        """The responses without a bound, then by slack, smallest first."""
        return tuple(sorted(self.responses, key=_urgency))

    def failed(self) -> tuple[Response, ...]:
        """The responses that are not met, worst first."""
        return tuple(r for r in self.worst_first() if r.verdict is not Verdict.MET)

    def response(self, element: str) -> Response:
        """The response of the task with that id; KeyError where there is none."""
        for response in self.responses:
            if response.task.element == element:
                return response
        raise KeyError(element)

    def utilisation(self, node: str) -> Fraction:
        """Share of one node's core that its tasks may need together."""
        return sum((r.utilisation for r in self.responses if r.task.node == node), Fraction(0))


def analyse(system: System) -> Analysis:
    """The worst-case response of every task of ``system``, each on its own node."""
    return Analysis(system, response_times(system.tasks, system.objects))


def response_times(
    tasks: Sequence[Task], objects: Sequence[SharedObject] = ()
) -> tuple[Response, ...]:
    """The worst-case response of each of ``tasks``, in the same order."""
    return tuple(
        response_time(task, more_urgent(task, tasks), blocking_of(task, tasks, objects))
        for task in tasks
    )


def more_urgent(task: Task, tasks: Sequence[Task]) -> tuple[Task, ...]:
    """The other tasks of the node that may run before ``task``: equal priorities too."""
    return tuple(
        other
        for other in tasks
        if other.node == task.node
        and other.element != task.element
        and other.priority >= task.priority
    )


def blocking_of(
    task: Task, tasks: Sequence[Task], objects: Sequence[SharedObject]
) -> Blocking | None:
    """The longest section that can hold ``task`` up, or None where there is none.

    A section counts when the object's ceiling reaches the task's priority and a
    user of lower priority may be inside; whether the task itself ever uses the
    object makes no difference.
    """
    priorities = {t.element: t.priority for t in tasks if t.node == task.node}
    longest: Blocking | None = None
    for item in objects:
        if item.node != task.node or item.ceiling < task.priority:
            continue
        for user in item.users:
            lower = priorities.get(user, ENVIRONMENT_PRIORITY) < task.priority
            if lower and item.section > (longest.section if longest else 0):
                longest = Blocking(item.element, user, item.section)
    return longest


def response_time(task: Task, others: Sequence[Task], blocking: Blocking | None) -> Response:
    """Worst-case response of ``task``; ``others`` are those of higher or equal priority.

    Every job of the busy period is looked at, up to the one after which the
    release pattern repeats: with a load of at most 1, later ones are no worse.
    """
    load = sum((Fraction(t.budget, t.period) for t in (task, *others)), Fraction(0))
    if load > 1:
        return _unbounded(
            task, blocking, f"it and what preempts it need {percent(load)} of the core"
        )
    start = task.budget + (blocking.section if blocking else 0)
    pattern = math.lcm(task.period, *(t.period for t in others)) // task.period
    bound, worst, finish = -1, 0, 0
    demand = start + sum(t.budget for t in others)
    evaluations, jobs = 0, 0
    for job in range(min(pattern, EVALUATION_LIMIT)):
        fixed = start + job * task.budget
        finished, demand, used = _fixed_point(demand, fixed, others, EVALUATION_LIMIT - evaluations)
        evaluations += used
        if not finished:
            break
        jobs = job + 1
        response = task.jitter + demand - job * task.period
        if response > bound:
            bound, worst, finish = response, job, demand
        if demand <= (job + 1) * task.period - task.jitter or jobs == pattern:
            return Response(task, blocking, Ns(bound), jobs, worst, _interference(others, finish))
        demand += task.budget
    return _unbounded(task, blocking, f"none was found within {EVALUATION_LIMIT} evaluations")


def growth_margin(tasks: Sequence[Task], objects: Sequence[SharedObject] = ()) -> int | None:
    """By how many thousandths all budgets and sections may grow, every deadline still met.

    Negative when they must shrink. None when no budget, however small, would do
    (jitter alone passes a deadline) or when there is no task.
    """

    def met(growth: int) -> bool:
        grown = [replace(t, budget=_scaled(t.budget, growth)) for t in tasks]
        held = [replace(o, section=_scaled(o.section, growth)) for o in objects]
        return all(
            response_time(task, more_urgent(task, grown), blocking_of(task, grown, held)).verdict
            is Verdict.MET
            for task in grown
        )

    return _greatest(met, 1 - GROWTH_SCALE, GROWTH_LIMIT) if tasks else None


def _fixed_point(
    demand: int, fixed: int, others: Sequence[Task], limit: int
) -> tuple[bool, int, int]:
    """Whether the recurrence settled, where, and after how many evaluations.

    ``demand`` is at most the fixed point, and only grows; ``fixed`` is what does
    not depend on the window.
    """
    for used in range(limit):
        needed = fixed + sum(-(-(t.jitter + demand) // t.period) * t.budget for t in others)
        if needed == demand:
            return True, demand, used + 1
        demand = needed
    return False, demand, limit


def _interference(others: Sequence[Task], window: int) -> tuple[Interference, ...]:
    """What each of ``others`` takes from a window of that length, most first."""
    shares = []
    for other in others:
        releases = -(-(other.jitter + window) // other.period)
        shares.append(Interference(other.element, releases, Ns(releases * other.budget)))
    return tuple(sorted(shares, key=lambda share: -share.time))


def _unbounded(task: Task, blocking: Blocking | None, reason: str) -> Response:
    """A response without a bound."""
    return Response(task, blocking, None, 0, 0, (), reason)


def _urgency(response: Response) -> tuple[bool, int]:
    """Sorts what has no bound first, then by slack."""
    return response.bound is not None, response.slack or 0


def _scaled(time: Ns, growth: int) -> Ns:
    """``time`` grown by so many thousandths, rounded up."""
    return Ns(-(-time * (GROWTH_SCALE + growth) // GROWTH_SCALE))


def _greatest(holds: Callable[[int], bool], low: int, high: int) -> int | None:
    """The greatest number in ``low .. high`` up to which ``holds``; None when not even low."""
    if not holds(low):
        return None
    for _ in range((high - low).bit_length()):
        middle = (low + high + 1) // 2
        if middle > low and holds(middle):
            low = middle
        else:
            high = max(low, middle - 1)
    return low
