# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The observed times of values along the chains of a system in a run, from its trace.

A journey begins when the first row of a chain runs, or a message from outside arrives. It
goes on with the next record in the trace at each place of the chain's way. The
reaction of a journey is that to an input which the run before its first row
has just missed. A row that sends only from some of its jobs reacts in these: a journey
ends where a job sends nothing. Frames are distinguished by their order only. Where several
of a message are under way, a journey may look shorter than it was, never longer. A value of a row
with a logical execution time goes on when it becomes visible.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ravenchart.gen.model.instances import End
from ravenchart.gen.model.logical import first_of, links_by_port, period_of, timed_row
from ravenchart.gen.model.raising import raises_for, released_at, taking_region
from ravenchart.gen.model.system import Carried, Chain, Stop, System

from .observed import Observation
from .timing import Analysis


@dataclass(frozen=True, slots=True)
class Journey:
    """The longest of ``count`` observed reactions of a chain, beside its bound, in ns."""

    chain: str
    count: int
    observed: int
    bound: int
    limit: int
    places: int = 1
    """Rows and messages on the way, each of which a host can delay."""
    times: tuple[int, ...] = field(default=(), compare=False)
    """Every observed reaction."""

    @property
    def exceeded(self) -> bool:
        """Whether the observed reaction is longer than the bound."""
        return self.observed > self.bound

    def is_explained(self, withheld: int) -> bool:
        """Whether it is longer by no more than a host that withholds the core at each place."""
        return self.exceeded and self.observed <= self.bound + self.places * withheld


class Stage(NamedTuple):
    """The times of the records at a place, and the starts of the row whose job wrote them.

    ``later``: when a journey that has come to a record goes on, where that is at another time. A
    value may become visible later, and a row runs after the release that the times have.
    """

    times: Sequence[int]
    jobs: Sequence[int] = ()
    later: Sequence[int] | None = None


def journeys(analysis: Analysis, seen: Observation) -> tuple[Journey, ...]:
    """The chains whose reaction has a bound and a limit, and was observed."""
    found = []
    for chain, latency in analysis.limited:
        if chain.reaction is not None and latency.reaction is not None:
            took = _reactions(chain, analysis.system, seen)
            if took:
                limits = latency.reaction, chain.reaction
                longest = max(took)
                places = len(chain.way)
                found.append(Journey(chain.name, len(took), longest, *limits, places, tuple(took)))
    return tuple(found)


def _reactions(chain: Chain, system: System, seen: Observation) -> list[int]:
    """From each start of the first row to the end of the journey that the next one begins."""
    begin, *others = _stages(chain, system, seen)
    first = [start for start in begin.times if start >= seen.ready]
    last = seen.executions.get(str(chain.way[-1]), 0)
    from_release = chain.of_call or isinstance(chain.way[0], Carried) or _is_awaited(chain, system)
    origins = first if from_release else (None, *first)
    found = []
    for origin, start in zip(origins, first, strict=False):
        end = _end(start, others)
        if origin is not None and end is not None:
            found.append(end + last - origin)
    return found


def _is_awaited(chain: Chain, system: System) -> bool:
    """Whether what the chain begins with releases its first row, so that it waits for no period."""
    first = str(chain.way[0])
    if all(slot.element != first for slot in system.slots):
        return False  # a port or a message
    return system.processor_of(first).released_by_interrupt is not None


def _end(start: int, stages: Sequence[Stage]) -> int | None:
    """The end of the journey that began at ``start``; None when it does not end."""
    now = start
    for times, jobs, later in stages:
        place, following = bisect_left(times, now), bisect_right(jobs, now)
        if place == len(times):
            return None
        if following < len(jobs) and times[place] >= jobs[following]:
            return None  # this job sent nothing
        now = times[place] if later is None else later[place]
    return now


def _stages(chain: Chain, system: System, seen: Observation) -> Iterator[Stage]:
    """The stage of each place of a chain's way that the trace records."""
    messages = {message.name: message for message in system.messages}
    inputs = {End(i.name, port.name) for i in system.instances for port in i.component.inputs()}
    rows = {slot.element for slot in system.slots}
    links = links_by_port(system)
    jobs: Sequence[int] = ()  # of the row before
    row = ""
    before: Stop | None = None
    for place in chain.way:
        if isinstance(place, Carried):
            message = messages[place.message]
            at_once = message.source is not None and message.transmission is None
            kind = "arrived" if message.source is None else "sent"
            times = [r.time for r in seen.of(kind, place.message)]
            yield Stage(times, jobs if at_once else ())
            jobs = ()
        elif place in inputs:
            came = [r.time for r in seen.of("arrived", str(place))]
            ran = [r.time for r in seen.of("activity", system.handler(place))]
            link = links.get(place)
            if link is None or row not in link.rows:
                yield from (Stage(came, jobs), Stage(ran))
            else:
                sent = _releases(system, seen, row, came)
                yield Stage(came, jobs, [release + link.lasting for release in sent])
                yield Stage(_releases(system, seen, link.handler, ran), later=ran)
            jobs = ()
        elif str(place) in rows:
            taken = released_at(system, place)
            if taken is not None and before is not None and raises_for(system, before, place):
                events = [f"{taken.instance}.{e}" for e in taking_region(system, taken).events()]
                raised = sorted(r.time for event in events for r in seen.of("raised", event))
                yield Stage(raised, jobs)
            times = [r.time for r in seen.of("activity", str(place))]
            yield Stage(times)
            jobs, row = times, str(place)
        before = place


def _releases(system: System, seen: Observation, row: str, times: Sequence[int]) -> list[int]:
    """The releases of the executions of a row in which these times are, all deadlines met.

    Releases count from the start of their own node, times from the first start of all.
    """
    place = timed_row(system, row)
    part = seen.parts.get(place[0].node)
    epoch = 0 if part is None else part.start - seen.start
    first, period = epoch + first_of(*place), period_of(*place)
    return [first + (time - first) // period * period for time in times]
