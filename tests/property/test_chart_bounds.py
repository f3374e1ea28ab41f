# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the rules say of every chart, held against what the interpreter does with random ones."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.region import RegionRun, Step, Stuck
from ravenchart.gen.model.chart.reach import Reach
from ravenchart.gen.model.chart.steps import RAISED, Steps
from ravenchart.gen.model.chart.tree import Tree
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System
from tests.support.interpreted import stimuli_of, system_of
from tests.support.random_charts import events_of, model_of

SEEDS = range(12)


def _bound(region: Region) -> int:
    """The most events that one step raises, as the rules see it."""
    steps = Steps(Tree(region))
    return max(len(tally.get(RAISED, ())) for _, tally in (*steps.single(), *steps.shared()))


def _entered(system: System, seed: int) -> Iterator[tuple[str, str]]:
    """Region and name of every state that is entered."""
    try:
        for record in Machine(system).run(stimuli_of(events_of(seed, [seed]), system)):
            for behaviour in record.behaviours:
                name, _, what = behaviour.rpartition(".")
                if what == "entry":
                    yield record.region, name
    except Stuck:
        return


@pytest.mark.parametrize("seed", SEEDS)
def test_no_step_raises_more_and_no_state_is_entered_that_is_not_reached(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    system = system_of(model_of([seed]))
    regions = system.components[0].regions
    bounds = {region.name: _bound(region) for region in regions}
    reached = {region.name: Reach(Tree(region), lambda state: True).found for region in regions}
    step = RegionRun.step

    def counted(run: RegionRun, view: object) -> Step:
        made = step(run, view)  # type: ignore[arg-type]
        assert len(made.out.raised) <= bounds[run.region.name]
        return made

    monkeypatch.setattr(RegionRun, "step", counted)
    for region, state in _entered(system, seed):
        assert state in reached[region]
