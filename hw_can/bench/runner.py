# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Runs a scenario against a controller, with a result for each step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ravenchart import rounded

from .axis import UM
from .drives import AxisTrack, Bench, press
from .peer import BenchError, FrameValues, Peer, Value
from .plant_stations import PlantStation, PlantTrack, plant_of
from .plants import PlantFaultError
from .replay import from_outside, log_for
from .scenario import Scenario
from .steps import (
    Expect,
    ExpectOutput,
    ExpectStop,
    KillBench,
    Pull,
    Release,
    Replay,
    ScenarioStep,
    SendStep,
    SetInput,
    StopFeedback,
    Wait,
    WaitFor,
)

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class StepResult:
    """The result of one step; times in s from the bench's start."""

    text: str
    line: int
    passed: bool
    outcome: str
    began: float
    ended: float


@dataclass(frozen=True, slots=True)
class Sending:
    """A message that a step sent."""

    at: float
    message: str
    values: Mapping[str, Value]


@dataclass(frozen=True, slots=True)
class ScenarioResult:
    """The observations of the bench, up to and with the first step that failed.

    ``tracks`` by drive, ``plants`` by plant; ``zeros`` are the true positions in um where
    the axes left their low switches; ``started`` is a time of `time.monotonic`.
    """

    title: str
    started: float
    steps: tuple[StepResult, ...]
    not_run: int
    tracks: Mapping[str, AxisTrack]
    zeros: Mapping[str, float | None]
    plants: Mapping[str, PlantTrack]
    sendings: tuple[Sending, ...]
    sent: Mapping[str, int]
    received: Mapping[str, int]
    unknown_frames: int
    skipped_ticks: int

    @property
    def passed(self) -> bool:
        """Whether every step was run and passed."""
        return self.not_run == 0 and all(step.passed for step in self.steps)


class _OutOfTimeError(Exception):
    """The time allowed for the whole scenario is over."""


def run_scenario(
    scenario: Scenario,
    peer: Peer,
    *,
    limit: float | None = None,
    progress: Progress = lambda text: None,
    ended: Callable[[], bool] = lambda: True,
) -> ScenarioResult:
    """Run ``scenario`` over ``peer``, for at most ``limit`` seconds, and close the peer.

    ``progress`` gets each step before it is run. After the last step the drives
    go on until ``ended`` returns true: it is called after every tick, and may end the
    controller. Raises BenchError only when a message does not fit the DBC.
    """
    stations: list[PlantStation] = []
    try:
        for step in scenario.steps:
            _check(step, peer)
        for name, form in scenario.plants.items():
            stations.append(PlantStation(name, form, plant_of(form, scenario.folder)))
        bench = Bench(peer, scenario.drives, peer.clock, peer.sleep, plants=stations)
        runner = _Runner(bench, limit, scenario)
        results: list[StepResult] = []
        for step, line in zip(scenario.steps, scenario.lines, strict=True):
            progress(str(step))
            began = bench.now
            try:
                passed, outcome = runner.do(step)
            except BenchError as fault:
                passed, outcome = False, str(fault)
            except _OutOfTimeError:
                passed, outcome = False, f"the run's {limit:g} s were over"
            results.append(StepResult(str(step), line, passed, outcome, began, bench.now))
            if not passed:
                break
        try:
            while not ended():
                bench.tick()
        except PlantFaultError as fault:
            line, now = scenario.lines[-1], bench.now
            results.append(StepResult("after the last step", line, False, str(fault), now, now))
        except BenchError:  # the controller left the bus, which it may
            pass
    finally:
        peer.close()
        for one in stations:
            one.close()
    return ScenarioResult(
        title=scenario.title,
        started=bench.start,
        steps=tuple(results),
        not_run=len(scenario.steps) - len(results),
        tracks={name: s.track for name, s in bench.stations.items()},
        zeros={name: None if s.zero is None else s.zero * UM for name, s in bench.stations.items()},
        plants={one.name: one.track for one in stations},
        sendings=tuple(runner.sendings),
        sent=dict(peer.sent),
        received=dict(peer.received),
        unknown_frames=peer.unknown,
        skipped_ticks=bench.skipped,
    )


def _check(step: ScenarioStep, peer: Peer) -> None:
    """BenchError when a step's message does not fit the DBC."""
    match step:
        case SendStep():
            peer.codec.check(step.send, step.fields, step.wrong)
        case WaitFor():
            message, field = step.wait_for.split(".")
            if field not in peer.codec.fields(message):
                raise BenchError(f"{message} has no field {field}")


class _Runner:
    """Carries out the steps of one scenario on one bench."""

    def __init__(self, bench: Bench, limit: float | None, scenario: Scenario) -> None:
        self.sendings: list[Sending] = []
        self._bench = bench
        self._limit = limit
        self._scenario = scenario

    def do(self, step: ScenarioStep) -> tuple[bool, str]:
        """Carry out a step: whether it passed, and its outcome."""
        match step:
            case SendStep():
                return self._send(step)
            case Replay():
                return self._replay(step)
            case WaitFor():
                return self._wait_for(step)
            case Expect():
                return self._until(lambda: self._in_place(step), step.within)
            case ExpectStop():
                return self._stop(step)
            case SetInput():
                self._bench.plants[step.plant].set(step.name, step.to)
                return True, "done"
            case ExpectOutput():
                return self._until(lambda: self._has_come(step), step.within)
            case Wait():
                self._pass(step.wait)
                return True, "done"
            case Pull():
                press(self._bench.stations[step.pull], step.switch)
                return True, "done"
            case Release():
                press(self._bench.stations[step.release], "none")
                return True, "done"
            case StopFeedback():
                self._bench.silence(step.stop_feedback)
                return True, "done"
            case KillBench():
                self._bench.peer.drop()
                return True, "done"

    def _send(self, step: SendStep) -> tuple[bool, str]:
        if not self._bench.peer.is_open:
            return False, "the bench has left the bus"
        began = self._bench.now
        self._bench.peer.send(step.send, step.fields, step.wrong)
        if step.wrong is None:  # what is faulty arrives at no port
            self.sendings.append(Sending(began, step.send, dict(step.fields)))
            self._bench.order(step.send, step.fields)
        return True, "lost" if step.wrong == "loss" else "sent"

    def _replay(self, step: Replay) -> tuple[bool, str]:
        """Send all frames of the log that come from outside, each at its time."""
        bench = self._bench
        log = log_for(self._scenario.file_of(step), bench.peer.codec)
        simulated = self._scenario.simulated()
        frames, began = from_outside(log, bench.peer.codec, simulated), bench.now
        bench.replayed.extend((began + at, frame) for at, frame in frames)
        while bench.replayed:
            if not bench.peer.is_open:
                return False, "the bench has left the bus"
            self._tick()
        return True, f"{len(frames)} of {len(log)} frames sent"

    def _wait_for(self, step: WaitFor) -> tuple[bool, str]:
        """Wait for a value; only messages that arrive from now on count."""
        message, field = step.wait_for.split(".")
        found: list[Value] = []

        def look(name: str, values: FrameValues) -> None:
            if name == message:
                found.append(values[field])

        began = self._bench.now
        self._bench.on_message = look
        try:
            while step.value not in found:
                if self._bench.now - began > step.within:
                    last = f"last {found[-1]}" if found else f"no {message} arrived"
                    return False, f"not within {step.within:g} s: {last}"
                self._tick()
        finally:
            self._bench.on_message = lambda name, values: None
        return True, f"after {_took(self._bench.now - began)} of {step.within:g} s"

    def _in_place(self, step: Expect) -> tuple[bool, str]:
        passed, found = True, []
        for name, wanted in step.expect.items():
            station = self._bench.stations[name]
            if station.zero is None:
                return False, f"{name} never left its low switch: it has no zero"
            error = station.drive.position - station.zero - wanted
            passed &= abs(error) <= step.tolerance
            found.append(f"{name} {error * UM:+.0f}")
        return passed, f"{', '.join(found)} um off, {step.tolerance * UM:g} allowed"

    def _has_come(self, step: ExpectOutput) -> tuple[bool, str]:
        value = self._bench.plants[step.plant].value(step.name)
        shown = f"{value:g}" if isinstance(value, float) else f"{value}"
        return step.accepts(value), f"{step.expect_output} is {shown}"

    def _stop(self, step: ExpectStop) -> tuple[bool, str]:
        """Pass when the axis was slow at the last tick; the outcome has the time since when."""
        drive = self._bench.stations[step.expect_stop].drive
        began, slow_since = self._bench.now, None
        while self._bench.now - began < step.within:
            self._tick()
            if abs(drive.speed) >= step.below:
                slow_since = None
            elif slow_since is None:
                slow_since = self._bench.now
        if slow_since is None:
            return False, f"still {drive.speed * 1e3:.1f} mm/s after {step.within:g} s"
        return True, f"after {_took(slow_since - began)}"

    def _until(self, look: Callable[[], tuple[bool, str]], within: float) -> tuple[bool, str]:
        began = self._bench.now
        while True:
            passed, outcome = look()
            if passed or self._bench.now - began >= within:
                return passed, outcome
            self._tick()

    def _pass(self, seconds: float) -> None:
        began = self._bench.now
        while self._bench.now - began < seconds:
            self._tick()

    def _tick(self) -> None:
        if self._limit is not None and self._bench.now > self._limit:
            raise _OutOfTimeError
        self._bench.tick()


def _took(seconds: float) -> str:
    """A measured time, with its unit."""
    return rounded.up(rounded.of_seconds(seconds))
