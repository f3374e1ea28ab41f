# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The Cartesian robot at work, with the tab Live of the workbench open in Chromium, or without."""

from __future__ import annotations

import shutil
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from statistics import median
from typing import Any

from playwright.sync_api import Page, expect

from ravenchart.building import checking, generation, programs
from ravenchart.paths import ROOT
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import run_controller
from tests.support.browser import BrowserPage, launched
from tests.support.workbench import running

ROBOT = ROOT / "examples" / "cartesian_robot"

RECORDED = """
record:
  - joint_x.drive
  - joint_x.measured
  - coordinator.Mission
"""
"""Added to the model: what the page plots."""

HOMED = """
  - wait: 300 ms
  - {send: robot_command, with: {kind: Home, x: 0, y: 0, z: 0}}
  - {wait_for: robot_status.condition, is: Homing, within: 500 ms}
  - {wait_for: robot_status.condition, is: Ready, within: 5 s}
"""
HOMED_TIME = 2.3
"""Seconds."""

CYCLE = """
  - {send: robot_command, with: {kind: Move, x: 300000, y: 200000, z: 100000}}
  - {wait_for: robot_status.condition, is: Moving, within: 500 ms}
  - {wait_for: robot_status.condition, is: Ready, within: 4 s}
  - {send: robot_command, with: {kind: Move, x: 60000, y: 90000, z: 30000}}
  - {wait_for: robot_status.condition, is: Moving, within: 500 ms}
  - {wait_for: robot_status.condition, is: Ready, within: 4 s}
"""
CYCLE_TIME = 2.9
"""Seconds."""

EXPECTED = """
expect:
  - {lost: robot_bus.lost_out, at_most: 40, because: sent before the bench was on the bus}
"""

NOTES_LOOKS = """() => {
  window.looks = [];
  const plain = window.fetch;
  window.fetch = async (...words) => {
    const answer = await plain(...words);
    if (/^live\\b/.test(words[0])) answer.clone().json().then((found) => {
      for (const node of found.nodes) window.looks.push({
        now: node.now, sequence: node.sequence, listed: node.events.length, unlisted: node.unlisted,
        counts: Object.fromEntries(node.values.map((one) => [one.name, one.count])),
      });
    });
    return answer;
  };
}"""
"""Has the page keep what it is told at each look."""

SNAPSHOTS = 10
"""In a second."""

SPARE = 1.1
"""A run of several parts is longer than these by that factor and `MARGIN`, in s."""
MARGIN = 3.0


@dataclass(frozen=True, slots=True)
class ViewedRun:
    """How a run went, and what the page was told meanwhile."""

    outcome: RunOutcome
    looks: Sequence[dict[str, Any]]

    @property
    def times(self) -> tuple[int, int]:
        """When the page looked first and last, in ns of the controller."""
        return (self.looks[0]["now"], self.looks[-1]["now"]) if self.looks else (0, 0)

    @property
    def seconds(self) -> float:
        """For how long the page looked."""
        begin, end = self.times
        return (end - begin) / 1e9

    @property
    def seen(self) -> int:
        """How many snapshots it looked at."""
        return len({one["sequence"] for one in self.looks})

    @property
    def written(self) -> int:
        """How many there were from the first of these to the last."""
        numbers = [one["sequence"] for one in self.looks]
        return max(numbers) - min(numbers) + 1 if numbers else 0

    @property
    def usual(self) -> float:
        """How many it looked at in most seconds, at the least: the median of whole seconds."""
        begin, _ = self.times
        first = {one["sequence"]: one["now"] - begin for one in reversed(self.looks)}
        whole = Counter(int(at / 1e9) for at in first.values() if at / 1e9 < int(self.seconds))
        return median(whole[second] for second in range(int(self.seconds)))

    def __str__(self) -> str:
        each = [after["now"] - before["now"] for before, after in pairwise(self.looks)]
        return (
            f"looked at {self.seen} of {self.written} snapshots in {self.seconds:.1f} s; "
            f"{max(each, default=0) / 1e6:.0f} ms between two at the most"
        )


class WorkingRobot:
    """The robot, built in a folder; it records values."""

    def __init__(self, folder: Path, *more: str) -> None:
        """``more``: elements to record as well."""
        self.model = Path(shutil.copytree(ROBOT, folder / "robot")) / "model.yaml"
        record = RECORDED + "".join(f"  - {one}\n" for one in more)
        self.model.write_text(self.model.read_text("utf-8") + record, "utf-8")
        self.checked = checking.check(self.model)
        generation.write_program(self.checked)
        (program,) = programs.programs_of(self.checked)
        self._executable = program.build()

    def viewed(self, seconds: float) -> ViewedRun:
        """Work for about that long, with the tab Live open from before the start to the end."""
        with self._page() as page:
            page.get_by_role("tab", name="Live").click()
            expect(page.locator("#outcome")).to_contain_text("No controller of")
            outcome = self.played(seconds)
            live = page.get_by_role("region", name="Controller of controller")
            expect(live.locator("h3")).to_contain_text("ended in order")
            looks = page.evaluate("window.looks")
        return ViewedRun(outcome, looks)

    def viewed_between(self, seconds: float) -> ViewedRun:
        """Work for three times that long, with the tab Live open in the middle third alone.

        The page is there all the time, and shows another tab before and after.
        """
        with self._page() as page, ThreadPoolExecutor() as aside:
            run = aside.submit(self.played, HOMED_TIME + 3 * SPARE * seconds + MARGIN)
            time.sleep(MARGIN / 2 + HOMED_TIME + seconds)
            page.get_by_role("tab", name="Live").click()
            time.sleep(seconds)
            page.get_by_role("tab", name="Findings").click()
            outcome = run.result()
            looks = page.evaluate("window.looks")
        return ViewedRun(outcome, looks)

    @contextmanager
    def _page(self) -> Iterator[Page]:
        """The page of the workbench, which notes its looks."""
        with running(self.model) as bench, launched() as browser:
            pane = BrowserPage(browser, bench.address)
            pane.page.evaluate(NOTES_LOOKS)
            yield pane.page
            pane.closed(bench.address)

    def played(self, seconds: float, *, watched: bool = True) -> RunOutcome:
        """Home, then move to and fro for about that long; the trace is in `out`, at the model."""
        cycles = round((seconds - HOMED_TIME) / CYCLE_TIME)
        drives = (ROBOT / "scenario.yaml").read_text("utf-8").partition("\nsteps:")[0]
        scenario = self.model.with_name("long.yaml")
        scenario.write_text(f"{drives}\nsteps:{HOMED}{CYCLE * cycles}{EXPECTED}", "utf-8")
        generated = self.checked.generated
        return run_controller(
            self._executable,
            generated / "trace.json",
            generated / "robot_bus.dbc",
            scenario,
            None,
            self.model.parent / "out",
            analysis=self.checked.analysis,
            watched=watched,
        )
