# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Contracts of activities: what breaks one is refused by gnatprove, and `prove` says which."""

from __future__ import annotations

import re
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.proof import proving
from ravenchart.proof.unproved import findings
from ravenchart.tools import toolchain

pytestmark = pytest.mark.skipif(
    not toolchain.have("gnatprove"), reason="gnatprove is not on PATH: nothing is proved"
)

FEATURE = ROOT / "tests" / "feature" / "contracts"
PAGE = (ROOT / "docs" / "contracts.md").read_text(encoding="utf-8")
BODIES = "contracts_feature-plant-activities.adb"
USER = f"user/{BODIES}"
FLOWS = "contracts_feature-plant-flows.adb"
MODEL = "model.yaml"
BROKEN = {
    "a body of the user": (USER, "'Min (90,", "'Min (99,", BODIES, "filter.ensures", "level <= 90"),
    "another body": (USER, "Rate + Rate", "Rate", BODIES, "boost.ensures", "rate * 2"),
    "a flow": (MODEL, "with: Draining", "with: Filling", FLOWS, "report.ensures", "= Draining"),
    "an instance": (
        *(MODEL, "low: 5, high: 6", "low: 7, high: 6"),
        *("contracts_feature-plant_2.adb", "regulate.requires", "low < high"),
    ),
    "data of another activity": (
        *(MODEL, "tank.level < 95", "tank.level < 90"),
        *("contracts_feature-plant_1.adb", "regulate.requires", "level < 90"),
    ),
}


def _task(folder: Path) -> tuple[checking.Checked, proving.ProofTask]:
    checked = checking.check(folder / MODEL)
    generation.write_program(checked)
    (program,) = programs.programs_of(checked)
    return checked, program.proof(programs.default_driver(checked))


@pytest.mark.slow
@pytest.mark.parametrize("what", BROKEN)
def test_what_breaks_a_contract_is_not_proved(tmp_path: Path, what: str) -> None:
    file, old, new, unit, element, line = BROKEN[what]
    folder = tmp_path / "contracts"
    shutil.copytree(FEATURE, folder)
    text = (folder / file).read_text()
    assert text.count(old) == 1
    (folder / file).write_text(text.replace(old, new))
    checked, task = _task(folder)
    with pytest.raises(proving.NotProved) as left:
        proving.prove(replace(task, units=(unit,)))
    open_ = left.value.proof.results.open
    places = [path for path in task.sources if path.is_dir()]
    (found,) = findings(str(left.value), open_, checked.system, folder, places)
    assert found.element == f"Plant.{element}"
    assert found.origin is not None
    assert line in (folder / MODEL).read_text().split("\n")[found.origin.line - 1]


@pytest.mark.slow
def test_the_listings_of_the_page_are_proved(tmp_path: Path) -> None:
    """The model, and the body of the user."""
    (model,) = re.findall(r"```yaml\n(system:.*?)```", PAGE, re.S)
    (body,) = re.findall(r"```ada\n( *package body.*?)```", PAGE, re.S)
    (tmp_path / MODEL).write_text(model)
    (tmp_path / "user").mkdir()
    (tmp_path / "user" / "tank_house-tank-activities.adb").write_text(body)
    _, task = _task(tmp_path)
    units = ("tank_house-tank-activities.adb", "tank_house-tank-flows.adb", "tank_house-upper.adb")
    proof = proving.prove(replace(task, units=units))
    assert proof.clean and proof.results.checks
