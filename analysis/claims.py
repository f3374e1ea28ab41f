"""The claims of a system's certificate, with the windows that show them.

A response keeps the window of its worst job; the certificate needs those of all jobs
of the busy period, and of a message the busy period itself.
"""

from __future__ import annotations

from gen.claims import ChainClaim, Claim, Claims, Step
from gen.terms import Ns

from .core import can
from .core.bus import Bus
from .core.can_response import ERRORS, FrameResponse
from .core.chains import Hop
from .core.responses import Response, demand_of, jitter_of
from .core.window import Effort, Window, fixed_cost, source
from .latencies import Latency, reception_frames
from .timing import Analysis

EFFORT = 200_000
"""Work for the windows of one task or message: as much as for its response."""


MOST_JOBS = 1_000
"""Jobs or instances of one busy period that a certificate lists at most."""


class Unclaimed(Exception):  # noqa: N818
    """Something has a bound, but no busy period that ends: its resource is full."""


def claims_of(analysis: Analysis) -> Claims:
    """What the certificate of a system whose deadlines are met claims.

    Unclaimed where a processor or bus is loaded to exactly its whole time.
    """
    items = {}
    for name, response in analysis.found.responses.items():
        items[name] = _of_task(response) if isinstance(response, Response) else _of(response)
    chains = tuple(_of_chain(latency, analysis) for _, latency in analysis.limited)
    steps = [step for chain in chains for step in chain.steps]
    bounds = {row.row.name: Ns(row.bound) for _, row in analysis.rows()}
    rows = {step.element: bounds[step.element] for step in steps if step.kind == "row"}
    handed = {step.element for step in steps if step.kind == "handed"}
    waits, busiest = _capped(analysis)
    return Claims(items, rows, waits, busiest, _turns(analysis, handed), chains)


def _of_task(response: Response) -> Claim:
    """Every job of the busy period; the table begins with all its rows."""
    assert response.bound is not None
    alone = response.jobs == 1 and response.window + response.jitter <= response.task.period
    windows = [response.window] if alone else _jobs(response)
    return Claim(Ns(response.bound), tuple(map(Ns, windows)))


def _jobs(response: Response) -> list[int]:
    """The window of each job of the busy period."""
    task, level = response.task, response.level
    window, effort = Window(), Effort(EFFORT)
    platform = level.platform
    others = [other for other in level.order[: level.reach] if other.name != task.name]
    for number, other in enumerate(others):
        own = source(other.period, jitter_of(other, platform), demand_of(other, platform))
        window.add(number, own)
    number = len(others)
    if platform.tick_cost:
        window.add(number, fixed_cost(platform.tick_period, 0, platform.tick_cost))
    for place, other in enumerate(level.order if platform.release else (), number + 1):
        release = fixed_cost(other.period, jitter_of(other, platform), platform.release)
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
    """The least windows that hold these demands and what the sources add."""
    found = []
    for demand in fixed:
        if not window.settle(demand, effort):
            raise Unclaimed(f"{name} has no busy period that ends")
        found.append(window.length)
    return found


def _of(response: FrameResponse) -> Claim:
    """Every instance of the busy period, and the busy period."""
    frame, level = response.frame, response.level
    assert response.bound is not None
    errors = level.bus.errors
    blocked = level.blocker[1]
    if errors is not None:
        blocked += (errors.burst - 1) * level.error_cost
    waiting, busy = Window(), Window()
    busy.length = 1  # zero is a fixed point too
    for number, other in enumerate(level.order[: level.reach]):
        late = level.jitter(other, frame)
        busy.add(number, fixed_cost(other.period, late, other.cost))
        if other.name != frame.name:
            until = fixed_cost(other.period, late + level.bus.bit_time, other.cost)
            waiting.add(number, until)
    if errors is not None:
        waiting.add(ERRORS, fixed_cost(errors.period, frame.cost, level.error_cost))
        busy.add(ERRORS, fixed_cost(errors.period, 0, level.error_cost))
    effort = Effort(EFFORT)
    (length,) = _settled(busy, [blocked], effort, frame.name)
    instances = -(-(length + frame.jitter) // frame.period)
    if instances > MOST_JOBS:
        raise Unclaimed(f"{frame.name} has {instances} instances in one busy period")
    fixed = [blocked + instance * frame.cost for instance in range(instances)]
    windows = _settled(waiting, fixed, effort, frame.name)
    return Claim(Ns(response.bound), tuple(map(Ns, windows)), Ns(length))


def _capped(analysis: Analysis) -> tuple[dict[str, Ns], dict[str, Ns]]:
    """The waits in queues that the busiest time of a bus bounds, and those times by bus."""
    waits: dict[str, Ns] = {}
    busiest: dict[str, Ns] = {}
    for bus in analysis.system.buses:
        for response in analysis.frames(bus):
            frame, bound = response.frame, response.bound or 0
            for other in analysis.frames(bus):
                wait = other.level.delays.get(frame.name)
                if wait is not None and wait < bound - frame.cost - frame.jitter:
                    waits[frame.name] = Ns(wait)
                    busiest[bus.name] = Ns(wait + frame.cost)
    return waits, busiest


def _turns(analysis: Analysis, handed: set[str]) -> dict[str, Claim]:
    """When the reception turns to each of these messages."""
    found: dict[str, Claim] = {}
    system = analysis.system
    for processor in system.processors:
        waiting = reception_frames(processor, system, analysis.found)
        for response in can.analyse(waiting, Bus(bit_time=1)):
            if response.frame.name in handed:
                claim = _of(response)
                turn = Ns(claim.response - processor.period)
                found[response.frame.name] = Claim(turn, claim.windows, claim.busy)
    return found


def _of_chain(latency: Latency, analysis: Analysis) -> ChainClaim:
    """The steps of a chain in the terms of the certificate."""
    steps = []
    for number, hop in enumerate(latency.hops):
        element, kind = hop.step.name, "item"
        if element in analysis.row_names:
            kind = "row"
        elif element not in analysis.found.responses:
            element, kind = element.removesuffix(".reception"), "handed"
        after = latency.hops[number + 1 : number + 2]
        renewed = any(one.step.hop is Hop.SAMPLED for one in after)
        wait = Ns(hop.wait or 0)
        steps.append(Step(element, kind, hop.step.hop.value, wait, renewed))
    assert latency.reaction is not None and latency.age is not None
    name = latency.chain.name
    return ChainClaim(name, tuple(steps), Ns(latency.reaction), Ns(latency.age))
