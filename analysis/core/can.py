# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Worst-case response times of CAN frames.

Davis, Burns, Bril, Lukkien, Controller Area Network (CAN) schedulability analysis:
refuted, revisited and revised (Real-Time Systems 35, 2007). For instance q (from 0):

    w(q) = B + E(w + C) + q C + sum over more urgent k of ceil((J_k + w + tau) / T_k) C_k
    R    = max over q of  J + w(q) + C - q T

over all instances of the busy period  t = B + E(t) + sum ceil((J_k + t) / T_k) C_k,
own frames included. tau is a bit: a frame queued until then still takes part in
arbitration. B is the longest less urgent frame, or the longest undeclared one. E is
the time lost to errors. R counts from the event that makes
the sender queue the frame, and includes the queuing jitter J.

The analysis assumes that each node offers its most urgent frame whenever the bus is free. The
node can still replace it by a more urgent one: buffers can be aborted, and copying takes no time.
Frames of a first-in first-out queue are the exception. They follow Davis, Kollmann, Pollex,
Slomka (ECRTS 2011), here with every instance of the busy period. A queued frame is analysed at
the least urgent identifier of its queue, with all frames of the queue before it. Towards other
frames the time until it is sent is additional jitter. The bound is safe, not exact. A controller
may get the frames of a queue one by one. Then any less urgent frame may be sent before each. So
all frames of the bus count, as often as they come: a busy bus sends them all in any order.

Frames of one rank delay each other: either may go first, each time anew.
Identifiers of a bus differ. Published systems have ranks that do not.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import groupby

from .bus import Bus, Frame
from .can_response import FrameLevel, FrameResponse, frame_response
from .checks import distinct
from .responses import Reason
from .window import Effort, Load, Source, Window, constant_source, rate

FRAME_EFFORT = 200_000
"""Changes of release numbers that one frame's analysis may take; then it has no bound."""

WHOLE_EFFORT = 5_000_000
"""The same for one call: later frames have no bound either."""

ROUNDS = 100
"""Rounds in which the delays of first-in first-out queues must settle."""


def analyse(frames: Sequence[Frame], bus: Bus) -> tuple[FrameResponse, ...]:
    """The worst-case response of every frame of one bus, in the order given.

    ValueError for a name that two of them have.
    """
    return _analysed(tuple(frames), bus)


@lru_cache(maxsize=64)
def _analysed(frames: tuple[Frame, ...], bus: Bus) -> tuple[FrameResponse, ...]:
    """As `analyse`; cached, because the rounds of a network and changed models ask again."""
    distinct("messages", [frame.name for frame in frames])
    effort = Effort(WHOLE_EFFORT)
    order = tuple(sorted(frames, key=lambda frame: frame.rank))
    delays = _queue_delays(order, bus, effort)
    found = {item.frame.name: item for item in _of_bus(order, bus, delays, effort)}
    return tuple(found[frame.name] for frame in frames)


def response_under(
    frame: Frame,
    interfering: Sequence[Frame],
    others: Sequence[Frame],
    bus: Bus,
    delays: Mapping[str, int] | None = None,
) -> FrameResponse:
    """The response when ``interfering`` are more urgent than ``frame`` and ``others`` are less.

    Ranks do not count. ``delays`` is needed for frames with first-in first-out queues, all
    ``reloaded`` (`delays_in_any_order`); all other frames interfere with such a frame.
    """
    level = FrameLevel((*interfering, frame, *others), len(interfering) + 1, bus, delays or {})
    return _alone(frame, level, Effort(FRAME_EFFORT))


def delays_in_any_order(frames: Sequence[Frame], bus: Bus) -> Delays:
    """How long each frame of a ``reloaded`` queue waits, whatever the ranks are.

    All frames of the bus may go before it, so its wait is that of every order.
    ValueError for a queue that the controller holds as a whole: there ranks count.
    """
    for frame in frames:
        if frame.queue and not frame.reloaded:
            raise ValueError(f"queue of message {frame.name} must be empty here, or reloaded")
    return _queue_delays(tuple(frames), bus, Effort(WHOLE_EFFORT))


def load(frames: Sequence[Frame]) -> Fraction:
    """Share of a bus that the frames need, each at its longest and most frequent."""
    return sum((frame.utilisation for frame in frames), Fraction(0))


Delays = Mapping[str, int | None]
"""The longest wait of frames in queues, by name; None where there is no bound."""


def _queue_delays(order: tuple[Frame, ...], bus: Bus, effort: Effort) -> Delays:
    """How long each frame of a first-in first-out queue waits for its transmission.

    The delays of different queues depend on each other: they grow from zero until none grows.
    No delay is longer than the longest busy time of the whole bus: by its end the bus has sent
    each waiting frame, whatever the order. On a full bus, which may never be idle again,
    no queue has a bound: no time is known at which it is empty.
    """
    queued = [frame for frame in order if frame.queue]
    busiest = _busiest(order, bus, effort) if queued else None
    if busiest is None:
        return dict.fromkeys(frame.name for frame in queued)
    longest = {frame.name: busiest - frame.transmission_time for frame in queued}
    delays: dict[str, int] = dict.fromkeys(longest, 0)
    for _ in range(ROUNDS):
        found = dict(longest)
        for frame in queued:
            sent = _in_queue(frame, order, bus, delays, effort).bound
            if sent is not None:
                waited = sent - frame.transmission_time - frame.jitter
                found[frame.name] = min(waited, longest[frame.name])
        if found == delays:
            return delays
        delays = found
    return longest


def _busiest(order: tuple[Frame, ...], bus: Bus, effort: Effort) -> int | None:
    """The longest time that the bus is never idle, or None where it has no bound."""
    level = FrameLevel(order, len(order), bus, {})
    window, used = Window(), Load()
    window.length = 1  # zero is a fixed point too
    for number, frame in enumerate(order):
        source = constant_source(frame.period, frame.jitter, frame.transmission_time)
        used.add(source)
        window.add(number, source)
    fixed = bus.unknown
    if bus.errors is not None:
        fixed += (bus.errors.burst - 1) * level.error_overhead
        window.add(len(order), constant_source(bus.errors.period, 0, level.error_overhead))
    if _overloaded(level, used):
        return None
    allowed = Effort(min(FRAME_EFFORT, effort.left))
    effort.left -= allowed.left
    settled = window.settle(fixed, allowed)
    effort.left += allowed.left
    return window.length if settled else None


def _of_bus(
    order: tuple[Frame, ...], bus: Bus, delays: Delays, effort: Effort
) -> Iterator[FrameResponse]:
    """The responses of the frames of a bus, most urgent first."""
    waiting, busy, used = Window(), Window(), Load()
    known = {name: delay for name, delay in delays.items() if delay is not None}
    reason: Reason | None = None
    for _, group in groupby(enumerate(order, 1), key=lambda placed: placed[1].rank):
        members = list(group)
        level = FrameLevel(order, members[-1][0], bus, known)
        if any(frame.queue and delays[frame.name] is None for _, frame in members):
            reason = reason or Reason.DELAYED
        for _, frame in members:
            used.add(_source(frame, known))
        for _, frame in members:
            if frame.queue:
                yield _in_queue(frame, order, bus, delays, effort)
                continue
            reason = reason or _obstacle(level, used, frame, waiting, busy, effort)
            if reason is not None:
                yield FrameResponse(frame, level, None, reason=reason)
                continue
            allowed = Effort(min(FRAME_EFFORT, effort.left))
            effort.left -= allowed.left
            if len(members) > 1:
                yield _alone(frame, level, allowed)
            else:
                yield frame_response(frame, level, waiting.fork(), busy.fork(), allowed)
            effort.left += allowed.left
        for number, frame in members:
            busy.add(number, _source(frame, known))
            waiting.add(number, _source(frame, known, bus.bit_time))


def _source(frame: Frame, delays: Mapping[str, int], later: int = 0) -> Source:
    """The demand of a frame on the bus, late by its jitter, its queue delay and ``later``."""
    return constant_source(
        frame.period, frame.jitter + delays.get(frame.name, 0) + later, frame.transmission_time
    )


def _obstacle(
    level: FrameLevel, used: Load, frame: Frame, waiting: Window, busy: Window, effort: Effort
) -> Reason | None:
    """The reason why this frame and those below have no bound; lengthens the windows."""
    if _overloaded(level, used):
        return Reason.OVERLOAD
    if waiting.settle(0, effort) and busy.settle(frame.transmission_time, effort):
        return None
    return Reason.EFFORT


def _overloaded(level: FrameLevel, used: Load) -> bool:
    """Whether the frames and the errors of a level need more than the bus has."""
    errors = level.bus.errors
    extra = 0 if errors is None else rate(constant_source(errors.period, 0, level.error_overhead))
    return used.above_one(lambda: level.load, extra)


def _in_queue(
    frame: Frame, order: tuple[Frame, ...], bus: Bus, delays: Delays, effort: Effort
) -> FrameResponse:
    """The response of a frame of a queue, at the least urgent rank that goes before it."""
    last = max(other.rank for other in order if other.queue == frame.queue)
    reach = sum(frame.reloaded or other.rank <= last for other in order)
    known = {name: delay for name, delay in delays.items() if delay is not None}
    level = FrameLevel(order, reach, bus, known)
    if delays[frame.name] is None:
        whole = FrameLevel(order, len(order), bus, known)
        used = Load()
        for other in order:
            used.add(constant_source(other.period, 0, other.transmission_time))
        if _overloaded(whole, used):
            return FrameResponse(frame, whole, None, reason=Reason.OVERLOAD)
        return FrameResponse(frame, level, None, reason=Reason.EFFORT)
    for other in order[:reach]:
        if other.queue != frame.queue and delays.get(other.name, 0) is None:
            return FrameResponse(frame, level, None, reason=Reason.DELAYED)
    return _alone(frame, level, effort)


def _alone(frame: Frame, level: FrameLevel, effort: Effort) -> FrameResponse:
    """The response of ``frame`` with windows made for it only."""
    waiting, busy, used = Window(), Window(), Load()
    effort.left -= level.reach
    for number, other in enumerate(level.order[: level.reach]):
        late = level.jitter(other, frame)
        source = constant_source(other.period, late, other.transmission_time)
        used.add(source)
        if other.name != frame.name:
            busy.add(number, source)
            waiting.add(
                number,
                constant_source(other.period, late + level.bus.bit_time, other.transmission_time),
            )
    if _overloaded(level, used):
        return FrameResponse(frame, level, None, reason=Reason.OVERLOAD)
    return frame_response(frame, level, waiting, busy, effort)
