"""Every chart that can be simulated can be built too: warnings are errors in both modes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.compiled import complaints

FRAME = """\
system: Tried
components:
  Part:
    events: [Go, Bye, Next]
    regions: {{Subject: {{period: 10 ms, wcet: 10 us, queue: 4, {}}}}}
nodes: {{board: {{context_switch: 1 us, critical_section: 1 us}}}}
instances: {{unit: {{component: Part, node: board}}}}
processors: {{runner: {{node: board, stack: 32 KiB, activities: [unit.Subject]}}}}
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
}


def _models(charts: dict[str, str]) -> dict[str, str]:
    return {name: FRAME.format(" ".join(chart.split())) for name, chart in charts.items()}


@pytest.mark.parametrize("mode", ["checks", "release"])
def test_unusual_charts_compile(mode: str, tmp_path: Path) -> None:
    assert complaints(_models(CHARTS), tmp_path, mode) == ""
