# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The timing of a whole system: every response, latency and load, from `analysis.core`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from ravenchart.analysis.core import holistic
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.holistic import Holistic, Network
from ravenchart.analysis.core.responses import Level, Response, RowResponse
from ravenchart.analysis.core.sensitivity import NetworkScaling, network_scaling
from ravenchart.analysis.core.tasks import is_phased, with_full_jobs, without_phases
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.system import Chain, Stop, System
from ravenchart.gen.model.system import Task as ModelTask
from ravenchart.gen.origins import Origin

from . import latencies
from .depths import Depth, depths
from .latencies import Delivery, Latencies
from .network import network_of
from .stream import StreamResponse, streams
from .transport import Transfer, transfers

if TYPE_CHECKING:
    from .graph import Ways

FACTOR_STEPS = 1000
"""Factors of execution times are counted in 1 / this."""


class Verdict(Enum):
    """The verdict on one task or message."""

    MET = "met"
    MISSED = "missed"
    NO_BOUND = "no bound"


@dataclass(frozen=True)
class Analysis:
    """The analysis of a system; names are those of its elements.

    ``found`` counts the rows of a table in the jobs that run them, and these jobs where
    offsets place them. ``plain`` has the bounds with every row in every job at any time, as
    in a calculation by hand.
    """

    system: System
    network: Network
    found: Holistic
    plain: Holistic

    @cached_property
    def tasks(self) -> dict[str, ModelTask]:
        """The tasks of the system by element."""
        return {task.element: task for task in self.system.tasks}

    @cached_property
    def messages(self) -> dict[str, Message]:
        """The messages of the system by element."""
        return {message.element: message for message in self.system.frames}

    def origin(self, name: str) -> Origin:
        """The location of a task or message in the model."""
        return (self.tasks.get(name) or self.messages[name]).origin

    @cached_property
    def for_all_offsets(self) -> Analysis:
        """The same where offsets are unknown: itself where neither these nor phases count.

        Phases keep rows apart in a job of their own task; others count each row by itself. A task
        that is not done before its next release has no phases.
        """
        phased = {task.name for task in self.network.tasks if is_phased(task)}
        if not phased and not any(response.alignment for response in self.responses):
            return self
        tasks = [
            replace(task.at_any_time(), summed=task.name in phased) for task in self.network.tasks
        ]
        network = replace(self.network, tasks=tuple(tasks))
        found = holistic.analyse(network)
        late = {name for name in phased if not _is_alone(found.responses[name])}
        if late:
            tasks = [without_phases(task) if task.name in late else task for task in tasks]
            network = replace(network, tasks=tuple(tasks))
            found = holistic.analyse(network)
        return replace(self, network=network, found=found)

    @cached_property
    def responses(self) -> tuple[Response, ...]:
        """The responses of the tasks, in the system's order."""
        return tuple(r for r in self.found.responses.values() if isinstance(r, Response))

    def frames(self, bus: Bus) -> tuple[FrameResponse, ...]:
        """The responses of a bus's messages, most urgent first."""
        found = (self.found.responses[f.name] for f in self.network.frames[bus.name])
        sent = [one for one in found if isinstance(one, FrameResponse)]
        return tuple(sorted(sent, key=lambda one: one.frame.rank))

    def response(self, element: str) -> Response:
        """The response of the task with that id; KeyError where there is none."""
        response = self.found.responses[element]
        if not isinstance(response, Response):
            raise KeyError(element)
        return response

    def rows(self) -> Iterator[tuple[ModelTask, RowResponse]]:
        """Every row of every table with its response, where it has a bound."""
        for response in self.responses:
            for row in response.rows:
                yield self.tasks[response.task.name], row

    def verdict(self, name: str) -> Verdict:
        """Met when the time from the event that leads to it is at most its deadline."""
        if self.found.responses[name].bound is None:
            return Verdict.NO_BOUND
        return Verdict.MET if self.found.meets(name) else Verdict.MISSED

    def slack(self, name: str) -> int | None:
        """Deadline less response; negative when missed, None without a bound."""
        needed = self.found.from_event(name)
        return None if needed is None else self.found.deadline(name) - needed

    def worst_first(self) -> tuple[str, ...]:
        """Tasks and messages: those without a bound, then by slack, smallest first."""

        def key(name: str) -> tuple[bool, int]:
            slack = self.slack(name)
            return slack is not None, slack or 0

        return tuple(sorted(self.found.responses, key=key))

    def failed(self) -> tuple[str, ...]:
        """The tasks and messages that do not meet their deadlines, worst first."""
        return tuple(n for n in self.worst_first() if self.verdict(n) is not Verdict.MET)

    @property
    def schedulable(self) -> bool:
        """Whether all deadlines and limits are met, all frames are taken, and no value is lost.

        Queues for which no sufficient depth is known do not count.
        """
        kept = all(found.met for _, found in self.limited)
        kept = kept and all(one.in_time for one in self.transfers.values())
        full = any(queue.needed is not None for queue in self.short_queues)
        return self.found.met and not self.undelivered and kept and not full

    @cached_property
    def short_queues(self) -> tuple[Depth, ...]:
        """The queues that may lose values."""
        return tuple(one for one in depths(self) if not one.holds)

    @property
    def undelivered(self) -> tuple[Message, ...]:
        """Messages that may wait for their reception without bound."""
        lost = (one.message for one in self.deliveries.values() if one.bound is None)
        return tuple(dict.fromkeys(lost))

    @property
    def overloaded(self) -> tuple[Bus, ...]:
        """Buses whose messages and errors may need more than all of their time."""
        return tuple(bus for bus in self.system.buses if self.bus_load(bus) > 1)

    def utilisation(self, core: str) -> Fraction:
        """Share of one core that its tasks and overheads may need together."""
        order = tuple(task for task in self.network.tasks if task.core == core)
        return Level(order, len(order), self.network.platforms[core]).load

    def bus_load(self, bus: Bus) -> Fraction:
        """Share of a bus that messages and errors need, at their longest and most frequent."""
        frames = self.frames(bus)
        return frames[-1].level.load if frames else Fraction(0)

    @cached_property
    def loads(self) -> dict[str, Fraction]:
        """The load of each core, then of each bus, by name."""
        cores = [core for node in self.system.nodes for core in node.core_names]
        found = {core: self.utilisation(core) for core in cores}
        return found | {bus.name: self.bus_load(bus) for bus in self.system.buses}

    @cached_property
    def ways(self) -> Ways:
        """The ways that values can take."""
        from .graph import Ways  # only here: its graphs take longer to import than all of this

        return Ways.of(self.system)

    @cached_property
    def streams(self) -> tuple[StreamResponse, ...]:
        """The streams of the nodes to monitors. They count in no other bound, nor as tasks."""
        return tuple(streams(self.system, self.network, self.found))

    @cached_property
    def transfers(self) -> dict[str, Transfer]:
        """Values in several frames, by the reception of their segments."""
        return transfers(self.system, self.deliveries)

    @cached_property
    def deliveries(self) -> dict[str, Delivery]:
        """The delivery of each received message through the queue of its bus, by reception."""
        return latencies.deliveries(self.system, self.found)

    @cached_property
    def _latencies(self) -> Latencies:
        return Latencies.of(self.system, self.network, self.found, self.deliveries)

    def latency(self, way: Sequence[Stop]) -> latencies.Latency:
        """The latency of a way, which lists messages, ports, rows and data."""
        return self._latencies.along(f"{way[0]} to {way[-1]}", way)

    @cached_property
    def limited(self) -> tuple[tuple[Chain, latencies.Latency], ...]:
        """The chains that the model limits, where there is a way, with their latencies."""
        chains = (chain for chain in self.system.chains if chain.way)
        return tuple((chain, self._latencies.of_chain(chain)) for chain in chains)

    @cached_property
    def chains(self) -> tuple[latencies.Latency, ...]:
        """From each message received to each message that it can influence: the shortest way."""
        return tuple(self.latency(way) for way in self.ways.between_messages())

    @cached_property
    def scaling(self) -> NetworkScaling | None:
        """The factor of all execution times together; buses stay as they are."""
        return self.scaling_of(*self.tasks)

    def scaling_of(self, *names: str) -> NetworkScaling | None:
        """The factor of the execution times of these tasks, with all others unchanged."""
        return network_scaling(self.network, set(names), FACTOR_STEPS)


def analyse(system: System) -> Analysis:
    """The timing of ``system``."""
    network = network_of(system)
    summed = replace(network, tasks=tuple(with_full_jobs(task) for task in network.tasks))
    return Analysis(system, network, holistic.analyse(network), holistic.analyse(summed))


def _is_alone(found: Response | FrameResponse) -> bool:
    """Whether a job is done before the next release, so that one job is the busy period."""
    if not isinstance(found, Response) or found.bound is None:
        return False
    return found.jobs == 1 and found.window + found.jitter <= found.task.period
