# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Scripts for pyCPA: the same system, built and analysed by its Python interface.

pyCPA counts a response from the release: its figures are smaller, by up to the own jitter.
It has no sections, so the script brings a scheduler that adds the blocking found here. On
a bus it has no additional bit in which a frame still takes part in arbitration.
"""

from __future__ import annotations

import keyword
from collections.abc import Iterator, Sequence

from ravenchart.analysis.core.blocking import blockers, held_up
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.chains import HopKind, TimedChain
from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task

from .shapes import (
    Unfit,
    dense,
    last_bit,
    names,
    no_errors,
    remarks,
    seldom,
    spelled_out,
    trees,
    unqueued,
)

TAKEN = (*keyword.kwlist, "analysis", "blocked", "blocking", "int", "model", "options", "print",
         "results", "schedulers", "sorted", "str", "sum", "system", "task")  # fmt: skip
"""Names with a meaning of their own in the script."""

HEAD = '''"""{title}, for pyCPA. Times in ns; responses count from the release."""

from pycpa import analysis, model, options, schedulers


class Blocked(schedulers.SPPScheduler):
    """Static priorities, preemptive; each task is held up once by `blocking` ns."""

    def b_plus(self, task, q, details=None, **others):
        demand = own = q * task.wcet + blocking.get(task.name, 0)
        while True:
            needed = own + sum(
                other.wcet * other.in_event_model.eta_plus(demand)
                for other in task.get_resource_interferers()
                if self.priority_cmp(other.scheduling_parameter, task.scheduling_parameter)
            )
            if needed == demand:
                return demand
            demand = needed


'''

TAIL = """
if __name__ == "__main__":
    options.init_pycpa()
    results = analysis.analyze_system(system)
    for task in sorted(results, key=str):
        print(task.name, results[task].wcrt)
"""


def export(network: Network, chains: Sequence[TimedChain], title: str) -> str:
    """The script for ``network``, with the sampling ``chains`` as effect chains of tasks."""
    no_errors(network, "pyCPA")
    for name, bus in network.buses.items():
        if bus.unknown:
            raise Unfit(f"pyCPA needs every message: leave out the unknown ones of bus {name}")
    given = network
    network = spelled_out(unqueued(network))
    trees(network, "pyCPA")
    sampling = [chain for chain in chains if _samples(chain, network)]
    others = [chain for chain in chains if chain not in sampling]
    notes = (*remarks(given, others), *seldom(given), *last_bit(given, "pyCPA"))
    head = [f"#  {line}" for line in notes]
    lines = [*head, *_lines(network), *_effect_chains(network, sampling)]
    return HEAD.format(title=names([title])[title]) + "\n".join(lines) + "\n\n" + TAIL


def _samples(chain: TimedChain, network: Network) -> bool:
    """Every step is a task, all after the first sample, and none is sporadic."""
    items = network.items()
    roots = {name: items[(name, *network.releasers(name))[-1]] for name in items}
    tasks = {task.name for task in network.tasks if not roots[task.name].sporadic}
    sampled = all(step.hop is HopKind.SAMPLED for step in chain.steps[1:])
    return sampled and all(step.name in tasks for step in chain.steps)


def _lines(network: Network) -> Iterator[str]:
    """The statements that build the system."""
    items = names(network.items(), TAKEN)
    cores = list(dict.fromkeys(task.core for task in network.tasks))
    places = names([*cores, *network.frames], [*items.values(), *TAKEN])
    held = blockers(network.tasks, network.sections, network.ceilings)
    least = network.least()
    yield "system = model.System()"
    blocked = {task.name: held_up(task, held.get(task.name)) for task in network.tasks}
    lengths = {items[name]: length for name, length in blocked.items() if length}
    yield f"blocking = {lengths!r}"
    for core in cores:
        yield f'{places[core]} = system.bind_resource(model.Resource("{places[core]}", Blocked()))'
        members = [task for task in network.tasks if task.core == core]
        levels = dense(-task.priority for task in members)
        for task in members:
            level = levels[-task.priority]
            yield _task(items[task.name], places[core], task, level, task.best)
    for bus, frames in network.frames.items():
        scheduler = f"schedulers.SPNPScheduler(cycle_time={network.buses[bus].bit_time})"
        yield f'{places[bus]} = system.bind_resource(model.Resource("{places[bus]}", {scheduler}))'
        levels = dense(frame.rank for frame in frames)
        for frame in sorted(frames, key=lambda frame: frame.rank):
            level = levels[frame.rank]
            yield _task(items[frame.name], places[bus], frame, level, least[frame.name])
    for name, item in network.items().items():
        by = network.released_by.get(name)
        if by is not None:
            yield f"{items[by]}.link_dependent_task({items[name]})"
        else:
            event = f"model.PJdEventModel(P={item.period}, J={item.jitter})"
            yield f"{items[name]}.in_event_model = {event}"


def _task(name: str, place: str, item: Task | Frame, level: int, best: int) -> str:
    longest = item.wcet if isinstance(item, Task) else item.transmission_time
    return (
        f'{name} = {place}.bind_task(model.Task("{name}", wcet={longest}, bcet={best}, '
        f"scheduling_parameter={level}))"
    )


def _effect_chains(network: Network, chains: Sequence[TimedChain]) -> Iterator[str]:
    """The chains as effect chains."""
    items = names(network.items(), TAKEN)
    for number, chain in enumerate(chains, 1):
        members = ", ".join(items[step.name] for step in chain.steps)
        yield f'chain_{number} = model.EffectChain("chain_{number}", tasks=[{members}])'
