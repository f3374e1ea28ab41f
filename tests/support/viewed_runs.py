# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The Cartesian robot at work, with the tab Live of the workbench open in Chromium, or without."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from playwright.sync_api import expect

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
        sequence: node.sequence, listed: node.events.length, unlisted: node.unlisted,
        counts: Object.fromEntries(node.values.map((one) => [one.name, one.count])),
      });
    });
    return answer;
  };
}"""
"""Has the page keep what it is told at each look."""


@dataclass(frozen=True, slots=True)
class ViewedRun:
    """How a run went, and what the page was told meanwhile: nothing where there was none."""

    outcome: RunOutcome
    looks: Sequence[dict[str, Any]] = field(default_factory=tuple)

    def seconds(self) -> float:
        """For how long the controller ran."""
        seen = self.outcome.observation
        return 0.0 if seen is None or seen.now is None else seen.now / 1e9


def side_by_side(viewed: ViewedRun, other: ViewedRun) -> Iterator[str]:
    """The longest responses with the page and without, in us, beside the bound."""
    yield f"{'processor':<14}{'with':>12}{'without':>12}{'bound':>12}"
    without = {one.task: one for one in other.outcome.compared}
    for one in sorted(viewed.outcome.compared, key=lambda row: row.bound or 0):
        told = (one.observed, without[one.task].observed, one.bound or 0)
        yield f"{one.task:<14}" + "".join(f"{ns / 1e3:>12.1f}" for ns in told)
    for name, run in (("with", viewed), ("without", other)):
        why = run.outcome.not_judged or "the core was the controller's"
        yield f"{name}: {run.seconds():.0f} s; {why}"
    numbers = {one["sequence"] for one in viewed.looks}
    yield f"{len(viewed.looks)} looks at {len(numbers)} of {max(numbers, default=0)} snapshots"


class WorkingRobot:
    """The robot, built in a folder; it records values."""

    def __init__(self, folder: Path) -> None:
        self.model = Path(shutil.copytree(ROBOT, folder / "robot")) / "model.yaml"
        self.model.write_text(self.model.read_text("utf-8") + RECORDED, "utf-8")
        self._checked = checking.check(self.model)
        generation.write_program(self._checked)
        (program,) = programs.programs_of(self._checked)
        self._executable = program.build()

    def works(self, seconds: float, *, view: bool) -> ViewedRun:
        """Work for about that long."""
        if not view:
            return ViewedRun(self.played(seconds))
        with running(self.model) as bench, launched() as browser:
            pane = BrowserPage(browser, bench.address)
            pane.page.evaluate(NOTES_LOOKS)
            pane.page.get_by_role("tab", name="Live").click()
            expect(pane.page.locator("#outcome")).to_contain_text("No controller of")
            outcome = self.played(seconds)
            live = pane.page.get_by_role("region", name="Controller of controller")
            expect(live.locator("h3")).to_contain_text("ended in order")
            looks = pane.page.evaluate("window.looks")
            pane.closed(bench.address)
        return ViewedRun(outcome, looks)

    def played(self, seconds: float) -> RunOutcome:
        """Home, then move to and fro for about that long; the trace is in `out`, at the model."""
        cycles = round((seconds - HOMED_TIME) / CYCLE_TIME)
        drives = (ROBOT / "scenario.yaml").read_text("utf-8").partition("\nsteps:")[0]
        scenario = self.model.with_name("long.yaml")
        scenario.write_text(f"{drives}\nsteps:{HOMED}{CYCLE * cycles}{EXPECTED}", "utf-8")
        generated = self._checked.generated
        return run_controller(
            self._executable,
            generated / "trace.json",
            generated / "robot_bus.dbc",
            scenario,
            None,
            self.model.parent / "out",
            analysis=self._checked.analysis,
        )
