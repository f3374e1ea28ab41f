# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Random arrivals and late releases of jobs, as the analysis allows them."""

from __future__ import annotations

import random
from collections.abc import Iterable
from dataclasses import replace

from ravenchart.analysis.core.blocking import Section
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.simulation.phases import InsideSection, Phase, PhaseScenario, none


def chance_scenario(network: Network, chance: random.Random, until: int) -> PhaseScenario:
    """Phases, delays, jobs of cycles, places of sections and allowed faults at random."""
    phases = {
        name: _chance_phase(item, network.sections, chance)
        for name, item in network.items().items()
    }
    longest = max((task.period for task in network.tasks), default=0)
    epochs = {(task.core, task.epoch): 0 for task in network.tasks if task.epoch}
    epochs = {epoch: chance.randrange(2 * longest) for epoch in epochs}
    for task in network.tasks:
        if task.epoch:
            phase = phases[task.name]
            phases[task.name] = replace(phase, first=phase.first + epochs[task.core, task.epoch])
    return PhaseScenario(
        phases, {name: _chance_faults(network, name, chance, until) for name in network.buses}
    )


def _chance_phase(item: Task | Frame, sections: Iterable[Section], chance: random.Random) -> Phase:
    jitter = item.jitter
    late = chance.choice((none, lambda _: jitter, lambda _: chance.randint(0, jitter)))
    first = chance.randrange(item.period)
    if isinstance(item, Frame):
        rare = item.sporadic and chance.random() < 0.5
        return Phase(first, late, (lambda _: chance.randrange(item.period)) if rare else none)
    inside = _chance_inside([s for s in sections if s.user == item.name], item, chance)
    if item.offset is not None:
        return Phase(item.offset, late, inside=inside)
    sporadic = item.sporadic and chance.random() < 0.5
    return Phase(
        first,
        late,
        (lambda _: chance.randrange(item.period)) if sporadic else none,
        chance.randrange(item.frame_count),
        inside,
    )


def _chance_inside(
    sections: list[Section], task: Task, chance: random.Random
) -> tuple[InsideSection, ...]:
    """The sections in any order, as many as fit a job, with a random rest between them."""
    found = []
    at = 0
    least = min(task.wcet + sum(row.wcet for row in rows) for rows in task.frames)
    for section in chance.sample(sections, len(sections)):
        room = least - at - section.length
        if room >= 0:
            found.append(InsideSection(at + chance.randint(0, room), section))
            at = found[-1].start + section.length
    return tuple(found)


def _chance_faults(
    network: Network, bus: str, chance: random.Random, until: int
) -> tuple[int, ...]:
    """As many faults as the bus's model allows, or fewer."""
    model = network.buses[bus].errors
    if model is None:
        return ()
    times = []
    at = chance.randrange(model.period)
    while at < until:
        times.append(at)
        at += model.period + chance.choice((0, chance.randrange(model.period)))
    extra = [chance.randrange(until) for _ in range(model.burst - 1)]
    return tuple(sorted(times + extra))
