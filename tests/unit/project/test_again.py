# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where only tests that depend on the host's clock fail, the run asks for a second one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support import live
from tests.support.again import MOST, STATUS

TESTS = """
import os, pytest

@pytest.mark.clock
@pytest.mark.parametrize("number", range(7))
def test_clock(number):
    assert f"clock{number}" not in os.environ["FAILING"].split()

@pytest.mark.live
def test_live():
    assert "live" not in os.environ["FAILING"].split()

def test_value():
    assert "value" not in os.environ["FAILING"].split()
"""


@pytest.mark.parametrize(
    "workers",
    [
        pytest.param([], id="one process"),
        pytest.param(["-n", "2"], id="two workers", marks=pytest.mark.slow),
    ],
)
@pytest.mark.parametrize(
    ("failing", "status", "named"),
    [
        pytest.param("", 0, None, id="none", marks=pytest.mark.slow),
        pytest.param("value", 1, None, id="value", marks=pytest.mark.slow),
        pytest.param("value clock1", 1, None, id="both", marks=pytest.mark.slow),
        pytest.param("clock1", STATUS, ["test_clock[1]"], id="clock"),
        pytest.param(
            "clock1 live", STATUS, ["test_clock[1]", "test_live"], id="live", marks=pytest.mark.slow
        ),
        pytest.param(
            " ".join(f"clock{n}" for n in range(MOST + 1)),
            1,
            None,
            id="many",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_only_what_depends_on_the_clock_runs_again(
    tmp_path: Path, workers: list[str], failing: str, status: int, named: list[str] | None
) -> None:
    module, path = tmp_path / "test_some.py", tmp_path / "again"
    module.write_text(TESTS)
    path.write_text("an older run\n")
    words = [sys.executable, "-P", "-m", "pytest", "-q", "-p", "tests.conftest", *workers]
    done = subprocess.run(
        [*words, "--rootdir", tmp_path, "-c", os.devnull, "-p", "no:cacheprovider", module],
        cwd=ROOT,
        env={
            **os.environ,
            "FAILING": failing,
            "RAVENCHART_TESTS_AGAIN": str(path),
            live.LOCK: str(tmp_path / "live"),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == status, done.stdout + done.stderr
    found = path.read_text().splitlines() if path.exists() else None
    names = found and sorted(name.rpartition("::")[2] for name in found)
    assert names == named
    assert ("run once more, alone" in done.stdout) is (named is not None)
