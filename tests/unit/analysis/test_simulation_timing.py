# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Simulated tasks and buses against the bounds: never above, and equal where theory says so."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest

from ravenchart.analysis.core import can, holistic
from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.chains import latency
from ravenchart.analysis.core.fixed_priority import analyse_tasks, response_under
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.core.tasks import TableRow, Task
from ravenchart.analysis.simulation.engine import simulate
from ravenchart.analysis.simulation.phases import (
    InsideSection,
    Phase,
    PhaseScenario,
)
from tests.support import worst_phases
from tests.support.random_flows import observed_chain, random_chain
from tests.support.random_networks import (
    random_distribution,
    random_network,
    with_epochs,
    with_offsets,
)
from tests.support.random_phases import chance_scenario

SYSTEMS = 1_000


def late(limit: int) -> Phase:
    return Phase(late=lambda _: limit)


# --- The rules, by hand -------------------------------------------------------------------


def test_a_more_urgent_task_preempts_and_every_stretch_is_recorded() -> None:
    tasks = (Task("low", 1, 100, 100, 10), Task("high", 2, 100, 100, 3))
    scenario = PhaseScenario({"high": Phase(first=4)})
    seen = simulate(Network(tasks), scenario, 50, record=True)
    assert seen.longest == {"low": 13, "high": 3}
    assert [(s.name, s.start, s.end) for s in seen.stretches] == [
        ("low", 0, 4),
        ("high", 4, 7),
        ("low", 7, 13),
    ]


def test_a_section_runs_at_its_ceiling_from_its_first_tick_on() -> None:
    tasks = (Task("low", 1, 100, 100, 10), Task("high", 2, 100, 100, 3))
    sections = (Section("o", "low", 5), Section("o", "high", 1))
    inside = {"low": Phase(inside=(InsideSection(2, sections[0]),))}
    for first, response in ((2, 3), (3, 7), (6, 4), (7, 3)):
        phases = inside | {"high": Phase(first=first)}
        seen = simulate(Network(tasks, sections=sections), PhaseScenario(phases), 50)
        assert seen.longest["high"] == response, first


def test_equals_run_first_in_first_out() -> None:
    tasks = (Task("a", 1, 100, 100, 5), Task("b", 1, 100, 100, 5), Task("top", 2, 100, 100, 2))
    scenario = PhaseScenario({"b": Phase(first=1), "top": Phase(first=2)})
    assert simulate(Network(tasks), scenario, 50).longest == {"a": 7, "b": 11, "top": 2}


def test_rows_run_in_their_frames_and_each_is_timed() -> None:
    rows = (TableRow("fast", 2), TableRow("slow", 5, every=2, phase=1))
    task = Task("t", 1, 10, 10, 1, rows=rows)
    seen = simulate(Network((task,)), PhaseScenario(), 40)
    assert seen.rows == {("t", "fast"): 3, ("t", "slow"): 8}
    assert seen.longest == {"t": 8}
    only = simulate(Network((task,)), PhaseScenario(), 9)
    assert only.rows == {("t", "fast"): 3}


def test_a_frame_is_not_preempted_and_one_queued_within_a_bit_takes_part() -> None:
    frames = {"can": (Frame("low", 2, 1_000, 1_000, 100), Frame("high", 1, 1_000, 1_000, 60))}
    for first, response in ((0, 60), (1, 59), (2, 158)):
        network = Network((), frames, {"can": Bus(2)})
        seen = simulate(network, PhaseScenario({"high": Phase(first=first)}), 900)
        assert seen.longest["high"] == response, first


def test_a_queue_sends_its_oldest_and_a_fault_costs_the_frame_and_its_recovery() -> None:
    frames = (
        Frame("slow", 9, 1_000, 1_000, 60, queue="node"),
        Frame("urgent", 1, 1_000, 1_000, 60, queue="node"),
        Frame("middle", 5, 1_000, 1_000, 60),
    )
    network = Network((), {"can": frames}, {"can": Bus(1)})
    assert simulate(network, PhaseScenario(), 900).longest == {
        "middle": 60,
        "slow": 120,
        "urgent": 180,
    }
    struck = simulate(network, PhaseScenario(faults={"can": (50,)}), 900)
    assert struck.longest["middle"] == 50 + 31 + 60


def test_a_completion_releases_what_follows() -> None:
    network = Network(
        (Task("send", 1, 1_000, 1_000, 10, jitter=5), Task("take", 1, 1_000, 1_000, 20, core="b")),
        {"can": (Frame("m", 1, 1_000, 1_000, 60, jitter=3),)},
        {"can": Bus(1)},
        {"m": "send", "take": "m"},
    )
    seen = simulate(network, PhaseScenario({"send": late(5), "m": late(3)}), 900)
    assert seen.longest == {"send": 15, "m": 78, "take": 98}


def test_what_cannot_be_simulated_is_refused() -> None:
    task = Task("t", 1, 10, 10, 1, jitter=2)
    with pytest.raises(ValueError, match="overheads of core  cannot be simulated"):
        simulate(Network((task,), platforms={"": Platform(release=1)}), PhaseScenario(), 10)
    with pytest.raises(ValueError, match="t must be released at most 2 late"):
        simulate(Network((task,)), PhaseScenario({"t": late(3)}), 10)
    with pytest.raises(ValueError, match="until of the simulation"):
        simulate(Network((task,)), PhaseScenario(), -1)


# --- Against the bounds ----------------------------------------------------------------


@pytest.mark.slow
def test_no_random_system_is_observed_above_its_bounds() -> None:
    """Tables, sections, jitter, several cores, a bus with queues and faults, chains."""
    compared = 0
    for seed in range(SYSTEMS):
        chance = random.Random(seed)
        network = random_network(chance)
        found = holistic.analyse(network)
        until = 8 * max(item.period for item in network.items().values())
        for _ in range(2):
            seen = simulate(network, chance_scenario(network, chance, until), until)
            for name, longest in seen.longest.items():
                bound = found.from_event(name)
                assert bound is None or longest <= bound, (seed, name, longest, bound)
                compared += 1
            for (name, row), longest in seen.rows.items():
                response = found.responses[name]
                assert isinstance(response, Response)
                for one in response.rows:
                    if one.row.name == row:
                        best = found.best[name]
                        assert longest <= best + one.bound, (seed, name, row)
    assert compared > 5 * SYSTEMS


@pytest.mark.slow
def test_no_random_system_of_several_cores_and_buses_is_observed_above_its_bounds() -> None:
    """Chains over gateways, each from its first event on."""
    compared = bounded = far = 0
    for seed in range(SYSTEMS):
        chance = random.Random(seed)
        network = random_distribution(chance)
        found = holistic.analyse(network)
        until = 8 * max(item.period for item in network.items().values())
        seen = simulate(network, chance_scenario(network, chance, until), until)
        for name, longest in seen.longest.items():
            bound = found.from_event(name)
            assert bound is None or longest <= bound, (seed, name, longest, bound)
            compared += 1
            bounded += bound is not None
            far += bound is not None and name in {"x0.2", "x1.2", "x2.2"}
    assert bounded > compared // 2 and far > 20


@pytest.mark.slow
def test_no_chain_of_a_random_system_is_observed_above_its_bounds() -> None:
    """Ages, reactions and backlogs over several cores and buses, by variables and by queues."""
    ages = reactions = backlogs = close = 0
    for seed in range(SYSTEMS):
        chance = random.Random(seed)
        network = random_distribution(chance)
        chain = random_chain(network, chance)
        if chain is None:
            continue
        bound = latency(chain, network, holistic.analyse(network))
        until = 16 * max(item.period for item in network.items().values())
        seen = simulate(network, chance_scenario(network, chance, until), until, record=True)
        found = observed_chain(chain, seen)
        if bound.age is not None and found.outputs:
            assert found.age <= bound.age, (seed, chain, found, bound)
            ages += 1
            close += found.age > bound.age // 2
        if bound.reaction is not None and found.outputs:
            assert found.reaction <= bound.reaction, (seed, chain, found, bound)
            reactions += 1
        for hop in bound.hops:
            if hop.backlog and hop.step.name in found.backlogs:
                assert found.backlogs[hop.step.name] <= hop.backlog, (seed, chain, found, bound)
                backlogs += 1
    assert min(ages, reactions) > SYSTEMS // 3 and backlogs > SYSTEMS // 10 and close > 20


@pytest.mark.slow
@pytest.mark.parametrize("several", [False, True], ids=["one epoch", "several epochs"])
def test_no_random_system_with_offsets_is_observed_above_its_bounds(several: bool) -> None:
    """Tables, sections, jitter, several cores and chains, phases as the offsets say."""
    shorter = compared = 0
    for seed in range(SYSTEMS):
        chance = random.Random(seed)
        network = with_offsets(random_network(chance), chance)
        if several:
            network = with_epochs(network, chance)
        found = holistic.analyse(network)
        until = 10 * max(item.period for item in network.items().values())
        seen = simulate(network, chance_scenario(network, chance, until), until)
        for name, longest in seen.longest.items():
            bound = found.from_event(name)
            assert bound is None or longest <= bound, (seed, name, longest, bound)
            compared += 1
        responses = [r for r in found.responses.values() if isinstance(r, Response)]
        for response in responses:
            shorter += response.alignment is not None
            for one in response.rows:
                row = seen.rows.get((response.task.name, one.row.name), 0)
                assert row <= found.best[response.task.name] + one.bound, (seed, one)
    assert compared > 2 * SYSTEMS
    assert shorter > SYSTEMS // (30 if several else 10)


@pytest.mark.slow
def test_every_task_attains_a_bound_that_comes_of_offsets() -> None:
    """No sections; priorities that differ; tables among them."""
    attained = 0
    for seed in range(SYSTEMS // 2):
        chance = random.Random(seed)
        plain = replace(random_network(chance, plain=True), sections=())
        rows = (TableRow("r0", 5), TableRow("r1", 9, 2, seed % 2))
        tasks = tuple(
            replace(task, rows=rows) if number % 2 else task
            for number, task in enumerate(plain.tasks)
        )
        network = with_offsets(replace(plain, tasks=tasks), chance)
        for response in analyse_tasks(network.tasks):
            known = {t.name for t in network.tasks if t.offset is not None}
            level = response.level.order[: response.level.reach]
            tables = [t for t in level if t.rows and t.name not in known]
            if response.alignment is None or tables:
                continue
            case = worst_phases.of_task(response)
            if case.until > 200_000:
                continue
            for name in response.alignment.tasks:
                task = next(t for t in network.tasks if t.name == name)
                assert case.scenario.phases[name].first == task.offset
            seen = simulate(network, case.scenario, case.until).longest[response.task.name]
            assert seen == response.bound, (seed, response.task.name)
            attained += 1
    assert attained > SYSTEMS // 10


def test_every_task_attains_its_bound_where_theory_has_such_phases() -> None:
    """One cost a task, priorities that differ; the blocker has begun a tick before."""
    attained = 0
    for seed in range(SYSTEMS // 2):
        chance = random.Random(seed)
        network = random_network(chance, plain=True)
        for response in analyse_tasks(network.tasks, network.sections):
            if response.bound is None:
                continue
            case = worst_phases.of_task(response)
            alone = replace(network, frames={}, buses={}, released_by={})
            seen = simulate(alone, case.scenario, case.until).longest[response.task.name]
            order, reach = response.level.order, response.level.reach
            section = response.blocking
            if section is not None:
                section = (
                    replace(section, length=section.length - 1) if section.length > 1 else None
                )
            exact = response_under(response.task, order[: reach - 1], order[reach:], section)
            assert seen == exact.bound, (seed, response.task.name)
            attained += 1
    assert attained > SYSTEMS


def test_every_frame_attains_its_bound_but_for_one_bit_of_blocking() -> None:
    attained = 0
    for seed in range(SYSTEMS // 2):
        chance = random.Random(seed)
        bus = Bus(1)
        periods = [chance.randint(300, 3_000) for _ in range(chance.randint(1, 6))]
        frames = tuple(
            Frame(
                f"m{n}", n, t, 10 * t, chance.randint(40, 130), chance.choice((0, 0, t // 3, 2 * t))
            )
            for n, t in enumerate(periods)
        )
        for response in can.analyse(frames, bus):
            if response.bound is None:
                continue
            case = worst_phases.of_frame(response)
            seen = simulate(Network((), {"": frames}, {"": bus}), case.scenario, case.until)
            frame, level = response.frame, response.level
            lower = [
                replace(f, transmission_time=f.transmission_time - 1)
                for f in level.order[level.reach :]
                if f.name == response.blocker
            ]
            exact = can.response_under(frame, level.order[: level.reach - 1], lower, bus)
            assert seen.longest[frame.name] == exact.bound, (seed, frame.name)
            attained += 1
    assert attained > SYSTEMS


def test_a_simulation_that_only_starts_together_would_not_show_blocking() -> None:
    network = Network(
        (Task("high", 2, 100, 100, 5), Task("low", 1, 100, 100, 20)),
        sections=(Section("o", "low", 9), Section("o", "high", 1)),
    )
    response = analyse_tasks(network.tasks, network.sections)[0]
    assert response.bound == 14
    case = worst_phases.of_task(response)
    assert simulate(network, PhaseScenario(), 90).longest["high"] == 5
    assert simulate(network, case.scenario, case.until).longest["high"] == 13


def test_errors_within_the_model_stay_within_the_bound_and_others_show() -> None:
    frames = tuple(Frame(f"m{n}", n, 2_000, 2_000, 130) for n in range(3))
    bus = Bus(1, errors=Errors(1_000))
    bound = can.analyse(frames, bus)[2].bound
    assert bound is not None
    network = Network((), {"": frames}, {"": bus})
    assert simulate(network, PhaseScenario(faults={"": (120,)}), 1_900).longest["m2"] <= bound
    many = tuple(range(100, 1_500, 150))
    assert simulate(network, PhaseScenario(faults={"": many}), 5_000).longest["m2"] > bound
