# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""No execution of a random chart shows a goal that is said to be unreachable."""

from __future__ import annotations

import pytest

from ravenchart.behaviour.cases.goals import GoalCoverage, goals
from ravenchart.behaviour.cases.possible import outlook
from ravenchart.behaviour.cases.watched import watched_machine
from ravenchart.behaviour.interpreter.region import Stuck
from tests.support.interpreted import raised_outside, stimuli_of, system_of
from tests.support.random_charts import events_of, model_of

SEEDS = range(120)
SOME = 40


def unreachable_of(seed: int) -> int:
    """How many goals of a random chart are said to be unreachable; none of them is shown."""
    system = raised_outside(system_of(model_of([seed])))
    (instance,) = system.instances
    every = list(goals(instance.component))
    found = outlook(system, every, effort=3_000).unreachable
    coverage = GoalCoverage()
    for other in range(3):
        events = events_of(1_000 * other + seed, [seed], milliseconds=1_500)
        try:
            for _ in watched_machine(system, coverage).run(stimuli_of(events, system)):
                pass
        except Stuck:
            pass
    shown = {goal for goal in every if coverage.shows(goal)}
    assert [goal.text() for goal in found if goal in shown] == []
    return len(found)


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, len(SEEDS), SOME))
def test_what_is_said_to_be_unreachable_is_never_shown(first: int) -> None:
    found = [unreachable_of(seed) for seed in SEEDS[first : first + SOME]]
    assert sum(map(bool, found)) >= SOME // 4
