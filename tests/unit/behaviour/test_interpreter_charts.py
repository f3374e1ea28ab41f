# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The interpreter gives the published traces, and keeps its configuration sound."""

from __future__ import annotations

import pytest

from ravenchart.behaviour.interpreter.machine import InstanceRun, Machine
from ravenchart.behaviour.interpreter.region import RegionRun
from ravenchart.behaviour.tree import TOP
from ravenchart.gen.language.terms import IntegerType, Value
from ravenchart.gen.model.statechart import After, Every, PseudoKind
from ravenchart.gen.model.system import System
from tests.support import random_charts, reference_charts
from tests.support.interpreted import stimuli_of, system_of
from tests.support.reference_charts import chart_of, events_of, labels_of, model_of

BATCHES = (range(100, 106), range(106, 112))
"""Seeds of the charts of one system each."""


@pytest.mark.parametrize("name", reference_charts.NAMES)
def test_reference_chart_has_the_trace_in_model_order(name: str) -> None:
    case = chart_of(name)
    system = system_of(model_of(case))
    records = Machine(system).run(stimuli_of(events_of(case), system))
    behaviours = [one for record in records for one in record.behaviours]
    assert labels_of(case, behaviours) == case["expected_traces"][0]


@pytest.fixture(scope="module")
def systems() -> list[System]:
    """Systems of random charts."""
    return [system_of(random_charts.model_of(seeds)) for seeds in BATCHES]


@pytest.fixture(scope="module")
def observed(systems: list[System]) -> list[tuple[Machine, list[str]]]:
    """The systems after their events, with what was wrong on the way."""
    found = []
    for system, seeds in zip(systems, BATCHES, strict=True):
        machine = Machine(system)
        wrong: list[str] = []
        shadows: dict[str, set[str]] = {}
        events = random_charts.events_of(seeds[0], seeds, milliseconds=800)
        for record in machine.run(stimuli_of(events, system)):
            own = machine.instances[record.instance]
            run = own.regions[record.region]
            where = f"{record.at} {record.instance}.{record.region}"
            shadow = shadows.setdefault(f"{record.instance}.{record.region}", set())
            wrong += [f"{where}: {one}" for one in replayed(run, shadow, record.behaviours)]
            wrong += [f"{where}: {one}" for one in unsound(run)]
            wrong += [f"{where}: {one}" for one in out_of_range(own)]
        found.append((machine, wrong))
    return found


def test_random_charts_stay_sound(observed: list[tuple[Machine, list[str]]]) -> None:
    assert [one for _, wrong in observed for one in wrong] == []


def test_random_charts_do_something(observed: list[tuple[Machine, list[str]]]) -> None:
    runs = [run for machine, _ in observed for own in machine.instances.values()
            for run in own.regions.values()]  # fmt: skip
    moved = [run for run in runs if run.configuration() != frozenset(run.tree.default)]
    assert len(moved) > len(runs) / 2
    assert any(run.history for run in runs)
    assert any(run.deferred for run in runs)


def test_a_random_chart_is_the_same_in_every_model() -> None:
    alone, among = random_charts.component_of(7), random_charts.model_of((3, 7))
    assert alone == random_charts.component_of(7)
    assert "Chart_7" in among


def test_entering_by_default_makes_the_default_configuration(systems: list[System]) -> None:
    for instance in [one for system in systems for one in system.instances]:
        own = InstanceRun(instance)
        for run in own.regions.values():
            run.begin()
            run.step(own.view())
            assert run.configuration() == frozenset(run.tree.default)


# --- What is checked after every step ---------------------------------------------------


def replayed(run: RegionRun, active: set[str], behaviours: tuple[str, ...]) -> list[str]:
    """What is wrong with the order of exits and entries; ``active`` is kept up to date."""
    wrong: list[str] = []
    for behaviour in behaviours:
        name, _, what = behaviour.partition(".")
        inside = {one for one in active if name in run.tree.around(one)}
        if what == "exit":
            if name not in active or inside:
                wrong.append(f"{name} is left and {inside or 'it is not active'}")
            active.discard(name)
        elif what == "entry":
            missing = set(run.tree.around(name)) - active
            beside = {one for one in active if run.tree.slots[one] == run.tree.slots[name]}
            if name in active or missing or beside:
                wrong.append(f"{name} is entered beside {beside} without {missing}")
            active.add(name)
    now = {one for one in run.configuration() if not run.tree.states[one].final}
    if active != now:
        wrong.append(f"behaviours tell of {active}, and active is {now}")
    return wrong


def unsound(run: RegionRun) -> list[str]:
    """What is wrong with the configuration and with what depends on it."""
    tree, wrong = run.tree, []
    wanted = {TOP}
    for state in run.configuration():
        wanted.update(tree.regions_of(state))
    if set(run.active) != wanted:
        wrong.append(f"the places {set(run.active) ^ wanted} are active without reason, or not")
    for vertex in run.active.values():
        if tree.kinds.get(vertex) not in (None, PseudoKind.TERMINATE):
            wrong.append(f"it rests in {vertex}")
    timed = {
        t.name
        for t in run.region.transitions
        if isinstance(t.trigger, After | Every) and run.is_active(t.source)
    }
    if not set(run.timers) <= timed:
        wrong.append(f"time-outs of states that are not active: {set(run.timers) - timed}")
    for state in run.completed | run.done:
        if not run.is_active(state):
            wrong.append(f"{state} has completed and is not active")
    if len(run.queue) > run.region.queue_depth or len(run.deferred) > run.region.deferral_depth:
        wrong.append("more events wait than there is room for")
    return wrong


def out_of_range(own: InstanceRun) -> list[str]:
    """Data items whose value is not one of their type."""

    def fits(value: Value, kind: object) -> bool:
        if isinstance(kind, IntegerType):
            return isinstance(value, int) and kind.first <= value <= kind.last
        return value in ("False", "True")

    return [d.name for d in own.component.data if not fits(own.data[d.name], d.type)]
