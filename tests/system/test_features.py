"""Each folder of tests/feature: its model builds without a warning and runs to its trace."""

from __future__ import annotations

import re
import shutil
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import pytest
import yaml

from analysis.observed import Observation, read_map, read_trace
from ravenchart import steps, toolchain
from ravenchart.__main__ import main
from ravenchart.toolchain import ROOT

CASES = sorted(p.parent for p in (ROOT / "tests" / "feature").glob("*/model.yaml"))


@pytest.fixture(params=CASES, ids=lambda p: p.name)
def case(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Path, dict[str, Any]]:
    """A copy of the case, and what is expected of it."""
    folder = tmp_path / request.param.name
    shutil.copytree(request.param, folder)
    return folder, yaml.safe_load((folder / "expect.yaml").read_text())


def _run(folder: Path, seconds: float) -> tuple[steps.Checked, Observation]:
    checked = steps.check(folder / "model.yaml")
    assert checked.warnings == ""
    steps.write_program(checked)
    trace = folder / "trace"
    process = subprocess.Popen([steps.build(checked)], env={"RAVENCHART_TRACE": str(trace)})
    time.sleep(seconds)
    process.send_signal(signal.SIGTERM)
    assert process.wait(5) == 0
    names = read_map((folder / "generated" / "trace.json").read_text())
    return checked, read_trace(trace.read_text().splitlines(), names)


def test_it_runs_to_its_trace(case: tuple[Path, dict[str, Any]]) -> None:
    folder, expected = case
    _, seen = _run(folder, expected["seconds"])
    for region, wanted in expected["transitions"].items():
        assert [r.text for r in seen.of("transition", region)] == wanted
    for region, wanted in expected["states"].items():
        assert [v.state for v in seen.visits(region)] == wanted
    for kind, least in expected.get("faults", {}).items():
        assert seen.faults[kind] >= least, kind
    for pair in expected.get("apart_ms", ()):
        times = {r.text: r.time for r in seen.of("transition", pair["region"])}
        apart = (times[pair["to"]] - times[pair["from"]]) / 1e6
        assert pair["least"] <= apart <= pair["most"], pair


@pytest.mark.skipif(not toolchain.have("gnatprove"), reason="gnatprove is not on PATH")
def test_it_is_proved(
    case: tuple[Path, dict[str, Any]], capsys: pytest.CaptureFixture[str]
) -> None:
    folder, expected = case
    if not expected.get("proved"):
        assert "proved" not in expected
        return
    assert main(["prove", str(folder / "model.yaml")]) == 0
    assert re.search(r"checks (\d+), proved \1, justified 0, assumed 0", capsys.readouterr().out)
