# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claimed bounds of a system's certificate, with the windows that show them.

A response keeps the window of its worst job. The certificate needs the windows of all jobs
of the busy period and, for a message, the busy period itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from math import ceil

from ravenchart.analysis.core import can
from ravenchart.analysis.core.bus import Bus
from ravenchart.analysis.core.can_response import ERRORS, FrameResponse
from ravenchart.analysis.core.chains import HopKind
from ravenchart.analysis.core.offsets import OffsetSearch, aligned
from ravenchart.analysis.core.responses import (
    Response,
    demand_of,
    interference_of,
    jitter_of,
    release_time,
)
from ravenchart.analysis.core.tasks import is_phased
from ravenchart.analysis.core.window import Effort, Window, constant_source, source
from ravenchart.analysis.system import latencies
from ravenchart.analysis.system.authentication import authentications
from ravenchart.analysis.system.latencies import Latency, reception_frames
from ravenchart.analysis.system.protection import protected
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.diagnostics import UNREADY, Diagnostic, error
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.claims import ChainClaim, Claims, ResponseClaim

from .deadlines import each_finding

EFFORT = 200_000
"""The work for the windows of one task or message: as much as for its response."""

MOST_JOBS = 1_000
"""Jobs or instances of one busy period that a certificate lists at most."""

MOST_INSTANTS = 200
"""Instants of one processor that a certificate lists at most."""


class Unclaimed(Exception):  # noqa: N818
    """A task or message has a bound, but no busy period that ends: its resource is full."""


def claims_of(analysis: Analysis) -> Claims:
    """The claimed bounds of the certificate of a system whose deadlines are met.

    Responses are those for all offsets. A processor that is late with some offsets, but not
    with its own, also has the instants that show it. Unclaimed where a processor or bus is
    loaded to exactly its whole time.
    """
    since = by_offsets(analysis)
    analysis = analysis.for_all_offsets
    items = {}
    for name, response in analysis.found.responses.items():
        items[name] = _of_task(response) if isinstance(response, Response) else _of(response)
    for name, windows in since.items():
        items[name] = replace(items[name], since=windows)
    chains = {chain.name: _of_chain(latency) for chain, latency in analysis.limited}
    steps = {hop.step.name for _, latency in analysis.limited for hop in latency.hops}
    rows = {r.row.name: Ns(r.bound) for _, r in analysis.rows() if r.row.name in steps}
    handed = {element for element in analysis.deliveries if latencies.handed(element) in steps}
    guarded = protected(analysis)
    residual = {one.message.name: ceil(one.residual * 10**18) for one in guarded}
    noticed = [silence for one in guarded for silence in one.silences]
    noticed += [silence for one in authentications(analysis) for silence in one.silences]
    stale = {str(one.port): one.found for one in noticed if one.found is not None}
    handed |= {one.delivery for one in noticed if one.found is not None}
    travels = analysis.transfers.values()
    handed |= {one.reception.element for one in travels}
    handed |= {element for element, one in analysis.deliveries.items() if one.message.controls}
    sums = {
        one.message.element: (one.round_trip, one.bound)
        for one in travels
        if one.round_trip is not None and one.bound is not None
    }
    waits, busiest = _capped(analysis)
    turns = _turns(analysis, handed)
    return Claims(items, rows, waits, busiest, turns, chains, residual, stale, sums)


def uncertified(analysis: Analysis) -> Iterator[Diagnostic]:
    """An error for each deadline or limit that is met only by offsets no certificate shows."""
    if analysis.for_all_offsets is analysis:
        return
    phased = any(is_phased(task) for task in analysis.network.tasks)
    for one in each_finding(analysis.for_all_offsets, but=by_offsets(analysis)):
        if one.is_error:
            what = "offsets and phases" if phased else "offsets"
            text = f"without {what}, {one.message}; the certificate cannot show {what} here yet"
            hint = f"choose times or priorities that do without {what}"
            yield error(UNREADY, one.origin, text, notes=one.notes, hint=hint)


def by_offsets(analysis: Analysis) -> dict[str, tuple[Ns, ...]]:
    """The processors that only their offsets keep from being late, with `ResponseClaim.since`."""
    blind = analysis.for_all_offsets
    if blind is analysis:
        return {}
    offsets = {task.name: task.offset for task in analysis.network.tasks}
    phased = {task.name for task in analysis.network.tasks if is_phased(task)}
    found = {}
    for name in blind.failed():
        response = blind.found.responses[name]
        if isinstance(response, Response) and response.bound is not None:
            if any(one.name in phased for one in response.level.order):
                continue  # the instants of a certificate know no phases
            windows = _since(response, offsets, analysis)
            if windows is not None:
                found[name] = windows
    return found


def _since(
    response: Response, offsets: Mapping[str, int | None], analysis: Analysis
) -> tuple[Ns, ...] | None:
    """The windows from all instants, with inherited jitter for any offsets; None if too late."""
    level, task = response.level, analysis.tasks[response.task.name]
    order = tuple(replace(one, offset=offsets[one.name]) for one in level.order)
    own = next(one for one in order if one.name == task.element)
    known = replace(response, task=own, level=replace(level, order=order))
    tasks = aligned(known)
    everyone = {one.name for one in order[: level.reach] if one.offset is not None}
    if own not in tasks or {one.name for one in tasks} != everyone or own.deadline > own.period:
        return None
    assert response.bound is not None
    search, found = OffsetSearch(known, tasks, Effort(EFFORT)), []
    starts = search.followed(response.bound - response.jitter - own.deadline)
    if len(starts) > MOST_INSTANTS:
        return None
    for start, lead in starts:
        window = search.window(start)
        if window is None or window > lead + own.deadline:
            return None
        found.append(Ns(window))
    return tuple(found)


def _of_task(response: Response) -> ResponseClaim:
    """Every job of the busy period; the table begins with all its rows."""
    assert response.bound is not None
    alone = response.jobs == 1 and response.window + response.jitter <= response.task.period
    windows = [response.window] if alone else _jobs(response)
    return ResponseClaim(Ns(response.bound), tuple(map(Ns, windows)))


def _jobs(response: Response) -> list[int]:
    """The window of each job of the busy period."""
    task, level = response.task, response.level
    window, effort = Window(), Effort(EFFORT)
    platform = level.platform
    others = [other for other in level.order[: level.reach] if other.name != task.name]
    for number, other in enumerate(others):
        own = source(other.period, jitter_of(other, platform), interference_of(other, platform))
        window.add(number, own)
    number = len(others)
    if platform.tick_wcet:
        window.add(number, constant_source(platform.tick_period, 0, platform.tick_wcet))
    for place, other in enumerate(level.order if platform.release else (), number + 1):
        wcet = release_time(other, platform)
        release = constant_source(other.period, jitter_of(other, platform), wcet)
        window.add(place, release)
    demand = demand_of(task, platform)
    found: list[int] = []
    while not found or found[-1] + response.jitter > len(found) * task.period:
        if len(found) == MOST_JOBS:
            raise Unclaimed(f"{task.name} is never done before its next release")
        fixed = response.blocked + demand.most(len(found) + 1)
        found += _settled(window, [fixed], effort, task.name)
    return found


def _settled(window: Window, fixed: list[int], effort: Effort, name: str) -> list[int]:
    """The least windows that hold these demands and those of the sources."""
    found = []
    for demand in fixed:
        if not window.settle(demand, effort):
            raise Unclaimed(f"{name} has no busy period that ends")
        found.append(window.length)
    return found


def _of(response: FrameResponse) -> ResponseClaim:
    """Every instance of the busy period, and the busy period."""
    frame, level = response.frame, response.level
    assert response.bound is not None
    errors = level.bus.errors
    blocked = level.blocker[1]
    if errors is not None:
        blocked += (errors.burst - 1) * level.error_overhead
    waiting, busy = Window(), Window()
    busy.length = 1  # zero is a fixed point too
    for number, other in enumerate(level.order[: level.reach]):
        late = level.jitter(other, frame)
        busy.add(number, constant_source(other.period, late, other.transmission_time))
        if other.name != frame.name:
            until = constant_source(
                other.period, late + level.bus.bit_time, other.transmission_time
            )
            waiting.add(number, until)
    if errors is not None:
        waiting.add(
            ERRORS, constant_source(errors.period, frame.transmission_time, level.error_overhead)
        )
        busy.add(ERRORS, constant_source(errors.period, 0, level.error_overhead))
    effort = Effort(EFFORT)
    (length,) = _settled(busy, [blocked], effort, frame.name)
    instances = -(-(length + frame.jitter) // frame.period)
    if instances > MOST_JOBS:
        raise Unclaimed(f"{frame.name} has {instances} instances in one busy period")
    fixed = [blocked + instance * frame.transmission_time for instance in range(instances)]
    windows = _settled(waiting, fixed, effort, frame.name)
    return ResponseClaim(Ns(response.bound), tuple(map(Ns, windows)), Ns(length))


def _capped(analysis: Analysis) -> tuple[dict[str, Ns], dict[str, Ns]]:
    """The waits in queues that the busiest time of a bus bounds, and these times by bus."""
    waits: dict[str, Ns] = {}
    busiest: dict[str, Ns] = {}
    for bus in analysis.system.buses:
        for response in analysis.frames(bus):
            frame, bound = response.frame, response.bound or 0
            for other in analysis.frames(bus):
                wait = other.level.delays.get(frame.name)
                if wait is not None and wait < bound - frame.transmission_time - frame.jitter:
                    waits[frame.name] = Ns(wait)
                    busiest[bus.name] = Ns(wait + frame.transmission_time)
    return waits, busiest


def _turns(analysis: Analysis, handed: set[str]) -> dict[str, ResponseClaim]:
    """The claimed bounds on the time until the reception turns to each of these messages."""
    found: dict[str, ResponseClaim] = {}
    system = analysis.system
    for processor in system.processors:
        waiting = reception_frames(processor, system, analysis.found)
        for response in can.analyse(waiting, Bus(bit_time=1)):
            if response.frame.name in handed:
                claimed = _of(response)
                turn = Ns(claimed.response - processor.period)
                found[response.frame.name] = ResponseClaim(turn, claimed.windows, claimed.busy)
    return found


def _of_chain(latency: Latency) -> ChainClaim:
    """The latencies of a chain; a latency without a bound has no limit either."""
    waits = tuple(Ns(hop.wait or 0) for hop in latency.hops if hop.step.hop is HopKind.QUEUED)
    return ChainClaim(Ns(latency.reaction or 0), Ns(latency.age or 0), waits)
