# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The ways that values take through messages, ports, rows and data, for chains.

A row leads to the data that it writes and to the ports that it sends on. A region leads also to
the rows that ask for its state. Of several shortest ways the one is meant whose stops come first
in the model.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from ravenchart.gen.model.commands import Binding, RemoteRead, Server
from ravenchart.gen.model.instances import End, Events
from ravenchart.gen.model.raising import raises_for
from ravenchart.gen.model.statechart import OnEvent
from ravenchart.gen.model.system import Carried, Chain, Gap, Stop, System

from .calls import asking, published_by, serving

Flow = Mapping[Stop, Sequence[Stop]]
"""The stops that values go to from each stop, in model order."""


def flow_of(system: System) -> Flow:
    """Where values go from each stop of a system."""
    flow: defaultdict[Stop, list[Stop]] = defaultdict(list)
    for instance in system.instances:
        component = instance.component
        known = {port.name for port in component.ports}
        known |= {item.name for item in component.data}
        known |= {region.name for region in component.regions}
        for row in component.runnables():
            own = End(instance.name, row.name)
            for name in row.reads:
                if name in known and name != row.name:
                    flow[End(instance.name, name)].append(own)
            flow[own] += [End(instance.name, name) for name in (*row.writes, *row.sends)]
    for binding in system.bindings:
        for before, after in _through(system, binding):
            flow[before].append(after)
    joined = [(one.source, one.target) for one in system.connections]
    for source, target in (*joined, *_by_events(system)):
        flow[source].append(target)
    for message in (m for m in system.messages if not m.controls):
        if message.source is not None:
            flow[message.source].append(Carried(message.name))
        flow[Carried(message.name)] += message.targets
        if message.call is not None:
            served = serving(message.call.server)
            reply = message.source if message.is_reply else None
            flow[served if reply else message.targets[0]].append(reply or served)
    return flow


def _by_events(system: System) -> Iterator[tuple[End, End]]:
    """Each row or port that raises events by which a region releases its processor, with that."""
    for taken in (processor.released_by for processor in system.processors):
        if not isinstance(taken, Events):
            continue
        region = End(taken.instance, taken.name)
        component = system.instance(taken.instance).component
        for one in (*component.runnables(), *component.inputs()):
            place = End(taken.instance, one.name)
            if place != region and raises_for(system, place, region):
                yield place, region


def _through(system: System, binding: Binding) -> Iterator[tuple[Stop, Stop]]:
    """Where values go through a binding: calls, published data, fallbacks."""
    provider, need = binding.provider, binding.need
    source: Stop | None = None
    if isinstance(provider, Server):
        item = published_by(binding)
        if item is not None:
            source = End(provider.instance, item)
        elif provider.interface.server is not None:
            yield End(binding.instance, need.command.name), serving(provider)
    elif isinstance(provider, RemoteRead) and need.is_part:
        source = End(binding.instance, need.name)
    elif provider is None and need.fallback is not None:
        source = End(binding.instance, need.fallback.item)
    if source is not None:
        for row in asking(system, binding):
            yield source, row


def _event_over(
    system: System, flow: Flow, before: Stop, after: Stop
) -> tuple[str, str, str] | None:
    """An event over a gap of a chain: itself, the element that raises it and the region it is for.

    None where no single event joins both sides.
    """
    for instance in system.instances:
        component = instance.component
        taken = [
            (End(instance.name, region.name), transition.trigger.event)
            for region in component.regions
            for transition in region.transitions
            if isinstance(transition.trigger, OnEvent)
        ]
        raised = [(End(instance.name, r.name), e) for r in component.runnables() for e in r.raises]
        ports = (port for port in component.ports if not port.is_command)
        raised += [
            (End(instance.name, port.name), event)
            for port in ports
            for event in (port.on_arrival, port.on_stale, port.on_overflow)
            if event is not None
        ]
        for place, event in raised:
            for region, wanted in taken:
                fits = wanted == event and place != region
                if fits and _shortest(flow, before, place) and _shortest(flow, region, after):
                    return event, str(place), str(region)
    return None


def routed(system: System) -> System:
    """The system with the way of each of its chains, and the connections on logical ones marked."""
    flow = flow_of(system)
    chains = tuple(_routed(chain, system, flow) for chain in system.chains)
    logical = {hop for chain in chains if chain.logical for hop in pairwise(chain.way)}
    if not logical:
        return replace(system, chains=chains)
    connections = tuple(
        replace(one, logical=(one.source, one.target) in logical) for one in system.connections
    )
    return replace(system, chains=chains, connections=connections)


def _routed(chain: Chain, system: System, flow: Flow) -> Chain:
    """A chain with its way, or the gap in it."""
    way = [*chain.path[:1]]
    for before, after in pairwise(chain.path):
        part = _shortest(flow, before, after)
        if not part:
            return replace(chain, way=(), gap=_gap(system, flow, before, after))
        way += part[1:]
    return replace(chain, way=tuple(way), gap=None)


def _gap(system: System, flow: Flow, before: Stop, after: Stop) -> Gap:
    """The gap between two stops that no values join, with the reasons."""
    back: defaultdict[Stop, list[Stop]] = defaultdict(list)
    for place, following in flow.items():
        for one in following:
            back[one].append(place)
    return Gap(
        str(before),
        str(after),
        _event_over(system, flow, before, after),
        bool(_shortest(flow, after, before)),
        _ends(flow, before),
        _ends(back, after),
    )


def _ends(flow: Flow, first: Stop) -> tuple[str, ...]:
    """The stops behind a stop from which nothing goes on."""
    seen, ahead = {first}, [first]
    for place in ahead:
        new = [one for one in flow.get(place, ()) if one not in seen]
        seen.update(new)
        ahead += new
    return tuple(dict.fromkeys(str(one) for one in ahead if one != first and not flow.get(one)))


def _shortest(flow: Flow, first: Stop, last: Stop) -> list[Stop]:
    """The shortest way between two stops, both included; nothing where there is none."""
    came_from = {first: first}
    ahead = [first]
    while ahead and last not in came_from:
        further: list[Stop] = []
        for place in ahead:
            for following in flow.get(place, ()):
                if following not in came_from:
                    came_from[following] = place
                    further.append(following)
        ahead = further
    if last not in came_from:
        return []
    way = [last]
    while way[-1] != first:
        way.append(came_from[way[-1]])
    return way[::-1]
