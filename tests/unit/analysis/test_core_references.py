# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The reference cases, to the unit."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from ravenchart.analysis.core import can, fixed_priority, holistic
from ravenchart.analysis.core.assignment import (
    Order,
    audsley_frames,
    deadline_monotonic,
)
from ravenchart.analysis.core.bus import Bus, Frame
from ravenchart.analysis.core.chains import ChainStep, HopKind, TimedChain, latency
from ravenchart.analysis.core.frames import classic_bits
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.core.sensitivity import network_scaling
from tests.support.core_cases import (
    bus_of,
    cases,
    frames_of,
    network_of,
    ns,
    sections_of,
    tasks_of,
    two_nodes,
)
from tests.support.priorities import audsley_tasks, with_priorities, with_ranks


def named(file: str, *models: str) -> list[Any]:
    return [pytest.param(case, id=case["name"]) for case in cases(file, *models)]


def test_every_case_of_the_files_is_read_below() -> None:
    models = ("fp", "fp-offsets", "opa", "holistic")
    assert [len(cases("rta.json", model)) for model in models] == [6, 1, 1, 2]
    models = ("can-2007", "can-1994", "can-opa", "can-frame-length")
    assert [len(cases("can.json", model)) for model in models] == [5, 1, 1, 1]


@pytest.mark.parametrize("case", named("rta.json", "fp"))
def test_tasks(case: Any) -> None:
    for response in fixed_priority.analyse_tasks(tasks_of(case), sections_of(case)):
        expected = case["expected"][response.task.name]
        assert response.bound == expected["R"]
        assert response.met == expected["ok"]
        assert response.worst_job == expected.get("worst_job", 0)
        assert response.blocked == expected.get("B", 0)


@pytest.mark.parametrize("case", named("rta.json", "fp-offsets"))
def test_tasks_with_offsets_have_the_exact_figure_and_without_them_the_plain_one(
    case: Any,
) -> None:
    tasks = tasks_of(case)
    for response in fixed_priority.analyse_tasks(tasks):
        expected = case["expected"][response.task.name]
        assert (response.bound, response.met) == (expected["R"], expected["ok"])
    for response in fixed_priority.analyse_tasks([replace(task, offset=None) for task in tasks]):
        assert response.bound == case["expected"][response.task.name]["R_without_offsets"]


@pytest.mark.parametrize("case", named("rta.json", "opa"))
def test_assignment_of_priorities(case: Any) -> None:
    expected, tasks = case["expected"], tasks_of(case)
    monotonic = Order(tuple(task.name for task in deadline_monotonic(tasks)))
    assert list(monotonic.names) == expected["dm_order"]
    by_deadline = fixed_priority.analyse_tasks(with_priorities(tasks, monotonic))
    assert {r.task.name: r.bound for r in by_deadline} == expected["dm_R"]
    assert all(r.met for r in by_deadline) == expected["dm_schedulable"]
    order = audsley_tasks(tasks)
    assert order.complete == expected["feasible"]
    assert all(r.met for r in fixed_priority.analyse_tasks(with_priorities(tasks, order)))
    example = Order(tuple(expected["opa_order_example"]))
    found = fixed_priority.analyse_tasks(with_priorities(tasks, example))
    assert {r.task.name: r.bound for r in found} == expected["opa_R"]


@pytest.mark.parametrize("case", named("rta.json", "holistic"))
def test_chains_over_several_resources(case: Any) -> None:
    found = holistic.analyse(network_of(case))
    expected = case["expected"]
    assert {name: found.from_event(name) for name in expected["steps"]} == expected["steps"]
    assert found.met == case["schedulable"]
    for chain in case["transactions"]:
        assert (
            found.from_event(chain["steps"][-1]["name"])
            == (expected["end_to_end"][chain["name"]]["R"])
        )


@pytest.mark.parametrize("case", named("can.json", "can-2007"))
def test_frames(case: Any) -> None:
    frames = frames_of(case)
    for response in can.analyse(frames, bus_of(case)):
        expected = case["expected"][response.frame.name]
        assert response.bound == ns(expected["R"])
        assert response.met == expected["ok"]
        assert response.blocked == ns(expected["B"])
        assert response.instances == expected["instances"]
        assert response.worst_instance == expected.get("worst_instance", 0)
        assert (
            response.frame.transmission_time * case["bit_rate_kbit"] == expected["C_bits"] * 10**6
        )
    assert round(float(can.load(frames)), 6) == float(case["utilisation"])


def first_instance_only(frames: list[Frame], bus: Bus) -> dict[str, int]:
    """The analysis of 1994: it overlooks what the first instance pushes on to later ones."""
    found = {}
    for frame in frames:
        urgent = [f for f in frames if f.rank < frame.rank]
        blocked = max((f.transmission_time for f in frames if f.rank > frame.rank), default=0)
        wait, settled = -1, blocked
        while wait != settled:
            wait = settled
            settled = blocked + sum(
                -(-(f.jitter + wait + bus.bit_time) // f.period) * f.transmission_time
                for f in urgent
            )
        found[frame.name] = frame.jitter + wait + frame.transmission_time
    return found


@pytest.mark.parametrize("case", named("can.json", "can-1994"))
def test_the_old_analysis_is_optimistic(case: Any) -> None:
    frames, bus = frames_of(case), bus_of(case)
    old = first_instance_only(frames, bus)
    assert old == {name: ns(e["R"]) for name, e in case["expected"].items()}
    assert all(old[f.name] <= f.deadline for f in frames) == case["schedulable"]
    new = {r.frame.name: r for r in can.analyse(frames, bus)}
    assert (old["c"], new["c"].bound, new["c"].met) == (3_000_000, 3_600_000, False)
    assert (old["a"], old["b"]) == (new["a"].bound, new["b"].bound)


@pytest.mark.parametrize("case", named("can.json", "can-opa"))
def test_assignment_of_identifiers(case: Any) -> None:
    expected, frames, bus = case["expected"], frames_of(case), bus_of(case)
    ranks = [10, 20, 30]
    monotonic = Order(tuple(frame.name for frame in deadline_monotonic(frames)))
    assert list(monotonic.names) == expected["djm_order"]
    by_deadline = can.analyse(with_ranks(frames, monotonic, ranks), bus)
    assert {r.frame.name: r.bound for r in by_deadline} == {
        name: ns(bound) for name, bound in expected["djm_R"].items()
    }
    assert all(r.met for r in by_deadline) == expected["djm_schedulable"]
    order = audsley_frames(frames, bus)
    assert order.complete == expected["feasible"]
    assert list(order.names) == expected["opa_order_example"]
    found = can.analyse(with_ranks(frames, order, ranks), bus)
    assert {r.frame.name: r.bound for r in found} == {
        name: ns(bound) for name, bound in expected["opa_R"].items()
    }


@pytest.mark.parametrize("case", named("can.json", "can-frame-length"))
def test_frame_lengths(case: Any) -> None:
    for row in case["expected"]:
        size = row["data_bytes"]
        assert classic_bits(size).nominal == row["std_max"]
        assert classic_bits(size, stuffed=False).nominal == row["std_min"]
        assert classic_bits(size, extended=True).nominal == row["ext_max"]
        assert classic_bits(size, extended=True, stuffed=False).nominal == row["ext_min"]


def test_two_nodes_as_mast_has_them() -> None:
    network = two_nodes()
    found = holistic.analyse(network)
    assert {name: found.from_event(name) for name in network.items()} == {
        "sense": 2100,
        "frame_cmd": 2640,
        "wheel": 3350,
        "housekeeping": 3960,
        "frame_hk": 4500,
    }
    sense = found.responses["sense"]
    assert isinstance(sense, Response)
    assert (sense.blocked, found.responses["frame_cmd"].blocked) == (120, 270)
    assert (sense.jitter, sense.own, sense.overheads.switch_time) == (1050, 900, 10)
    assert (sense.overheads.ticks, sense.overheads.tick_time) == (2, 20)
    loads = {r.task.core: r.level.load for r in found.responses.values() if isinstance(r, Response)}
    assert loads == {"obc": Fraction(1311, 10_000), "act": Fraction(71, 1_000)}
    assert can.load(network.frames["can"]) == Fraction(297, 10_000)


def test_two_nodes_chain_is_its_holistic_response() -> None:
    network = two_nodes()
    steps = tuple(ChainStep(name, HopKind.RELEASED) for name in ("sense", "frame_cmd", "wheel"))
    found = latency(TimedChain("control", steps), network, holistic.analyse(network))
    assert [hop.response for hop in found.hops] == [2100, 540, 710]
    assert (found.reaction, found.age, found.held) == (3350, 3350, 13_350)


@pytest.mark.parametrize(
    ("names", "factor", "binding", "printed"),
    [
        (None, "3.9285", "wheel", 292.58),
        (("sense", "frame_cmd", "wheel"), "4.54", "wheel", 353.91),
        (("housekeeping", "frame_hk"), "18", "wheel", 1699.6),
    ],
)
def test_two_nodes_have_the_room_that_mast_finds_by_halving(
    names: tuple[str, ...] | None, factor: str, binding: str, printed: float
) -> None:
    found = network_scaling(two_nodes(), names)
    assert found is not None
    assert (found.factor, found.binding) == (Fraction(factor), binding)
    assert 0 <= float(found.factor - 1) * 100 - printed < 1
