# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The page docs/getting-started.md, followed to the letter."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.evidence.records import of_termination
from ravenchart.paths import ROOT
from ravenchart.tools import toolchain
from tests.support.proof_records import stale_sources

PAGE = (ROOT / "docs" / "getting-started.md").read_text()


def _block(language: str) -> str:
    found = re.search(rf"```{language}\n(.*?)```", PAGE, re.S)
    assert found is not None
    return found.group(1)


@pytest.fixture
def tank(tmp_path: Path) -> Path:
    """The reader's folder after step 3."""
    folder = tmp_path / "tank"
    (folder / "user").mkdir(parents=True)
    (folder / "model.yaml").write_text(_block("yaml"))
    (folder / "user" / "tank_system-plant-activities.adb").write_text(_block("ada"))
    return folder


def test_a_first_body_is_written_once_and_named_until_it_is_changed(
    tank: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = str(tank / "model.yaml")
    body = tank / "user" / "tank_system-plant-activities.adb"
    body.unlink()
    assert main(["build", model]) == 0
    assert f"note: {body}: new; its bodies do nothing yet" in capsys.readouterr().err
    assert main(["generate", model]) == 0
    assert f"note: {body}: its bodies do nothing yet" in capsys.readouterr().err
    body.write_text(_block("ada"))
    assert main(["generate", model]) == 0
    assert capsys.readouterr().err == ""
    assert body.read_text() == _block("ada")


@pytest.mark.live
def test_the_tank_builds_runs_and_keeps_its_level(
    tank: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = str(tank / "model.yaml")
    report = tank / "report"
    assert main(["check", model]) == 0
    assert main(["run", model, "--seconds", "3", "--report", str(report)]) == 0
    said = capsys.readouterr().out
    assert "Idle, Filling" in said
    assert "verdict: PASS" in said


def test_the_one_wcet_that_the_page_raises_is_refused_with_the_task_that_it_names(
    tank: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = " ".join(PAGE.split())
    told = re.search(
        r"Raise the `wcet` of `(\w+)` to `([\d.]+ ms)`: `check` refuses the model\. "
        r"It names the task without a response-time bound, `(\w+)`, and the tasks that preempt",
        words,
    )
    assert told is not None
    raised, wcet, task = told.groups()
    model = tank / "model.yaml"
    text, count = re.subn(
        rf"(\n +{raised}:\n +period: \w+ ms\n +wcet: )[^\n]+", rf"\g<1>{wcet}", model.read_text()
    )
    assert count == 1
    model.write_text(text)
    assert main(["check", str(model)]) == 1
    said = capsys.readouterr().err
    assert re.search(rf"model.yaml:\d+:\d+: error: {task} has no response-time bound", said)
    assert "note: simulation, period 20 ms, preempts" in said


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_the_tank_is_proved_and_the_unbounded_level_of_the_page_is_not(
    tank: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = str(tank / "model.yaml")
    record = tank / "proof.toml"
    assert main(["prove", model, "--record", str(record)]) == 0
    assert stale_sources(record) == stale_sources(of_termination(record)) == ()
    printed = capsys.readouterr().out
    assert re.search(r"checks (\d+), proved \1, justified 0, assumed 0", printed)
    assert "`all executions of 4 rows end: proved`" in PAGE
    assert "all executions of 4 rows end: proved\n" in printed
    body = tank / "user" / "tank_system-plant-activities.adb"
    bounded = "Unit_Mm'Max (0, Unit_Mm'Min (2_000, Height + Change))"
    assert bounded in body.read_text()
    body.write_text(body.read_text().replace(bounded, "Height + Change"))
    assert main(["prove", model]) == 1
    said = capsys.readouterr()
    assert re.search(r"checks (\d+), proved \d+, .*, NOT PROVED 1\n", said.out)
    told = re.search(
        r"^(user/tank.*?: not proved: range check .*?), .*?\n(.*?\n)  fails", PAGE, re.S | re.M
    )
    assert told is not None
    for part in told.groups():
        assert part in said.err
    assert "fails for example when" in said.err
    assert re.search(r"belongs to Plant.simulate \(.*model.yaml:\d+:7\)", said.err)
