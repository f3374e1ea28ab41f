# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`tests --coverage`: what the cases execute of the generated program, counted by gcov."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.evidence import facts
from ravenchart.evidence.claim import Shown
from ravenchart.evidence.coverage import coverage
from ravenchart.paths import ROOT
from tests.support.answers import answered

pytestmark = pytest.mark.slow


def test_the_cases_execute_the_whole_body_of_a_chart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("GPR_CONFIG", raising=False)  # the store of objects keeps no counts
    folder = Path(shutil.copytree(ROOT / "examples" / "crossing", tmp_path / "crossing"))
    file = tmp_path / "new" / "crossing.info"
    answer = answered(capsys, "tests", folder / "model.yaml", "--coverage", file)
    bodies = {Path(one["file"]).name: one for one in answer["result"]["coverage"]}
    chart = bodies["crossing_system-crossing-lights.adb"]
    assert chart["origin"] == "generated" and chart["not_executed"] == []
    assert chart["lines"] == chart["executed"] > 200
    declared = bodies["crossing_system-crossing-lights.ads"]
    assert declared["not_executed"] == []
    assert 50 < declared["branches"] < declared["lines"] * 2  # once, not for each inlined call
    assert bodies["ravenchart-timers.adb"]["origin"] == "runtime"

    records = file.read_text(encoding="utf-8").split("end_of_record\n")[:-1]
    assert len(records) == len(bodies)
    record = next(one for one in records if f"SF:{chart['file']}\n" in one)
    assert f"LF:{chart['lines']}\nLH:{chart['executed']}\n" in record
    assert record.count("\nDA:") == chart["lines"]
    assert record.count("\nBRDA:") == chart["branches"]

    (claim,) = coverage(facts.gather(folder / "model.yaml", coverage=file))
    assert claim.id == "coverage-Crossing.Lights" and claim.verdict in (Shown.MET, Shown.PARTLY)
    assert not any("not executed" in reason for reason in claim.reasons)

    unplayed = answered(
        capsys, "tests", folder / "model.yaml", "--effort", "1", "--no-run", "--coverage", file
    )
    fewer = {Path(one["file"]).name: one for one in unplayed["result"]["coverage"]}
    assert fewer[Path(chart["file"]).name]["executed"] < chart["executed"]
