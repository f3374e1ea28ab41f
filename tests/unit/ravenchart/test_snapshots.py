# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The files of snapshots: whole ones, torn ones, and those that nobody writes any more."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import TraceError
from ravenchart.running.process import ControllerProcess
from ravenchart.running.snapshots import VARIABLE, SnapshotFile, parsed_snapshot
from tests.support.snapshot_files import held, number, processors, snapshot, trace_map


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "pump_main.live-1"


def test_a_whole_snapshot_is_read(path: Path) -> None:
    path.write_text(snapshot(7, *processors(40)))
    text = SnapshotFile(path).text()
    assert text is not None
    found = parsed_snapshot(text, trace_map(), "file")
    assert found.sequence == 7
    assert found.seen.processors["control"].releases == 40
    assert found.seen.now == 2_000_000_000
    assert found.seen.losses == {"trace": 0, "ward.lost_out": 3, "snapshot": 0}


def test_a_shorter_snapshot_in_place_of_a_longer_one_is_read(path: Path) -> None:
    long, short = snapshot(7, *processors(40)), snapshot(8)
    path.write_text(short + long[len(short) :])
    assert SnapshotFile(path).text() == short


@pytest.mark.parametrize("cut", ["", "S 00000", None])
def test_what_is_no_whole_snapshot_is_none(path: Path, cut: str | None) -> None:
    path.write_text(snapshot(7, *processors(40))[:-30] if cut is None else cut)
    assert SnapshotFile(path).text() is None


def test_a_snapshot_over_which_another_is_being_written_is_none(path: Path) -> None:
    old, new = snapshot(7, *processors(40)), snapshot(8, *processors(41))
    assert len(old) == len(new)
    path.write_text(new[: len(new) // 2] + old[len(new) // 2 :])
    assert SnapshotFile(path).text() is None


def test_records_are_counted_and_the_last_one_is_known(path: Path) -> None:
    region = number("bed.Infusion", "region")
    text = snapshot(1, f"C STATE {region} 12 1050103723 2", *processors(1))
    (tally,) = parsed_snapshot(text, trace_map(), "file").tallies
    assert (tally.count, tally.last.kind, tally.last.time) == (12, "state", 1_050_103_723)
    assert tally.last.text == trace_map().named("bed.Infusion", "region").leaves[2]


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("C STATE 999 1 5 0", "the map has no element 999"),
        ("C NONE 1 1 5 0", "unknown kind 'NONE'"),
        ("C STATE 23 1 5", "not enough values"),
    ],
)
def test_a_line_that_cannot_be_read_is_named(line: str, problem: str) -> None:
    with pytest.raises(TraceError, match=r"^file:4: error: ") as found:
        parsed_snapshot(snapshot(1, line), trace_map(), "file")
    assert problem in str(found.value)


def test_the_owner_is_the_process_that_holds_the_lock(path: Path) -> None:
    path.write_text("")
    file = SnapshotFile(path)
    assert file.owner() is None
    with held(path) as process:
        assert file.owner() == process
    assert file.owner() is None


@pytest.mark.parametrize("watched", [True, False])
def test_a_controller_that_is_not_watched_is_given_no_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, watched: bool
) -> None:
    monkeypatch.setenv(VARIABLE, "inherited")
    program = tmp_path / "program"
    program.write_text(f'#!/bin/sh\necho "${{{VARIABLE}-none}}" >&2\n')
    program.chmod(0o755)
    hidden = {} if watched else {VARIABLE: None}
    process = ControllerProcess(program, tmp_path / "trace.txt", 0, **hidden)
    file = process.snapshots
    process.runs_for(5.0)
    assert process.stop(0.0).warnings == (str(file) if watched else "none",)
    assert (file is not None and file.parent == tmp_path) == watched
