# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The states that a replay of a simulation shows are those that random charts were in."""

from __future__ import annotations

from collections import defaultdict
from typing import ClassVar

import pytest

from ravenchart.behaviour.interpreter.expressions import View
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import RegionRun, Step, Stuck
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.behaviour.tree import ChartTree
from ravenchart.gen.model.statechart import TOP, PseudoKind
from ravenchart.running.traces.simulated_runs import FollowedChart, observed_simulation
from tests.support.effort import seeds
from tests.support.interpreted import stimuli_of, system_of
from tests.support.random_charts import events_of, model_of

Shown = dict[str, str]
"""The active leaf by the name of its region; that of the top-level region is empty."""


class Noting(RegionRun):
    """Notes what is active after each step that the trace has."""

    noted: ClassVar[defaultdict[str, list[Shown]]]

    def step(self, view: View) -> Step:
        """One step."""
        found = super().step(view)
        if found.behaviours:
            self.noted[self.region.name].append(_shown(self))
        return found


def _shown(run: RegionRun) -> Shown:
    """The leaves by the regions that they fill; where a chart has terminated, that alone."""
    ends = [v for v in run.active.values() if run.tree.kinds.get(v) is PseudoKind.TERMINATE]
    if ends:
        return {TOP.name: ends[0]}
    leaves = [state for state in run.configuration() if run.tree.is_innermost(state)]
    return {run.tree.concurrent_region_of[leaf].name: leaf for leaf in leaves}


def played(seed: int) -> tuple[list[StepRecord], dict[str, list[Shown]], dict[str, ChartTree]]:
    """The steps of a random component, what was active behind each, and its charts."""
    system = system_of(model_of([seed]))

    class Own(Noting):
        noted: ClassVar[defaultdict[str, list[Shown]]] = defaultdict(list)

    records: list[StepRecord] = []
    try:
        for record in Machine(system, Own).run(stimuli_of(events_of(seed, [seed]), system)):
            records.append(record)
    except Stuck:
        pass
    (instance,) = system.instances
    trees = {region.name: ChartTree(region) for region in instance.component.regions}
    return records, Own.noted, trees


@pytest.mark.parametrize("seed", seeds(20, 300))
def test_the_followed_states_are_those_of_the_interpreter(seed: int) -> None:
    records, noted, trees = played(seed)
    followed = {name: FollowedChart(tree) for name, tree in trees.items()}
    count: dict[str, int] = defaultdict(int)
    for record in records:
        one = followed[record.region]
        assert one.take(record) is None
        leaves = {region.name: leaf for region, leaf in one.leaves()}
        assert leaves == noted[record.region][count[record.region]], record.text()
        count[record.region] += 1
    assert sum(count.values()) > 0


@pytest.mark.slow
def test_the_charts_have_final_states_orthogonal_regions_and_ends() -> None:
    """Without these the comparison would say little."""
    several = finals = ends = 0
    for seed in range(60):
        _, noted, trees = played(seed)
        for name, shown in noted.items():
            several += any(len(one) > 1 for one in shown)
            states = trees[name].states
            finals += any(states[s].final for one in shown for s in one.values() if s in states)
            ends += any(s not in states for one in shown for s in one.values())
    assert several > 5 and finals > 5 and ends > 0, (several, finals, ends)


@pytest.mark.parametrize("seed", seeds(6, 20))
def test_the_observation_has_each_step_with_its_transitions_and_leaves(seed: int) -> None:
    records, noted, _ = played(seed)
    system = system_of(model_of([seed]))
    seen = observed_simulation(system, (f"{one.text()}\n" for one in records), "file")
    effects = [
        (one.at, name.removesuffix(".effect"))
        for one in records
        for name in one.behaviours
        if name.endswith(".effect") and "(" not in name
    ]
    assert [(r.time, r.text) for r in seen.records if r.kind == "transition"] == effects
    states = sum(len(one) for shown in noted.values() for one in shown)
    assert sum(r.kind == "state" for r in seen.records) == states
