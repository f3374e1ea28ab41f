# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The runtime as a crate: a consumer's project, built as Alire builds it, and run."""

from __future__ import annotations

import os
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

from ravenchart.paths import ROOT


def _built(tmp_path: Path, mode: str) -> Path:
    """The program of a copy of the example, with the runtime where a pin would lead."""
    home = tmp_path / "consumer"
    shutil.copytree(ROOT / "examples" / "by_hand", home)
    environment = {name: value for name, value in os.environ.items() if "RAVENCHART" not in name}
    environment |= {
        "GPR_PROJECT_PATH": str(ROOT / "spark_runtime"),
        "RAVENCHART_OBJECTS": str(tmp_path / "objects"),
        "MODE": mode,
    }
    words = ["gprbuild", "-p", "-q", "-P", "by_hand.gpr"]
    done = subprocess.run(
        words, cwd=home, env=environment, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout + done.stderr) == (0, "")
    return home / "build" / "by_hand_main"


@pytest.mark.parametrize("mode", ["checks", "release"])
def test_a_processor_by_hand_is_built_without_a_warning_and_runs(tmp_path: Path, mode: str) -> None:
    program, trace = _built(tmp_path, mode), tmp_path / "trace.txt"
    environment = {**os.environ, "RAVENCHART_TRACE": str(trace)}
    subprocess.run([program], env=environment, check=True)  # it fails unless it has counted
    assert trace.read_text().endswith("END\n")


def test_the_processor_by_hand_is_40_lines() -> None:
    texts = [path.read_text() for path in (ROOT / "examples" / "by_hand" / "src").glob("*.ad[sb]")]
    lines = [line for text in texts for line in text.splitlines()]
    assert len(list(filter(str.strip, lines))) <= 40
    assert max(map(len, lines)) <= 79


def test_the_crates_have_the_version_of_the_tool() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for crate in ("alire.toml", "spark_runtime/alire.toml"):
        known = tomllib.loads((ROOT / crate).read_text())
        assert (known["version"], known["licenses"]) == (project["version"], project["license"])
        for name in known["project-files"]:
            assert (ROOT / crate).with_name(name).is_file()
