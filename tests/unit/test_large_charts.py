"""A chart of many leaf states is checked to the end."""

from __future__ import annotations

from time import process_time

import pytest

from behaviour.rules import SECONDS, UNFINISHED, findings
from behaviour.rules.reach import Clock, Reach
from gen.model import System
from ravenchart.large_charts import large_chart
from tests.support.interpreted import system_of


def _reach(system: System, index: int = 0) -> Reach:
    return Reach(system.components[index], system, Clock(300.0))


def test_120_leaves_are_checked_to_the_end() -> None:
    system = system_of(large_chart(12))
    start = process_time()
    found = findings(system)
    assert process_time() - start < SECONDS
    assert {item.code for item in found} == {"RV-1105"}, found
    assert UNFINISHED not in [item.code for item in found]


def test_each_further_block_is_as_many_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("behaviour.rules.reach.MOST_NODES", 9)
    nodes = [len(_reach(system_of(large_chart(b))).threads[0].nodes) for b in (2, 4, 6)]
    assert nodes[2] - nodes[1] == nodes[1] - nodes[0] == 2 * 13
