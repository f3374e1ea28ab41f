# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The pictures under docs show the examples as they are, and their READMEs show the pictures."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ravenchart.building import checking, drawings
from ravenchart.command_line import main
from ravenchart.gen.draw.svg import mark
from ravenchart.paths import ROOT

PICTURES = ROOT / "docs" / "pictures"
EXAMPLES = sorted(path.parent.name for path in (ROOT / "examples").glob("*/model.yaml"))


def _texts(example: str) -> dict[str, str]:
    return drawings.texts(checking.check(ROOT / "examples" / example / "model.yaml").system)


@pytest.mark.parametrize("example", EXAMPLES)
def test_pictures_are_of_what_the_model_says(example: str) -> None:
    texts = _texts(example)
    there = {path.name: path.read_text() for path in (PICTURES / example).iterdir()}
    assert sorted(there) == sorted(texts), "run make docs, and delete what is no longer drawn"
    for name, text in texts.items():
        assert mark(text) in there[name], f"{name}: run make docs"


@pytest.mark.parametrize("example", EXAMPLES)
def test_the_readme_shows_every_picture(example: str) -> None:
    readme = (ROOT / "examples" / example / "README.md").read_text()
    for name in _texts(example):
        assert f"](../../docs/pictures/{example}/{name})" in readme


def test_the_command_writes_one_file_for_each_chart_and_one_for_the_structure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    model = str(ROOT / "tests" / "feature" / "charts" / "model.yaml")
    assert main(["draw", model, "--out", str(tmp_path)]) == 0
    assert capsys.readouterr().out == f"{tmp_path}: 3 drawings\n"
    names = ["Unit.Leader.svg", "Unit.Subject.svg", "structure.svg"]
    assert sorted(path.name for path in tmp_path.iterdir()) == names
    assert main(["draw", model, "--out", str(tmp_path), "--format", "mermaid"]) == 0
    assert (tmp_path / "Unit.Subject.mmd").read_text().startswith("---\ntitle: Unit.Subject\n")


def test_identifiers_are_the_same_text_in_every_format() -> None:
    system = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    texts = [drawings.text(system, drawings.STRUCTURE, form) or "" for form in drawings.FORMATS]
    extended = ROOT / "examples" / "j1939_node" / "model.yaml"
    texts += drawings.texts(checking.check(extended).system, "mermaid").values()
    found = [re.findall(r"0x[0-9A-F]+", text) for text in texts]
    robot = {message.shown_identifier for message in system.messages}
    assert all(set(one) == robot for one in found[:3])
    assert all(len(one) == len("0x18FEF100") for one in found[3]), found[3]
