# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A build gives the variant that was asked for, whichever was built before it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT

pytestmark = pytest.mark.slow


def _copied(example: Path, folder: Path) -> programs.Program:
    shutil.copytree(example, folder)
    checked = checking.check(folder / "model.yaml")
    generation.write_program(checked)
    return programs.programs_of(checked)[0]


def _shown(tool: str, option: str, program: Path) -> str:
    return subprocess.run(
        [tool, option, program], capture_output=True, text=True, check=True
    ).stdout


def test_the_mode_of_the_last_build_does_not_stay(tmp_path: Path) -> None:
    program = _copied(ROOT / "examples" / "three_components", tmp_path / "three")
    for mode in ("checks", "release", "checks", "release"):
        has_contracts = "raise_assert_failure" in _shown("nm", "-a", program.build(mode))
        assert has_contracts == (mode == "checks"), mode


@pytest.mark.parametrize("mode", ["checks", "release"])
def test_the_registers_of_the_last_build_do_not_stay(tmp_path: Path, mode: str) -> None:
    folder = tmp_path / "registers"
    shutil.copytree(ROOT / "tests" / "feature" / "registers", folder)
    model = folder / "model.yaml"
    text = model.read_text()
    right = "Right: {type: Drive, "
    assert text.count(right) == 1
    model.write_text(text.replace(right, f"{right}address: 0x4000_1000, "))
    checked = checking.check(model)
    generation.write_program(checked)
    program = programs.programs_of(checked)[0]
    for registers in ("simulated", "hardware", "simulated", "hardware"):
        built = program.build(mode, registers=registers)
        has_addresses = "0x40001008" in _shown("objdump", "-d", built)
        assert has_addresses == (registers == "hardware"), registers
