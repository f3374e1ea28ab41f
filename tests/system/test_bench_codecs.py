# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The codecs of the robot beside the C that cantools generates: the same frames, and faster."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from ravenchart.building import checking
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT
from tests.bench import codecs as bench_codecs

pytestmark = pytest.mark.slow


@pytest.mark.alone
def test_the_codecs_take_no_longer_than_c_that_checks_nothing() -> None:
    robot = checking.check(ROOT / "examples" / "cartesian_robot" / "model.yaml").system
    figures = bench_codecs.nanoseconds()
    assert list(figures) == [message.name for message in robot.messages]
    spent = {
        kind: sum(one[way, kind] for one in figures.values() for way in bench_codecs.WAYS)
        for kind in bench_codecs.KINDS
    }
    assert 0 < spent["ada"] <= spent["bare"] <= spent["checked"]


def test_c_that_makes_other_frames_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    made = bench_codecs.c_objects

    def broken(system: System, database: Path, place: Path) -> list[str]:
        text = database.read_text(encoding="utf-8")
        database.write_text(text.replace("y : 21|19", "y : 21|18", 1), encoding="utf-8")
        return made(system, database, place)

    monkeypatch.setattr(bench_codecs, "c_objects", broken)
    with pytest.raises(subprocess.CalledProcessError, match="codecs_bench"):
        bench_codecs.nanoseconds()
