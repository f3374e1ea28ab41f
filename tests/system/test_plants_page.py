# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""docs/plants.md as its reader does it: the oven is heated by a class, and by a unit of FMI."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.command_line import main
from tests.support.fmus import oven_unit
from tests.support.listings import listing

UNIT = """\
    fmu: oven.fmu
    parameters: {loss: 4}
    step: 5 ms
"""


@pytest.mark.alone
@pytest.mark.slow
@pytest.mark.parametrize("kind", ["class", "fmu"])
def test_the_oven_is_heated_and_held(
    tmp_path: Path, kind: str, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("model.yaml", "oven.py", "warm.yaml"):
        (tmp_path / name).write_text(listing("plants.md", name))
    if kind == "fmu":
        oven_unit(tmp_path / "oven.fmu", 3)
        scenario = (tmp_path / "warm.yaml").read_text()
        given = "    class: oven.py:Oven\n    parameters: {capacity: 20}\n"
        assert given in scenario
        (tmp_path / "warm.yaml").write_text(scenario.replace(given, UNIT))
        (tmp_path / "oven.py").unlink()
    model, scenario, report = (str(tmp_path / n) for n in ("model.yaml", "warm.yaml", "report"))
    status = main(["run", model, "--scenario", scenario, "--report", report])
    shown = capsys.readouterr().out
    assert re.search(r"expect 178 <= oven.temperature +oven.temperature is 178", shown), shown
    assert re.search(r"oven.Heating in Safe +at ", shown)
    page = (tmp_path / "report" / "report.html").read_text()
    assert "Values that each plant gave to the controller." in page
    assert status == 0, shown
