# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A queue that releases its reader: bounds of its wait and backlog, against every tick of runs."""

from __future__ import annotations

import random
from collections import deque
from dataclasses import replace

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.chains import ChainStep, HopKind, Latency, TimedChain, latency
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task

WRITER, READER = "writer", "reader"


def task(name: str, priority: int, wcet: int, period: int, sporadic: bool = False) -> Task:
    return Task(name, priority, period, period, wcet, core="cpu", sporadic=sporadic)


def bound(tasks: tuple[Task, ...], puts: int = 1) -> Latency:
    network = Network(tasks)
    steps = ChainStep(WRITER, HopKind.RELEASED), ChainStep(READER, HopKind.WOKEN, puts=puts)
    return latency(TimedChain("chain", steps), network, holistic.analyse(network))


def test_by_hand() -> None:
    found = bound((task(WRITER, 2, 3, 20), task(READER, 1, 4, 20, sporadic=True)))
    # the reader waits for the writer once: R = 4 + 3
    assert [(hop.wait, hop.response) for hop in found.hops] == [(0, 3), (7, 7)]
    assert (found.reaction, found.age) == (3 + 7 + 7, 3 + 7 + 7)
    assert found.hops[1].backlog == 1


def test_several_at_once_wait_for_each_other() -> None:
    found = bound((task(WRITER, 2, 3, 20), task(READER, 1, 2, 6, sporadic=True)), puts=3)
    assert [(hop.wait, hop.response) for hop in found.hops] == [(0, 3), (5 + 2 * 6, 5)]
    assert found.hops[1].backlog == 6
    found = bound((task(WRITER, 2, 3, 20), task(READER, 1, 2, 7, sporadic=True)), puts=3)
    assert found.reaction is None


def test_what_comes_sooner_than_the_separation_has_no_bound() -> None:
    found = bound((task(WRITER, 2, 3, 20), task(READER, 1, 4, 21, sporadic=True)))
    assert (found.reaction, found.age, found.hops[1].backlog) == (None, None, None)


def test_a_chain_does_not_begin_with_it() -> None:
    network = Network((task(READER, 1, 4, 20, sporadic=True),))
    chain = TimedChain("chain", (ChainStep(READER, HopKind.WOKEN),))
    with pytest.raises(ValueError, match="must begin with a step without a queue"):
        latency(chain, network, holistic.analyse(network))


def observed(
    tasks: tuple[Task, ...], chance: random.Random, ticks: int, puts: int = 1
) -> tuple[int, int, int]:
    """The longest time from a job of the writer to the end of the release that takes its item.

    Also the most items that wait at once, and the least distance of two releases. All tasks but
    the reader are released at random offsets, every period or, if sporadic, later at random. A job
    of the writer puts as many items in as it may, or fewer.
    """
    reader = next(one for one in tasks if one.name == READER)
    others = [one for one in tasks if one is not reader]
    following = {one.name: chance.randrange(one.period) for one in others}
    jobs: dict[str, deque[list[int]]] = {one.name: deque() for one in others}  # release, left
    items: deque[int] = deque()  # of which job of the writer
    left, item, due, earliest = 0, 0, -1, 0  # the release under way; due: when it may begin
    longest, most, least = 0, 0, ticks
    for now in range(ticks):
        for one in others:
            if following[one.name] == now:
                jobs[one.name].append([now, chance.randint(max(1, one.wcet // 2), one.wcet)])
                late = chance.randrange(one.period) if one.sporadic else 0
                following[one.name] = now + one.period + late
        while True:
            ready = [one for one in others if jobs[one.name]]
            if left or (items and due < 0) or (due >= 0 and now >= due):
                ready.append(reader)
            running = max(ready, key=lambda one: one.priority, default=None)
            if running is not reader or left:
                break
            if due < 0:  # it returns from waiting, and looks at the clock
                due = max(now, earliest)
                least = min(least, due - earliest + reader.period) if earliest else least
            if now >= due:
                item, left = items.popleft(), chance.randint(1, reader.wcet)
        if running is None:
            continue
        if running is reader:
            left -= 1
            if not left:
                longest = max(longest, now + 1 - item)
                earliest, due = due + reader.period, -1
            continue
        job = jobs[running.name][0]
        job[1] -= 1
        if not job[1]:
            jobs[running.name].popleft()
            if running.name == WRITER:
                items += [job[0]] * chance.choice((puts, chance.randint(0, puts)))
                most = max(most, len(items) + (1 if left else 0))
    return longest, most, least


def sets(chance: random.Random, puts: int) -> tuple[Task, ...]:
    period = chance.randint(8, 40) * puts
    priorities = chance.sample(range(1, 6), 4)
    separation = chance.choice((period // puts, chance.randint(6, period // puts)))
    reader = task(READER, priorities[0], chance.randint(1, 4), separation, True)
    writer = task(WRITER, priorities[1], chance.randint(1, 4), period)
    others = [
        task(f"other_{n}", priorities[n], chance.randint(1, 4), chance.randint(10, 60), n == 3)
        for n in (2, 3)
    ]
    return reader, writer, *others


@pytest.mark.parametrize("puts", [1, 2, 3])
def test_no_run_is_longer_than_the_bound(puts: int) -> None:
    chance = random.Random(7)
    compared, later = 0, 0
    while compared < 80:
        tasks = sets(chance, puts)
        found, whole = bound(tasks, puts), holistic.analyse(Network(tasks))
        if not whole.met or found.reaction is None:
            continue
        compared += 1
        backlog = found.hops[1].backlog
        assert backlog is not None
        runs = [observed(tasks, chance, 1_500, puts) for _ in range(3)]
        assert max(run[0] for run in runs) <= found.reaction, tasks
        assert max(run[1] for run in runs) <= backlog, tasks
        assert min(run[2] for run in runs) >= tasks[0].period
        wait = found.hops[1].wait
        assert wait is not None
        later += max(run[0] for run in runs) > found.reaction - wait
    assert later  # so without the wait the bound would be too short


def test_runs_show_a_separation_that_is_not_kept() -> None:
    chance = random.Random(3)
    tasks = (task(READER, 1, 1, 10, True), task(WRITER, 3, 1, 10), task("other", 2, 6, 15))
    shorter = (replace(tasks[0], period=1), *tasks[1:])
    assert observed(tasks, chance, 500)[2] >= 10
    assert observed(shorter, chance, 500)[2] < 10
