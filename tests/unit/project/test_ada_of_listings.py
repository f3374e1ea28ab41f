# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Declarations of the docs are what `generate` writes, and bodies are compiled with it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from ravenchart.command_line import main
from ravenchart.paths import ROOT
from tests.support.listings import MODELS, Listing, filled, listings, one_of


def generated(folder: Path, model: str) -> Path:
    """The folder of the program of a model."""
    (folder / "model.yaml").write_text(model, encoding="utf-8")
    assert main(["generate", str(folder / "model.yaml")]) == 0
    return folder / "generated"


def from_page(page: str) -> str:
    """The whole model of a page."""
    return one_of(page, "system:").text


def from_file(name: str) -> str:
    """A model with listings."""
    return json.dumps(filled(MODELS / f"{name}.yaml").tree)


def plain(ada: str) -> str:
    """Ada without comments and layout."""
    return " ".join(re.sub(r"--.*", "", ada).split())


SPECS = {
    one_of("docs/contracts.md", "Pre => Low < High", "ada"):
        (from_page("docs/contracts.md"), "tank_house-tank-activities.ads"),
    one_of("docs/devices.md", "procedure Control", "ada"):
        (from_file("devices"), "robot_arm-servo-activities.ads"),
    one_of("docs/semantics.md", "procedure Watch", "ada"):
        (from_file("semantics_may_send"), "plant-tank-activities.ads"),
}  # fmt: skip
"""Declarations, each with its model and a generated file."""


@pytest.mark.parametrize("declared", SPECS, ids=lambda one: one.page)
def test_generate_writes_the_declaration_of_the_page(declared: Listing, tmp_path: Path) -> None:
    model, file = SPECS[declared]
    text = (generated(tmp_path, model) / file).read_text(encoding="utf-8")
    assert plain(declared.text) in plain(text)


def test_generate_writes_the_postconditions_that_comments_of_a_model_show(tmp_path: Path) -> None:
    shown = re.findall(r"# post: (.*)", one_of("docs/contracts.md", "may_send:").text)
    file = generated(tmp_path, from_file("contracts")) / "tank_house-tank-activities.ads"
    assert f"Post => {' and then '.join(shown)};" in plain(file.read_text(encoding="utf-8"))


RUNTIME = ROOT / "spark_runtime" / "src"
BODIES = [
    one_of("docs/contracts.md", "package body", "ada"),
    one_of("docs/getting-started.md", "package body", "ada"),
]
"""Bodies for the model of their page. Tests of the system build and prove them."""
BUILT = {one_of("docs/databases.md", "package body", "ada"): "tests/system/test_floats.py"}
"""A body for an imported database, and the test that builds it."""


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc is not on PATH")
@pytest.mark.parametrize("body", BODIES, ids=lambda one: one.page)
def test_a_body_is_compiled_with_the_generated_specs(body: Listing, tmp_path: Path) -> None:
    folder = generated(tmp_path, from_page(body.page))
    name = body.first.removeprefix("package body ").lower().replace(".", "-")
    assert (folder / f"{name}.ads").is_file()
    (tmp_path / f"{name}.adb").write_text(body.text, encoding="utf-8")
    done = subprocess.run(
        ["gcc", "-c", "-gnatc", "-gnat2022", f"-I{folder}", f"-I{RUNTIME}", f"{name}.adb"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")


def test_each_listing_in_ada_is_used() -> None:
    ada = {one for one in listings() if one.language == "ada"}
    assert {*SPECS, *BODIES, *BUILT} == ada
    assert all((ROOT / test).is_file() for test in BUILT.values())
