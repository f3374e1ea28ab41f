# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The responses of activities while a controller runs, and up to any instant of its replay."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from ravenchart.analysis.system.observed import Releases, read_trace
from ravenchart.analysis.system.row_responses import RowHistogram, row_histograms
from ravenchart.gen.language.terms import Ns
from ravenchart.running.held_files import link_trace, new_file, trace_beside
from ravenchart.running.live_responses import (
    MOST_READ,
    NO_TRACE,
    LiveResponses,
    ProcessResponses,
    TraceTail,
)
from ravenchart.running.row_histories import histories
from ravenchart.running.snapshots import MARK
from tests.support.responses import MS, desk, desk_map, lines, random_run

START = Ns(1000)
HEAD = ("E 1000", f"M {desk_map().digest}")
JOBS = (
    "B 0.1 own.Control", "B 1.0 own.toil", "B 2.0 own.rest",
    "B 10.2 own.Control", "B 11.1 own.toil",
)  # fmt: skip
FIRST = "P 15 work 2 2.0"
SECOND = "P 16 work 2 2.0"


def live(*, whole: bool = True) -> LiveResponses:
    return LiveResponses(desk(), desk_map(), whole=whole)


def fed(told: list[str], *, whole: bool = True) -> list[RowHistogram]:
    """The histograms once all of these lines came."""
    found = live(whole=whole)
    for one in told:
        found.take(one)
    return found.shown()


def counts(rows: list[RowHistogram]) -> dict[str, tuple[int, int, int]]:
    """By activity: exact responses, upper estimates, and executions."""
    return {one.name: (sum(one.exact), sum(one.at_most), one.executions) for one in rows}


# --- Lines as they come ----------------------------------------------------------------------


@pytest.mark.parametrize("losses", [0, 30])
@pytest.mark.parametrize("seed", range(10))
def test_lines_that_come_one_by_one_show_what_the_whole_trace_shows(seed: int, losses: int) -> None:
    told, _ = random_run(seed, losses)
    assert fed([*told, "END"]) == row_histograms(desk(), read_trace(told, desk_map()))


def test_records_that_come_behind_the_report_of_their_release_are_sampled() -> None:
    told = lines(*JOBS[:3], FIRST, *JOBS[3:], SECOND)
    assert counts(fed(told)) == {
        "own.Control": (0, 2, 2), "own.toil": (1, 1, 2), "own.rest": (0, 0, 1),
    }  # fmt: skip
    before = lines(*JOBS[:3], FIRST, *JOBS[3:])
    assert counts(fed(before))["own.Control"] == (0, 0, 0)  # some might follow yet


def test_a_trace_that_is_read_from_its_middle_counts_from_the_next_report_on() -> None:
    told, _ = random_run(3, 0)
    place = [n for n, line in enumerate(told) if line.startswith("N")][5]
    rows = fed([*told[place:], "END"], whole=False)
    whole = fed([*told, "END"])
    records = [one for one in told[place + 2 :] if one.startswith("T")]
    head = fed([*told[: place + 2], *records, "END"])
    for one, all_of_it, before in zip(rows, whole, head, strict=True):
        assert one.executions == all_of_it.executions - before.executions
        assert sum(one.at_most) == sum(all_of_it.at_most) - sum(before.at_most)
        assert sum(one.exact) == sum(all_of_it.exact) - sum(before.exact)


# --- The trace of a process -------------------------------------------------------------------


def written(path: Path, told: list[str]) -> None:
    path.write_text("".join(f"{line}\n" for line in (*HEAD, *told)), encoding="ascii")


def test_a_trace_is_read_on_from_look_to_look(tmp_path: Path) -> None:
    path = tmp_path / "trace.txt"
    told = lines(*JOBS, FIRST, SECOND)
    written(path, told[:4])
    tail = TraceTail(path, START)
    assert tail.whole
    assert tail.lines() == [*HEAD, *told[:4]]
    assert tail.lines() == []
    with path.open("a", encoding="ascii") as file:
        file.write(told[4][:5])
    assert tail.lines() == []
    with path.open("a", encoding="ascii") as file:
        file.write(f"{told[4][5:]}\n")
    assert tail.lines() == [told[4]]
    tail.close()


def test_of_a_long_trace_the_end_is_read(tmp_path: Path) -> None:
    path = tmp_path / "trace.txt"
    told = [f"N {number}" for number in range(1_000_000, 1_100_000)]
    written(path, told)
    tail = TraceTail(path, START)
    assert not tail.whole
    found = tail.lines()
    assert found == told[-len(found) :]  # without a part of a line
    assert MOST_READ * 0.9 < sum(map(len, found)) + len(found) <= MOST_READ
    tail.close()


@pytest.mark.parametrize("text", ["", "E 10", "E 999\n", "T 0 Activity 1 0\n"])
def test_a_trace_of_another_run_is_not_read(tmp_path: Path, text: str) -> None:
    path = tmp_path / "trace.txt"
    path.write_text(text, encoding="ascii")
    with pytest.raises(ValueError, match="not the trace of the run"):
        TraceTail(path, START)


def test_without_a_trace_the_last_activity_has_the_responses_of_snapshots(tmp_path: Path) -> None:
    file = tmp_path / "desk.live"
    found = ProcessResponses(desk(), desk_map(), file)
    one = Releases(3, 0, Ns(4 * MS), Ns(25 * MS), Ns(4 * MS))
    later = replace(one, releases=4, now=Ns(35 * MS), last_response=Ns(MS))
    for seen in (one, one, later, replace(later, now=Ns(36 * MS))):
        shown = found.look(START, [("work", seen)])
    assert shown.note == NO_TRACE
    assert counts(shown.rows) == {
        "own.Control": (0, 0, 1), "own.toil": (1, 0, 1), "own.rest": (0, 0, 0),
    }  # fmt: skip
    written(trace_beside(file), lines(*JOBS, FIRST, SECOND))  # it is flushed late
    shown = found.look(START, [("work", later)])
    assert shown.note.startswith("From the trace up to 0.015 s")
    assert counts(shown.rows)["own.Control"] == (0, 2, 2)
    shown = found.look(Ns(2000), [("work", one)])  # another run
    assert counts(shown.rows)["own.Control"] == (0, 0, 0)
    found.close()


def test_the_link_to_a_trace_goes_with_the_file_of_its_snapshots(tmp_path: Path) -> None:
    left, mine = tmp_path / "desk.live-1", tmp_path / "desk.live-2"
    left.touch()
    mine.touch()
    trace = tmp_path / "out" / "trace.txt"
    link_trace(left, trace)
    link_trace(mine, trace)
    assert trace_beside(left).is_symlink()
    left.unlink()
    trace_beside(mine).unlink()
    link_trace(mine, trace)
    assert not trace_beside(left).is_symlink()
    assert trace_beside(mine).readlink() == trace


# --- Replay -----------------------------------------------------------------------------------


def test_at_an_instant_the_responses_are_those_of_the_reports_before() -> None:
    told = lines(
        *JOBS, FIRST, "B 20.1 own.Control", "B 21.0 own.toil", "B 22.5 own.rest", "P 25 work 3 9.0"
    )
    rows = list(histories(desk(), read_trace(told, desk_map())))

    def at(now: float) -> dict[str, tuple[int, int, int]]:
        return counts([one.at(round(now * MS)) for one in rows])

    assert at(0) == at(14.9) == dict.fromkeys(("own.Control", "own.toil", "own.rest"), (0, 0, 0))
    assert at(15) == at(24.9) == {
        "own.Control": (0, 2, 2), "own.toil": (1, 1, 2), "own.rest": (0, 0, 1),
    }  # fmt: skip
    assert at(25)["own.rest"] == (1, 0, 2)
    early, late = rows[2].at(15 * MS), rows[2].at(25 * MS)
    assert (early.longest, late.longest, late.longest_at_most) == (None, 9 * MS, None)
    assert early.width == late.width
    assert rows[1].at(15 * MS).longest_at_most == 2 * MS


def test_the_last_instant_of_a_replay_shows_the_whole_run() -> None:
    told, _ = random_run(7, 0)
    seen = read_trace(told, desk_map())
    rows = [one.at(seen.end) for one in histories(desk(), seen)]
    assert rows == row_histograms(desk(), seen)


def test_a_run_that_starts_leaves_the_link_to_a_trace_that_was_not_written_for_long(
    tmp_path: Path,
) -> None:
    trace = tmp_path / "trace.txt"
    trace.write_text("E 7\n")
    os.utime(trace, (0, 0))
    mine = new_file(tmp_path / "main", MARK)
    assert mine is not None
    link_trace(mine, trace)
    assert new_file(tmp_path / "main", MARK) is not None
    assert trace_beside(mine).is_symlink()
