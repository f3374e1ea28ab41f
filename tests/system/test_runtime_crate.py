# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The runtime as a crate: `alr` builds its consumers in each build profile, and they run."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

from ravenchart.paths import ROOT
from tests.support.alire import PROFILES, Alire, manifest, switches, with_profile

CRATES = (".", "spark_runtime")
"""Where their alire.toml is."""
CONSUMERS = {"examples/by_hand": "spark_runtime", "tests/can_crate": "."}
"""Crates that are written by hand, and the crate that each is pinned to."""
WARNING = re.compile(r":\d+:\d+: warning")
"""Of a compiler, or of gprbuild. Alire warns that its index has no GNAT to install."""
GENERATED = """\
name = "three_components"
description = "A generated program and the crate"
version = "0.1.0"
licenses = "Apache-2.0"
maintainers = ["nobody@example.org"]
maintainers-logins = ["nobody"]
project-files = ["generated/three_components.gpr"]

[configuration]
disabled = true

[[depends-on]]
ravenchart = "~0.1.0"

[[pins]]
ravenchart = { path = "../.." }
"""


def _run(program: Path, tmp_path: Path) -> None:
    """Run it; it fails unless it has done what it is for."""
    trace = tmp_path / "trace.txt"
    subprocess.run([program], env={**os.environ, "RAVENCHART_TRACE": str(trace)}, check=True)
    assert trace.read_text().endswith("END\n")


@pytest.mark.parametrize("mode", ["checks", "release"])
def test_a_processor_by_hand_is_built_without_a_warning_and_runs(tmp_path: Path, mode: str) -> None:
    home = Path(shutil.copytree(ROOT / "examples" / "by_hand", tmp_path / "consumer"))
    environment = {name: value for name, value in os.environ.items() if "RAVENCHART" not in name}
    environment |= {
        "GPR_PROJECT_PATH": str(ROOT / "spark_runtime"),
        "RAVENCHART_OBJECTS": str(tmp_path / "objects"),
        "MODE": mode,
    }
    done = subprocess.run(
        ["gprbuild", "-p", "-q", "-P", "by_hand.gpr"], cwd=home, env=environment,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout + done.stderr) == (0, "")
    _run(home / "build" / "by_hand_main", tmp_path)


# --- As Alire builds -----------------------------------------------------------------


@pytest.fixture(scope="module")
def alr(tmp_path_factory: pytest.TempPathFactory) -> Alire:
    if shutil.which("alr") is None:
        pytest.skip("alr is not on PATH (`scripts/setup.sh tests` installs it)")
    return Alire.installed(tmp_path_factory.mktemp("alire"))


def _checkout(folder: Path, consumer: str) -> Path:
    """What Alire takes of a checkout: both crates, and a consumer that is pinned to one."""
    for name in ("alire.toml", "ravenchart.gpr", "switches.gpr"):
        shutil.copy(ROOT / name, folder / name)
    for name in ("spark_runtime", "hw_can"):
        shutil.copytree(ROOT / name, folder / name, symlinks=True)
    return Path(shutil.copytree(ROOT / consumer, folder / consumer))


@pytest.mark.parametrize(
    "profile",
    [p if p == "release" else pytest.param(p, marks=pytest.mark.slow) for p in PROFILES],
)
@pytest.mark.parametrize(("consumer", "crate"), CONSUMERS.items())
def test_a_consumer_is_built_in_the_profile_and_runs(
    alr: Alire, tmp_path: Path, consumer: str, crate: str, profile: str
) -> None:
    home, objects = _checkout(tmp_path, consumer), tmp_path / "objects"
    with_profile(home, profile)
    said = alr.call(home, "build", RAVENCHART_OBJECTS=str(objects))
    assert WARNING.search(said) is None
    (built,) = objects.iterdir()
    assert built.name.startswith("crate-") and f"-{profile}" in built.name
    (program,) = manifest(home)["executables"]
    _run(next(path for path in home.rglob(program) if path.is_file()), tmp_path)

    chosen = switches(tmp_path / crate)
    assert "-gnatwe" not in chosen
    assert not any(one.startswith("-gnaty") for one in chosen)
    assert ("-gnata" in chosen, "-gnatp" in chosen) == (
        (False, True) if profile == "release" else (True, False)
    )


@pytest.mark.slow
def test_a_generated_program_is_built_with_the_crate(alr: Alire, tmp_path: Path) -> None:
    home, objects = _checkout(tmp_path, "examples/three_components"), tmp_path / "objects"
    (home / "alire.toml").write_text(GENERATED, encoding="utf-8")
    build = tmp_path / "build"
    said = alr.call(home, "build", RAVENCHART_OBJECTS=str(objects), RAVENCHART_BUILD=str(build))
    assert WARNING.search(said) is None
    assert (build / "release").is_dir()
    assert (objects / "crate-release-loopback").is_dir()


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
        known = manifest(ROOT / crate)
        assert (known["version"], known["licenses"]) == (project["version"], project["license"])
        for name in known["project-files"]:
            assert (ROOT / crate / name).is_file()
