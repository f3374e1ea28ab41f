# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart measure` on this machine: a program in mode release, run and measured."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import yaml

from ravenchart.command_line import main
from ravenchart.failures import OK, WRONG
from ravenchart.gen.language.quantities import duration
from ravenchart.paths import ROOT

MODEL = ROOT / "examples" / "three_components" / "model.yaml"


@pytest.mark.slow
@pytest.mark.live
def test_every_row_is_measured_by_a_program_without_contracts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "times.yaml"
    words = ["measure", str(MODEL), "--seconds", "1", "--margin", "50%", "--out", str(out)]
    status = main([*words, "--json"])
    found = json.loads(capsys.readouterr().out)
    assert status in (OK, WRONG)  # interrupts of this machine may be in a row
    measurement = found["result"]["measurement"]
    assert (measurement["target"], measurement["margin"]) == ("native", 50)
    assert "clock of this machine" in measurement["clock"]
    rows = {one["row"]: one for one in measurement["rows"]}
    assert {name.partition(".")[0] for name in rows} == {"one", "two", "three"}
    for one in rows.values():
        assert 100 < one["measured"] < 50_000_000
        assert one["proposed"] == -(-one["measured"] * 3 // 2)
    content = yaml.safe_load(out.read_text(encoding="utf-8"))
    assert content["not_executed"] == []
    for time in content["wcet"].values():
        assert duration(time) is not None
