# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Ten regions of ten states are checked with little work, or the check says how far it got."""

from __future__ import annotations

import re

import pytest

from ravenchart.behaviour.limits import EFFORT
from ravenchart.behaviour.rules import findings
from ravenchart.gen.model.system import System
from tests.support.behaviour_models import model, region


def _ring(index: int) -> str:
    """A region that goes round ten states, each next step waiting for another thing."""
    name, other = f"Ring_{index}", f"Ring_{(index + 1) % 10}"
    states = ", ".join(f"S{n}: {{}}" for n in range(9))
    ways = (
        "on: Go, guard: level > {n}",
        "on: Stop",
        "after: {n} ms",
        f"when: in({other}.S{{n}}) and level < 9",
        "on: Go, guard: not armed",
    )
    moves = [
        f"t{n}: {{from: S{n}, to: S{(n + 1) % 10}, {ways[n % 5].format(n=n)}}}" for n in range(10)
    ]
    moves += [f"stay_{n}: {{from: S{n}, on: Halt, guard: mode = Service}}" for n in range(10)]
    moves += [f"home_{n}: {{from: S{n}, to: S0, on: Home}}" for n in range(10)]
    counting = 'S9: {entry: [{set: count, to: "min(count + 1, 100)"}]}' if index == 0 else "S9: {}"
    return region(name, f"{{{states}, {counting}}}", "\n".join(moves), initial="S0")


def _rings() -> System:
    return model(
        *(_ring(index) for index in range(10)),
        events="[Go, Stop, Halt, Home]",
        outside="one.Go, one.Stop, one.Halt, one.Home",
        never='{far: "in(Ring_0.S5) and in(Ring_1.S5) and count > 3"}',
    )


@pytest.mark.slow
def test_ten_regions_of_ten_states_take_a_fifth_of_the_work_at_most() -> None:
    assert "RV-1110" not in [item.code for item in findings(_rings(), EFFORT // 5)]


def test_a_check_without_enough_work_says_how_far_it_got_and_as_far_each_time() -> None:
    texts = [findings(_rings(), EFFORT // 50)[0].message for _ in range(2)]
    assert texts[0] == texts[1]
    head = "the behaviour of Unit is not checked to the end: "
    found = re.fullmatch(head + r"(\d+) situations took all the work.*", texts[0])
    assert found is not None and int(found[1]) > 10


def test_findings_are_the_same_each_time() -> None:
    choice = "go: {from: A, to: B, on: Go}\nhigh: {from: B, to: A, guard: level > 5}"
    states = "{A: {}, B: {kind: choice}, C: {}}"
    system = model(region("Main", states, choice + "\nlow: {from: B, to: C, guard: level < 5}"))
    assert findings(system) == findings(system)
