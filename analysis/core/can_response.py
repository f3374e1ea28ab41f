# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The instances of one frame's busy period, and every term of its response."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from .bus import Bus, Frame
from .responses import Reason
from .window import Effort, Window, constant_source, releases_in

ERRORS = 1 << 40
"""Serial number of the errors; those of frames are below."""


@dataclass(frozen=True, slots=True)
class FrameInterference:
    """The interference of one other message before the transmission."""

    frame: Frame
    instances: int
    time: int


@dataclass(frozen=True, slots=True)
class FrameLevel:
    """The frames sent before a frame: the first ``reach`` of ``order``, most urgent first.

    ``delays`` has, by name, the longest time that frames of first-in first-out queues
    wait to take part in arbitration.
    """

    order: tuple[Frame, ...]
    reach: int
    bus: Bus
    delays: Mapping[str, int]

    @property
    def load(self) -> Fraction:
        """Share of the bus that these frames and errors need."""
        load = sum((frame.utilisation for frame in self.order[: self.reach]), Fraction(0))
        errors = self.bus.errors
        return load if errors is None else load + Fraction(self.error_overhead, errors.period)

    @property
    def error_overhead(self) -> int:
        """The time lost to one error at this level; 0 where none are assumed."""
        if self.bus.errors is None:
            return 0
        longest = max(frame.transmission_time for frame in self.order[: self.reach])
        return self.bus.errors.bits * self.bus.bit_time + longest

    @property
    def blocker(self) -> tuple[str, int]:
        """The longest less urgent frame and its time; no name for an undeclared frame."""
        longest = ("", self.bus.unknown)
        for frame in self.order[self.reach :]:
            if frame.transmission_time > longest[1]:
                longest = (frame.name, frame.transmission_time)
        return longest

    def jitter(self, frame: Frame, towards: Frame) -> int:
        """The longest time from the event of ``frame`` until it competes with ``towards``."""
        if frame.queue and frame.queue == towards.queue:
            return frame.jitter
        return frame.jitter + self.delays.get(frame.name, 0)


@dataclass(frozen=True, slots=True)
class FrameResponse:
    """The worst-case response of one frame; all times in ticks.

    ``bound`` counts from the event that makes the sender queue it, or is None with
    the ``reason``. It is attained by instance ``worst_instance`` (from 0) of the
    ``instances`` in the busy period, which waits ``window`` from its start:

        jitter + window + transmission_time - worst_instance * period = bound
        blocked + own + interference + errors = window
    """

    frame: Frame
    level: FrameLevel
    bound: int | None
    instances: int = 0
    worst_instance: int = 0
    window: int = 0
    reason: Reason | None = None

    @property
    def met(self) -> bool:
        """The bound exists and is at most the deadline."""
        return self.bound is not None and self.bound <= self.frame.deadline

    @property
    def slack(self) -> int | None:
        """Deadline less bound; negative when missed, None without a bound."""
        return None if self.bound is None else self.frame.deadline - self.bound

    @property
    def lead(self) -> int:
        """From the beginning of the busy period to the event of the worst instance."""
        return self.worst_instance * self.frame.period - self.frame.jitter

    @property
    def blocker(self) -> str:
        """The less urgent frame that blocks this one; "" for none, or one not declared."""
        return self.level.blocker[0]

    @property
    def blocked(self) -> int:
        """The blocking by the longest less urgent frame, which counts once."""
        return self.level.blocker[1]

    @property
    def own(self) -> int:
        """Earlier instances of the same message in the busy period."""
        return self.worst_instance * self.frame.transmission_time

    @property
    def errors(self) -> int:
        """Time lost to errors until the frame is sent."""
        model = self.level.bus.errors
        if model is None or self.bound is None:
            return 0
        return len(self.error_times) * self.level.error_overhead

    @property
    def error_times(self) -> list[int]:
        """When errors come in the window, at the soonest."""
        model = self.level.bus.errors
        if model is None or self.bound is None:
            return []
        count = releases_in(self.window, model.period, self.frame.transmission_time)
        later = [max(0, n * model.period - self.frame.transmission_time) for n in range(count)]
        return [0] * (model.burst - 1) + later

    def queued(self, other: Frame) -> list[int]:
        """When frames of another message of the level take part in the window, at the soonest."""
        late = self.level.jitter(other, self.frame) + self.level.bus.bit_time
        count = releases_in(self.window, other.period, late)
        return [max(0, n * other.period - late) for n in range(count)]

    @property
    def interference(self) -> tuple[FrameInterference, ...]:
        """The interference of each other message of the level in the window, longest first."""
        if self.bound is None:
            return ()
        found = []
        for other in self.level.order[: self.level.reach]:
            if other.name != self.frame.name:
                count = len(self.queued(other))
                found.append(FrameInterference(other, count, count * other.transmission_time))
        return tuple(sorted(found, key=lambda share: -share.time))


def frame_response(
    frame: Frame, level: FrameLevel, waiting: Window, busy: Window, effort: Effort
) -> FrameResponse:
    """The response of ``frame``; both windows hold its interference, and are no longer than its.

    In ``waiting`` a frame interferes if it is queued until arbitration is over, a bit later.
    ``busy`` is the busy period, in which a frame interferes until its end.
    """
    fixed = level.blocker[1]
    errors = level.bus.errors
    if errors is not None:
        lost = level.error_overhead
        fixed += (errors.burst - 1) * lost
        waiting.add(ERRORS, constant_source(errors.period, frame.transmission_time, lost))
        busy.add(ERRORS, constant_source(errors.period, 0, lost))
    pattern = math.inf
    bound, worst, window, instance = -1, 0, 0, 0
    while waiting.settle(fixed + instance * frame.transmission_time, effort) and effort.left > 0:
        effort.left -= 1
        late = frame.jitter + waiting.length + frame.transmission_time - instance * frame.period
        if late > bound:
            bound, worst, window = late, instance, waiting.length
        instance += 1
        if not busy.settle(fixed + instance * frame.transmission_time, effort):
            break
        over = busy.length <= instance * frame.period - frame.jitter
        if instance == 1 and not over:
            pattern = _pattern(level, frame.period, effort.left)
        if over or instance >= pattern:
            return FrameResponse(frame, level, bound, instance, worst, window)
    return FrameResponse(frame, level, None, reason=Reason.EFFORT)


def _pattern(level: FrameLevel, period: int, limit: int) -> float:
    """Instances after which the frames of a level repeat; infinity when above ``limit``."""
    length = math.lcm(period, level.bus.errors.period if level.bus.errors else 1)
    for frame in level.order[: level.reach]:
        length = math.lcm(length, frame.period)
        if length // period > limit:
            return math.inf
    return length // period
