# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The analysis of a plain system, and all of it as one JSON object. Times are whole ns."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from fractions import Fraction

from ravenchart.analysis.core import chains, holistic
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.chains import Latency
from ravenchart.analysis.core.holistic import Holistic, Network
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.core.sensitivity import NetworkScaling, network_scaling
from ravenchart.analysis.units import ratio

from .build import PlainSystem

DETAILED = 300
"""With more tasks and messages than this, neither the terms nor the scaling are worked out."""

Json = dict[str, object]


@dataclass(frozen=True, slots=True)
class PlainResult:
    """The responses and latencies of a system; ``scaling`` is None where there is none."""

    system: PlainSystem
    found: Holistic
    latencies: tuple[Latency, ...]
    detailed: bool
    scaling: NetworkScaling | None

    @property
    def met(self) -> bool:
        """Whether every deadline and every limit of a chain is met."""
        return self.found.met and all(latency.met for latency in self.latencies)


def analyse_plain(system: PlainSystem) -> PlainResult:
    """All responses and latencies; ValueError for a chain that the system does not have."""
    network = system.network
    found = holistic.analyse(network)
    latencies = tuple(chains.latency(chain, network, found) for chain in system.chains)
    detailed = len(found.responses) <= DETAILED
    scaling = network_scaling(network) if detailed else None
    return PlainResult(system, found, latencies, detailed, scaling)


def loads(network: Network) -> dict[str, Fraction]:
    """Share of each core and bus that its tasks or messages need, overheads apart."""
    found: dict[str, Fraction] = {}
    for task in network.tasks:
        found[task.core] = found.get(task.core, Fraction(0)) + task.utilisation
    for bus, frames in network.frames.items():
        found[bus] = sum((frame.utilisation for frame in frames), Fraction(0))
    return found


def everything(result: PlainResult) -> Json:
    """Everything, for `json.dumps`; a response without a bound is null, with the reason."""
    network = result.system.network
    found = result.found
    factor = result.scaling.factor if result.scaling else None
    return {
        "unit": "ns",
        "met": result.met,
        "scaling": None if factor is None else f"{factor.numerator}/{factor.denominator}",
        "binding": result.scaling.binding if result.scaling else None,
        "terms": result.detailed,
        "load": {name: ratio(share) for name, share in loads(network).items()},
        "tasks": [
            _task(response, found, result.detailed)
            for response in found.responses.values()
            if isinstance(response, Response)
        ],
        "messages": [
            _message(response, bus, found, result.detailed)
            for bus, frames in network.frames.items()
            for response in _of(found.responses, [frame.name for frame in frames])
        ],
        "chains": [latency_figures(latency) for latency in result.latencies],
    }


def _of(
    responses: Mapping[str, Response | FrameResponse], names: Iterable[str]
) -> list[FrameResponse]:
    found = [responses[name] for name in names]
    return [response for response in found if isinstance(response, FrameResponse)]


def _common(name: str, response: Response | FrameResponse, found: Holistic) -> Json:
    """The shared figures of tasks and messages; ``response`` counts from the chain's event."""
    needed = found.from_event(name)
    deadline = found.deadline(name)
    return {
        "deadline": deadline,
        "inherited_jitter": found.inherited.get(name),
        "blocked": response.blocked,
        "response": needed,
        "slack": None if needed is None else deadline - needed,
        "met": found.meets(name),
        "by_distances": name in found.ends,
        "reason": response.reason.value if response.reason else None,
        "window": response.window if response.bound is not None else None,
    }


def _task(response: Response, found: Holistic, detailed: bool) -> Json:
    task = response.task
    answer: Json = {
        "task": task.name,
        "core": task.core,
        "priority": task.priority,
        "period": task.period,
        "wcet": task.longest_wcet,
        "jitter": response.jitter,
        **_common(task.name, response, found),
        "blocker": response.blocking.user if response.blocking else None,
        "object": response.blocking.resource if response.blocking else None,
        "worst_job": response.worst_job,
        "offset": task.offset,
        "by_offsets": response.alignment is not None,
        "rows": [
            {"row": row.row.name, "wcet": row.row.wcet, "response": row.bound}
            for row in response.rows
        ],
    }
    if detailed:
        extra = response.overheads
        answer["interference"] = [
            {"task": one.task.name, "releases": one.releases, "time": one.time}
            for one in response.interference
        ]
        answer["overheads"] = {
            "switches": extra.switch_time,
            "ticks": extra.tick_time,
            "releases": extra.release_time,
        }
    return answer


def _message(response: FrameResponse, bus: str, found: Holistic, detailed: bool) -> Json:
    frame = response.frame
    answer: Json = {
        "message": frame.name,
        "bus": bus,
        "rank": frame.rank,
        "period": frame.period,
        "cost": frame.transmission_time,
        "jitter": frame.jitter,
        **_common(frame.name, response, found),
        "blocker": response.blocker or None,
        "worst_instance": response.worst_instance,
        "errors": response.errors,
    }
    if detailed:
        answer["interference"] = [
            {"message": one.frame.name, "instances": one.instances, "time": one.time}
            for one in response.interference
        ]
    return answer


def latency_figures(latency: Latency) -> Json:
    """The reaction and age of a chain, hop by hop."""
    chain = latency.chain
    return {
        "chain": chain.name,
        "reaction": latency.reaction,
        "reaction_limit": chain.reaction_limit or None,
        "age": latency.age,
        "age_limit": chain.age_limit or None,
        "held": latency.held,
        "met": latency.met,
        "hops": [
            {
                "step": hop.step.name,
                "hop": hop.step.hop.value,
                "wait": hop.wait,
                "response": hop.response,
                "renewal": hop.renewal,
                "backlog": hop.backlog,
            }
            for hop in latency.hops
        ],
    }
