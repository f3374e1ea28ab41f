# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The outcome of an analysis in sentences: verdict, loads, room left, and its limit."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction

from ravenchart import rounded
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.holistic import Holistic
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.system.critical import GIVEN
from ravenchart.analysis.system.stream import StreamResponse
from ravenchart.analysis.system.timing import Analysis, Verdict
from ravenchart.analysis.units import microseconds
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.logical import logical_of
from ravenchart.gen.model.system import System

WORDS = {Verdict.MET: "ok", Verdict.MISSED: "MISS", Verdict.NO_BOUND: "NONE"}
"""The verdict of a row in a word."""


@dataclass(frozen=True, slots=True)
class TextPart:
    """A part of a window: its kind, its name, and its sum."""

    kind: str
    """``jitter``, ``own``, ``blocking``, ``interference`` or ``overhead``."""
    name: str
    sum_of: str
    time: int


def verdict_line(analysis: Analysis) -> str:
    """The outcome in one line."""
    name, failed = analysis.system.name, analysis.failed()
    tasks, messages = len(analysis.tasks), len(analysis.messages)
    total = f"{tasks} tasks" + (f", {messages} messages" if messages else "")
    over = [
        f"{name} ({rounded.percent(load)})" for name, load in analysis.loads.items() if load > 1
    ]
    late = [chain.name for chain, found in analysis.limited if not found.met]
    parts = []
    if failed:
        more = f" and {len(failed) - 1} more" if len(failed) > 1 else ""
        parts.append(
            f"{len(failed)} of {tasks + messages} deadlines may be missed: {failed[0]}{more}"
        )
    if over:
        parts.append(f"overloaded: {', '.join(over)}")
    if late:
        parts.append(f"too slow: {', '.join(late)}")
    lost = [message.name for message in analysis.undelivered]
    short = [queue.key for queue in analysis.short_queues if queue.needed is not None]
    if short and not failed:
        parts.append(f"queues too short: {', '.join(dict.fromkeys(short))}")
    if lost and not failed:
        parts.append(f"not received in time: {', '.join(lost)}")
    return f"{name}: {'; '.join(parts) or f'every deadline is met ({total})'}"


def overload_lines(loads: Mapping[str, Fraction]) -> tuple[str, ...]:
    """One line for each core or bus that needs more than all of its time."""
    over = {name: rounded.percent(share) for name, share in loads.items() if share > 1}
    return tuple(
        f"{name or 'the core'} is overloaded: what runs on it needs {share} of its time"
        for name, share in over.items()
    )


def load_lines(analysis: Analysis) -> tuple[str, ...]:
    """The load of each core and bus, the growth of execution times, and the limit of growth."""
    system = analysis.system
    lines = list(overload_lines(analysis.loads))
    lines += [
        f"{core}: core load {rounded.percent(analysis.utilisation(core))}"
        for node in system.nodes
        for core in node.core_names
    ]
    of_buses = ((bus.name, rounded.percent(analysis.bus_load(bus))) for bus in system.buses)
    lines += [f"{name}: bus load {load}, every frame at its longest" for name, load in of_buses]
    return (*lines, growth_line(analysis), *binding_lines(analysis))


def growth_line(analysis: Analysis) -> str:
    """The margin of the whole system in one sentence."""
    scaling = analysis.scaling
    if scaling is None:
        return "no execution time, however short, meets every deadline"
    change = scaling.factor - 1
    if change >= 0:
        share = rounded.room(change)
        return f"all execution times may grow by {share} before a task or frame is late"
    return f"all execution times must shrink by {rounded.percent(-change)} to meet every deadline"


def binding(analysis: Analysis) -> str | None:
    """The worst failing item or, if none fails, the first to fail as execution times grow."""
    if failed := analysis.failed():
        return failed[0]
    return None if analysis.scaling is None else analysis.scaling.binding


def binding_lines(analysis: Analysis) -> tuple[str, ...]:
    """The constraint that limits the system, in one sentence."""
    name = binding(analysis)
    if name is None:
        return ()
    slack = analysis.slack(name)
    room = "has no bound"
    if slack is not None:
        room = f"misses by {rounded.up(-slack)}" if slack < 0 else ""
        room = room or f"is the tightest, with a slack of {rounded.down(slack)}"
    parts = sorted(window_parts(analysis, name), key=lambda part: -part.time)
    if not parts:
        return (f"{name} {room}",)
    total = sum(part.time for part in parts)
    share = rounded.percent(Fraction(parts[0].time, total))
    return (f"{name} {room}: {share} of its response is {parts[0].name}",)


def window_parts(analysis: Analysis, name: str) -> tuple[TextPart, ...]:
    """The parts of the response of a task or message, its lateness at the start included."""
    return response_parts(analysis.found.responses[name], analysis.network.released_by.get(name))


def response_parts(
    response: Response | FrameResponse, releaser: str | None
) -> tuple[TextPart, ...]:
    """The same of a response, released by that task or message if any."""
    if response.bound is None:
        return ()
    parts = _task_parts(response) if isinstance(response, Response) else _frame_parts(response)
    jitter = response.late if isinstance(response, Response) else response.frame.jitter
    if jitter:
        source = f"the jitter inherited from {releaser}" if releaser else "its late release"
        parts.insert(0, TextPart("jitter", source, "", jitter))
    return tuple(part for part in parts if part.time)


def instant_lines(system: System) -> tuple[str, ...]:
    """Logical execution times and chosen or given phases, each in a sentence."""
    times = ((one, logical_of(system, one.name)) for one in system.processors)
    logical = [
        f"{one.name} {shown(time)}{' on chains' if one.logical is None else ''}"
        for one, time in times
        if time is not None
    ]
    phases = [
        f"{slot.element} {shown(Ns(slot.phase * processor.period))}"
        for processor in system.processors
        for slot in processor.slots
        if slot.phase
    ]
    found = []
    if logical:
        found.append(f"Logical execution times: {', '.join(logical)}.")
    if phases:
        found.append(f"Phases: {', '.join(phases)}. All other rows run from release 0 on.")
    return tuple(found)


def offset_lines(found: Iterable[Response | FrameResponse]) -> tuple[str, ...]:
    """The responses that hold by offsets, in one sentence; none where all hold for any."""
    names = [r.task.name for r in found if isinstance(r, Response) and r.alignment is not None]
    if not names:
        return ()
    return (f"By their offsets: R of {', '.join(names)}. All others hold for any offsets.",)


def stream_lines(analysis: Analysis) -> tuple[str, ...]:
    """The load and the limits of each stream to a monitor; none where no node declares one."""
    return tuple(line for one in analysis.streams for line in lines_of_stream(one))


def lines_of_stream(one: StreamResponse) -> Iterator[str]:
    """The load and the limits of one stream."""
    load = rounded.percent(one.load)
    yield f"{one.name} is the main program, below all tasks: core load {load} with it."
    if one.apart is not None:
        late = "" if one.holds else ": not ten a second"
        yield f"Its snapshots are at most {rounded.up(one.apart)} apart{late}."
    if one.node.trace_depth and one.records is not None:
        values = one.records.values
        also = f" and {values:,} recorded values" if values else ""
        kept = f"{one.node.trace_depth:,} is {'too short' if one.is_short else 'enough'}"
        yield f"At most {one.records.trace:,} records{also} wait in its trace: {kept}."


def distance_lines(found: Holistic) -> tuple[str, ...]:
    """The responses that the distances in chains make shorter, in two sentences."""
    if not found.ends:
        return ()
    names = ", ".join(found.ends)
    return (
        f"By the distances of the steps of chains: R of {names}. "
        "Their parts are those of the longer bound without distances.",
    )


def _task_parts(response: Response) -> list[TextPart]:
    jobs = response.worst_job + 1
    parts = [TextPart("own", "its own execution", f"{jobs} jobs" if jobs > 1 else "", response.own)]
    if response.blocking is not None:
        inside = f"{response.blocking.user} in {response.blocking.resource}"
        parts.append(TextPart("blocking", inside, "", response.blocking.length))
    if response.task.held:
        parts.append(TextPart("blocking", GIVEN, "", response.task.held))
    by_name = {share.task.name: share for share in response.interference}
    for family, members in families(by_name).items():
        each = [by_name[member] for member in members]
        releases = sum(share.releases for share in each)
        wcets = {share.task.plain_wcet for share in each}
        time = sum(share.time for share in each)
        plain = len(wcets) == 1 and releases * max(wcets) == time
        longest = microseconds(max(wcets))
        sum_of = f"{releases} x {longest}" if plain else f"{releases} releases"
        parts.append(TextPart("interference", family, sum_of, time))
    lost = response.overheads
    for what, count, time in (
        ("context switches", lost.switches, lost.switch_time),
        ("ticks", lost.ticks, lost.tick_time),
        ("making jobs ready", lost.releases, lost.release_time),
    ):
        if time:
            parts.append(
                TextPart("overhead", what, f"{count} x {microseconds(time // count)}", time)
            )
    return parts


def _frame_parts(response: FrameResponse) -> list[TextPart]:
    own = response.own + response.frame.transmission_time
    parts = [TextPart("own", "its own frame", "", own)]
    blocker = response.blocker or "a frame of somebody else"
    parts.append(TextPart("blocking", blocker, "", response.blocked))
    for share in response.interference:
        sum_of = f"{share.instances} x {microseconds(share.frame.transmission_time)}"
        parts.append(TextPart("interference", share.frame.name, sum_of, share.time))
    parts.append(TextPart("overhead", "errors", "", response.errors))
    return parts


def families(elements: Iterable[str]) -> dict[str, list[str]]:
    """Elements by a common name: those that differ in their last part only share one.

    ``bus.driver_rx.a`` and ``bus.driver_rx.b`` are ``bus.driver_rx.*``; a single
    element keeps its own name.
    """
    found: dict[str, list[str]] = {}
    for element in elements:
        head, dot, _ = element.rpartition(".")
        found.setdefault(f"{head}.*" if dot else element, []).append(element)
    return {name if len(all_) > 1 else all_[0]: all_ for name, all_ in found.items()}
