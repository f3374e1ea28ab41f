# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random cause-effect chains over simulated networks: ages, reactions and backlogs as they were.

A job reads when it begins to execute, and writes when it is complete. Both lie within the times
that the bounds count.
"""

from __future__ import annotations

import random
from bisect import bisect_right
from dataclasses import dataclass, field

from ravenchart.analysis.core.chains import ChainStep, HopKind, TimedChain
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.simulation.engine import ObservedTimes


def random_chain(network: Network, chance: random.Random) -> TimedChain | None:
    """Two or three tasks that read at their own times, perhaps with all that they release.

    None where the network has too few tasks for it.
    """
    roots = [t.name for t in network.tasks if not t.rows and t.name not in network.released_by]
    if len(roots) < 2:
        return None
    followers = {by: name for name, by in network.released_by.items()}
    steps: list[ChainStep] = []
    for name in chance.sample(roots, min(len(roots), chance.randint(2, 3))):
        queued = bool(steps) and chance.random() < 0.5
        kind = HopKind.QUEUED if queued else HopKind.SAMPLED
        steps.append(ChainStep(name, kind, takes=chance.randint(1, 3) if queued else 1))
        while (name := followers.get(name, "")) and chance.random() < 0.8:
            steps.append(ChainStep(name, HopKind.RELEASED))
    return TimedChain("chain", tuple(steps))


@dataclass(slots=True)
class ObservedChain:
    """The longest times of a chain, and the most items that waited before each of its steps."""

    age: int = 0
    reaction: int = 0
    backlogs: dict[str, int] = field(default_factory=dict)
    outputs: int = 0


@dataclass(frozen=True, slots=True)
class _Job:
    """A job: what its output was made of, as the number of a job of the first step."""

    start: int
    end: int
    made_of: int | None
    is_new: bool = True
    """Whether it made an output; one that finds a queue empty makes none."""


def observed_chain(chain: TimedChain, seen: ObservedTimes) -> ObservedChain:
    """What happened on a chain in a recorded simulation."""
    found = ObservedChain()
    spans = {step.name: _spans(step.name, seen) for step in chain.steps}
    first, *others = chain.steps
    jobs = [_Job(*span, number) for number, span in enumerate(spans[first.name])]
    for step in others:
        jobs = _HOPS[step.hop](step, jobs, spans[step.name], found)
    begun = [start for start, _ in spans[first.name]]
    made = [(one.made_of, one.end) for one in jobs if one.is_new and one.made_of is not None]
    found.outputs = len(made)
    for number, end in made:
        found.age = max(found.age, end - begun[number])
    for number, start in enumerate(begun):
        knows = next((end for known, end in made if known > number), None)
        if knows is not None:
            found.reaction = max(found.reaction, knows - start)
    return found


def _spans(name: str, seen: ObservedTimes) -> list[tuple[int, int]]:
    """Beginning and end of the execution of each complete instance."""
    spans: dict[int, tuple[int, int]] = {}
    for one in seen.stretches:
        if one.name == name and one.number < seen.completed.get(name, 0):
            start, end = spans.get(one.number, (one.start, one.end))
            spans[one.number] = min(start, one.start), max(end, one.end)
    return [spans[number] for number in sorted(spans)]


def _released(
    _step: ChainStep, before: list[_Job], spans: list[tuple[int, int]], _found: ObservedChain
) -> list[_Job]:
    pairs = zip(before, spans, strict=False)
    return [_Job(*span, one.made_of, one.is_new) for one, span in pairs]


def _sampled(
    _step: ChainStep, before: list[_Job], spans: list[tuple[int, int]], _found: ObservedChain
) -> list[_Job]:
    ends = [one.end for one in before]
    jobs = []
    for start, end in spans:
        last = bisect_right(ends, start)
        jobs.append(_Job(start, end, before[last - 1].made_of if last else None))
    return jobs


def _queued(
    step: ChainStep, before: list[_Job], spans: list[tuple[int, int]], found: ObservedChain
) -> list[_Job]:
    items = [(one.end, one.made_of) for one in before if one.is_new and one.made_of is not None]
    jobs: list[_Job] = []
    taken = put = 0
    for start, end in spans:
        while put < len(items) and items[put][0] <= start:
            put += 1
            found.backlogs[step.name] = max(found.backlogs.get(step.name, 0), put - taken)
        some = items[taken : min(put, taken + step.takes)]
        taken += len(some)
        last = some[-1][1] if some else jobs[-1].made_of if jobs else None
        jobs.append(_Job(start, end, last, bool(some)))
    return jobs


_HOPS = {HopKind.RELEASED: _released, HopKind.SAMPLED: _sampled, HopKind.QUEUED: _queued}
