# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The dependencies of a system as a graph, and the chains through it.

Nodes are an `End` for a row, port or data item, `Carried` for a message, and the id for a row of
a bus. Components, instances and processors are kind and name. Each node has its ``kind``. Edges
point in the direction of values (``reads``, ``writes``, ``sends``, ``carries``). Other edges lead
from a processor to the rows it ``runs`` and from an instance to its component (``is``).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import cast

import networkx as nx

from ravenchart.gen.model.component import Activity, Component, Direction
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Carried, Stop, System

FLOW = frozenset({"reads", "writes", "sends", "carries"})
"""The kinds of edges along which values travel."""


def dependencies(system: System) -> nx.DiGraph[Stop | str]:
    """The graph of the whole system."""
    graph: nx.DiGraph[Stop | str] = nx.DiGraph(name=system.name)
    for component in system.components:
        graph.add_node(f"component {component.name}", kind="component", label=component.name)
    for instance in system.instances:
        _add_instance(graph, instance)
    for processor in system.processors:
        node = f"processor {processor.name}"
        graph.add_node(node, kind="processor", label=processor.name)
        for slot in processor.slots:
            row: Stop | str = slot.element if slot.of_bus else End(slot.owner, slot.name)
            if slot.of_bus:
                graph.add_node(row, kind="row", label=slot.element)
            graph.add_edge(node, row, kind="runs")
    for connection in system.connections:
        graph.add_edge(connection.source, connection.target, kind="carries")
    for message in system.messages:
        carried = Carried(message.name)
        graph.add_node(carried, kind="message", label=message.name)
        if message.controls:
            continue  # no values travel with it
        if message.source is not None:
            graph.add_edge(message.source, carried, kind="carries")
        for target in message.targets:
            graph.add_edge(carried, target, kind="carries")
    return graph


@dataclass(frozen=True, slots=True)
class Ways:
    """The ways that values can take through messages, ports, rows and data."""

    system: System
    flow: nx.DiGraph[Stop]

    @classmethod
    def of(cls, system: System) -> Ways:
        """Of the whole system."""
        graph = cast("nx.DiGraph[Stop]", dependencies(system))  # values go between stops alone
        carries = {edge for edge in graph.edges if graph.edges[edge]["kind"] in FLOW}
        return cls(system, nx.subgraph_view(graph, filter_edge=lambda a, b: (a, b) in carries))

    def between_messages(self) -> tuple[tuple[Stop, ...], ...]:
        """From each message received to each message sent: the shortest way through the rows.

        Each lists the message, then every port, row and data item on its way.
        """
        arriving = [Carried(m.name) for m in self.system.messages if m.source is None]
        leaving = [Carried(m.name) for m in self.system.messages if not m.targets]
        found = []
        for first in arriving:
            ways = nx.single_source_shortest_path(self.flow, first)
            found += [tuple(ways[last]) for last in leaving if last in ways]
        return tuple(found)


def component_view(system: System) -> nx.DiGraph[str]:
    """Instances and the messages between them and the outside; edges hold the port names."""
    graph: nx.DiGraph[str] = nx.DiGraph(name=system.name)
    for instance in system.instances:
        graph.add_node(instance.name, kind="instance", label=instance.name)
    for message in system.messages:
        graph.add_node(f"message {message.name}", kind="message", label=message.name)
    for connection in system.connections:
        _add_port(
            graph, connection.source.instance, connection.target.instance, connection.target.name
        )
    for message in system.messages:
        node = f"message {message.name}"
        if message.source is not None:
            _add_port(graph, message.source.instance, node, message.source.name)
        for target in message.targets:
            _add_port(graph, node, target.instance, target.name)
    return graph


def _add_instance(graph: nx.DiGraph[Stop | str], instance: Instance) -> None:
    """The ports, data and rows of one instance, and the values between them."""
    component = instance.component
    graph.add_node(f"instance {instance.name}", kind="instance", label=instance.name)
    graph.add_edge(f"instance {instance.name}", f"component {component.name}", kind="is")

    def at(name: str) -> End:
        return End(instance.name, name)

    for port in component.ports:
        graph.add_node(at(port.name), kind="port", label=port.name)
    for data in component.data:
        graph.add_node(at(data.name), kind="data", label=data.name)
    for handler in component.handlers():
        graph.add_node(at(handler), kind="row", label=handler)
        for port in component.handled(handler):
            graph.add_edge(at(port.name), at(handler), kind="handles")
    for row in _rows(component):
        graph.add_node(at(row.name), kind="row", label=row.name)
    for row, name, kind in _uses(component):
        if kind == "reads":
            graph.add_edge(at(name), at(row.name), kind=kind)
        else:
            graph.add_edge(at(row.name), at(name), kind=kind)


def _rows(component: Component) -> tuple[Region | Activity, ...]:
    """The regions and activities of a component."""
    return (*component.regions, *component.activities)


def _uses(component: Component) -> Iterator[tuple[Region | Activity, str, str]]:
    """(row, what it uses, how) for everything but parameters and the row itself."""
    known = {p.name for p in component.ports} | {d.name for d in component.data}
    known |= {r.name for r in component.regions}
    outputs = {p.name for p in component.ports if p.direction is Direction.OUT}
    for row in _rows(component):
        yield from ((row, n, "reads") for n in row.reads if n in known and n != row.name)
        yield from ((row, n, "writes") for n in row.writes if n in known)
        yield from ((row, n, "sends") for n in row.sends if n in outputs)


def _add_port(graph: nx.DiGraph[str], source: str, target: str, port: str) -> None:
    """One more port on the edge between two nodes."""
    if graph.has_edge(source, target):
        graph.edges[source, target]["ports"] += (port,)
    else:
        graph.add_edge(source, target, ports=(port,))
