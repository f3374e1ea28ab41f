# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Two main files in one folder: each has a program of its own, and none touches the other's."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT


def _put(folder: Path, name: str, text: str) -> checking.Checked:
    (folder / name).write_text(text)
    checked = checking.check(folder / name)
    generation.write_program(checked)
    return checked


def _files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_each_main_file_has_its_own_folder_of_generated_files(tmp_path: Path) -> None:
    text = (ROOT / "tests" / "feature" / "conflicts" / "model.yaml").read_text()
    usual = _put(tmp_path, "model.yaml", text)
    before = _files(tmp_path / "generated")
    other = _put(tmp_path, "slow.yaml", text.replace("10 ms", "20 ms"))
    third = _put(tmp_path, "third.yaml", text.replace("system: ", "system: Other_"))
    assert _files(tmp_path / "generated") == before
    homes = [one.generated for one in (usual, other, third)]
    assert homes == [tmp_path / n for n in ("generated", "generated-slow", "generated-third")]
    assert _files(homes[1]).keys() == before.keys()
    assert _files(homes[1]) != before
    made = [programs.programs_of(one)[0] for one in (usual, other, third)]
    assert len({one.home("slcan") for one in made}) == 3
    assert [one.project.parent for one in made] == homes


@pytest.mark.slow
def test_a_second_main_file_builds_beside_the_first(tmp_path: Path) -> None:
    text = (ROOT / "tests" / "feature" / "conflicts" / "model.yaml").read_text()
    built = [
        programs.programs_of(_put(tmp_path, name, text))[0].build()
        for name in ("model.yaml", "slow.yaml")
    ]
    assert all(path.is_file() for path in built)
    assert built[0] != built[1]
