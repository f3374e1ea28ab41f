# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Types and components of any model can be a library: their code stays the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.proof.code import elements
from tests.support.as_library import NAME, split

MODELS = {
    path.parent.name: path.parent
    for kind in ("tests/feature", "tests/nodes")
    for path in sorted((ROOT / kind).glob("*/model.yaml"))
    if path.parent.name != "library"
}
SEES_RUNTIME_BY_ROOT = {"registers"}
"""Drivers of the user there name the runtime, which the root has for its own types alone."""


def code_of(path: Path, root: str) -> list[bytes]:
    """The lexical elements of a unit, its context clauses apart, with one name for the root."""
    found = [
        b"ROOT" if one.lower() == root.lower().encode() else one
        for one in elements(path.read_bytes())
    ]
    begin = next(n for n, one in enumerate(found) if one in (b"package", b"procedure"))
    return found[begin:]


@pytest.mark.parametrize("name", MODELS)
def test_components_have_the_same_code_in_a_library(name: str, tmp_path: Path) -> None:
    main = split(MODELS[name], tmp_path / "split")
    parted = checking.check(main, deadlines=False)
    (library,) = parted.libraries
    generation.write_program(parted)
    whole = checking.check(MODELS[name] / "model.yaml", deadlines=False)
    folder = tmp_path / "whole"
    folder.mkdir()
    root = whole.system.name
    texts = generation.texts_of(whole)
    units = [path for path in library.generated.glob("*-*.ad?")]
    compared = 0
    for unit in units:
        same = [
            key for key in texts if key.endswith(unit.name.replace(NAME.lower(), root.lower(), 1))
        ]
        for key in same:
            (folder / "unit").write_text(texts[key], "utf-8")
            assert code_of(unit, NAME) == code_of(folder / "unit", root), unit.name
            compared += 1
    assert compared >= len(units) > 0 or not whole.system.components


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(MODELS.keys() - SEES_RUNTIME_BY_ROOT))
def test_such_a_model_compiles_without_a_warning(name: str, tmp_path: Path) -> None:
    checked = checking.check(split(MODELS[name], tmp_path / "split"), deadlines=False)
    generation.write_program(checked)
    said: list[str] = []
    for one in programs.programs_of(checked):
        one.build("checks", warn=said.append, stacks_needed=False)
    assert said == []
