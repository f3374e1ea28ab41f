# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The generator: the same bytes for the same model, and the committed ones."""

from __future__ import annotations

import hashlib
import shutil
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, written
from ravenchart.command_line import main
from ravenchart.failures import OK
from ravenchart.gen.emit.program import generate
from ravenchart.paths import ROOT
from tests import house

EXAMPLES = house.EXAMPLES


def _files(name: str) -> dict[str, str]:
    checked = checking.check(ROOT / "examples" / name / "model.yaml")
    return generate(checked.system, generation.claims(checked))


@pytest.mark.parametrize("name", EXAMPLES)
def test_generated_files_are_those_in_the_repository(name: str) -> None:
    folder = ROOT / "examples" / name / "generated"
    files = [p for p in folder.rglob("*") if p.is_file() and p.name != written.MANIFEST]
    there = {p.relative_to(folder).as_posix(): p.read_text() for p in files}
    assert _files(name) == there
    listed = (folder / written.MANIFEST).read_text().splitlines()
    assert listed == [
        f"{hashlib.sha256(text.encode()).hexdigest()}  {name}"
        for name, text in sorted(there.items())
    ]


@pytest.mark.parametrize("name", EXAMPLES)
def test_lines_fit_79_columns_and_name_no_path_or_date(name: str) -> None:
    for file, text in _files(name).items():
        if file.endswith((".ads", ".adb")):
            assert max(map(len, text.splitlines())) <= 79, file
        assert str(ROOT) not in text


def test_regenerating_replaces_nothing_and_leaves_user_code_alone(tmp_path: Path) -> None:
    folder = tmp_path / "robot"
    shutil.copytree(ROOT / "examples" / "cartesian_robot", folder)
    own = folder / "user" / "notes.txt"
    own.write_text("mine")
    checked = checking.check(folder / "model.yaml")
    first = generation.write_program(checked)
    stamps = {p: p.stat().st_mtime_ns for p in folder.rglob("*") if p.is_file()}
    second = generation.write_program(checked)
    assert (first.untouched, second.changed) == ((), 0)
    assert stamps == {p: p.stat().st_mtime_ns for p in folder.rglob("*") if p.is_file()}
    assert own.read_text() == "mine"


def test_a_file_that_is_no_longer_generated_goes_and_a_strange_one_stays(tmp_path: Path) -> None:
    folder = tmp_path / "three"
    shutil.copytree(ROOT / "examples" / "three_components", folder)
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    generated = folder / "generated"
    (generated / "old_unit.ads").write_text("package Old_Unit is end Old_Unit;")
    (generated / "keep.txt").write_text("keep")
    manifest = generated / written.MANIFEST
    manifest.write_text(manifest.read_text() + "old_unit.ads\n../user/evil.adb\n")
    generation.write_program(checked)
    assert not (generated / "old_unit.ads").exists()
    assert (generated / "keep.txt").read_text() == "keep"


def test_an_edit_of_a_generated_file_is_named_and_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "three"
    shutil.copytree(ROOT / "examples" / "three_components", folder)
    model = str(folder / "model.yaml")
    assert main(["generate", model]) == OK
    spec = folder / "generated" / "three_components.ads"
    made = spec.read_text()
    spec.write_text(f"{made}--  by hand\n")
    capsys.readouterr()
    assert main(["generate", model]) == OK
    assert capsys.readouterr().err == (
        f"warning: {spec} was edited by hand and is generated again; "
        "your version is kept as three_components.ads.edited\n"
    )
    assert spec.read_text() == made
    assert spec.with_name("three_components.ads.edited").read_text() == f"{made}--  by hand\n"
    assert main(["generate", model]) == OK
    assert "edited" not in capsys.readouterr().err


def test_a_generation_that_was_cut_short_leaves_no_edits(tmp_path: Path) -> None:
    folder = tmp_path / "three"
    shutil.copytree(ROOT / "examples" / "three_components", folder)
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    manifest = folder / "generated" / written.MANIFEST
    manifest.write_text(manifest.read_text().replace(manifest.read_text()[:64], "0" * 64))
    assert generation.write_program(checked).edited == ()
