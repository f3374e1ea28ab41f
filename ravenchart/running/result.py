# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The outcome of one run, and the rows and pictures that are made of it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from ravenchart import rounded
from ravenchart.analysis.present.report import Comparison, Execution, FrameRow, StepRow
from ravenchart.analysis.system.journeys import Journey
from ravenchart.analysis.system.observed import Observation
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.runner import ScenarioResult
from ravenchart.hw_can.bench.scenario import Scenario

from .expected import DEADLINE_MISS
from .plots import OperatorMark, Stay
from .process import ERROR, Ended


@dataclass(frozen=True, slots=True)
class RunOutcome:
    """The outcome of one run; ``failures`` is empty exactly when it passed.

    ``observation`` is None when there is no readable trace, ``scenario_result``
    when no scenario was asked for or it could not begin. ``clock_offset`` turns a
    time of the bench into one of the trace, in s; None when nothing links them.
    """

    title: str
    scenario: Scenario | None
    scenario_result: ScenarioResult | None
    observation: Observation | None
    ended: Ended
    steps: tuple[StepRow, ...]
    compared: tuple[Comparison, ...]
    journeys: tuple[Journey, ...]
    failures: tuple[str, ...]
    notes: tuple[str, ...]
    clock_offset: float | None
    not_judged: str | None = None
    """Why the timing was not judged, where it was not."""
    unseen: tuple[str, ...] = ()
    """Other parts that were not judged, for the same reason."""

    @property
    def passed(self) -> bool:
        """Nothing failed."""
        return not self.failures

    @property
    def verdict(self) -> str:
        """The last line of the summary."""
        if not self.passed:
            return f"verdict: FAIL: {self.failures[0]}"
        return f"verdict: PASS ({self.gaps})" if self.gaps else "verdict: PASS"

    @property
    def gaps(self) -> str:
        """The parts that were not judged, and why; empty where all were."""
        what = ", ".join(("timing", *self.unseen))
        return f"{what} not judged: {self.not_judged}" if self.not_judged else ""


def notes(
    ended: Ended,
    result: ScenarioResult | None,
    seen: Observation | None,
    executed: Sequence[Execution],
    compared: Sequence[Comparison],
) -> Iterator[str]:
    """Remarks for the reader that are no failures."""
    for row in executed:
        if row.exceeded:
            longest, wcet = rounded.beside(row.observed, row.wcet)
            yield f"{row.row} ran for {longest}, above its WCET of {wcet}"
    for task in compared:
        if task.word == "host" and ended.real_time:
            yield (
                f"{task.task} took {rounded.up(task.observed)}, above its bound: the host "
                f"withheld the core for up to {rounded.up(task.withheld)}"
            )
    reasons = {f"{ERROR}{reason}" for reason in ended.reasons}
    said = (line for line in ended.warnings if line not in reasons)
    yield from (f"the controller says: {line}" for line in said)
    if result is not None and result.skipped_ticks:
        yield f"the host held the bench up: {result.skipped_ticks} feedback cycles were skipped"
    if result is not None and result.unknown_frames:
        yield f"{result.unknown_frames} frames had an identifier that the DBC does not know"
    if seen is not None:
        missed = sum(n for what, n in seen.faults.items() if what.upper() == DEADLINE_MISS)
        if missed:
            yield f"deadlines missed: {missed}"


def clock_offset(
    result: ScenarioResult | None, seen: Observation | None, system: System
) -> float | None:
    """From the bench's clock to the trace's: by the quickest arrival of a sent message."""
    if result is None or seen is None:
        return None
    offsets: list[float] = []
    for message in system.messages:
        times = [s.at for s in result.sendings if s.message.lower() == message.name.lower()]
        for target in message.targets:
            arrivals = seen.of("arrived", str(target))
            offsets += [a.time / 1e9 - t for a, t in zip(arrivals, times, strict=False)]
    return min(offsets, default=None)


def spans(result: RunOutcome) -> Mapping[str, tuple[Stay, ...]]:
    """The states of each axis, on the bench's clock."""
    seen, offset = result.observation, result.clock_offset
    if seen is None or offset is None or result.scenario is None:
        return {}
    return {
        name: tuple(
            Stay(v.state, v.start / 1e9 - offset, (v.end or seen.end) / 1e9 - offset)
            for v in seen.visits(form.states)
        )
        for name, form in result.scenario.drives.items()
        if form.states is not None
    }


def marks(result: ScenarioResult) -> tuple[OperatorMark, ...]:
    """The operator's actions, as marks in the picture."""
    found = [
        OperatorMark(s.at, next((v for v in s.values.values() if isinstance(v, str)), s.message))
        for s in result.sendings
    ]
    found += [
        OperatorMark(s.began, s.text.replace("the ", "").replace(" limit switch of", ""))
        for s in result.steps
        if s.text.startswith(("pull", "kill", "stop"))
    ]
    return tuple(sorted(found, key=lambda mark: mark.at))


def frames(result: RunOutcome) -> Iterator[FrameRow]:
    """The frames that the bench counted, both ways."""
    if result.scenario_result is not None:
        for message, count in sorted(result.scenario_result.sent.items()):
            yield FrameRow(message, "to controller", count)
        for message, count in sorted(result.scenario_result.received.items()):
            yield FrameRow(message, "from controller", count)


def positions(result: RunOutcome) -> Iterator[str]:
    """Where each axis stood at the end, from its zero."""
    if result.scenario_result is None:
        return
    for name, track in result.scenario_result.tracks.items():
        zero = result.scenario_result.zeros[name]
        if not track.position:
            continue
        last = track.position[-1]
        place = "never homed" if zero is None else f"{(last - zero) / 1e3:.3f} mm from its zero"
        speed = f"{round(track.speed[-1] / 1e3, 1) + 0.0:.1f} mm/s"
        yield f"{name}: {last / 1e3:.3f} mm from the low stop, {place}, {speed}"
