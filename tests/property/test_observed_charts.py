# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What an observed region says of its steps, held against what random charts execute."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

import pytest

from ravenchart.behaviour.interpreter.expressions import View
from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.interpreter.observed import FiringReason, ObservedRegion
from ravenchart.behaviour.interpreter.region import RegionRun, Step, Stuck
from ravenchart.behaviour.interpreter.traces import StepRecord
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.system import System
from ravenchart.workbench.play.explained import occurrence, reason
from tests.support.effort import seeds
from tests.support.interpreted import stimuli_of, system_of
from tests.support.random_charts import events_of, model_of

SEEDS = 40

seen: Counter[FiringReason] = Counter()
"""The reasons that the charts have shown so far."""


class Compared(ObservedRegion):
    """Compares each step with what it says."""

    def step(self, view: View) -> Step:
        """One step."""
        before = self.configuration()
        found = super().step(view)
        said = self.steps[-1]
        from_states = {t.name for t in self.region.transitions if t.source in before}
        taken = {one.removesuffix(".effect") for one in found.behaviours if ".effect" in one}
        fired = {v.transition.name for v in said.verdicts if v.reason is FiringReason.FIRED}
        assert fired == taken & from_states
        if said.occurrence is not None:
            assert {v.transition.name for v in said.verdicts} == from_states
        for one in said.verdicts:
            seen[one.reason] += 1
            text = reason(one, Ns(10_000_000))
            assert text and text != "the step was for something else"
            assert (one.reason is FiringReason.GUARD_FALSE) <= bool(one.failed)
            assert (one.reason is FiringReason.NOT_DUE) == (one.executions > 0)
        assert occurrence(said)
        return found


def _played(system: System, seed: int, region: type[RegionRun]) -> Iterator[StepRecord]:
    try:
        yield from Machine(system, region).run(stimuli_of(events_of(seed, [seed]), system))
    except Stuck:
        return


@pytest.mark.parametrize("seed", seeds(12, SEEDS))
def test_a_transition_is_said_to_fire_exactly_where_it_does(seed: int) -> None:
    system = system_of(model_of([seed]))
    assert list(_played(system, seed, Compared)) == list(_played(system, seed, RegionRun))


@pytest.mark.slow
def test_the_charts_have_shown_every_reason() -> None:
    for seed in range(SEEDS):
        list(_played(system_of(model_of([seed])), seed, Compared))
    assert set(FiringReason) - set(seen) == set()
