# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The drives on the bench: one loop that receives, moves the axes and reports.

The loop runs on an absolute grid of PERIOD, so it does not drift. When the host
delayed the loop, it skips the missed ticks instead of sending them all at once.
"""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

from .axis import STEP, UM, Drive, DriveMode, Push
from .forms import DriveForm
from .peer import BenchError, FrameValues, Peer
from .plant_stations import PlantStation
from .quantities import PERIOD
from .replay import Timed

FEEDBACK_FIELDS = ("count", "speed", "limit", "condition")
SET_POINT_FIELDS = ("mode", "speed")


@dataclass(slots=True)
class AxisTrack:
    """The motion of one axis, one entry a tick: um, um/s, times in s from the bench's start."""

    time: list[float] = field(default_factory=list)
    position: list[float] = field(default_factory=list)
    speed: list[float] = field(default_factory=list)
    encoder: list[int] = field(default_factory=list)
    set_speed: list[float] = field(default_factory=list)
    target: list[float | None] = field(default_factory=list)
    """Position ordered last, as a true position; None before the first or before homing."""


@dataclass(slots=True)
class Station:
    """One drive with its messages, its track and its orders."""

    form: DriveForm
    drive: Drive
    track: AxisTrack = field(default_factory=AxisTrack)
    zero: float | None = None
    """True position in m where the axis last left its low switch."""
    ordered: float | None = None
    """Position ordered last, in m from zero."""
    silent: bool = False


class Bench:
    """All drives and plants of a scenario on one peer."""

    def __init__(
        self,
        peer: Peer,
        forms: Mapping[str, DriveForm],
        clock: Callable[[], float] = time.monotonic,
        sleep: Callable[[float], None] = time.sleep,
        *,
        plants: Sequence[PlantStation] = (),
        tracks: bool = True,
    ) -> None:
        """Power on: every axis at its start. BenchError when a message does not fit.

        ``plants`` are at time 0; the caller closes them.

        Without ``tracks`` no motion is kept, so the bench may go on for days.
        """
        for form in forms.values():
            _check_fields(peer, form.feedback, FEEDBACK_FIELDS)
            _check_fields(peer, form.set_point, SET_POINT_FIELDS)
        self.peer = peer
        self.stations = {name: Station(form, Drive(form.axis())) for name, form in forms.items()}
        self.plants = {one.name: one for one in plants}
        self.replayed: deque[Timed] = deque()
        """Frames of a log that are still to be sent, with their times from power-on in s."""
        self.latest: dict[str, FrameValues] = {}
        """The last values of each message received."""
        self.skipped = 0
        """Ticks that were missed because the host delayed the bench."""
        self.on_message: Callable[[str, FrameValues], None] = lambda name, values: None
        """Called for each message received."""
        self.start = clock()
        self._clock = clock
        self._sleep = sleep
        self._tracks = tracks
        self._tick = 0
        self._steps = 0

    @property
    def now(self) -> float:
        """Time since power-on in s."""
        return self._clock() - self.start

    def tick(self) -> None:
        """Go on to the next point of the grid: receive, move, report, record."""
        due = self._tick + 1
        late = math.floor(self.now / PERIOD)
        if late > due:
            self.skipped += late - due
            due = late
        self._tick = due
        deadline = self.start + due * PERIOD
        while self.peer.is_open and self.replayed and self.replayed[0][0] <= due * PERIOD:
            at, frame = self.replayed.popleft()
            self.peer.receive_until(self.start + at, self._take)
            self.peer.forward(frame)
        if self.peer.is_open:
            self.peer.receive_until(deadline, self._take)
        self._sleep(max(0.0, deadline - self._clock()))
        self._advance(due * PERIOD)
        if self.peer.is_open:
            for station in self.stations.values():
                if not station.silent:
                    self.peer.send(station.form.feedback, _feedback(station.drive))
            for plant in self.plants.values():
                plant.send(self.peer, due * PERIOD, PERIOD)
        for station in self.stations.values() if self._tracks else ():
            _record(station, due * PERIOD)
        for plant in self.plants.values() if self._tracks else ():
            plant.record(due * PERIOD)

    def silence(self, name: str) -> None:
        """Let a drive or plant, or every one (``all``), send no more."""
        for drive, station in self.stations.items():
            station.silent |= name in ("all", drive)
        for plant in self.plants.values():
            plant.silent |= name in ("all", plant.name)

    def order(self, message: str, values: Mapping[str, object]) -> None:
        """Remember the positions that a sent message orders."""
        for station in self.stations.values():
            if station.form.target is None:
                continue
            name, wanted = station.form.target.split(".")
            position = values.get(wanted)
            if name == message and isinstance(position, int):
                station.ordered = position / UM

    def _take(self, name: str, values: FrameValues) -> None:
        """Take a message: the axes move up to now, then the set point counts."""
        self._advance(self.now)
        self.latest[name] = values
        for station in self.stations.values():
            if station.form.set_point == name:
                station.drive.command(*_set_point(name, values))
        for plant in self.plants.values():
            plant.take(name, values)
        self.on_message(name, values)

    def _advance(self, until: float) -> None:
        """Go on to that time: axes in whole steps."""
        steps = math.floor(until / STEP)
        for _ in range(steps - self._steps):
            for station in self.stations.values():
                drive = station.drive
                pressed = drive.on_low_switch
                drive.step()
                if pressed and not drive.on_low_switch:
                    station.zero = drive.position
        self._steps = max(self._steps, steps)
        for plant in self.plants.values():
            plant.advance(until)


def press(station: Station, switch: str) -> None:
    """Press the ``low`` or ``high`` switch by hand, or none of them (``none``)."""
    station.drive.push = Push(switch)


def _set_point(name: str, values: FrameValues) -> tuple[DriveMode, float]:
    """Mode and speed in m/s; BenchError when a drive does not know the mode."""
    try:
        return DriveMode(values["mode"]), int(values["speed"]) / UM
    except ValueError as fault:
        raise BenchError(f"{name}: {fault}") from None


def _feedback(drive: Drive) -> FrameValues:
    """The feedback of a drive."""
    return {
        "count": drive.count,
        "speed": round(drive.speed_um),
        "limit": drive.limit.value,
        "condition": drive.condition.value,
    }


def _record(station: Station, now: float) -> None:
    """Add an entry to the track."""
    drive, track = station.drive, station.track
    track.time.append(now)
    track.position.append(drive.position_um)
    track.speed.append(drive.speed_um)
    track.encoder.append(drive.count)
    track.set_speed.append(drive.set_speed * UM if drive.mode is DriveMode.ENABLED else 0.0)
    known = station.zero is not None and station.ordered is not None
    track.target.append(((station.zero or 0.0) + (station.ordered or 0.0)) * UM if known else None)


def _check_fields(peer: Peer, message: str, wanted: tuple[str, ...]) -> None:
    """BenchError unless the message has exactly the fields of a drive."""
    found = peer.codec.fields(message)
    if set(found) != set(wanted):
        raise BenchError(f"{message} has the fields {', '.join(found)}, not {', '.join(wanted)}")
