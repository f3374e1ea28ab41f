# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Every chart that can be simulated can be built too: warnings are errors in both modes."""

from __future__ import annotations

import os
import resource
from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.bench.large_charts import large_chart
from tests.support import random_charts, reference_charts
from tests.support.compiled import complaints

pytestmark = pytest.mark.slow

LONG = "RAVENCHART_LONG_TESTS" in os.environ
"""`make test-long`: all charts that `test_simulation` runs, in batches of one run each."""

FRAME = """\
system: Tried
components:
  Part:
    events: [Go, Bye, Next]
    regions: {{Subject: {{period: 10 ms, wcet: 10 us, queue: 4, {}}}}}
nodes: {{board: {{context_switch: 1 us, critical_section: 1 us}}}}
instances: {{unit: {{component: Part, node: board}}}}
processors: {{runner: {{node: board, stack: 32 KiB, activities: [{}]}}}}
shutdown: {{raises: [unit.Go, unit.Bye, unit.Next], grace: 0 ms}}
"""

CHARTS = {
    "Terminate_In_A_Region": """
        initial: Idle, states: {Idle: {}, Both: {regions: {
          Left: {initial: L1, states: {L1: {}}},
          Right: {initial: R1, states: {R1: {}, Stop: {kind: terminate}}}}}},
        transitions: {
          go: {from: Idle, to: Both, on: Go}, halt: {from: R1, to: Stop, on: Go}}""",
    "Terminate_Below_A_Region": """
        initial: Idle, states: {Idle: {}, Both: {regions: {
          Left: {initial: L1, states: {L1: {}, L2: {}}},
          Right: {initial: R1, states: {R1: {}, Deep: {initial: R2, states: {
            R2: {}, Stop: {kind: terminate}}}}}}}},
        transitions: {
          go: {from: Idle, to: Both, on: Go}, left: {from: L1, to: L2, on: Next},
          right: {from: R1, to: Deep, on: Next}, halt: {from: R2, to: Stop, on: Go},
          away: {from: Both, to: Idle, on: Bye}}""",
    "Passed_Through": """
        initial: Idle, states: {Idle: {}, Around: {initial: Slow, states: {Slow: {}, Fast: {}}}},
        transitions: {
          go: {from: Idle, to: Fast, on: Go}, slower: {from: Fast, to: Slow, on: Bye}}""",
    "Only_Final": """
        initial: A, states: {A: {}, B: {initial: C, states: {
          C: {initial: F, states: {F: {kind: final}}}}}},
        transitions: {go: {from: A, to: B, on: Go}}""",
    "Around_Everything": """
        initial: Whole, deferred: 2, states: {Whole: {initial: A, defer: [Bye], states: {
          A: {}, B: {}, H: {kind: history}}}},
        transitions: {
          go: {from: A, to: B, on: Go}, back: {from: B, to: A, after: 20 ms},
          leave: {from: Whole, to: Whole, on: Next}, recall: {from: B, to: H, on: Bye}}""",
    "Around_A_Region": """
        initial: A, states: {A: {}, Both: {regions: {
          Left: {initial: L, states: {L: {initial: L1, states: {L1: {}, L2: {}}}}},
          Right: {initial: R1, states: {R1: {}, R2: {}}}}}},
        transitions: {
          go: {from: A, to: Both, on: Go}, left: {from: L1, to: L2, on: Next},
          right: {from: R1, to: R2, on: Next}, up: {from: L, to: L2, on: Bye}}""",
    "No_Transitions": """
        initial: A, states: {A: {}, B: {}}, transitions: {go: {from: A, to: B, on: Go}}}, Still: {
        period: 10 ms, wcet: 10 us, initial: A, states: {A: {}}, transitions: {}""",
    "No_Transitions_In_Regions": """
        initial: A, states: {A: {}, B: {}}, transitions: {go: {from: A, to: B, on: Go}}}, Still: {
        period: 10 ms, wcet: 10 us, initial: A, states: {A: {regions: {
          Left: {initial: L, states: {L: {}}}, Right: {initial: R1, states: {R1: {}}}}}},
        transitions: {}""",
}

FEW = (1007, 1016, 1044, 1075)
"""Random charts of about ten transitions each."""
RUNS = [range(first, first + 12) for first in range(1_000, 3_004, 12)] if LONG else [FEW]


def _models(charts: dict[str, str]) -> dict[str, str]:
    """The systems of these charts; one chart may close its region and begin another."""
    found: dict[str, str] = {}
    for name, chart in charts.items():
        rows = ["unit.Subject", "unit.Still"] if "Still:" in chart else ["unit.Subject"]
        found[name] = FRAME.format(" ".join(chart.split()), ", ".join(rows))
    return found


@pytest.fixture(params=["checks", "release"])
def mode(request: pytest.FixtureRequest) -> str:
    """Each mode of a build."""
    named: str = request.param
    return named


def test_unusual_charts_compile(mode: str, tmp_path: Path) -> None:
    assert complaints(_models(CHARTS), tmp_path, mode) == ""


def test_reference_charts_compile(mode: str, tmp_path: Path) -> None:
    cases = enumerate(reference_charts.NAMES)
    charts = {f"Case_{k}": reference_charts.chart_of(name) for k, name in cases}
    models = {name: reference_charts.model_of(chart) for name, chart in charts.items()}
    assert complaints(models, tmp_path, mode) == ""


@pytest.mark.parametrize("seeds", RUNS, ids=lambda seeds: str(seeds[0]))
def test_random_charts_compile(seeds: Sequence[int], mode: str, tmp_path: Path) -> None:
    models = {f"Random_{seed}": random_charts.model_of([seed]) for seed in seeds}
    assert complaints(models, tmp_path, mode) == ""


@pytest.mark.parametrize("mode", ["checks", "release"] if LONG else ["release"])
def test_240_leaves_compile_in_a_minute(
    mode: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("GPR_CONFIG", raising=False)  # without the store of tests/compiler
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert complaints({"Chart_240": large_chart(24)}, tmp_path, mode) == ""
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 60
