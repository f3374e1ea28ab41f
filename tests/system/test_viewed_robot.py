# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The robot works while a browser shows it live: what it costs, and what is lost."""

from __future__ import annotations

from pathlib import Path

import pytest

from ravenchart.running.result import RunOutcome
from tests.support import live
from tests.support.browser import IN_BROWSER
from tests.support.viewed_parts import LAST_VALUES, PERIODS, parts, told
from tests.support.viewed_runs import SNAPSHOTS, SPARE, ViewedRun, WorkingRobot

pytestmark = [*IN_BROWSER, pytest.mark.alone]

VIEWED = 60.0
PART = 10.0
"""Seconds."""

ENOUGH = 0.9
"""Of ten snapshots in a second the page looks at nine at least."""


def is_enough(run: ViewedRun) -> bool:
    """Has the page shown the robot ten times a second?"""
    return run.seen >= ENOUGH * SNAPSHOTS * run.seconds > 0


def above(outcome: RunOutcome) -> list[str]:
    """The processors above their bounds by more than the host withheld the core."""
    return [one.task for one in outcome.compared if one.exceeded and not one.explained]


def test_a_minute_of_live_view_breaks_no_bound_and_counts_all_that_it_does_not_show(
    tmp_path: Path,
) -> None:
    robot = WorkingRobot(tmp_path)
    runs: list[ViewedRun] = []

    def viewed() -> RunOutcome:
        runs.append(robot.viewed(SPARE * VIEWED))
        print(runs[-1])
        return runs[-1].outcome

    outcome = live.played(viewed, lambda: is_enough(runs[-1]))
    run, seen = runs[-1], outcome.observation
    assert outcome.failures == () and seen is not None
    assert run.seconds >= VIEWED

    # The trace has all of it: a record that was lost is a failure of the run.
    listed = sum(one["listed"] + one["unlisted"] for one in run.looks)
    happened = [one for one in seen.records if one.kind in ("transition", "fault")]
    assert listed == len(happened) > 100
    counts = run.looks[-1]["counts"]
    assert len(counts) == 5
    assert sum(counts.values()) == len(seen.values) > 10_000

    left = []
    if outcome.ended.real_time:
        assert above(outcome) == []
    else:
        left.append(f"bounds: {outcome.not_judged}")
    assert run.usual >= ENOUGH * SNAPSHOTS, str(run)  # the host withholds less than most seconds
    if outcome.not_judged and not is_enough(run):
        left.append(f"10 Hz: the page {run}; {outcome.not_judged}")
    else:
        assert is_enough(run), str(run)
    if left:
        pytest.skip(f"all but this was judged: {'; '.join(left)}")


def test_no_part_of_a_run_is_above_its_bounds_with_the_page_open_or_closed_or_without_snapshots(
    tmp_path: Path,
) -> None:
    viewed, found = parts(tmp_path, PART)
    print(*told(viewed, found), sep="\n")
    begin, end = viewed.times
    for one in found:
        for processor in LAST_VALUES:
            due = (end - begin) / PERIODS[processor]
            assert due - 1 < len(one.responses[processor]) < due + 1
    last = (tmp_path / "robot" / "out" / "trace.txt").read_text("ascii")
    assert last.count("\nN ") == 1  # its counts came once, at its end: there was no snapshot
    if not all(one.outcome.ended.real_time for one in found):
        pytest.skip("all but this was judged: bounds: the controller had no real-time priorities")
    assert [text for one in found for text in one.exceeded] == []
    assert [name for one in found for name in above(one.outcome)] == []
