"""How long values took along the chains of a system in a run, from its trace.

A journey begins when the first row of a chain runs, or a message from outside arrives,
and goes on with what comes next in the trace at each place of the chain's way. The
reaction that a journey shows is that to an input which the run before its first row
has just missed. Frames are told apart by their order only: where several of a message
are under way, a journey may look shorter than it was, never longer.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from ravenchart.gen.model.system import Carried, Chain, System

from .observed import Observation
from .timing import Analysis


@dataclass(frozen=True, slots=True)
class Journey:
    """The longest reaction that a run showed of a chain, of so many, beside its bound, in ns."""

    chain: str
    count: int
    observed: int
    bound: int
    limit: int
    places: int = 1
    """Rows and messages on the way, each of which a host can delay."""
    times: tuple[int, ...] = field(default=(), compare=False)
    """Every reaction that was seen."""

    @property
    def exceeded(self) -> bool:
        """What was seen is longer than the bound."""
        return self.observed > self.bound

    def is_explained(self, withheld: int) -> bool:
        """It is longer by no more than a host takes that withholds the core at each place."""
        return self.exceeded and self.observed <= self.bound + self.places * withheld


def journeys(analysis: Analysis, seen: Observation) -> tuple[Journey, ...]:
    """The chains whose reaction has a bound and a limit, and was seen."""
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
    starts, *others = _stages(chain, system, seen)
    first = [start for start in starts if start >= seen.ready]
    last = seen.executions.get(str(chain.way[-1]), 0)
    origins = first if isinstance(chain.way[0], Carried) else (None, *first)
    found = []
    for origin, start in zip(origins, first, strict=False):
        end = _end(start, others)
        if origin is not None and end is not None:
            found.append(end + last - origin)
    return found


def _end(start: int, stages: Sequence[Sequence[int]]) -> int | None:
    """When what began then has come through all stages; None when it has not."""
    now = start
    for stage in stages:
        place = bisect_left(stage, now)
        if place == len(stage):
            return None
        now = stage[place]
    return now


def _stages(chain: Chain, system: System, seen: Observation) -> Iterator[Sequence[int]]:
    """When something happened at each place of a chain's way that the trace tells of."""
    sources = {message.name: message.source for message in system.messages}
    inputs = {f"{i.name}.{port.name}" for i in system.instances for port in i.component.inputs()}
    rows = {slot.element for slot in system.slots}
    for place in chain.way:
        if isinstance(place, Carried):
            kind = "arrived" if sources[place.message] is None else "sent"
            yield [r.time for r in seen.of(kind, place.message)]
        elif place in inputs:
            yield [r.time for r in seen.of("arrived", place)]
            yield [r.time for r in seen.of("activity", f"{place.rpartition('.')[0]}.ports")]
        elif place in rows:
            yield [r.time for r in seen.of("activity", place)]
