# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What would meet all deadlines: each change that is told suffices, and a step less does not."""

from __future__ import annotations

import itertools
import random
from dataclasses import replace
from fractions import Fraction

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.changes import (
    STEPS,
    ChangeKind,
    moved,
    parts,
    ranked,
    reordered,
    shorter,
    shrunk,
    slower,
    stretched,
)
from ravenchart.analysis.core.holistic import Network, met
from ravenchart.analysis.core.tasks import TableRow, Task
from tests.support.random_networks import random_network

#  b needs 5 + 2 x 3 = 11 us within 10.
LATE = Network((Task("a", 2, 7_000, 7_000, 3_000), Task("b", 1, 40_000, 10_000, 5_000)))


def test_the_least_changes_by_hand() -> None:
    """Twice 2.5 of a leave 5 for b; 4 of b end before the second a, and so do 8 us."""
    found = {c.name: c.factor for c in shorter(LATE, {"a": [("a", "")], "b": [("b", "")]}, met)}
    assert found == {"a": Fraction(833, 1_000), "b": Fraction(4, 5)}
    (longer,) = slower(LATE, ["a"], met)
    assert longer.factor == Fraction(1_143, 1_000)  # 8.001 us, and 8 us with a step less
    (never,) = slower(LATE, ["b"], met)
    assert not never.enough


def test_every_change_suffices_and_a_step_less_does_not() -> None:
    looked = 0
    for seed in range(60):
        network = random_network(random.Random(seed))
        found = holistic.analyse(network)
        if found.met or len(found.responses) > 6:
            continue
        looked += 1
        step = Fraction(1, STEPS)
        groups = {task.name: parts(task) for task in network.tasks}
        for change in shorter(network, groups, met):
            chosen = groups[change.name]
            if change.factor is None:
                assert not met(shrunk(network, chosen, step))
            else:
                assert met(shrunk(network, chosen, change.factor))
                more = change.factor + step
                assert more == 1 or not met(shrunk(network, chosen, more))
        roots = [n for n in network.items() if n not in network.released_by]
        for change in slower(network, roots[:2], met):
            if change.factor is not None:
                assert met(stretched(network, change.name, change.factor))
    assert looked > 5


def test_an_order_is_found_where_there_is_one() -> None:
    """On plain tasks of one core: as all orders tried one by one."""
    some = none = 0
    for seed in range(200):
        network = random_network(random.Random(seed), plain=True)
        tasks = network.tasks
        if met(network) or not 2 <= len(tasks) <= 4:
            continue
        (change,) = reordered(network, {t.name for t in tasks}, met)
        orders = itertools.permutations(range(1, len(tasks) + 1))
        exists = any(
            met(replace(network, tasks=tuple(
                replace(t, priority=p) for t, p in zip(tasks, order, strict=True))))
            for order in orders
        )  # fmt: skip
        assert change.enough == exists, seed
        some, none = some + exists, none + (not exists)
        if exists:
            level = {name: -n for n, name in enumerate(change.order)}
            given = tuple(replace(t, priority=level[t.name]) for t in tasks)
            assert met(replace(network, tasks=given))
    assert none > 5


def test_an_inverted_order_is_put_right() -> None:
    network = Network(
        (Task("slow", 2, 100, 100, 30), Task("fast", 1, 20, 20, 5)),
        sections=(Section("o", "slow", 3), Section("o", "fast", 3)),
        ceilings={"o": 2},
    )
    (change,) = reordered(network, {"slow", "fast"}, met)
    assert (change.kind, change.enough, change.order) == (ChangeKind.ORDER, True, ("fast", "slow"))


def test_a_late_frame_moves_up_as_few_places_as_do() -> None:
    frames = tuple(Frame(name, n, 100, 100, 10) for n, name in enumerate("abcd"))
    late = replace(frames[3], deadline=30)
    network = Network((), {"can": (*frames[:3], late)}, {"can": Bus(1)})
    (change,) = moved(network, "d", met)
    assert change.order == ("a", "d", "b", "c")
    hopeless = replace(network, frames={"can": (*frames[:3], replace(late, deadline=12))})
    (change,) = moved(hopeless, "d", met)
    assert not change.enough


def test_rows_shrink_alone_and_sections_with_their_job() -> None:
    network = Network(
        (Task("a", 1, 100, 100, rows=(TableRow("r", 10), TableRow("s", 40))),),
        sections=(Section("o", "a", 45),),
    )
    less = shrunk(network, [("a", "s")], Fraction(1, 4))
    assert [row.wcet for row in less.tasks[0].rows] == [10, 10]
    assert less.sections[0].length == 20


def test_what_suffices_comes_first_and_the_least_of_it() -> None:
    changes = ranked(
        [*shorter(LATE, {"a": [("a", "")]}, met), *reordered(LATE, {"a", "b"}, met),
         *slower(LATE, ["a", "b"], met)]
    )  # fmt: skip
    enough = [change.enough for change in changes]
    assert enough == sorted(enough, reverse=True)
    amounts = [change.amount for change in changes if change.enough]
    assert amounts == sorted(amounts)
