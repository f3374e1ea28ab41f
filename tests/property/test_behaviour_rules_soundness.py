# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What the interpreter comes to, the rules of behaviour have found reachable."""

from __future__ import annotations

from collections.abc import Collection, Iterator

import pytest

from ravenchart.behaviour.interpreter.machine import Machine
from ravenchart.behaviour.rules import threads as thread_rules
from ravenchart.behaviour.rules.budget import Budget
from ravenchart.behaviour.rules.reach import Reachable
from ravenchart.behaviour.rules.threads import Thread
from tests.support.interpreted import raised_outside, stimuli_of, system_of
from tests.support.random_charts import events_of, instance_name, model_of

CHARTS = (0, 2, 4, 7, 8, 10, 11, 13, 15, 16, 21, 22, 23, 28)


LIMITS = {
    "finely": (thread_rules.MOST_NODES, thread_rules.MOST_CONFIGURATIONS),
    "coarsely": (3, thread_rules.MOST_CONFIGURATIONS),
    "in parts": (3, 3),
}


def _parts(thread: Thread, active: Collection[str]) -> Iterator[tuple[str, ...]]:
    """The states around each leaf that is active, or all of them where they are known together."""
    tree = thread.tree
    leaves = [s for s in active if tree.is_innermost(s)] if thread.parts is not None else []
    chains: list[Collection[str]] = [tree.chains[leaf] for leaf in leaves]
    for chain in chains or [active]:
        yield tree.ordered(chain)


@pytest.mark.slow
@pytest.mark.parametrize("limits", LIMITS.values(), ids=LIMITS)
@pytest.mark.parametrize("seed", CHARTS)
def test_every_configuration_and_transition_of_a_run_is_found(
    seed: int, limits: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(thread_rules, "MOST_NODES", limits[0])
    monkeypatch.setattr(thread_rules, "MOST_CONFIGURATIONS", limits[1])
    system = raised_outside(system_of(model_of([seed])))
    reach = Reachable(system.components[0], system, Budget(300_000_000))
    threads = {t.name: t for t in reach.threads}
    found = {name: {n.configuration.active for n in t.nodes} for name, t in threads.items()}
    fired = {n: {f for e in t.edges for f in e.outcome.fired} for n, t in threads.items()}
    machine = Machine(system)
    regions = machine.instances[instance_name(seed)].regions
    for record in machine.run(stimuli_of(events_of(seed, [seed]), system)):
        for name, run in regions.items():
            for active in _parts(threads[name], run.configuration()):
                assert active in found[name], (record.text(), name)
        effects = {b.removesuffix(".effect") for b in record.behaviours if b.endswith(".effect")}
        assert {e for e in effects if not e.startswith("initial(")} <= fired[record.region]
