# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Responses of the robot with the tab Live open, without it, and without snapshots.

The parts are equally long. Three of them are those of one run, in which the tab is open in the
middle. A controller writes snapshots for as long as it runs, or never, so the part without is of
a run of its own. The last row of each periodic processor records a value in each release. So the
trace has the response of each release, with snapshots and without.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ravenchart.analysis.present.report import Comparison
from ravenchart.analysis.system.observed import Observation
from ravenchart.running.result import RunOutcome
from tests.support import live
from tests.support.viewed_runs import HOMED_TIME, MARGIN, SPARE, ViewedRun, WorkingRobot

LAST_VALUES = {
    "trajectory": "joint_z.profile.phase",
    "control": "joint_z.measured.position",
    "supervision": "coordinator.status.condition",
}
"""What the last row of each processor records; `reception` has no time when it is due."""

PERIODS = {"trajectory": 5_000_000, "control": 10_000_000, "supervision": 20_000_000}
"""In ns."""


class NoPartError(Exception):
    """A run has no such part; the text says why."""


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a run; ``responses`` has those of the releases that were due in it, in ns.

    A response ends with the value that the last row records.
    """

    name: str
    outcome: RunOutcome
    responses: Mapping[str, Sequence[int]]

    @property
    def compared(self) -> Iterator[Comparison]:
        """The longest response of the part beside the bound; of `reception` that of the run."""
        for row in self.outcome.compared:
            yield replace(row, observed=max(self.responses.get(row.task, (row.observed,))))

    @property
    def exceeded(self) -> list[str]:
        """The processors that were above their bounds by more than the host withheld the core."""
        return [
            f"{self.name}: {row.task} took {row.observed} ns, its bound is {row.bound} ns"
            for row in self.compared
            if row.exceeded and not row.explained
        ]


def part_of(name: str, outcome: RunOutcome, begin: int, end: int) -> Part:
    """The part of a run between two times of the controller, in ns; NoPartError."""
    seen = outcome.observation
    if outcome.failures or seen is None:
        raise NoPartError(f"{name}: the run has failed: {'; '.join(outcome.failures)}")
    if not 0 <= begin < end <= seen.end:
        raise NoPartError(f"{name}: no part of a run of {seen.end} ns is from {begin} to {end} ns")
    found = {
        processor: [response for due, response in responses(seen, processor) if begin <= due < end]
        for processor in LAST_VALUES
    }
    return Part(name, outcome, found)


def responses(seen: Observation, processor: str) -> Iterator[tuple[int, int]]:
    """When each release was due, and its response, in ns; no release is left out by a processor."""
    recorded = (one.time for one in seen.values if one.element.name == LAST_VALUES[processor])
    for number, end in enumerate(recorded):
        due = number * PERIODS[processor]
        yield due, end - due


def parts(folder: Path, seconds: float) -> tuple[ViewedRun, tuple[Part, ...]]:
    """The run whose middle part of about that length is viewed, and all four parts.

    NoPartError where a run failed.
    """
    robot = WorkingRobot(folder, *LAST_VALUES.values())
    runs: list[ViewedRun] = []

    def viewed() -> RunOutcome:
        runs.append(robot.viewed_between(seconds))
        return runs[-1].outcome

    whole = live.played(viewed)
    begin, end = runs[-1].times
    length = end - begin
    enough = HOMED_TIME + SPARE * seconds + MARGIN
    bare = live.played(lambda: robot.played(enough, watched=False))
    homed = round(1e9 * HOMED_TIME)
    return runs[-1], (
        part_of("no snapshots", bare, homed, homed + length),
        part_of("closed before", whole, begin - length, begin),
        part_of("page open", whole, begin, end),
        part_of("closed after", whole, end, end + length),
    )


def table(found: Sequence[Part]) -> Iterator[str]:
    """Responses of each processor in each part in us, beside the bound."""
    yield f"{'processor':<12}{'bound':>6}  {'part':<14}{'median':>8}{'99 %':>8}{'longest':>8}"
    rows = (row for row in found[0].outcome.compared if row.task in PERIODS)
    for row in sorted(rows, key=lambda row: row.bound or 0):
        head = f"{row.task:<12}{us(row.bound or 0):>6}"
        for one in found:
            taken = one.responses[row.task]
            told = (statistics.median(taken), statistics.quantiles(taken, n=100)[-1], max(taken))
            yield f"{head:<18}  {one.name:<14}" + "".join(f"{us(each):>8}" for each in told)
            head = ""


def difference(found: Sequence[Part]) -> str:
    """The median with the page open less that of the same run with the page closed."""
    _, before, opened, after = found
    parts = []
    for processor in LAST_VALUES:
        closed = [*before.responses[processor], *after.responses[processor]]
        more = statistics.median(opened.responses[processor]) - statistics.median(closed)
        parts.append(f"{processor} {more / 1000:+.0f} us")
    return ", ".join(parts)


def us(time: float) -> str:
    """A time in us."""
    return f"{time / 1000:.0f}"


def told(viewed: ViewedRun, found: Sequence[Part]) -> Iterator[str]:
    """The table, the difference, what the page looked at, and how far the host gave the core."""
    yield from table(found)
    yield f"median with the page open less closed: {difference(found)}"
    yield f"page open: {viewed}"
    for name, one in (("no snapshots", found[0]), ("the other parts", found[1])):
        yield f"{name}: {one.outcome.not_judged or 'the host gave the core all the time'}"
