# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The longest responses of small task sets over everything that can happen, tick by tick.

Nothing of the analysis is used or known here. Each task may start at any time, or has an
offset; each job may be released up to the jitter late, a sporadic task may arrive late, and
of several jobs of one priority any may run. All states that can be reached are visited.
Time is discrete: a less urgent job that holds others up has begun a whole tick before.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product

NOT_STARTED = -1

STATES = 2_000_000
"""More than any of the sets reaches: its load would be above 1."""

Job = tuple[int, int, int]
"""Age since the arrival, ticks executed, frame."""

TaskState = tuple[int, int, tuple[int, ...], tuple[Job, ...]]
"""Ticks to the next arrival, its frame, ages of jobs not yet released, jobs released."""

State = tuple[TaskState, ...]


@dataclass(frozen=True)
class Toy:
    """A task: ``frames[k mod n]`` are the costs of the rows of job k.

    From tick ``hold[0]`` of a job on it is inside an object for ``hold[1]`` ticks, and
    there it has the priority ``hold[2]``. A job that is not ``preemptible`` runs to its end.
    Of the tasks of one ``queue``, without jitter, only the oldest job competes. With an
    ``offset`` job 0, of frame 0, arrives that long after the beginning, and none ever waits.
    """

    priority: int
    period: int
    frames: tuple[tuple[int, ...], ...]
    jitter: int = 0
    sporadic: bool = False
    hold: tuple[int, int, int] | None = None
    preemptible: bool = True
    queue: str = ""
    offset: int | None = None


@dataclass
class Seen:
    """The longest response of a task, and of each row of each frame."""

    response: int
    rows: dict[tuple[int, int], int]


def longest_responses(toys: Sequence[Toy]) -> list[Seen]:
    """What each task suffers at worst; its load must be at most 1, or this never ends."""
    seen = [Seen(0, {}) for _ in toys]
    starts: list[State] = list(product(*map(_starts, toys)))
    known: set[State] = set(starts)
    open_states = list(starts)
    while open_states:
        state = open_states.pop()
        for arrived in product(*(_arrivals(toy, s) for toy, s in zip(toys, state, strict=True))):
            for after in _executions(toys, arrived, seen):
                if after not in known:
                    known.add(after)
                    assert len(known) < STATES, toys
                    open_states.append(after)
    return seen


def _starts(toy: Toy) -> list[TaskState]:
    """How a task may begin: with any frame at any time, or with the first at its offset."""
    if toy.offset is not None:
        return [(toy.offset, 0, (), ())]
    return [(NOT_STARTED, frame, (), ()) for frame in range(len(toy.frames))]


def _arrivals(toy: Toy, state: TaskState) -> Iterator[TaskState]:
    """What a task may do at the beginning of a tick: arrive or not, release jobs or not."""
    left, frame, waiting, jobs = state
    if left <= 0:
        if left == NOT_STARTED or toy.sporadic:
            yield from _releases(toy, left, frame, waiting, jobs)
        left, waiting = toy.period, (*waiting, 0)
        yield from _releases(toy, left, frame, waiting, jobs)
    else:
        yield from _releases(toy, left, frame, waiting, jobs)


def _releases(
    toy: Toy, left: int, frame: int, waiting: tuple[int, ...], jobs: tuple[Job, ...]
) -> Iterator[TaskState]:
    """Release the oldest jobs: at least those whose jitter is used up."""
    due = sum(age >= toy.jitter for age in waiting)
    for count in range(due, len(waiting) + 1):
        n = len(toy.frames)
        released = ((age, 0, (frame + k) % n) for k, age in enumerate(waiting[:count]))
        work = tuple(job for job in released if sum(toy.frames[job[2]]) > 0)
        yield left, (frame + count) % n, waiting[count:], jobs + work


def _level(toy: Toy, jobs: tuple[Job, ...]) -> tuple[int, bool] | None:
    """The priority at which the task's oldest job competes, and whether it holds something."""
    if not jobs:
        return None
    done = jobs[0][1]
    if not toy.preemptible and done > 0:
        return 1_000, True
    if toy.hold is not None:
        start, length, ceiling = toy.hold
        if start < done < start + length:
            return max(ceiling, toy.priority), True
    return toy.priority, False


def _executions(toys: Sequence[Toy], state: State, seen: list[Seen]) -> Iterator[State]:
    """The states after one tick, whichever of the most urgent jobs runs."""
    for heads in _heads(toys, state):
        levels = [
            _level(toy, task[3]) if not toy.queue or index in heads else None
            for index, (toy, task) in enumerate(zip(toys, state, strict=True))
        ]
        urgent = max((level for level in levels if level is not None), default=None)
        if urgent is None:
            yield tuple(_older(task) for task in state)
            continue
        for index, level in enumerate(levels):
            if level == urgent:
                left, frame, waiting, jobs = state[index]
                jobs = _run(toys[index], jobs, seen[index])
                yield tuple(
                    _older((left, frame, waiting, jobs) if n == index else task)
                    for n, task in enumerate(state)
                )


def _heads(toys: Sequence[Toy], state: State) -> Iterator[tuple[int, ...]]:
    """Every choice of one oldest job for each queue; what is being sent stays in front."""
    candidates: dict[str, list[tuple[bool, int, int]]] = {}
    for index, (toy, task) in enumerate(zip(toys, state, strict=True)):
        if toy.queue and task[3]:
            age, done, _ = task[3][0]
            candidates.setdefault(toy.queue, []).append((done > 0, age, index))
    tied = [
        [index for sent, age, index in found if (sent, age) == max(found)[:2]]
        for found in candidates.values()
    ]
    yield from product(*tied)


def _run(toy: Toy, jobs: tuple[Job, ...], seen: Seen) -> tuple[Job, ...]:
    """Execute one tick of the oldest job and note what is complete with it."""
    age, done, frame = jobs[0]
    done += 1
    total = 0
    for row, cost in enumerate(toy.frames[frame]):
        total += cost
        if total == done:
            seen.rows[frame, row] = max(seen.rows.get((frame, row), 0), age + 1)
    if done < total:
        return ((age, done, frame), *jobs[1:])
    seen.response = max(seen.response, age + 1)
    return jobs[1:]


def _older(task: TaskState) -> TaskState:
    """One tick later."""
    left, frame, waiting, jobs = task
    return (
        left - 1 if left > 0 else left,
        frame,
        tuple(age + 1 for age in waiting),
        tuple((age + 1, done, f) for age, done, f in jobs),
    )
