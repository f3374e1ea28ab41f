# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Chains whose steps meet on a core or bus: shorter bounds, and never below what happens."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.plain.build import PlainSystem, load_plain
from ravenchart.analysis.simulation.engine import simulate
from tests.support.random_networks import random_transactions
from tests.support.random_phases import chance_scenario

PUBLISHED = """
bus,bit_rate
line,1000000000

task,core,priority,period_ms,deadline_ms,wcet_ms,best_ms,released_by
t1,one,30,20,20,4,4,
t21,one,10,250,250,20,20,
t22,one,10,250,250,30,30,m2
t3,two,30,30,30,5,5,
t4,two,20,250,250,15,15,m1
t5,two,10,200,200,100,100,

message,bus,priority,period_ms,deadline_ms,cost_ms,best_ms,released_by
m1,line,10,250,250,25,25,t21
m2,line,10,250,250,34,34,t4
"""
"""The example of Palencia and Gonzalez Harbour, RTSS 1998, as MAST's `rtss_98.txt` has it."""

ITEMS = ("t1", "t21", "m1", "t4", "m2", "t22", "t3", "t5")


def published() -> Network:
    found = load_plain(PUBLISHED, "rtss98.csv")
    assert isinstance(found, PlainSystem)
    return found.network


def in_ms(found: holistic.Holistic) -> list[int]:
    """Whole milliseconds: three bits between frames are 3 ns here, and nothing there."""
    return [(found.from_event(name) or 0) // 1_000_000 for name in ITEMS]


def test_the_published_example_has_the_published_bounds() -> None:
    # MAST's `offset_based_approx`, and its `holistic`
    assert in_ms(holistic.analyse(published())) == [4, 28, 53, 73, 107, 145, 5, 140]
    alone = replace(published(), together=False)
    assert in_ms(holistic.analyse(alone)) == [4, 66, 125, 145, 204, 270, 5, 140]


def test_a_step_does_not_meet_the_step_that_releases_it() -> None:
    # `last` and `first` never wait at once, on whichever core `middle` is; `low` sees one of them.
    tasks = (
        Task("first", 3, 100, 100, 10, core="a", best=10),
        Task("middle", 1, 100, 100, 20, core="b", best=20),
        Task("last", 2, 100, 100, 10, core="a"),
        Task("low", 1, 100, 100, 10, core="a"),
    )
    network = Network(tasks, released_by={"middle": "first", "last": "middle"}, together=True)
    found = holistic.analyse(network)
    assert [found.from_event(t.name) for t in tasks] == [10, 30, 40, 20]
    alone = holistic.analyse(replace(network, together=False))
    assert [alone.from_event(t.name) for t in tasks] == [10, 30, 50, 30]
    assert (set(found.ends), set(alone.ends)) == ({"last", "low"}, set())


def test_events_that_come_apart_say_nothing_of_what_follows_a_period_later() -> None:
    # `last` arrives 110 to 120 after an event, which comes 100 after the one before or later.
    tasks = (
        Task("first", 3, 100, 300, 10, core="a", best=10, sporadic=True),
        Task("middle", 1, 100, 300, 90, jitter=20, core="b", best=90),
        Task("last", 2, 100, 300, 10, core="a"),
        Task("low", 1, 200, 300, 10, core="a"),
    )
    released = {"middle": "first", "last": "middle"}
    sporadic = Network(tasks, released_by=released, together=True)
    assert holistic.analyse(sporadic).ends == {}
    regular = replace(sporadic, tasks=(replace(tasks[0], sporadic=False), *tasks[1:]))
    assert holistic.analyse(regular).ends != {}


def test_a_chain_that_returns_settles_only_where_its_steps_do_not_meet() -> None:
    # Each step waits for all the others of its core where they may meet, and is later for it.
    count = 8
    tasks = tuple(
        Task(f"s{n}", n + 1, 100, 100, 10, core="ab"[n % 2], best=10) for n in range(count)
    )
    released = {f"s{n}": f"s{n - 1}" for n in range(1, count)}
    network = Network(tasks, released_by=released, together=True)
    assert holistic.analyse(network).from_event("s7") == 80
    assert not holistic.met(replace(network, together=False))


@pytest.mark.slow
@pytest.mark.parametrize("shorter_jobs", [False, True])
def test_no_random_system_of_chains_is_observed_above_its_bounds(*, shorter_jobs: bool) -> None:
    sooner = compared = attained = 0
    for seed in range(150):
        chance = random.Random(seed)
        network = random_transactions(chance)
        found = holistic.analyse(network)
        alone = holistic.analyse(replace(network, together=False))
        for name in found.responses:
            least, most = found.from_event(name), alone.from_event(name)
            assert most is None or (least is not None and least <= most), (seed, name)
        until = 12 * max(item.period for item in network.items().values())
        for _ in range(4):
            ran = with_shorter_jobs(network, chance) if shorter_jobs else network
            seen = simulate(ran, chance_scenario(ran, chance, until), until)
            for name, longest in seen.longest.items():
                bound = found.from_event(name)
                assert bound is None or longest <= bound, (seed, name, longest, bound)
                compared += 1
                attained += longest == bound and name in found.ends
        sooner += len(found.ends)
    assert compared > 3_000
    assert sooner > 150
    assert shorter_jobs or attained > 15


def with_shorter_jobs(network: Network, chance: random.Random) -> Network:
    """All jobs of a task, and all frames of a message, take some time between best and worst."""
    return replace(
        network,
        tasks=tuple(
            replace(task, wcet=chance.randint(max(1, task.best), task.wcet))
            for task in network.tasks
        ),
        frames={
            bus: tuple(
                replace(f, transmission_time=chance.randint(max(1, f.best), f.transmission_time))
                for f in some
            )
            for bus, some in network.frames.items()
        },
    )
