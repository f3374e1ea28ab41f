# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The robot works for a minute while a browser shows it live: what it costs, and what is lost."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support import live
from tests.support.browser import IN_BROWSER
from tests.support.viewed_runs import ViewedRun, WorkingRobot, side_by_side

pytestmark = [*IN_BROWSER, pytest.mark.alone]

VIEWED = 60.0
UNVIEWED = 8.0
"""Seconds."""


def test_a_minute_of_live_view_breaks_no_bound_and_counts_all_that_it_does_not_show(
    tmp_path: Path,
) -> None:
    robot = WorkingRobot(tmp_path)
    runs: list[ViewedRun] = []

    def viewed() -> ViewedRun:
        runs.append(robot.works(VIEWED, view=True))
        return runs[-1]

    live.played(lambda: viewed().outcome)
    run, other = runs[-1], robot.works(UNVIEWED, view=False)
    print(*side_by_side(run, other), sep="\n")
    seen = run.outcome.observation
    assert run.outcome.failures == () and seen is not None
    assert run.seconds() > 0.9 * VIEWED
    if run.outcome.ended.real_time:
        assert not [one for one in run.outcome.compared if one.exceeded and not one.explained]

    # The trace has all of it: a record that was lost is a failure of the run.
    numbers = {one["sequence"] for one in run.looks}
    assert len(numbers) > 5 * VIEWED  # ten a second are made
    listed = sum(one["listed"] + one["unlisted"] for one in run.looks)
    happened = [one for one in seen.records if one.kind in ("transition", "fault")]
    assert listed == len(happened) > 100
    counts = run.looks[-1]["counts"]
    assert len(counts) == 5
    assert sum(counts.values()) == len(seen.values) > 10_000
