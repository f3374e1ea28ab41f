# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The timing of a system: its tasks, frames and chains as the core sees them.

What the core itself does with them is shown by the tests of the core.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.responses import Reason
from ravenchart.analysis.present.sentences import growth_line
from ravenchart.analysis.system.timing import Analysis, Verdict, analyse
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import BusErrors
from ravenchart.gen.model.nodes import Tick
from ravenchart.gen.model.system import SharedObject, System, Task
from tests.support.core_cases import cases
from tests.support.pump import system_of
from tests.support.simulation import longest_responses
from tests.support.systems import bus, message, shared, system, task

REFERENCES = [c for c in cases("rta.json", "fp") if not any("offset" in t for t in c["tasks"])]


def system_of_case(case: Any) -> System:
    """Each section as an object of its own, with the ceiling of what it is inside."""
    tasks = [
        task(t["name"], t["prio"], t["C"], t["T"], t["D"], t.get("J", 0)) for t in case["tasks"]
    ]
    ceilings: dict[str, int] = {}
    for one in case["tasks"]:
        for name, _ in one.get("cs", []):
            ceilings[name] = max(one["prio"], ceilings.get(name, 0))
    objects = [
        shared(f"{name}.{one['name']}", ceilings[name], length, one["name"])
        for one in case["tasks"]
        for name, length in one.get("cs", [])
    ]
    return system(tasks, objects)


@pytest.mark.parametrize("case", [pytest.param(c, id=c["name"]) for c in REFERENCES])
def test_reference_cases_are_reproduced_through_a_system(case: Any) -> None:
    found = analyse(system_of_case(case))
    for response in found.responses:
        expected = case["expected"][response.task.name]
        assert response.bound == expected["R"]
        assert (found.verdict(response.task.name) is Verdict.MET) == expected["ok"]
        assert response.worst_job == expected.get("worst_job", 0)
        assert response.blocked == expected.get("B", 0)


def test_every_case_of_the_reference_file_is_accounted_for() -> None:
    assert len(REFERENCES) == 6


def test_the_breakdown_adds_up_by_hand() -> None:
    #  c: w = 5 + ceil(20/7) 3 + ceil(20/12) 3 = 5 + 9 + 6 = 20
    tasks = [task("a", 3, 3, 7), task("b", 2, 3, 12), task("c", 1, 5, 20)]
    found = analyse(system(tasks))
    c = found.response("c")
    shares = [(i.task.name, i.releases, i.time) for i in c.interference]
    assert shares == [("a", 3, 9), ("b", 2, 6)]
    assert (c.own, c.blocked, c.bound, c.jobs, found.slack("c")) == (5, 0, 20, 1, 0)


def verdicts(*tasks: Task) -> list[Verdict]:
    found = analyse(system(tasks))
    return [found.verdict(one.element) for one in tasks]


def test_response_equal_to_deadline_passes_and_one_nanosecond_more_fails() -> None:
    assert verdicts(task("a", 2, 3, 10), task("b", 1, 4, 20, 7)) == [Verdict.MET, Verdict.MET]
    late = (task("a", 2, 3, 10), task("b", 1, 5, 20, 7))
    assert verdicts(*late) == [Verdict.MET, Verdict.MISSED]
    assert analyse(system(late)).slack("b") == -1


def test_equal_priorities_interfere_both_ways() -> None:
    found = analyse(system([task("a", 5, 2, 20), task("b", 5, 3, 20)]))
    assert [r.bound for r in found.responses] == [5, 5]


def test_tasks_of_other_nodes_do_not_interfere() -> None:
    one = system([task("a", 1, 5, 10), replace(task("z", 9, 9, 10), node="other")])
    other = replace(one.nodes[0], name="other")
    found = analyse(replace(one, nodes=(*one.nodes, other)))
    assert [r.bound for r in found.responses] == [5, 9]
    assert found.utilisation("other") == Fraction(9, 10)


def test_load_above_one_has_no_bound_and_says_so() -> None:
    found = analyse(system([task("a", 2, 6, 10), task("b", 1, 5, 10)]))
    assert found.verdict("a") is Verdict.MET
    assert (found.verdict("b"), found.slack("b")) == (Verdict.NO_BOUND, None)
    assert found.response("b").reason is Reason.OVERLOAD


def test_the_blocker_is_the_longest_section_below_whose_ceiling_reaches_the_task() -> None:
    tasks = [task("high", 3, 4, 50), task("middle", 2, 9, 50), task("low", 1, 9, 50)]
    objects = [
        shared("queue", 3, 4, "high", "low"),
        shared("store", 2, 9, "middle", "low"),
        shared("log", 3, 4, "high", "main"),
        shared("end", 1, 6, "low", "main"),
    ]
    found = analyse(system(tasks, objects))
    assert found.response("high").blocking == Section("queue", "low", 4)
    assert found.response("middle").blocking == Section("store", "low", 9)
    assert found.response("low").blocking == Section("end", "main", 6)


def test_users_of_equal_priority_do_not_block() -> None:
    tasks = [task("a", 2, 5, 20), task("b", 2, 5, 20)]
    found = analyse(system(tasks, [shared("o", 2, 5, "a", "b")]))
    assert [r.blocked for r in found.responses] == [0, 0]


def test_worst_slack_comes_first_and_no_bound_before_all() -> None:
    tasks = [task("a", 4, 1, 10), task("b", 3, 3, 10, 5), task("c", 2, 4, 10, 7)]
    tasks.append(task("d", 1, 9, 9))
    assert analyse(system(tasks)).worst_first() == ("d", "c", "b", "a")


def test_utilisation_is_exact() -> None:
    tasks = [task("a", 2, 1, 3), task("b", 1, 1, 6)]
    assert analyse(system(tasks)).utilisation("cpu") == Fraction(1, 2)


def test_growth_is_the_last_step_that_meets_every_deadline() -> None:
    def growth(*tasks: Task) -> str:
        return growth_line(analyse(system(tasks)))

    assert "may grow by 150 %" in growth(task("a", 1, 400_000, 1_000_000))
    assert "must shrink by 50 %" in growth(task("a", 1, 2_000_000, 1_000_000))
    assert growth(task("a", 1, 1, 10, 10, jitter=11)).startswith("no execution time, however")


def test_an_analysis_finds_its_tasks_by_name() -> None:
    found: Analysis = analyse(system([task("a", 1, 1, 2)]))
    assert found.schedulable
    with pytest.raises(KeyError):
        found.response("b")


# --- Tables ----------------------------------------------------------------------------


def test_rows_count_in_the_releases_that_run_them() -> None:
    """Of the pump house, `tell` runs in every second release only."""
    found = analyse(system_of())
    rows = {row.name: row.every for row in found.network.tasks[1].rows}
    assert rows == {"north.ports": 1, "north.Control": 1, "north.tell": 2}
    #  a release every 10 ms: 50 us, or 80 us with `tell`; and two context switches
    regulation = found.response("regulation").task
    assert regulation.utilisation == Fraction(50_000 + 80_000, 20_000_000)
    assert found.plain.responses["regulation"].bound == found.response("regulation").bound


def test_a_window_over_two_releases_holds_a_rare_row_once_and_the_plain_sum_twice() -> None:
    fast = task("fast", 2, 8, 10)
    low = task("low", 1, 7, 40)
    one = system([fast, low])
    base = system_of().tasks[1].slots
    slots = tuple(
        replace(slot, divisor=n, timing=replace(slot.timing, wcet=Ns(4)))
        for slot, n in zip(base[:2], (1, 2), strict=True)
    )
    one = replace(one, tasks=(replace(fast, slots=slots), low))
    found = analyse(one)
    #  low: 7 + 8 + 4 = 19 in two releases of `fast`; with 8 in each, 7 + 3 x 8 = 31 in four
    assert found.response("low").bound == 19
    assert found.plain.responses["low"].bound == 39
    rows = [(row.row.name, row.bound) for _, row in found.rows()]
    assert rows == [("north.ports", 4), ("north.Control", 8)]


def test_overheads_of_the_node_are_those_of_its_tasks() -> None:
    one = system([replace(task("a", 1, 100, 10_000), timed=True)])
    node = replace(one.nodes[0], context_switch=Ns(5), release=Ns(3), tick=Tick(Ns(1_000), Ns(10)))
    found = analyse(replace(one, nodes=(node,)))
    #  a tick of lateness; then 100 + 2 switches + 1 release + 1 tick
    assert found.response("a").bound == 1_000 + 100 + 10 + 3 + 10


# --- Buses and chains ------------------------------------------------------------------


def test_frames_take_part_and_their_senders_responses_are_their_jitter() -> None:
    found = analyse(system_of())
    regulation = found.response("regulation").bound
    released = found.found.inherited
    assert released["can_bus.driver_tx.valve_out"] == regulation
    assert released["can_bus.valve_out"] == found.response("can_bus.driver_tx.valve_out").bound
    assert released["can_bus.driver_rx.level_in"] == found.found.responses["can_bus.level_in"].bound
    #  both have two bytes, 75 bits; the other frame is in the way
    assert found.found.responses["can_bus.level_in"].bound == (75 + 75) * 2_000


def test_frames_of_the_node_share_a_queue() -> None:
    found = analyse(system_of())
    queues = {frame.name: frame.queue for frame in found.network.frames["can_bus"]}
    assert queues == {"can_bus.level_in": "", "can_bus.valve_out": "board.can_bus"}


def test_errors_of_a_bus_delay_its_frames_and_load_it() -> None:
    clean = system([], (), [bus()], [message("a", period=1_000_000)])
    errors = BusErrors(Ns(10_000_000), 2)
    faulty = replace(clean, buses=(replace(clean.buses[0], errors=errors),))
    first, second = (analyse(one).frames(one.buses[0])[0] for one in (clean, faulty))
    #  two errors of 31 bits and the frame of 135 bits again
    assert (first.bound, second.bound) == (270_000, 270_000 + 2 * (31 + 135) * 2_000)
    assert analyse(clean).bus_load(clean.buses[0]) == Fraction(27, 100)
    extra = Fraction((31 + 135) * 2_000, 10_000_000)
    assert analyse(faulty).bus_load(faulty.buses[0]) == Fraction(27, 100) + extra


def test_a_reception_that_is_too_slow_has_no_delivery() -> None:
    slow = system_of(("released_by: can_bus, period: 1 ms", "released_by: can_bus, period: 11 ms"))
    (delivery,) = analyse(slow).deliveries.values()
    assert delivery.bound is None
    assert not analyse(slow).schedulable
    (delivery,) = analyse(system_of()).deliveries.values()
    reception = analyse(system_of()).response("reception").bound
    assert reception is not None
    arrival = analyse(system_of()).found.responses["can_bus.driver_rx.level_in"].bound
    assert delivery.bound == (arrival or 0) + 2 * reception


def test_a_chain_is_followed_from_frame_to_frame() -> None:
    (chain,) = analyse(system_of()).chains
    hops = [(hop.step.name, hop.step.hop.value) for hop in chain.hops]
    assert hops == [
        ("can_bus.level_in", "released"),
        ("can_bus.driver_rx.level_in", "released"),
        ("can_bus.level_in.reception", "released"),
        ("north.ports", "sampled"),
        ("north.tell", "sampled"),
        ("can_bus.driver_tx.valve_out", "released"),
        ("can_bus.valve_out", "released"),
    ]
    found = analyse(system_of())
    rows = {row.row.name: row.bound for _, row in found.rows()}
    sent = found.found.responses["can_bus.valve_out"].bound
    delivered = found.deliveries["can_bus.level_in"].bound
    assert sent is not None and delivered is not None
    assert chain.reaction == delivered + 10_000_000 + rows["north.ports"] + 20_000_000 + sent


# --- Properties ------------------------------------------------------------------------


@st.composite
def task_sets(draw: st.DrawFn) -> list[Task]:
    """One to four tasks with short periods; any load, ties included."""
    tasks = []
    for index in range(draw(st.integers(1, 4))):
        period, level = draw(st.integers(2, 12)), draw(st.integers(1, 4))
        tasks.append(task(f"t{index}", level, draw(st.integers(1, 5)), period))
    return tasks


@settings(max_examples=120, deadline=None)
@given(task_sets())
@example([task("a", 2, 3, 12), task("b", 1, 14, 19, 25)])
def test_synchronous_sets_agree_with_simulation(tasks: list[Task]) -> None:
    assume(len({t.priority for t in tasks}) == len(tasks))
    assume(sum(Fraction(t.wcet, t.period) for t in tasks) <= 1)
    found = analyse(system(tasks))
    assert {r.task.name: r.bound for r in found.responses} == longest_responses(tasks)


@settings(max_examples=100, deadline=None)
@given(task_sets(), st.integers(0, 1))
def test_the_plain_sum_is_never_less(tasks: list[Task], section: int) -> None:
    objects: list[SharedObject] = [shared("o", 4, section, "main")] if section else []
    found = analyse(system(tasks, objects))
    for name, response in found.found.responses.items():
        plain = found.plain.responses[name].bound
        assert response.bound is None or plain is None or plain >= response.bound
