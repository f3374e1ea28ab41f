# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How far an execution time may grow: to the microsecond, by the analysis itself."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.analysis.findings.growth import STEP, largest_wcet
from ravenchart.analysis.system.timing import analyse
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.support.pump import PUMP

ROWS = {
    "control": ("joint_x.position_control", "joint_y.position_control", "joint_z.position_control"),
    "mission": ("coordinator.Mission",),
}


def schedulable(text: str, path: Path) -> bool:
    """Whether a model keeps all of its deadlines and limits."""
    path.write_text(text, encoding="utf-8")
    system = load(path).system
    assert system is not None
    return analyse(system).schedulable


def test_the_largest_wcet_is_kept_and_a_microsecond_more_is_not(tmp_path: Path) -> None:
    path = tmp_path / "model.yaml"
    wcet = "tell:\n        period: 20 ms\n        wcet: 30 us"
    assert wcet in PUMP
    path.write_text(PUMP, encoding="utf-8")
    system = load(path).system
    assert system is not None
    analysis = analyse(system)
    all_rows = (row.name for task in analysis.network.tasks for row in task.rows)
    rows = [name for name in all_rows if name.endswith(".tell")]
    found = largest_wcet(analysis, rows)
    assert found is not None and found > 30_000 and found % STEP == 0
    longer = wcet.replace("30 us", f"{found} ns")
    assert schedulable(PUMP.replace(wcet, longer), path)
    assert not schedulable(PUMP.replace(wcet, wcet.replace("30 us", f"{found + STEP} ns")), path)


@pytest.mark.slow
@pytest.mark.parametrize("name", ROWS)
def test_rows_of_one_component_grow_together(name: str, tmp_path: Path) -> None:
    robot = ROOT / "examples" / "cartesian_robot" / "model.yaml"
    system = load(robot).system
    assert system is not None
    analysis = analyse(system)
    found = largest_wcet(analysis, ROWS[name])
    assert found is not None
    one = largest_wcet(analysis, ROWS[name][:1])
    assert one is not None and one >= found
    if len(ROWS[name]) > 1:
        assert one > found


def test_a_wcet_that_is_too_long_now_cannot_grow(tmp_path: Path) -> None:
    robot = ROOT / "examples" / "cartesian_robot" / "model.yaml"
    system = load(robot).system
    assert system is not None
    (chain, *rest) = system.chains
    late = replace(system, chains=(replace(chain, reaction=Ns(1000)), *rest))
    assert largest_wcet(analyse(late), ROWS["control"]) is None


def test_a_row_that_no_table_has_is_an_error() -> None:
    system = load(ROOT / "examples" / "pump" / "model.yaml").system
    assert system is not None
    with pytest.raises(KeyError):
        largest_wcet(analyse(system), ["pump.nothing"])
