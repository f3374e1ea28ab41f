# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a reader expects at the door of a project: licences, changelog, a build that runs."""

from __future__ import annotations

import hashlib
import json
import re
import tomllib
from pathlib import Path

import jsonschema
import pytest
import yaml

from ravenchart.paths import ROOT
from tests.support import licences

LICENCES = ("LICENSE", "LICENSES/Apache-2.0.txt")
OTHERS = {"LICENSES/MIT.txt": "ravenchart/workbench/assets/preact.js"}
"""Texts of other licences, each with a file of others that is shipped under it."""

PREACT = "72284e8e9079c87817145df1110f74e8a2aa040b2fc384922e18dfcb46fc1fd7"
"""SHA-256 of htm/preact/standalone.module.js in htm 3.1.1."""


def tracked() -> list[str]:
    """Every file of the repository."""
    if not (ROOT / ".git").exists():
        pytest.skip("not a git checkout: no list of tracked files")
    return licences.tracked()


def test_every_file_of_ours_has_its_licence_at_its_head() -> None:
    assert len(tracked()) > 100
    wrong = [
        file
        for file in licences.wanting()
        if licences.head((ROOT / file).read_text(encoding="utf-8")) != licences.LINES
    ]
    assert wrong == [], "run `python -P -m tests.support.licences`"


def test_a_file_has_its_licence_in_one_place() -> None:
    twice = [
        file
        for file in set(tracked()) - set(licences.wanting()) - set(licences.TEXTS)
        if licences.comment(file) and licences.head((ROOT / file).read_text(encoding="utf-8"))
    ]
    assert twice == []


@pytest.mark.parametrize(
    ("file", "text", "expected"),
    [
        ("a.py", '"""Doc."""\n', '# {0}\n# {1}\n\n"""Doc."""\n'),
        ("__init__.py", "", "# {0}\n# {1}\n"),
        ("a.sh", "#!/bin/sh\n# Why.\n", "#!/bin/sh\n# {0}\n# {1}\n\n# Why.\n"),
        ("a.adb", "package body A is\n", "--  {0}\n--  {1}\n\npackage body A is\n"),
        ("a.css", "/* Why. */\n", "/* {0} */\n/* {1} */\n\n/* Why. */\n"),
        ("Makefile", "all:\n", "# {0}\n# {1}\n\nall:\n"),
    ],
)
def test_a_licence_is_written_below_the_name_of_the_interpreter(
    file: str, text: str, expected: str
) -> None:
    marks = licences.comment(file)
    assert marks is not None
    assert licences.head(text) == ()
    written = licences.with_head(text, marks)
    assert written == expected.format(*licences.LINES)
    assert licences.head(written) == licences.LINES


def test_a_star_of_a_path_stays_in_a_folder() -> None:
    of = licences.Annotation(("a/*.yaml", "b/**", "**.md"), "MIT", False).covers
    assert [of(name) for name in ("a/x.yaml", "b/c/x", "c/d.md", "d.md")] == [True] * 4
    assert [of(name) for name in ("a/b/x.yaml", "a/xayaml", "new/x.py")] == [False] * 3


def test_no_annotation_names_what_is_not_there() -> None:
    files = tracked()
    paths = [path for one in licences.annotated() for path in one.paths]
    single = [licences.Annotation((path,), "", False) for path in paths]
    assert [one.paths for one in single if not any(map(one.covers, files))] == []


def test_the_licence_is_one_text_and_one_identifier() -> None:
    first, second = ((ROOT / name).read_text(encoding="utf-8") for name in LICENCES)
    assert first == second
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    named = {one.licence for one in licences.annotated() if not one.foreign}
    assert named == {project["project"]["license"]} == {licences.LICENCE}


def test_the_version_is_one() -> None:
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    crates = [file for file in tracked() if Path(file).name == "alire.toml"]
    assert len(crates) > 4
    found = {file: tomllib.loads((ROOT / file).read_text())["version"] for file in crates}
    package = "editors/vscode/package.json"
    found[package] = json.loads((ROOT / package).read_text())["version"]
    page = (ROOT / "docs" / "editors.md").read_text(encoding="utf-8")
    (found["docs/editors.md"],) = re.findall(r"ravenchart-(\S+)\.vsix", page)
    assert {file: one for file, one in found.items() if one != version} == {}


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
    (foreign,) = [one for one in licences.annotated() if one.foreign]
    names = foreign.licence.split(" AND ")
    assert {f"LICENSES/{name}.txt" for name in names} == {*LICENCES[1:], *OTHERS}
    assert set(OTHERS.values()) <= set(foreign.paths)
    content = (ROOT / "ravenchart/workbench/assets/preact.js").read_bytes()
    assert hashlib.sha256(content).hexdigest() == PREACT


def test_an_editor_that_opens_the_checkout_finds_the_schemas() -> None:
    settings = json.loads((ROOT / ".vscode" / "settings.json").read_text(encoding="utf-8"))
    for schema, patterns in settings["yaml.schemas"].items():
        known = jsonschema.Draft202012Validator(json.loads((ROOT / schema).read_text()))
        for pattern in patterns:
            files = sorted(ROOT.glob(pattern))
            assert files, pattern
            for file in files[:10]:
                data = yaml.load(file.read_text(encoding="utf-8"), yaml.BaseLoader)
                assert data is not None
                wrong = [one.validator for one in known.iter_errors(data)]
                assert "additionalProperties" not in wrong, file
