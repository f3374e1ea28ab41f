"""What a reader expects at the door of a project: licences, changelog, a build that runs."""

from __future__ import annotations

import hashlib
import subprocess
import tomllib
from fnmatch import fnmatchcase
from pathlib import Path

import pytest
import yaml

from ravenchart.paths import ROOT
from tests.support import licences

LICENCES = ("LICENSE", "LICENSES/Apache-2.0.txt")
OTHERS = {"LICENSES/MIT.txt": "ravenchart/workbench/assets/preact.js"}
"""Texts of other licences, each with a file of others that is shipped under it."""

PREACT = "72284e8e9079c87817145df1110f74e8a2aa040b2fc384922e18dfcb46fc1fd7"
"""SHA-256 of htm/preact/standalone.module.js in htm 3.1.1."""


def licensed() -> tuple[tuple[str, ...], ...]:
    """The paths of each annotation of REUSE.toml."""
    read = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))
    return tuple(tuple(one["path"]) for one in read["annotations"])


def uncovered(files: list[str]) -> list[str]:
    """The files to which no annotation gives a licence."""
    paths = [path for group in licensed() for path in group]
    return [file for file in files if not any(fnmatchcase(file, path) for path in paths)]


def tracked() -> list[str]:
    """Every file of the repository, without the texts of licences and REUSE.toml itself."""
    if not (ROOT / ".git").exists():
        pytest.skip("not a git checkout: no list of tracked files")
    done = subprocess.run(
        ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    return [file for file in done.stdout.split("\0") if file and file != "REUSE.toml"]


def test_every_tracked_file_has_a_licence() -> None:
    files = tracked()
    assert len(files) > 100
    assert [file for file in uncovered(files) if file not in (*LICENCES, *OTHERS)] == []


def test_a_new_tree_has_no_licence_before_it_is_listed() -> None:
    assert uncovered(["new_tree/file.py", "gen/pipeline.py", "new.md"]) == [
        "new_tree/file.py",
        "new.md",
    ]


def test_every_source_of_ours_begins_with_its_licence() -> None:
    assert len(list(licences.sources())) > 100
    assert licences.without_lines() == []


def test_no_annotation_names_what_is_not_there() -> None:
    paths = [path for group in licensed() for path in group]
    assert [path for path in paths if not (ROOT / path.removesuffix("/**")).exists()] == []


def test_the_licence_is_one_text_and_one_identifier() -> None:
    first, second = ((ROOT / name).read_text(encoding="utf-8") for name in LICENCES)
    assert first == second
    read = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    own = [one for one in read["annotations"] if one.get("precedence") != "override"]
    named = {one["SPDX-License-Identifier"] for one in own}
    assert named == {project["project"]["license"]} == {"Apache-2.0"}


def test_the_map_of_the_house_names_every_folder() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    folders = {file.split("/")[0] for file in tracked() if "/" in file}
    shown = {folder for folder in folders if not folder.startswith(".")} - {"LICENSES", "scripts"}
    assert [folder for folder in sorted(shown) if f"`{folder}/`" not in text] == []


@pytest.mark.parametrize("file", [".pre-commit-config.yaml", ".github/workflows/ci.yml"])
def test_files_of_others_tools_name_programs_that_are_here(file: str) -> None:
    text = (ROOT / file).read_text(encoding="utf-8")
    assert yaml.safe_load(text)
    named = [word for word in text.split() if word.startswith((".ci/", "tests/"))]
    assert named
    assert [word for word in named if not Path(ROOT, word.rstrip(".")).exists()] == []


def test_files_of_others_are_as_published_under_a_licence_that_is_here() -> None:
    read = tomllib.loads((ROOT / "REUSE.toml").read_text(encoding="utf-8"))
    (foreign,) = [one for one in read["annotations"] if one.get("precedence") == "override"]
    names = foreign["SPDX-License-Identifier"].split(" AND ")
    assert {f"LICENSES/{name}.txt" for name in names} == {*LICENCES[1:], *OTHERS}
    assert set(OTHERS.values()) <= set(foreign["path"])
    content = (ROOT / "ravenchart/workbench/assets/preact.js").read_bytes()
    assert hashlib.sha256(content).hexdigest() == PREACT
