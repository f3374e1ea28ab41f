# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Files beside a program: those that someone writes now, and those that are left over."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from ravenchart.running import held_files
from tests.support.snapshot_files import held

MARK = ".live-"


def test_only_files_that_are_held_are_found_the_newest_first(tmp_path: Path) -> None:
    mode = tmp_path / "checks"
    mode.mkdir()
    first, second, left = (mode / f"pump_main.live-{n}" for n in range(3))
    for age, one in ((9, first), (3, second), (1, left)):
        one.write_text("")
        os.utime(one, (time.time() - age,) * 2)
    with held(first), held(second):
        assert held_files.held_files([tmp_path], "pump_main", MARK) == [second, first]
        assert held_files.held_files([tmp_path], "other_main", MARK) == []
        assert held_files.held_files([tmp_path], "pump_main", ".bus-") == []


def test_a_new_file_takes_those_away_that_a_killed_run_has_left(tmp_path: Path) -> None:
    program = tmp_path / "pump_main"
    old, fresh, used, other = (
        tmp_path / f"pump_main.{name}"
        for name in ("live-old", "live-fresh", "live-used", "bus-old")
    )
    for one in (old, fresh, used, other):
        one.write_text("")
    for one in (old, used, other):
        os.utime(one, (time.time() - 2 * held_files.ABANDONED,) * 2)
    with held(used):
        made = held_files.new_file(program, MARK)
    assert made is not None
    assert sorted(tmp_path.iterdir()) == sorted((fresh, made, used, other))


def test_without_a_folder_there_is_no_new_file(tmp_path: Path) -> None:
    assert held_files.new_file(tmp_path / "none" / "pump_main", MARK) is None


def test_a_file_is_held_by_one_until_it_is_closed(tmp_path: Path) -> None:
    """Also where holder and reader are one process."""
    path = tmp_path / "one"
    path.touch()
    first, second = (os.open(path, os.O_RDWR) for _ in range(2))
    held_files.hold(first)
    assert held_files.is_held(path) and held_files.holder(second) == -1
    with pytest.raises(OSError, match="unavailable"):
        held_files.hold(second)
    os.close(first)
    assert not held_files.is_held(path) and held_files.holder(second) is None
    os.close(second)
