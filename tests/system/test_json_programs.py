"""`--json` of the commands that compile, run and prove a program; terminals and pipes."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests.support.answers import answered

PRINTED = pytest.CaptureFixture[str]


@pytest.fixture
def model(tmp_path: Path, capsys: PRINTED) -> Path:
    """The model of a new project."""
    answered(capsys, "new", tmp_path / "tank")
    return tmp_path / "tank" / "model.yaml"


def test_a_program_that_was_built_is_named(model: Path, capsys: PRINTED) -> None:
    result = answered(capsys, "build", model)["result"]
    (built,) = result["programs"]
    assert Path(built["program"]).is_file() and result["generated"]["files"] > 0
    source = next((model.parent / "user").glob("*.adb"))
    source.write_text(source.read_text().replace("begin", "begin oops;", 1))
    answer = answered(capsys, "build", model, status=1)
    assert any(
        one["file"] == source.name and one["line"] and one["severity"] == "error"
        for one in answer["diagnostics"]
    )
    answered(capsys, "clean", model)


@pytest.mark.live
def test_a_run_answers_with_its_verdict(model: Path, capsys: PRINTED) -> None:
    result = answered(capsys, "run", model, "--seconds", "1")["result"]
    assert result["passed"] and result["verdict"].startswith("verdict: PASS")
    assert Path(result["report"]).is_file() and result["processors"][0]["count"] > 0
    scenario = model.with_name("none.yaml")
    answer = answered(capsys, "run", model, "--scenario", scenario, status=1)
    assert answer["diagnostics"] and answer["result"] is None
    answered(capsys, "clean", model)


@pytest.mark.skipif(shutil.which("gnatprove") is None, reason="gnatprove is not on PATH")
def test_a_proof_answers_with_its_checks(model: Path, capsys: PRINTED) -> None:
    (proved,) = answered(capsys, "prove", model)["result"]["programs"]
    assert proved["clean"] and proved["checks"] == proved["proved"] > 0
    answered(capsys, "clean", model)
