# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The ways that values take through messages, ports, rows and data, for chains.

A row leads to the data that it writes and to the ports that it sends on. A region leads also to
the rows that ask for its state. Of several shortest ways the one is meant whose stops come first
in the model.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from ravenchart.gen.model.commands import Server
from ravenchart.gen.model.statechart import OnEvent
from ravenchart.gen.model.system import Carried, Chain, Gap, Stop, System

from .calls import published_by, rows_of

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
            own = f"{instance.name}.{row.name}"
            for name in row.reads:
                if name in known and name != row.name:
                    flow[f"{instance.name}.{name}"].append(own)
            flow[own] += [f"{instance.name}.{name}" for name in (*row.writes, *row.sends)]
    for binding in system.bindings:
        provider, need = binding.provider, binding.need
        if isinstance(provider, Server):
            item = published_by(binding)
            if item is not None:
                flow[f"{provider.instance}.{item}"] += rows_of(system, binding)
            elif provider.interface.server is not None:
                served = f"{provider.instance}.{provider.interface.server}"
                flow[f"{binding.instance}.{need.name}"].append(served)
        elif provider is None and need.stand_in is not None:
            own = f"{binding.instance}.{need.stand_in.item}"
            flow[own] += rows_of(system, binding)
    for connection in system.connections:
        flow[str(connection.source)].append(str(connection.target))
    for message in (m for m in system.messages if not m.controls):
        if message.source is not None:
            flow[str(message.source)].append(Carried(message.name))
        flow[Carried(message.name)] += map(str, message.targets)
        if message.call is not None:
            served = message.call.served
            way = (served, message.source) if message.is_reply else (message.targets[0], served)
            flow[str(way[0])].append(str(way[1]))
    return flow


def _event_over(
    system: System, flow: Flow, before: Stop, after: Stop
) -> tuple[str, str, str] | None:
    """An event over a gap of a chain: itself, the element that raises it and the region it is for.

    None where no single event joins both sides.
    """
    for instance in system.instances:
        component = instance.component
        taken = [
            (f"{instance.name}.{region.name}", transition.trigger.event)
            for region in component.regions
            for transition in region.transitions
            if isinstance(transition.trigger, OnEvent)
        ]
        raised = [(f"{instance.name}.{r.name}", e) for r in component.runnables() for e in r.raises]
        ports = (port for port in component.ports if not port.is_command)
        raised += [
            (f"{instance.name}.{port.name}", event)
            for port in ports
            for event in (port.on_arrival, port.on_stale, port.on_overflow)
            if event is not None
        ]
        for place, event in raised:
            for region, wanted in taken:
                fits = wanted == event and place != region
                if fits and _shortest(flow, before, place) and _shortest(flow, region, after):
                    return event, place, region
    return None


def routed(system: System) -> System:
    """The system with the way of each of its chains."""
    flow = flow_of(system)
    return replace(system, chains=tuple(_routed(chain, system, flow) for chain in system.chains))


def _stop(place: str) -> Stop:
    """A stop as the path of a chain names it: elements have a dot, messages none."""
    return place if "." in place else Carried(place)


def _routed(chain: Chain, system: System, flow: Flow) -> Chain:
    """A chain with its way, or the gap in it."""
    nodes = [_stop(place) for place in chain.path]
    way = nodes[:1]
    for before, after in pairwise(nodes):
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
