# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Each warning that generated Ada switches off is one that the compiler gives there."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from ravenchart.gen.emit.program import generate, library_files
from ravenchart.gen.files.load import deployments_of
from ravenchart.gen.model.claims import Claims
from ravenchart.gen.pipeline import load
from ravenchart.paths import ROOT
from tests.house import EXAMPLES, MODELS

pytestmark = pytest.mark.slow

NOT_ALWAYS = "no entities of*"
"""Of a package of a library that is only a prefix: the compiler warns in some of these units."""
OFF = re.compile(r'^ *pragma Warnings \(Off, "([^"]*)".*\n', re.M)
FOLDERS = {name: ROOT / "examples" / name for name in EXAMPLES} | MODELS
RUNTIME = (
    *(ROOT / "spark_runtime" / name for name in ("src", "native")),
    *(ROOT / "hw_can" / name for name in ("hal", "protocol", "simulator", "drivers/loopback")),
)


def _written(folder: Path, home: Path) -> Iterator[Path]:
    """The files of the programs of the models in a folder, each in its place."""
    for number, path in enumerate(deployments_of(folder / "model.yaml")):
        system = load(path).system
        assert system is not None
        libraries = [library_files(one) for one in system.libraries]
        parts = [*libraries, generate(system, Claims())]
        for name, text in (pair for part in parts for pair in part.items()):
            file = home / str(number) / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
            yield file


def _said(unit: Path, users: list[Path]) -> str:
    """What the compiler says of a unit and of the spec that it completes."""
    body = unit.with_suffix(".adb")
    searched = [f"-I{folder}" for folder in (unit.parent, unit.parent.parent, *users, *RUNTIME)]
    command = ["gcc", "-c", "-gnat2012", "-gnatwa", "-gnata", *searched]
    made = body if body.exists() else unit
    done = subprocess.run([*command, made], cwd=unit.parent, capture_output=True, text=True)
    return done.stderr


@pytest.mark.parametrize("name", FOLDERS)
def test_without_the_line_the_compiler_warns(name: str, tmp_path: Path) -> None:
    users = [path.parent for path in FOLDERS[name].glob("**/user/**/*.ad[sb]")]
    for file in list(_written(FOLDERS[name], tmp_path)):
        text = file.read_text(encoding="utf-8")
        for line in OFF.finditer(text):
            if line[1] == NOT_ALWAYS:
                continue
            without = text[: line.start()] + text[line.end() :]
            file.write_text(without, encoding="utf-8")
            said = _said(file, users)
            words = ".*".join(map(re.escape, line[1].split("*")))
            warned = re.search(rf"^{re.escape(file.name)}:\d+:\d+: warning: {words}", said, re.M)
            assert warned, f"{file.name}: {line[0]}{said}"
            file.write_text(text, encoding="utf-8")


def test_the_examples_have_the_lines_that_are_looked_for() -> None:
    """So few that each is named here: the test above would pass where none is found."""
    found = [
        (path.name, line[1])
        for path in sorted((ROOT / "examples").glob("*/generated/**/*.ad[sb]"))
        for line in OFF.finditer(path.read_text(encoding="utf-8"))
    ]
    assert found == [
        *[("autopilot.ads", "use clause for type*")] * 3,
        ("canopen_device-controller-inbox.ads", "*can * be*"),
        ("crossing_system-crossing-lights.ads", "*array aggregate using*"),
        ("infusion_system-pump-infusion.ads", "*array aggregate using*"),
        ("infusion_system-pump-keys.ads", "*can * be*"),
        ("qhsm_test-qhsm-chart.ads", "*explicit membership test*"),
        ("qhsm_test-qhsm-keys.ads", "*can * be*"),
    ]
