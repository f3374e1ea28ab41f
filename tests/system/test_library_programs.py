# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Systems with libraries, built, executed, proved, and judged from outside."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.evidence.claim import Shown
from ravenchart.evidence.claims import claims
from ravenchart.evidence.facts import gather
from ravenchart.paths import ROOT

LIBRARY = ROOT / "tests/feature/library"
NO_GNATPROVE = pytest.mark.skipif(shutil.which("gnatprove") is None, reason="needs gnatprove")

EVENTS = """\
- {at: 5 ms, put: watcher.sample, value: {level: 900, quality: Good}}
- {at: 25 ms, put: watcher.sample, value: {level: 100, quality: Good}}
- {until: 60 ms}
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return Path(shutil.copytree(LIBRARY, tmp_path / "library"))


def test_a_library_is_compiled_by_itself(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["build", str(folder / "blocks/library.yaml")]) == 0
    out, err = capsys.readouterr()
    assert "compiled Blocks: " in out and "warning" not in err
    body = folder / "blocks/user/blocks-smoother_type-activities.adb"
    body.write_text(body.read_text("utf-8").replace("Smooth := Kept;", "Smooth := 1;"), "utf-8")
    assert main(["build", str(folder / "blocks/library.yaml")]) == 1
    assert "blocks-smoother_type-activities.adb" in capsys.readouterr().err


@pytest.mark.slow
def test_the_program_of_a_library_does_what_its_model_says(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    events = folder / "events.yaml"
    events.write_text(EVENTS, "utf-8")
    steps = []
    for more in ([], ["--interpreter"]):
        call = ["simulate", str(folder / "model.yaml"), "--alone", "watcher", *more]
        assert main([*call, "--events", str(events)]) == 0
        steps.append(capsys.readouterr().out)
    assert "Alarmed" in steps[0]
    assert steps[0] == steps[1]


@NO_GNATPROVE
@pytest.mark.slow
def test_one_proof_of_a_library_serves_every_system(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record = folder / "blocks.toml"
    assert main(["prove", str(folder / "blocks/library.yaml"), "--record", str(record)]) == 0
    capsys.readouterr()
    assert main(["prove", str(folder / "model.yaml"), "--record", str(folder / "all.toml")]) == 0
    lines = capsys.readouterr().out.splitlines()
    (own,) = (line for line in lines if line.startswith("Blocks: "))
    assert own.endswith("(proved before from the same content)")
    system, ends = (line for line in lines if line.startswith("Library_Feature: "))
    assert "outside SPARK 0" in system and ends.endswith("rows end: proved")
    given = [folder / f"all-{one}.toml" for one in ("Blocks", "Gauges", "Words", "board")]
    found = {one.id: one for one in claims(gather(folder / "model.yaml", given=given))}
    assert found["chart-Watcher_Type.Watching"].verdict is Shown.MET
    assert found["generated-Blocks"].verdict is Shown.MET
    assert found["program-Blocks"].verdict is Shown.MET
    spec = folder / "blocks/generated/blocks-watcher_type.ads"
    spec.write_text(f"{spec.read_text('utf-8')}--  changed\n", "utf-8")
    found = {one.id: one for one in claims(gather(folder / "model.yaml", given=given))}
    assert found["chart-Watcher_Type.Watching"].verdict is Shown.NOT_MET
    assert found["generated-Blocks"].verdict is Shown.NOT_MET


def test_a_claim_about_a_library_needs_its_record(folder: Path) -> None:
    assert main(["generate", str(folder / "model.yaml")]) == 0
    found = {one.id: one for one in claims(gather(folder / "model.yaml"))}
    assert found["generated-Blocks"].verdict is Shown.MET
    assert found["chart-Watcher_Type.Watching"].verdict is Shown.NOT_SHOWN
    assert "of the library Blocks" in found["chart-Watcher_Type.Watching"].statement


def test_the_trace_map_has_the_versions(folder: Path) -> None:
    assert main(["generate", str(folder / "model.yaml")]) == 0
    found = json.loads((folder / "generated/trace.json").read_text("utf-8"))
    assert [one["version"] for one in found["libraries"]] == ["1.0.0", "1.2.0", "0.3.1-draft"]
