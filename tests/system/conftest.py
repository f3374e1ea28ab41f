# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Programs built once for all system tests."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT

CopyOf = Callable[[str], Path]
"""Copies an example to a folder of its own."""


def _built(name: str) -> tuple[checking.Checked, Path]:
    checked = checking.check(ROOT / "examples" / name / "model.yaml")
    generation.write_program(checked)
    return checked, programs.programs_of(checked)[0].build()


@pytest.fixture(scope="session")
def robot() -> tuple[checking.Checked, Path]:
    """The Cartesian robot, checked and built."""
    return _built("cartesian_robot")


@pytest.fixture(scope="session")
def stations() -> tuple[checking.Checked, Path]:
    """The three components, checked and built."""
    return _built("three_components")


@pytest.fixture
def copy_of(tmp_path: Path) -> CopyOf:
    """A function that copies an example to a folder of its own."""

    def copied(name: str) -> Path:
        target = tmp_path / name
        shutil.copytree(ROOT / "examples" / name, target)
        return target

    return copied
