# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Invariants as contracts of the code: an effect that breaks one is refused by gnatprove."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.building import checking, generation
from ravenchart.failures import ToolFailed
from ravenchart.paths import ROOT
from ravenchart.proof import ages
from ravenchart.tools import toolchain

pytestmark = pytest.mark.skipif(
    not toolchain.have("gnatprove"), reason="gnatprove is not on PATH: nothing is proved"
)

FILLING = "never_feature-unit-filling.adb"
BROKEN = {
    "an effect": ("Data.Tank.Level + 20, 80)", "Data.Tank.Level + 20, 100)"),
    "an entry": ("Self.Data.Pump := Never_Feature.Slow;", "null;"),
    "an exit": ("Self.Data.Tank.Open := False;", "null;"),
}


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """The generated program of the feature."""
    folder = tmp_path / "never"
    shutil.copytree(ROOT / "tests" / "feature" / "never", folder)
    generation.write_program(checking.check(folder / "model.yaml"))
    return folder / "generated"


@pytest.mark.parametrize("what", BROKEN)
def test_an_effect_that_breaks_an_invariant_is_not_proved(program: Path, what: str) -> None:
    old, new = BROKEN[what]
    body = program / FILLING
    text = body.read_text()
    assert old in text
    body.write_text(text.replace(old, new))
    variables = {"RAVENCHART_BUILD": str(program.parent / "build")}
    options = ["-P", "never_feature.gpr", "-q", "--output=oneline", "--no-subprojects"]
    refused = f"^{FILLING}:.* postcondition might fail, cannot prove .*Is_Safe"
    with pytest.raises(ToolFailed, match=refused):
        ages.run([*options, "-u", FILLING], program, variables)
