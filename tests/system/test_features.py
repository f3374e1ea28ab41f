# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each folder of tests/feature: its model builds without a warning and runs to its trace."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
import yaml

from ravenchart.analysis.system.observed import Observation
from ravenchart.building import checking
from ravenchart.paths import ROOT
from tests.support.short_runs import observed

pytestmark = pytest.mark.clock

FOLDERS = sorted(p.parent for p in (ROOT / "tests" / "feature").glob("*/model.yaml"))
QUICK = {"charts", "devices", "faults", "passes", "registers", "requests", "signals"}
CASES = [
    pytest.param(p, marks=() if p.name in QUICK else pytest.mark.slow, id=p.name) for p in FOLDERS
]


def _expected(case: Path) -> dict[str, Any]:
    found: dict[str, Any] = yaml.safe_load((case / "expect.yaml").read_text())
    return found


@pytest.fixture
def folder(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A copy of the case."""
    copy: Path = tmp_path / request.param.name
    shutil.copytree(request.param, copy)
    return copy


def _run(folder: Path, expected: dict[str, Any]) -> Observation:
    checked = checking.check(folder / "model.yaml")
    assert re.findall(r"\[(RV-\d+)\]", checked.warnings) == expected.get("warnings", [])
    if not os.sched_getaffinity(0).issuperset(range(checked.system.most_cores)):
        pytest.skip(f"needs the first {checked.system.most_cores} processors of the machine")
    return observed(checked, folder, expected["seconds"])


def _agrees(seen: list[str], wanted: list[str]) -> bool:
    """Is that what happened? Where `...` ends what is wanted, it goes on until the run ends."""
    if wanted[-1:] == ["..."]:
        return seen[: len(wanted) - 1] == wanted[:-1]
    return seen == wanted


@pytest.mark.slow
@pytest.mark.parametrize("folder", CASES, indirect=True)
def test_it_runs_to_its_trace(folder: Path) -> None:
    expected = _expected(folder)
    seen = _run(folder, expected)
    for region, wanted in expected["transitions"].items():
        found = [r.text for r in seen.of("transition", region)]
        assert _agrees(found, wanted), found
    for region, wanted in expected["states"].items():
        assert [v.state for v in seen.visits(region)] == wanted
    for kind, least in expected.get("faults", {}).items():
        assert seen.faults[kind] >= least, kind
    for pair in expected.get("apart_ms", ()):
        times = {r.text: r.time for r in seen.of("transition", pair["region"])}
        apart = (times[pair["to"]] - times[pair["from"]]) / 1e6
        assert pair["least"] <= apart <= pair["most"], pair
