# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Diagnostics for missed deadlines, overloaded buses, late chains and short queues."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from fractions import Fraction
from functools import partial

from ravenchart import rounded
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.chains import HopLatency
from ravenchart.analysis.core.responses import Interference, Reason, Response
from ravenchart.analysis.system.latencies import HopKind, Latency
from ravenchart.analysis.system.stream import StreamResponse
from ravenchart.analysis.system.timing import Analysis
from ravenchart.analysis.units import duration
from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.nodes import SNAPSHOT_PERIOD, TRACE_LIMIT
from ravenchart.gen.model.system import Carried, Chain, Gap
from ravenchart.gen.origins import Origin

from .bit_rates import blamed_on_a_bus
from .causes import Causes, RootFinding, is_full

MISSED = "RV-0901"
"""A task or message may complete after its deadline."""

NO_BOUND = "RV-0902"
"""The response of a task or message has no known bound."""

BUS_OVERLOAD = "RV-0903"
"""The messages of a bus need more than all of its time."""

NO_WAY, CHAIN_LATE = "RV-0904", "RV-0905"
"""A chain is broken; it may take longer than its limit."""

QUEUE_SHORT, QUEUE_OPEN = "RV-0906", "RV-0907"
"""A queue is too short for the values that may wait in it; their number has no bound."""

GIVEN_UP = "RV-0909"
"""A time-out of a transfer may pass although no frame is lost."""

STREAM_LATE = "RV-0911"
"""A node may not hand its trace and snapshots to a monitor in time."""

TRACE_SHORT = "RV-0912"
"""A trace is too short for the records that may wait in it."""

LARGEST = 3
"""How many interferers a diagnostic names."""


def findings(analysis: Analysis, but: Collection[str] = ()) -> tuple[Diagnostic, ...]:
    """One error for each deadline that may be missed, each overload, and each limit of a chain.

    Deadlines of tasks and messages in ``but`` are left out. So is an error that only depends on
    another one, which has a note of how many there are.
    """
    return blamed_on_a_bus(analysis, _found(analysis, but), partial(each_finding, but=but))


def each_finding(analysis: Analysis, but: Collection[str] = ()) -> tuple[Diagnostic, ...]:
    """The same, without a look for a bus that is too slow."""
    return tuple(one.shown for one in _found(analysis, but))


def _found(analysis: Analysis, but: Collection[str]) -> tuple[RootFinding, ...]:
    """The errors that do not depend on others, each with the number of those that do."""
    causes = Causes(analysis, [one for one in analysis.failed() if one not in but])
    found: list[tuple[str, Diagnostic]] = []
    for name in causes.failed:
        response = analysis.found.responses[name]
        if causes.leave_out(causes.cause.get(name)):
            continue
        if isinstance(response, Response):
            found.append((name, _of_task(response, analysis)))
        else:
            found.append((name, _of_message(response, analysis)))
    found += [(bus.name, _of_bus(bus, analysis)) for bus in analysis.overloaded]
    others = (
        *_of_transfers(analysis),
        *_of_receptions(analysis, causes),
        *_of_chains(analysis, causes),
        *_of_queues(analysis),
        *_of_streams(analysis),
    )
    counted = (causes.counted(name, one) for name, one in found)
    return (*counted, *(RootFinding("", one) for one in others))


def _of_transfers(analysis: Analysis) -> Iterator[Diagnostic]:
    """An error for each transfer that may be given up although no frame is lost."""
    for one in analysis.transfers.values():
        if one.in_time or one.round_trip is None or one.segment is None:
            continue  # what has no bound has its own error
        needed = Ns(one.round_trip + one.segment)
        takes, timeout = rounded.against(needed, one.transport.timeout)
        message = f"the time-out of {one.message.name} is {timeout}; with "
        message += f"flow control its next segment may take {takes}"
        hint = f"give `transport` a `timeout` of {duration(needed)} or more"
        yield error(GIVEN_UP, one.message.origin, message, hint=hint)


def no_bound_reason(response: Response | FrameResponse) -> str:
    """Why there is no bound, in words."""
    reason = response.reason or Reason.EFFORT
    if not is_full(response):
        return str(reason.value)
    load = rounded.percent(response.level.load)
    if isinstance(response, Response):
        return f"it and the tasks that preempt it need {load} of the core, more than all of it"
    return f"it and the messages sent before it need {load} of the bus, more than all of it"


def _of_task(response: Response, analysis: Analysis) -> Diagnostic:
    """The error of one task."""
    task = analysis.tasks[response.task.name]
    if response.bound is None:
        return error(
            NO_BOUND,
            task.origin,
            f"{task.element} has no response-time bound: {no_bound_reason(response)}",
            notes=_task_notes(response, analysis),
            hint="shorten worst-case execution times, or lengthen periods",
        )
    bound, deadline = rounded.against(response.bound, task.deadline)
    hint = "lengthen its period, or move an activity to a processor with a longer period"
    if task.driver_of:
        hint = "lengthen the period of the message, or shorten what preempts the driver"
    own = next((p for p in analysis.system.processors if p.name == task.element), None)
    if own is not None and own.logical == task.deadline < own.period:
        hint = "lengthen its `logical_execution_time`, or move an activity to another processor"
    elif own is not None and own.cyclic:
        hint = "give phases that keep long rows apart, or move a row to another processor"
    return error(
        MISSED,
        task.origin,
        f"{task.element} misses its deadline: R = {bound} > D = {deadline}",
        notes=_task_notes(response, analysis),
        hint=hint,
    )


def _task_notes(response: Response, analysis: Analysis) -> tuple[tuple[Origin, str], ...]:
    """Its own time, the largest interferers and the blocker, each where it is declared."""
    tasks, blocking = analysis.tasks, response.blocking
    task = tasks[response.task.name]
    notes = [(task.origin, f"{task.element} itself runs for up to {rounded.up(task.wcet)}")]
    if response.jitter:
        late = f"the release of {task.element} is late by up to {rounded.up(response.jitter)}"
        notes.append((task.origin, late))
    notes += _preempting(response, analysis)
    if blocking is not None:
        origin = tasks[blocking.user].origin if blocking.user in tasks else task.origin
        notes.append(
            (
                origin,
                f"{blocking.user} may block {task.element} for {rounded.up(blocking.length)} "
                f"inside {blocking.resource}",
            )
        )
    return tuple(notes)


def _preempting(response: Response, analysis: Analysis) -> Iterator[tuple[Origin, str]]:
    """The tasks that take most of its time or, where it has no bound, of its core."""
    name = response.task.name
    found = [(share.task, taken(share)) for share in response.interference]
    if response.bound is None:
        others = response.level.order[: response.level.reach]
        load = sorted(others, key=lambda other: -other.utilisation)
        found = [
            (other, f"{rounded.percent(other.utilisation)} of the core")
            for other in load
            if other.name != name
        ]
    for other, what in found[:LARGEST]:
        text = f"{other.name}, period {rounded.down(other.period)}, preempts {name}: {what}"
        yield analysis.tasks[other.name].origin, text


def taken(share: Interference) -> str:
    """The sum that the time of an interferer is made of."""
    wcet, time = share.task.plain_wcet, rounded.up(share.time)
    if share.time == share.releases * wcet:
        return f"{share.releases} x {rounded.up(wcet)} = {time}"
    return f"{share.releases} releases, not all with every row, take {time}"


def _of_message(response: FrameResponse, analysis: Analysis) -> Diagnostic:
    """The error of one message."""
    message = analysis.messages[response.frame.name]
    takes = rounded.up(response.frame.transmission_time)
    notes = [(message.origin, f"the frame of {message.name} takes {takes}")]
    if response.frame.jitter:
        late = f"the controller gets {message.name} up to {rounded.up(response.frame.jitter)} late"
        notes.append((message.origin, late))
    notes += [
        (
            analysis.messages[share.frame.name].origin,
            f"{share.frame.name} goes before {message.name}: {share.instances} x "
            f"{rounded.up(share.frame.transmission_time)} = {rounded.up(share.time)}",
        )
        for share in response.interference[:LARGEST]
    ]
    if response.bound is None:
        return error(
            NO_BOUND,
            message.origin,
            f"message {message.name} has no response-time bound: {no_bound_reason(response)}",
            notes=notes,
            hint="lengthen periods, or raise the bit rate",
        )
    bound, deadline = rounded.against(response.bound, message.limit)
    hint = "let its sender finish earlier, or set `deadline:`"
    if response.interference:
        hint = f"give it a lower identifier, {hint}"
    return error(
        MISSED,
        message.origin,
        f"message {message.name} misses its deadline: R = {bound} > D = {deadline}",
        notes=notes,
        hint=hint,
    )


def _of_bus(bus: Bus, analysis: Analysis) -> Diagnostic:
    """The error of one bus."""
    frames = sorted(analysis.network.frames[bus.name], key=lambda frame: -frame.utilisation)
    notes = []
    for frame in frames[:LARGEST]:
        message = analysis.messages[frame.name]
        notes.append(
            (
                message.origin,
                f"{message.name} takes {rounded.percent(frame.utilisation)}: "
                f"{rounded.up(frame.transmission_time)} every {rounded.down(frame.period)}",
            )
        )
    return error(
        BUS_OVERLOAD,
        bus.origin,
        f"{bus.name} may be loaded to {rounded.percent(analysis.bus_load(bus))}",
        notes=notes,
        hint="lengthen periods, or raise the bit rate",
    )


def _of_receptions(analysis: Analysis, causes: Causes) -> Iterator[Diagnostic]:
    """An error for each reception that takes frames more slowly than they come."""
    for processor in analysis.system.processors:
        received = analysis.system.received(processor.released_by, processor.node)
        taken_here = [one.message for one in received]
        load = sum((Fraction(processor.period, m.period) for m in taken_here), Fraction(0))
        if load > 1 or any(message in analysis.undelivered for message in taken_here):
            if load <= 1 and causes.leave_out(causes.of_reception(processor.name)):
                continue
            lost = "frames will be lost" if load > 1 else "a frame may wait without bound"
            yield error(
                NO_BOUND,
                processor.origin,
                f"{processor.name} takes a frame every {rounded.up(processor.period)}, but "
                f"its messages need {rounded.percent(load)} of that rate: {lost}",
                notes=[
                    (m.origin, f"{m.name} comes every {rounded.down(m.period)}") for m in taken_here
                ],
                hint="shorten the period of the processor",
            )


def _of_queues(analysis: Analysis) -> Iterator[Diagnostic]:
    """Queues that may lose values: a warning where no depth is known to hold them all."""
    for one in analysis.short_queues:
        lost = f"but `{one.key}` is {one.given}: the queue can overflow"
        hint = "let it be read more often, or filled less often"
        if one.needed is not None:
            message = f"up to {one.needed} {one.what}, {lost}"
            hint = f"give it `{one.key}: {one.needed}`, or {hint}"
            yield error(QUEUE_SHORT, one.origin, message, hint=hint)
        elif analysis.found.met:
            yield warning(QUEUE_OPEN, one.origin, f"any number of {one.what}, {lost}", hint=hint)


def _of_streams(analysis: Analysis) -> Iterator[Diagnostic]:
    """A warning for each stream that is late, unless a task of its core has no bound itself.

    Of one that is not late, a warning where the trace is too short.
    """
    for one in analysis.streams:
        core = one.response.task.core
        if one.holds:
            if one.is_short:
                yield _trace_is_short(one)
        elif all(r.bound is not None for r in analysis.responses if r.task.core == core):
            yield _stream_is_late(one, analysis)


def _trace_is_short(one: StreamResponse) -> Diagnostic:
    within = rounded.up(one.unread or 0)
    message = f"up to {one.waiting} records may wait in the trace of {one.node.name} "
    message += f"within {within}, but `trace` is {one.node.trace_depth}"
    hint = "let its rows run less often"
    if (one.waiting or 0) <= TRACE_LIMIT:
        hint = f"give it `trace: {one.waiting}`, or {hint}"
    return warning(TRACE_SHORT, one.node.origin, message, hint=hint)


def _stream_is_late(one: StreamResponse, analysis: Analysis) -> Diagnostic:
    message = f"{one.name} has no response-time bound: {no_bound_reason(one.response)}"
    if one.bound is not None:
        bound, period = rounded.against(one.bound, SNAPSHOT_PERIOD)
        message = f"{one.name} does not keep ten snapshots a second: R = {bound} > T = {period}"
    hint = "shorten worst-case execution times, lengthen periods, or record fewer values"
    notes = tuple(_preempting(one.response, analysis))
    return warning(STREAM_LATE, one.origin, message, notes=notes, hint=hint)


def _of_chains(analysis: Analysis, causes: Causes) -> Iterator[Diagnostic]:
    """An error for each chain without a way, and for each that may take too long."""
    for chain in analysis.system.chains:
        gap = chain.gap
        if gap is not None:
            message = (
                f"the chain {chain.name} is broken: no values go from {gap.before} to {gap.after}"
            )
            yield error(NO_WAY, chain.origin, message, hint=_gap_hint(gap))
    for chain, found in analysis.limited:
        pairs = (("reaction", found.reaction, chain.reaction), ("age", found.age, chain.age))
        for what, value, limit in pairs:
            if limit is not None and (value is None or value > limit):
                if causes.leave_out(causes.of_chain(found)):
                    continue
                yield _late_chain(chain, found, what, value, limit)


def _gap_hint(gap: Gap) -> str:
    """The change that closes the gap, as far as the model determines it."""
    if gap.event is not None:
        name, source, region = gap.event
        return (
            f"the event {name} leads from {source} to {region}; a chain follows values: "
            f"let {region} read what {source} holds or writes"
        )
    if gap.turned:
        return f"values go from {gap.after} to {gap.before}: give the two in that order"
    ends, begins = _few(gap.reached), _few(gap.sources)
    first = f"values of {gap.before} end at {ends}" if ends else f"nothing uses {gap.before}"
    then = f"those of {gap.after} begin at {begins}" if begins else f"nothing leads to {gap.after}"
    return f"{first}, and {then}: connect the two, or let a row read the one and make the other"


def _few(places: Sequence[str]) -> str:
    """Some places, and how many more there are."""
    more = f" and {len(places) - LARGEST} more" if len(places) > LARGEST else ""
    return ", ".join(places[:LARGEST]) + more


def _late_chain(
    chain: Chain, found: Latency, what: str, value: int | None, limit: int
) -> Diagnostic:
    """The error of a limit that is not met, with the slowest hops."""
    hops = [(hop.step.name, (hop.wait or 0) + (hop.response or 0)) for hop in found.hops]
    hops.sort(key=lambda hop: -hop[1])
    takes, shown = "has no bound", rounded.down(limit)
    if value is not None:
        longest, shown = rounded.against(value, limit)
        takes = f"may take {longest}"
    return error(
        CHAIN_LATE,
        chain.origin,
        f"the {what} of {chain.name} {takes}; its limit is {shown}",
        notes=[(chain.origin, reason) for reason in _unbounded(found, what)]
        or [
            (chain.origin, f"{name} takes up to {rounded.up(time)}")
            for name, time in hops[:LARGEST]
        ],
        hint=_chain_hint(chain, found, what, value),
    )


def _chain_hint(chain: Chain, found: Latency, what: str, value: int | None) -> str:
    if value is not None:
        return "let its rows run more often, or in one processor in the order of the chain"
    carried = any(isinstance(place, Carried) for place in chain.way)
    if what == "age" and not carried and found.reaction is not None:
        return "limit the reaction instead"
    if what == "age" and carried and any(_ages(hop) for hop in found.hops):
        return (
            "limit the reaction instead; or, if the sender of the message queues one every period "
            "exactly, give it `sporadic: no`"
        )
    return "limit the parts of it before and behind that"


def _ages(hop: HopLatency) -> bool:
    """Whether its next value is as late as a sporadic one, and the last one is used meanwhile."""
    taken = hop.step.hop in (HopKind.QUEUED, HopKind.WOKEN)
    return hop.renewal is None and not hop.step.keeps and not taken


def _unbounded(found: Latency, what: str) -> Iterator[str]:
    """The reasons of the hops that have no bound."""
    begun = found.hops[0].step.name
    seldom = False
    for before, hop in zip((None, *found.hops), found.hops, strict=False):
        step = hop.step
        begun = begun if step.hop is HopKind.RELEASED else step.name
        if hop.response is None:
            yield f"{step.name} has no bound of its response"
        elif what == "age" and step.keeps:
            seldom = True
            yield step.keeps
        elif what == "age" and _ages(hop):
            if seldom:
                continue  # it follows from that
            yield f"{begun} is sporadic: its next value may come at any later time"
        elif step.waits and (what == "reaction" or step.hop is HopKind.WOKEN):
            yield step.waits
        elif step.hop is HopKind.QUEUED and hop.wait is None and before:
            many = f"{step.puts} values at once" if step.puts > 1 else "them faster"
            yield f"{step.name} takes one value in a job, and {before.step.name} may put {many} in"
        elif step.hop is HopKind.SAMPLED and hop.wait is None:
            yield f"{step.name} has no period, so the age of its output is unbounded"
