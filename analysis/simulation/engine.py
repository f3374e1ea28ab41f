# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The event queue: arrivals, completions and the releases by them, in order of time."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from heapq import heappop, heappush

from ravenchart.analysis.core.blocking import ceilings
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.checks import natural
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.platform import Platform
from ravenchart.analysis.core.tasks import Task

from .phases import Phase, PhaseScenario
from .processor import Job, SimulatedProcessor, segments_of
from .wire import QueuedFrame, Wire

EVENTS = 5_000_000
"""Events after which a simulation is given up."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """Instance ``number`` of an item had its core or bus from ``start`` to ``end``."""

    resource: str
    name: str
    number: int
    start: int
    end: int


@dataclass(slots=True)
class ObservedTimes:
    """The observed times, in ticks.

    The names are those of tasks and messages.

        ``longest``    longest time from the event of the chain to a completion
        ``rows``       longest time from the arrival of a job to the end of a row, by both names
        ``completed``  instances that were completed
        ``stretches``  the use of cores and buses, where it was recorded
    """

    longest: dict[str, int] = field(default_factory=dict)
    rows: dict[tuple[str, str], int] = field(default_factory=dict)
    completed: dict[str, int] = field(default_factory=dict)
    stretches: list[Stretch] = field(default_factory=list)


@dataclass(frozen=True, slots=True, order=True)
class _Release:
    """Instance ``number`` of an item is released at ``time``; ``order`` decides between equals."""

    time: int
    order: int
    name: str
    number: int
    event: int
    arrival: int


def simulate(
    network: Network, scenario: PhaseScenario, until: int, *, record: bool = False
) -> ObservedTimes:
    """The observed times up to ``until``, with every job executing its whole C.

    ValueError for cores with overheads, which are not simulated, and as `ceilings`; and
    where the simulation takes more than `EVENTS` events.
    """
    natural("the simulation", until=until)
    for core, platform in network.platforms.items():
        if platform != Platform():
            raise ValueError(f"overheads of core {core} cannot be simulated: add them to the WCETs")
    return _Engine(network, scenario, until, record).run()


class _Engine:
    def __init__(self, network: Network, scenario: PhaseScenario, until: int, record: bool) -> None:
        self.scenario = scenario
        self.until = until
        self.record = record
        self.items = network.items()
        self.ceilings = ceilings(network.tasks, network.sections, network.ceilings)
        self.releases: list[_Release] = []
        self.seen = ObservedTimes()
        self.pieces: dict[tuple[str, str, int, int], int] = {}
        self.order = 0
        self.cores = {task.core: SimulatedProcessor() for task in network.tasks}
        self.wires = {
            name: Wire(bus, scenario.faults.get(name, ())) for name, bus in network.buses.items()
        }
        self.home = {frame.name: bus for bus, some in network.frames.items() for frame in some}
        self.released: dict[str, list[str]] = {}
        for name, by in network.released_by.items():
            self.released.setdefault(by, []).append(name)
        self.followers = frozenset(network.released_by)
        self.last: dict[str, int] = {}
        for name in self.items:
            if name not in self.followers:
                self._arrive(name, 0, self._phase(name).first)

    def run(self) -> ObservedTimes:
        """Process the events; at one time first the ends, then the beginnings."""
        for _ in range(EVENTS):
            due = [c.due for c in self.cores.values()] + [w.due for w in self.wires.values()]
            times = [time for time in due if time is not None]
            if self.releases:
                times.append(self.releases[0].time)
            now = min(times, default=self.until + 1)
            if now > self.until:
                return self.seen
            self._end(now)
            while self.releases and self.releases[0].time == now:
                self._release(heappop(self.releases))
            for core in self.cores.values():
                core.dispatch()
            for wire in self.wires.values():
                wire.dispatch(now)
        raise ValueError(f"the simulation takes more than {EVENTS} events: shorten it")

    def _phase(self, name: str) -> Phase:
        item = self.items[name]
        offset = item.offset if isinstance(item, Task) else None
        return self.scenario.phases.get(name, Phase(offset) if offset else _SYNCHRONOUS)

    def _arrive(self, name: str, number: int, arrival: int, event: int | None = None) -> None:
        """Note the release of an instance that arrives then, never before the previous one's."""
        late = self._phase(name).late(number)
        if not 0 <= late <= self.items[name].jitter:
            raise ValueError(f"{name} must be released at most {self.items[name].jitter} late")
        time = max(arrival + late, self.last.get(name, 0))
        self.last[name] = time
        self.order += 1
        begun = arrival if event is None else event
        heappush(self.releases, _Release(time, self.order, name, number, begun, arrival))

    def _release(self, one: _Release) -> None:
        item, phase = self.items[one.name], self._phase(one.name)
        self.order += 1
        if one.name not in self.followers:
            self._arrive(
                one.name, one.number + 1, one.arrival + item.period + phase.more(one.number)
            )
        if isinstance(item, Frame):
            message = QueuedFrame(item, one.number, one.event, self.order)
            self.wires[self.home[one.name]].release(message)
            return
        frame = (phase.frame + one.number) % item.frame_count
        job = Job(item, one.number, one.event, one.arrival, self.order)
        job.segments = segments_of(item, frame, phase.inside, self.ceilings)
        if job.segments:
            self.cores[item.core].release(job)
        else:
            self._complete(one.name, one.number, one.event, one.time)

    def _end(self, now: int) -> None:
        """Process all that ends at ``now``, on every core and bus."""
        for name, core in self.cores.items():
            job, start = core.running, core.now
            if self.record and job is not None:
                self._note(Stretch(name, job.task.name, job.number, start, now))
            ended = core.advance(now)
            if ended is not None:
                job, segment = ended
                if segment.row:
                    key = job.task.name, segment.row
                    self.seen.rows[key] = max(self.seen.rows.get(key, 0), now - job.arrival)
                if not job.segments:
                    self._complete(job.task.name, job.number, job.event, now)
        for name, wire in self.wires.items():
            if wire.due == now:
                sending = wire.sending
                sent = wire.advance(now)
                if self.record and sending is not None:
                    self._note(Stretch(name, sending.frame.name, sending.number, wire.start, now))
                if sent is not None:
                    self._complete(sent.frame.name, sent.number, sent.event, now)

    def _note(self, stretch: Stretch) -> None:
        """Record a stretch, joined with the recorded one that it continues."""
        if stretch.start == stretch.end:
            return
        key = (stretch.resource, stretch.name, stretch.number, stretch.start)
        at = self.pieces.pop(key, None)
        if at is None:
            at = len(self.seen.stretches)
            self.seen.stretches.append(stretch)
        else:
            self.seen.stretches[at] = replace(self.seen.stretches[at], end=stretch.end)
        self.pieces[*key[:3], stretch.end] = at

    def _complete(self, name: str, number: int, event: int, now: int) -> None:
        """Note a completion, and release the items that follow it."""
        seen = self.seen
        seen.longest[name] = max(seen.longest.get(name, 0), now - event)
        seen.completed[name] = seen.completed.get(name, 0) + 1
        for follower in self.released.get(name, ()):
            self._arrive(follower, number, now, event)


_SYNCHRONOUS = Phase()
