# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The runtime as a crate: projects of consumers, built as Alire builds them, and run.

`alr` is not called: `tests/support/alire.py` writes the configuration that it would write.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support import alire

CRATES = (".", "spark_runtime")
"""Where their alire.toml is."""


def _built(project: Path, path: str, tmp_path: Path, **scenario: str) -> None:
    """Build a consumer; ``path`` leads to the projects of the crates."""
    environment = {name: value for name, value in os.environ.items() if "RAVENCHART" not in name}
    environment |= {
        "GPR_PROJECT_PATH": path,
        "RAVENCHART_OBJECTS": str(tmp_path / "objects"),
        **scenario,
    }
    done = subprocess.run(
        ["gprbuild", "-p", "-q", "-P", project.name], cwd=project.parent, env=environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout + done.stderr) == (0, "")


def _run(program: Path, tmp_path: Path) -> None:
    """Run it; it fails unless it has done what it is for."""
    trace = tmp_path / "trace.txt"
    subprocess.run([program], env={**os.environ, "RAVENCHART_TRACE": str(trace)}, check=True)
    assert trace.read_text().endswith("END\n")


@pytest.mark.parametrize("mode", ["checks", "release"])
def test_a_processor_by_hand_is_built_without_a_warning_and_runs(tmp_path: Path, mode: str) -> None:
    home = Path(shutil.copytree(ROOT / "examples" / "by_hand", tmp_path / "consumer"))
    _built(home / "by_hand.gpr", str(ROOT / "spark_runtime"), tmp_path, MODE=mode)
    _run(home / "build" / "by_hand_main", tmp_path)


# --- As Alire builds -----------------------------------------------------------------

OWN, OF_DEPENDENCIES = ("development", "validation"), ("release", "validation")
"""The profiles of `alr build`, and of `alr build --validation` with `"*" = "validation"`."""


def _deployed(tmp_path: Path) -> tuple[Path, Path]:
    """Both crates where Alire puts the dependencies of a program."""
    whole = tmp_path / "dependencies" / "ravenchart"
    for name in ("alire.toml", "ravenchart.gpr", "switches.gpr"):
        (whole / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, whole / name)
    for name in ("spark_runtime", "hw_can"):
        shutil.copytree(ROOT / name, whole / name, symlinks=True)
    return whole, whole / "spark_runtime"


@pytest.mark.parametrize(("own", "of_dependencies"), list(zip(OWN, OF_DEPENDENCIES, strict=True)))
def test_a_consumer_of_the_whole_crate_has_the_can_layer(
    tmp_path: Path, own: str, of_dependencies: str
) -> None:
    home = Path(shutil.copytree(ROOT / "tests" / "can_crate", tmp_path / "consumer"))
    whole, _ = _deployed(tmp_path)
    alire.configure(home, own)
    alire.configure(whole, of_dependencies)
    _built(home / "can_by_hand.gpr", alire.project_path(whole), tmp_path)
    _run(home / "bin" / "can_by_hand_main", tmp_path)
    assert (tmp_path / "objects" / f"crate-{of_dependencies}-loopback").is_dir()


@pytest.mark.parametrize("profile", OF_DEPENDENCIES)
def test_a_consumer_of_the_runtime_alone_is_built_in_the_profile(
    tmp_path: Path, profile: str
) -> None:
    home = Path(shutil.copytree(ROOT / "examples" / "by_hand", tmp_path / "consumer"))
    _, runtime = _deployed(tmp_path)
    alire.configure(runtime, profile)
    _built(home / "by_hand.gpr", alire.project_path(runtime), tmp_path)
    _run(home / "build" / "by_hand_main", tmp_path)
    assert (tmp_path / "objects" / f"crate-runtime-{profile}").is_dir()


@pytest.mark.slow
def test_a_generated_program_is_built_with_the_crate(tmp_path: Path) -> None:
    home = Path(shutil.copytree(ROOT / "examples" / "three_components", tmp_path / "consumer"))
    whole, _ = _deployed(tmp_path)
    alire.configure(whole, "release")
    project, build = home / "generated" / "three_components.gpr", str(tmp_path / "build")
    _built(project, alire.project_path(whole), tmp_path, RAVENCHART_BUILD=build)
    assert (tmp_path / "build" / "release").is_dir()
    assert (tmp_path / "objects" / "crate-release-loopback").is_dir()


@pytest.mark.parametrize("crate", CRATES)
def test_warnings_of_no_profile_are_errors_and_contracts_are_executed_but_in_release(
    crate: str,
) -> None:
    for profile in alire.PROFILES:
        switches = alire.switches(ROOT / crate, profile)
        assert "-gnatwe" not in switches
        assert not any(one.startswith("-gnaty") for one in switches)
        assert ("-gnata" in switches, "-gnatp" in switches) == (
            (False, True) if profile == "release" else (True, False)
        )


PROJECTS = {
    "ravenchart.gpr": "hw_can/crate/ravenchart.gpr",
    "spark_runtime/ravenchart_runtime.gpr": "spark_runtime/crate/ravenchart_runtime.gpr",
}


def _folders(project: str) -> set[str]:
    """The folders of sources that a project names, but for that of the target."""
    home = (ROOT / project).parent
    named = re.findall(r'"([\w./]+)"', (ROOT / project).read_text(encoding="utf-8"))
    found = {Path(name).name for name in named if (home / name).is_dir()}
    return found - {"", "..", "native", "spark_runtime"}


@pytest.mark.parametrize(("plain", "of_crate"), PROJECTS.items())
def test_the_project_of_a_crate_has_the_sources_of_the_plain_one(plain: str, of_crate: str) -> None:
    assert _folders(of_crate) == _folders(plain)
    assert {"src", "light"} <= _folders(plain)


def test_the_processor_by_hand_is_40_lines() -> None:
    texts = [path.read_text() for path in (ROOT / "examples" / "by_hand" / "src").glob("*.ad[sb]")]
    lines = [line for text in texts for line in text.splitlines() if "SPDX" not in line]
    assert len(list(filter(str.strip, lines))) <= 40
    assert max(map(len, lines)) <= 79


def test_the_crates_have_the_version_of_the_tool() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    for crate in CRATES:
        known = alire.manifest(ROOT / crate)
        assert (known["version"], known["licenses"]) == (project["version"], project["license"])
        for name in known["project-files"]:
            assert (ROOT / crate / name).is_file()
