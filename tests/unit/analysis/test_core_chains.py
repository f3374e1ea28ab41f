# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Networks and chains: jitter inherited, reaction and age hop by hop, and their limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise, product
from typing import Any

import pytest

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.chains import ChainStep, HopKind, Latency, TimedChain, latency
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.responses import Reason, Response
from ravenchart.analysis.core.tasks import Task


def task(name: str, wcet: int, period: int, core: str, priority: int = 1, **more: Any) -> Task:
    return Task(name, priority, period, more.pop("deadline", period), wcet, core=core, **more)


def of(network: Network, *steps: tuple[str, HopKind], **limits: int) -> Latency:
    chain = TimedChain("chain", tuple(ChainStep(name, hop) for name, hop in steps), **limits)
    return latency(chain, network, holistic.analyse(network))


SAMPLED, RELEASED, QUEUED = HopKind.SAMPLED, HopKind.RELEASED, HopKind.QUEUED

LINE = Network(
    tasks=(task("read", 2, 10, "a"), task("plan", 5, 20, "b"), task("move", 3, 50, "c")),
)


def test_sampled_hops_by_hand() -> None:
    found = of(LINE, ("read", SAMPLED), ("plan", SAMPLED), ("move", SAMPLED))
    assert [(h.wait, h.response, h.renewal) for h in found.hops] == [
        (10, 2, 10),
        (20, 5, 20),
        (50, 3, 0),
    ]
    assert found.reaction == 10 + 2 + 20 + 5 + 50 + 3
    assert found.age == 2 + 10 + 5 + 20 + 3
    assert found.held == found.reaction


def test_an_event_that_releases_the_first_step_does_not_wait() -> None:
    found = of(LINE, ("read", RELEASED), ("move", SAMPLED))
    assert (found.reaction, found.age) == (2 + 50 + 3, 2 + 10 + 3)


def longest(read: int, offsets: tuple[int, int, int]) -> tuple[int, int]:
    """Reaction and held age of two tasks that each run alone, by trying all instants."""
    (first, c1, t1), (second, c2, t2) = (offsets[0], 2, read), (offsets[1], 3, offsets[2])
    horizon = 40 * max(t1, t2)
    writes = {}  # end of a job of the first task: when it read
    for start in range(first, horizon, t1):
        writes[start + c1] = start
    outputs = []  # end of a job of the second: when its input was read
    for start in range(second, horizon, t2):
        seen = [end for end in writes if end <= start]
        if seen:
            outputs.append((start + c2, writes[max(seen)]))
    reaction = max(
        next(end for end, sample in outputs if sample >= event) - event
        for event in range(t1 * 3, horizon // 2)
    )
    #  an input comes just after the instant at which the one before it was read
    held = max(later[0] - sample for (_, sample), later in pairwise(outputs))
    return reaction, held


@pytest.mark.parametrize(("fast", "slow"), [(5, 7), (7, 5), (6, 6), (4, 12)])
def test_no_phasing_is_worse_than_the_bound(fast: int, slow: int) -> None:
    network = Network((task("x", 2, fast, "a"), task("y", 3, slow, "b")))
    found = of(network, ("x", SAMPLED), ("y", SAMPLED))
    assert found.reaction is not None and found.held is not None
    seen = [longest(fast, (p, q, slow)) for p, q in product(range(fast), range(slow))]
    assert max(reaction for reaction, _ in seen) < found.reaction
    assert max(held for _, held in seen) <= found.held


def test_the_worst_phasing_of_coprime_periods_comes_within_a_tick_of_the_bound() -> None:
    network = Network((task("x", 2, 5, "a"), task("y", 3, 7, "b")))
    found = of(network, ("x", SAMPLED), ("y", SAMPLED))
    seen = [longest(5, (p, q, 7)) for p, q in product(range(5), range(7))]
    assert found.reaction == 17
    assert max(reaction for reaction, _ in seen) == 17 - 2  # less a tick for each wait


def test_a_chain_over_a_bus_is_no_sum_of_responses() -> None:
    network = Network(
        tasks=(
            task("send", 4, 100, "a", deadline=40),
            task("act", 6, 100, "b"),
            task("other", 10, 200, "b", priority=2),
        ),
        frames={"bus": (Frame("m", 1, 100, 100, 5), Frame("n", 2, 50, 50, 7))},
        buses={"bus": Bus(1)},
        released_by={"m": "send", "act": "m"},
    )
    result = holistic.analyse(network)
    assert result.inherited["m"] == 4 and result.inherited["act"] == 16
    assert [result.from_event(n) for n in ("send", "m", "act")] == [4, 16, 32]
    found = of(network, ("send", SAMPLED), ("m", RELEASED), ("act", RELEASED))
    assert [(h.wait, h.response) for h in found.hops] == [(100, 4), (0, 12), (0, 16)]
    assert (found.reaction, found.age) == (132, 32)
    tight = replace(network, tasks=(replace(network.tasks[0], best=4), *network.tasks[1:]))
    assert holistic.analyse(tight).inherited == {**result.inherited, "m": 0, "act": 12}
    assert holistic.analyse(tight).from_event("act") == 32


def test_a_queue_waits_for_a_burst() -> None:
    network = Network((task("write", 1, 10, "a", jitter=25, best=1), task("take", 2, 10, "b")))
    found = of(network, ("write", RELEASED), ("take", QUEUED))
    #  three items may come at once; the third waits for three jobs, and so does each later
    assert (found.hops[1].wait, found.hops[1].backlog) == (10 * 4 - 5, 7)
    assert found.reaction == 26 + 35 + 2
    two = TimedChain("two", (ChainStep("write", RELEASED), ChainStep("take", QUEUED, takes=2)))
    assert latency(two, network, holistic.analyse(network)).hops[1].wait == 20


def test_what_arrives_more_often_than_it_is_taken_has_no_bound() -> None:
    network = Network((task("write", 1, 10, "a"), task("take", 2, 11, "b")))
    found = of(network, ("write", RELEASED), ("take", QUEUED), reaction_limit=10**9)
    assert (found.reaction, found.hops[1].backlog, found.met) == (None, None, False)


def test_a_sporadic_task_samples_without_bound_and_its_values_age_without_bound() -> None:
    network = Network((task("rare", 1, 10, "a", sporadic=True), task("often", 2, 10, "b")))
    assert of(network, ("often", RELEASED), ("rare", SAMPLED)).reaction is None
    found = of(network, ("rare", RELEASED), ("often", SAMPLED), age_limit=99)
    assert (found.reaction, found.age, found.met) == (13, None, False)


def test_limits_are_inclusive() -> None:
    hops = (("read", SAMPLED), ("plan", SAMPLED))
    assert of(LINE, *hops, reaction_limit=37, age_limit=17).met
    assert not of(LINE, *hops, reaction_limit=36).met
    assert not of(LINE, *hops, age_limit=16).met


def test_jitter_that_feeds_itself_has_no_bound_and_ends() -> None:
    #  each chain delays the other on both cores: 0.9 of each core
    tasks = (
        task("a1", 9, 20, "x", priority=1),
        task("a2", 9, 20, "y", priority=2),
        task("b1", 9, 20, "y", priority=1),
        task("b2", 9, 20, "x", priority=2),
    )
    found = holistic.analyse(Network(tasks, released_by={"a2": "a1", "b2": "b1"}))
    assert not found.met
    assert all(r.bound is None or r.bound < 10**6 for r in found.responses.values())


def test_what_is_released_without_bound_takes_those_below_with_it() -> None:
    tasks = (
        task("full", 9, 10, "x", priority=9),
        task("late", 5, 10, "x"),
        task("after", 1, 10, "y", priority=5),
        task("above", 1, 10, "y", priority=6),
        task("below", 1, 10, "y", priority=4),
    )
    released = {"after": "late", "m": "late"}

    def analysed() -> Mapping[str, Response | FrameResponse]:
        names = enumerate("pmn", 1)
        frames = {"bus": tuple(Frame(name, rank, 10, 10, 1) for rank, name in names)}
        return holistic.analyse(Network(tasks, frames, {"bus": Bus(1)}, released)).responses

    found = analysed()
    assert analysed() == found, "from the responses of the bus that are kept, of other frames"
    reasons = {name: response.reason for name, response in found.items()}
    assert reasons == {
        **dict.fromkeys(("full", "above", "p")),
        "late": Reason.OVERLOAD,
        **dict.fromkeys(("after", "below", "m", "n"), Reason.DELAYED),
    }


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (lambda: Network((task("a", 1, 9, "x"),) * 2), "two tasks or messages have the name a"),
        (lambda: Network(LINE.tasks, released_by={"read": "gone"}), "gone is neither a task nor"),
        (
            lambda: Network(LINE.tasks, released_by={"read": "plan"}),
            "period of read must be a multiple of 20, that of plan which releases it, not 10",
        ),
        (
            lambda: Network((task("a", 1, 9, "x"),), released_by={"a": "a"}),
            "a is released by itself",
        ),
        (lambda: Network((), {"bus": ()}), "there are messages on bus, but no such bus"),
        (lambda: of(LINE, ("gone", SAMPLED)), "step gone of chain chain is no task or message"),
        (lambda: of(LINE, ("read", QUEUED)), "must begin with a step without a queue"),
        (
            lambda: of(LINE, ("read", SAMPLED), ("plan", RELEASED)),
            "step plan of chain chain is not released by read",
        ),
        (
            lambda: ChainStep("a", QUEUED, takes=0),
            "takes of step a must be an integer above 0, not 0",
        ),
    ],
)
def test_what_has_no_meaning_is_refused_by_name(made: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        made()


def test_releases_of_a_task_without_bound_take_the_bounds_of_all_above_it() -> None:
    """Releases run above all tasks: also those of a less urgent task whose jitter is lost."""
    network = Network(
        (
            Task("source", 1, 10, 10, 8, core="other"),
            Task("more", 2, 10, 10, 8, core="other"),
            Task("high", 2, 50, 50, 5, core="here"),
            Task("low", 1, 10, 10, 1, core="here"),
        ),
        released_by={"low": "source"},
    )
    assert holistic.analyse(network).from_event("high") == 5
    costly = replace(network, platforms={"here": Platform(release=1)})
    assert holistic.analyse(costly).from_event("high") is None


def test_several_values_at_once_wait_for_each_other() -> None:
    network = Network((task("write", 1, 40, "a"), task("take", 2, 10, "b")))
    chain = TimedChain("many", (ChainStep("write", RELEASED), ChainStep("take", QUEUED, puts=3)))
    hop = latency(chain, network, holistic.analyse(network)).hops[1]
    #  jitter of 1: the third is taken by the third job; 3 more come 39 later at the soonest
    assert (hop.wait, hop.backlog) == (30, 3)
    full = TimedChain("full", (ChainStep("write", RELEASED), ChainStep("take", QUEUED, puts=5)))
    assert latency(full, network, holistic.analyse(network)).reaction is None
    with pytest.raises(ValueError, match="takes several items or is given several, not both"):
        ChainStep("take", QUEUED, takes=2, puts=2)


def test_what_follows_every_second_job_only_waits_for_one_of_those() -> None:
    network = Network(
        (task("a", 1, 10, "x", priority=2), task("b", 1, 20, "x", priority=1)),
        released_by={"b": "a"},
    )
    found = of(network, ("a", SAMPLED), ("b", RELEASED), reaction_limit=15)
    #  an input just missed by the job that b follows waits for the second next one
    assert [(hop.wait, hop.response) for hop in found.hops] == [(10, 1), (10, 2)]
    assert (found.reaction, found.met) == (23, False)
    network = replace(network, tasks=(*network.tasks, task("in", 1, 10, "y")))
    queued = of(network, ("in", RELEASED), ("a", QUEUED), ("b", RELEASED))
    assert queued.reaction is None  # every second item goes no further


def test_a_queue_repeats_its_last_item_until_there_is_a_next_one() -> None:
    network = Network((task("in", 1, 100, "a"), task("take", 2, 10, "b"), task("act", 3, 10, "c")))
    found = of(network, ("in", RELEASED), ("take", QUEUED), ("act", SAMPLED))
    wait = found.hops[1].wait
    assert wait is not None
    assert found.age == 100 + 1 + wait + 2 + 3
    last = of(network, ("in", RELEASED), ("take", QUEUED))
    assert last.age == 100 + 1 + wait + 2


def test_what_keeps_its_old_output_ages_without_bound() -> None:
    network = Network((task("in", 1, 10, "a"), task("act", 3, 10, "c")))
    steps = (ChainStep("in", RELEASED, keeps="it may"), ChainStep("act", SAMPLED))
    found = latency(TimedChain("c", steps), network, holistic.analyse(network))
    assert found.age is None and found.reaction is not None
    last = (ChainStep("in", RELEASED), ChainStep("act", SAMPLED, keeps="it may"))
    found = latency(TimedChain("c", last), network, holistic.analyse(network))
    assert found.age is not None and found.held is None
    waits = (ChainStep("in", RELEASED), ChainStep("act", SAMPLED, waits="for others"))
    found = latency(TimedChain("c", waits), network, holistic.analyse(network))
    assert found.age is not None and found.reaction is None
