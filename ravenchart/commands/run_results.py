# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The answers of `run`, `shell` and `monitor` with `--json`."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.described import Described, Result
from ravenchart.running.bus_watch import WatchedBus
from ravenchart.running.monitored import WatchedNode


@dataclass(slots=True)
class PlayedStep(Described):
    """A step of the scenario."""

    at: float
    """When, in s from the start."""
    text: str
    """The step in words."""
    passed: bool
    """Whether it passed."""
    outcome: str
    """How it ended."""


@dataclass(slots=True)
class Observed(Described):
    """The longest response of a processor, or reaction of a chain, in the run."""

    name: str
    """Of the processor or chain."""
    count: int
    """How many releases or reactions there were."""
    observed: int
    """The longest, in ns."""
    bound: int | None
    """Its bound in ns; null where there is none."""


@dataclass(slots=True)
class RunResult(Result):
    """A run of the controller, judged."""

    title: str
    """The title of the scenario, or the length of a run without one."""
    passed: bool
    """Whether nothing failed."""
    verdict: str
    """The last line of the summary."""
    not_judged: str | None
    """Why the timing was not judged, where it was not."""
    failures: list[str]
    """The reasons; empty exactly when the run passed."""
    notes: list[str]
    """Remarks that are no failures."""
    steps: list[PlayedStep]
    """Of the scenario."""
    processors: list[Observed]
    """Longest responses."""
    chains: list[Observed]
    """Longest reactions."""
    report: str
    """The report as HTML."""


@dataclass(slots=True)
class ShellResult(Result):
    """The outcome of a script of the shell."""

    commands: list[PlayedStep]
    """Its lines that were carried out, the last one perhaps without success."""
    status: dict[str, dict[str, int | float | str]]
    """The last values of each message that came, by field."""
    charts: dict[str, str | None]
    """The active leaf state of each chart whose controller's snapshots are seen; null where the
    state around its region is not active."""


@dataclass(slots=True)
class MonitorResult(Result):
    """The running controllers at one time: with `--once` the answer, else a line each."""

    system: str
    """The name of the system."""
    nodes: list[WatchedNode]
    """The controllers that are watched."""
    buses: list[WatchedBus]
    """The bus that is watched, with `--interface`; else none."""
