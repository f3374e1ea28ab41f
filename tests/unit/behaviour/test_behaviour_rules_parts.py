# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A chart with too many configurations is checked in parts: each region of a state by itself."""

from __future__ import annotations

import pytest

from ravenchart.behaviour.rules import findings
from ravenchart.behaviour.rules import threads as thread_rules
from ravenchart.behaviour.rules.budget import Budget
from ravenchart.behaviour.rules.reach import Reachable
from ravenchart.behaviour.rules.threads import Thread
from ravenchart.gen.model.system import System
from tests.bench.large_charts import orthogonal_chart
from tests.support.behaviour_models import model, region, said
from tests.support.interpreted import system_of


@pytest.mark.slow
def test_120_leaves_in_four_regions_are_checked_to_the_end() -> None:
    assert [item.code for item in findings(system_of(orthogonal_chart(4, 120)))] == []


def _thread(system: System) -> Thread:
    return Reachable(system.components[0], system, Budget(150_000_000)).threads[0]


@pytest.mark.slow
def test_each_further_leaf_is_a_node_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(thread_rules, "MOST_CONFIGURATIONS", 10)
    threads = [_thread(system_of(orthogonal_chart(4, n))) for n in (60, 120, 240)]
    assert [len(t.nodes) for t in threads] == [63, 123, 243]
    few, some, many = (len(t.steps) for t in threads)
    assert many - some == 2 * (some - few)


@pytest.fixture
def _parts(monkeypatch: pytest.MonkeyPatch) -> None:
    """The smallest charts are looked at in parts."""
    monkeypatch.setattr(thread_rules, "MOST_NODES", 3)
    monkeypatch.setattr(thread_rules, "MOST_CONFIGURATIONS", 3)


BOTH = "{A: {}, Both: {regions: {L: %s, R: {initial: R1, states: {R1: {}, R2: {}, R3: {}}}}}}"
LEFT = "{initial: L1, states: {L1: {}, L2: {}%s}}"
MOVES = (
    "both: {from: A, to: Both, on: Go}\n"
    "left: {from: L1, to: L2, on: Go}\n"
    "back: {from: L2, to: L1, on: Stop}\n"
    "right: {from: R1, to: R2, on: Go}\n"
    "on: {from: R2, to: R3, on: Go}\n"
)
AWAY = "away: {from: R3, to: A, on: Stop}"


def _chart(more: str = AWAY, left: str = "", head: str = "") -> str:
    return region("Main", BOTH % (LEFT % left), MOVES + more, head=head)


@pytest.mark.usefixtures("_parts")
def test_small_chart_is_looked_at_in_parts() -> None:
    thread = _thread(model(_chart()))
    assert thread.parts is not None
    leaves = {node.configuration.active[-1:] for node in thread.nodes}
    assert leaves == {(), *((name,) for name in ("A", "Both", "L1", "L2", "R1", "R2", "R3"))}
    assert not said(model(_chart()))


def _always(source: str, target: str, lost: str) -> str:
    """Two transitions on Go, one of which is always taken, before a third one to ``lost``."""
    rows = (("high", target, "level > 50"), ("low", target, "level <= 50"), ("late", lost, ""))
    return "".join(
        f"\n{name}: {{from: {source}, to: {to}, on: Go{guard and f', guard: {guard}'}}}"
        for name, to, guard in rows
    )


@pytest.mark.usefixtures("_parts")
def test_state_and_transition_that_no_part_comes_to_are_errors() -> None:
    more = f"{AWAY}{_always('L2', 'L1', 'L3')}\nlast: {{from: L3, to: L1, on: Go}}"
    assert said(model(_chart(more, ", L3: {}"))) == [
        "RV-1101 error: the state L3 of Main is never entered, whatever the data"
    ]


@pytest.mark.usefixtures("_parts")
def test_what_another_region_leaves_is_near_the_safe_state() -> None:
    assert not said(model(_chart(head="safe_state: A\n")))


@pytest.mark.usefixtures("_parts")
def test_exit_of_another_region_raises_what_a_third_part_waits_for() -> None:
    """L2 is exited only by a transition from inside the other region."""
    left = BOTH % "{initial: L1, states: {L1: {}, L2: {exit: [{raise: Hit}]}}}"
    moves = MOVES.replace("back: {from: L2, to: L1, on: Stop}\n", "") + AWAY
    other = region("Other", "{A: {}, B: {}}", "hit: {from: A, to: B, on: Hit}")
    system = model(region("Main", left, moves), other, events="[Go, Stop, Hit]")
    assert not said(system)


@pytest.mark.usefixtures("_parts")
def test_state_completes_when_each_region_has_come_to_its_end() -> None:
    ends = "{initial: %s1, states: {%s1: {}, %s2: {kind: final}}}"
    both = ", ".join(f"{n}: {ends % (n, n, n)}" for n in "LR")
    moves = (
        "both: {from: A, to: Both, on: Go}\n"
        "left: {from: L1, to: L2, on: Go}\n"
        "right: {from: R1, to: R2, on: Stop}\n"
        "done: {from: Both, to: C, on: completion}"
    )
    moves = moves.replace(", on: completion", "")
    states = "{A: {}, C: {}, Both: {regions: {%s}}}"
    assert not said(model(region("Main", states % both, moves)))
    stays = both.replace("R2: {kind: final}", "R2: {}, R3: {kind: final}")
    moves += _always("R2", "R1", "R3")
    assert said(model(region("Main", states % stays, moves))) == [
        "RV-1101 error: the state C of Main is never entered, whatever the data",
        "RV-1101 error: the state R3 of Main is never entered, whatever the data",
    ]


@pytest.mark.usefixtures("_parts")
def test_choice_reads_what_another_region_may_have_set_in_the_same_step() -> None:
    """Left sets count to 1 and asks for it behind a choice; Right has no part in it, or has."""
    states = (
        "{A: {}, Both: {regions: {"
        "L: {initial: L1, states: {L1: {}, L2: {}, L3: {}, C: {kind: choice}}},"
        "R: {initial: R1, states: {R1: {}, R2: {exit: [{set: count, to: %s}]}}}}}}"
    )
    moves = (
        "both: {from: A, to: Both, on: Go}\n"
        "ask: {from: L1, to: C, on: Stop, effect: [{set: count, to: 1}]}\n"
        "one: {from: C, to: L2, guard: count = 1}\n"
        "other: {from: C, to: L3, guard: count /= 1}\n"
        "again: {from: L2, to: L1, on: Go}\n"
        "also: {from: L3, to: L1, on: Go}\n"
        "right: {from: R1, to: R2, on: Go}\n"
        "back: {from: R2, to: R1, on: Stop}\n"
        "away: {from: Both, to: A, on: Off}"
    )
    events = {"events": "[Go, Stop, Off]", "outside": "one.Go, one.Stop, one.Off"}
    found = said(model(region("Main", states % "2", moves), **events))
    assert not [one for one in found if "RV-1102" in one or "RV-1104" in one], found
    alone = region("Main", (states % "2").replace("set: count, to: 2", "raise: Off"), moves)
    found = said(model(alone, **events))
    assert found == ["RV-1101 error: the state L3 of Main is never entered, whatever the data"]


NEVER = '{both: "in(Main.%s) and in(Main.%s)"}'


@pytest.mark.usefixtures("_parts")
@pytest.mark.parametrize("pair", [("L1", "L2"), ("A", "L2"), ("A", "Both"), ("R1", "R3")])
def test_invariant_of_states_that_exclude_each_other_is_proved(pair: tuple[str, str]) -> None:
    assert not said(model(_chart(), never=NEVER % pair))


@pytest.mark.usefixtures("_parts")
@pytest.mark.parametrize("pair", [("L2", "R2"), ("Both", "L1")])
def test_invariant_of_regions_that_meet_is_violated(pair: tuple[str, str]) -> None:
    found = said(model(_chart(), never=NEVER % pair))
    assert [one[:10] for one in found] == ["RV-1108 er"], found


@pytest.mark.usefixtures("_parts")
def test_invariant_over_data_of_such_a_chart_is_not_proved_by_one_region() -> None:
    """One region keeps it, and the other one, in the same step, does not."""
    states = BOTH % "{initial: L1, states: {L1: {}, L2: {entry: [{set: count, to: 1}]}}}"
    moves = MOVES.replace("from: R1, to: R2, on: Go", "from: R1, to: R2, on: Go, effect: %s")
    moves = moves.replace("%s", '[{set: count, to: "min(count * 2, 100)"}]') + AWAY
    found = said(model(region("Main", states, moves), never='{two: "count = 2"}'))
    assert [one[:10] for one in found] == ["RV-1108 er"], found
