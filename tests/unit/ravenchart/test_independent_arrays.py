# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The independent checker counts arrays out by itself, and finds what is altered."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from ravenchart.independent.check import checked
from ravenchart.independent.findings import UnusableError
from ravenchart.paths import ROOT
from tests.unit.ravenchart.test_independent import _altered, _generated

PATH = ROOT / "tests/feature/arrays/model.yaml"


def generated(folder: Path) -> Path:
    return _generated(Path(shutil.copy(PATH, folder)))


def test_the_independent_checker_agrees_with_arrays(tmp_path: Path) -> None:
    report = checked(generated(tmp_path))
    assert report.disagreements == []
    assert all(report.counts[kind] > 0 for kind in ("tasks", "rows", "sums", "states"))


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("Follower, node: board, count: 4", "Follower, node: board, count: 3"),
        ("wheel_*.ports, ", "wheel_1.ports, "),
        ("wheel_*.Rolling, ", ""),
    ],
)
def test_the_independent_checker_finds_another_array(tmp_path: Path, old: str, new: str) -> None:
    path = generated(tmp_path)
    joins = [
        "{from: wheel_*.speed, to: shadow_*.speed}",
        "{from: wheel_1.speed, to: shadow_1.speed}",
    ]
    _altered(path, [joins, [old, new]])
    assert [one for one in checked(path).disagreements if one.kind != "digest"]


def test_the_independent_checker_takes_no_star_without_array(tmp_path: Path) -> None:
    path = generated(tmp_path)
    _altered(path, [["wheel_*.Rolling, ", "driver_*.steer, "]])
    with pytest.raises(UnusableError, match="`driver_\\*` is no array"):
        checked(path)
