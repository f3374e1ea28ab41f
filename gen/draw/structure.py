# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The component structure of a system as a graph for Graphviz.

Each node of the hardware is a cluster with its instances, their ports, interfaces and
connections, and the devices that it calls. Its processors are in the cluster, each a cluster with
its table in order. A binding is a dashed arrow from who requires to who provides; an edge from an
array to a member has a diamond at the array. A bus is a cluster of its messages. The instances
are read from the one with the most neighbours outward, buses last. A port stands on the side of
its peer, so that no wire has to pass around a box.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise, product, zip_longest

import networkx as nx

from ravenchart.gen.language.quantities import BITS_PER_SECOND, shown
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.component import Direction, Port
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.logical import logical_of
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import Processor, System

from .boxes import Box, boxed
from .devices import (
    DASHED,
    DeviceLink,
    device_links,
    device_name,
    devices,
    end_port,
    interface_cell,
    parts,
    provided_port,
    required,
    required_port,
)
from .dot import Attributes, Defaults, DotEdge, DotItem, Group, Html, cluster, digraph, html
from .dot import DotNode as Drawn
from .look import FONT, INK, LEFT, PAPER, ROOM, SHADES, SMALL

IN_A_ROW = 2
"""Processors side by side at most."""


def structure_dot(system: System) -> str:
    """The DOT text of a system's structure."""
    return digraph(system.name, _Drawing(system).items())


class _Drawing:
    """The statements of one system."""

    def __init__(self, system: System) -> None:
        self.system = system
        self.position = {name: index for index, name in enumerate(_order(system))}
        self.on_right = {
            (end.instance, end.name): self.position[end.instance] < self.position[other]
            for wire in reversed(system.connections)
            for end, other in (
                (wire.source, wire.target.instance),
                (wire.target, wire.source.instance),
            )
        }
        for link in reversed(device_links(system)):
            right = link.interface is None or (
                self.position[link.instance] < self.position[link.provider]
            )
            self.on_right[link.instance, required_port(link.required)] = right
            if link.interface is not None:
                self.on_right[link.provider, provided_port(link.interface)] = not right
        for message in system.messages:
            for end in (message.source, *message.targets):
                if end is not None:
                    self.on_right[end.instance, end_port(system, message, end)] = True

    def items(self) -> Iterator[DotItem]:
        """The whole graph."""
        yield Defaults("graph", {
            "label": Html(html(self.system.name, "b") + LEFT), "labelloc": "t", "labeljust": "l",
            "rankdir": "LR", "newrank": "true", "fontname": FONT, "fontsize": "13",
            "nodesep": "0.25", "ranksep": "0.9", "color": INK, "pad": "0.15",
        })  # fmt: skip
        yield Defaults("node", {
            "fontname": FONT, "fontsize": SMALL, "color": INK, "shape": "plain"
        })  # fmt: skip
        yield Defaults("edge", {"color": INK, "arrowhead": "vee", "arrowsize": "0.7"})
        for node in self.system.nodes:
            yield self._node(node)
        for bus in self.system.buses:
            yield self._bus(bus)
        for node, message in product(self.system.nodes, self.system.messages):
            yield DotEdge(_rim(node), _message_name(message), _HIDDEN)
        for wire in self.system.connections:
            yield self._wire(wire.source, wire.target)
        yield from map(self._bound, device_links(self.system))
        yield from parts(self.system)
        for message in self.system.messages:
            yield from self._carried(message)

    # --- nodes and buses

    def _node(self, node: Node) -> Group:
        here = [i for i in self.system.instances if i.node == node.name]
        ordered = sorted(here, key=lambda i: self.position[i.name])
        items: list[DotItem] = [self._box(one) for one in boxed(ordered)]
        items += devices(self.system, node.name)
        items.append(Drawn(_rim(node), {"shape": "point", "width": "0.01", "style": "invis"}))
        items += (DotEdge(i.name, _rim(node), _HIDDEN) for i in here)
        processors = [p for p in self.system.processors if p.node == node.name]
        for processor in processors:
            look = {"style": "filled", "fillcolor": PAPER}
            table = Drawn(_table_name(processor), {"label": _table(processor)})
            lasting = logical_of(self.system, processor.name)
            title = _title(processor, lasting, several=node.cores > 1)
            items.append(_framed(f"processor {processor.name}", title, look, [table]))
        for start in range(0, len(processors), IN_A_ROW):
            row = [_table_name(p) for p in processors[start : start + IN_A_ROW]]
            items += (DotEdge(a, b, _HIDDEN) for a, b in pairwise((*row, _rim(node))))
        look = {"style": "rounded,filled", "fillcolor": SHADES[0]}
        return _framed(f"node {node.name}", f"node {html(node.name, 'b')}{LEFT}", look, items)

    def _box(self, box: Instance | Box) -> DotItem:
        """An instance, or the frame of a composite round those inside."""
        if isinstance(box, Instance):
            return Drawn(box.name, {"label": self._instance(box)})
        look = {"style": "rounded,filled", "fillcolor": SHADES[1]}
        inside = [self._box(one) for one in box.inside]
        title = f"{html(box.name, 'b')} : {html(box.component)}{LEFT}"
        return _framed(f"composite {box.name}", title, look, inside)

    def _bus(self, bus: Bus) -> Group:
        rates = _rate(bus.bit_rate)
        rates += "" if bus.data_rate is None else f", data {_rate(bus.data_rate)}"
        title = f"bus {html(bus.name, 'b')}{LEFT}{rates}{LEFT}"
        messages = [
            Drawn(_message_name(m), {"label": _message(m)})
            for m in self.system.messages
            if m.bus == bus.name
        ]
        look = {"style": "filled", "fillcolor": SHADES[1]}
        return _framed(f"bus {bus.name}", title, look, messages)

    def _instance(self, instance: Instance) -> Html:
        """Its name, and its ports on both sides."""
        component = instance.component
        ports = [port for port in component.ports if not port.is_command]
        right = [port for port in ports if self._is_right(instance.name, port)]
        left = [port for port in ports if port not in right]
        name = f"{html(instance.name, 'b')} : {html(component.name)}"
        rows = f'<tr><td colspan="3" border="0" cellpadding="5">{name}</td></tr>'
        cells: tuple[list[str], list[str]] = [_cell(p) for p in left], [_cell(p) for p in right]
        ends = [(required_port(one), one, True) for one in required(instance)]
        ends += [(provided_port(one.name), one.name, False) for one in component.provides]
        for port, text, requires in ends:
            on_right = self.on_right.get((instance.name, port), requires)
            cells[on_right].append(interface_cell(port, text))
        for one, other in zip_longest(*cells, fillvalue='<td border="0"></td>'):
            rows += f'<tr>{one}<td border="0" width="20"></td>{other}</tr>'
        table = f'<table border="1" cellborder="1" cellspacing="2" bgcolor="{PAPER}"'
        return Html(f"{table}>{rows}</table>")

    def _is_right(self, instance: str, port: Port) -> bool:
        return self.on_right.get((instance, port.name), port.direction is Direction.OUT)

    # --- wires

    def _wire(self, source: End, target: End) -> DotEdge:
        if self.position[source.instance] <= self.position[target.instance]:
            return DotEdge(source.instance, target.instance, {
                "tailport": self._port(source), "headport": self._port(target),
            })  # fmt: skip
        return DotEdge(target.instance, source.instance, {
            "tailport": self._port(target), "headport": self._port(source), **_BACKWARD,
        })  # fmt: skip

    def _bound(self, link: DeviceLink) -> DotEdge:
        """From a required interface to what provides it; devices stand on the right."""
        tail = f"{required_port(link.required)}:{self._side(link.instance, link.required)}"
        if link.interface is None:
            return DotEdge(link.instance, device_name(link.provider), {"tailport": tail, **DASHED})
        port = provided_port(link.interface)
        head = f"{port}:{'e' if self.on_right[link.provider, port] else 'w'}"
        if self.position[link.instance] <= self.position[link.provider]:
            look = {"tailport": tail, "headport": head, **DASHED}
            return DotEdge(link.instance, link.provider, look)
        look = {"tailport": head, "headport": tail, **DASHED, **_BACKWARD}
        return DotEdge(link.provider, link.instance, look)

    def _side(self, instance: str, name: str) -> str:
        return "e" if self.on_right[instance, required_port(name)] else "w"

    def _carried(self, message: Message) -> Iterator[DotEdge]:
        """From the port that sends a message, and to those that receive it."""
        name = _message_name(message)
        if message.source is not None:
            ports = {"tailport": self._end(message, message.source), "headport": "w"}
            yield DotEdge(message.source.instance, name, dict(ports))
        for target in message.targets:
            ports = {"tailport": self._end(message, target), "headport": "w"}
            yield DotEdge(target.instance, name, ports | _BACKWARD)

    def _port(self, end: End) -> str:
        """A port and its side."""
        return f"{end.name}:{'e' if self.on_right[end.instance, end.name] else 'w'}"

    def _end(self, message: Message, end: End) -> str:
        """The port or interface where a message begins or ends, and its side."""
        port = end_port(self.system, message, end)
        return f"{port}:{'e' if self.on_right[end.instance, port] else 'w'}"


_HIDDEN: Attributes = {"style": "invis"}
"""Of an edge that only keeps one thing before another."""
_BACKWARD = {"dir": "back", "arrowtail": "vee"}


def _order(system: System) -> list[str]:
    """The instances, neighbours of earlier ones first; begun with the best connected."""
    graph: nx.Graph[str] = nx.Graph()
    graph.add_nodes_from(instance.name for instance in system.instances)
    graph.add_edges_from((w.source.instance, w.target.instance) for w in system.connections)
    bound = [one for one in device_links(system) if one.interface is not None]
    graph.add_edges_from((one.instance, one.provider) for one in bound)
    found: list[str] = []
    while len(graph):
        hub = max(graph, key=graph.degree)
        part = [hub, *(name for _, name in nx.bfs_edges(graph, hub))]
        found += part
        graph.remove_nodes_from(part)
    return found


def _framed(name: str, label: str, look: Attributes, items: Sequence[DotItem]) -> Group:
    frame: Attributes = {"label": Html(label), "fontsize": "11", "labeljust": "l", "margin": "10"}
    return Group(cluster(name), (Defaults("graph", frame | look), *items))


def _title(processor: Processor, lasting: Ns | None, *, several: bool) -> str:
    release = f"every {shown(processor.period)}"
    if processor.released_by is not None:
        release = f"on {processor.released_by}, at most {release}"
    if processor.cyclic:
        release += ", cyclic executive"
    if lasting is not None:
        on = " on chains" if processor.logical is None else ""
        release += f", logical execution time {shown(lasting)}{on}"
    place = f"priority {processor.priority}{f', core {processor.core}' if several else ''}"
    facts = f'<font point-size="{SMALL}">{html(release)}, {place}{ROOM}</font>'
    return f"processor {html(processor.name, 'b')}{LEFT}{facts}{LEFT}"


def _rim(node: Node) -> str:
    """The name of the hidden point right of all that is in a node, and left of every bus."""
    return f"rim {node.name}"


def _table_name(processor: Processor) -> str:
    return f"table {processor.name}"


def _table(processor: Processor) -> Html:
    """The rows of a processor in the order in which they run."""
    rows = "".join(
        f'<tr><td align="left">{html(slot.element)}{ROOM}</td>'
        f'<td align="right">{html(shown(slot.timing.period))}</td></tr>'
        for slot in processor.slots
    )
    return Html(f'<table border="0" cellborder="0" cellspacing="0" cellpadding="2">{rows}</table>')


def _cell(port: Port) -> str:
    return f'<td port="{port.name}" bgcolor="{SHADES[1]}">{html(port.name)}</td>'


def _rate(bits: int) -> str:
    exact = [(size, unit) for unit, size in BITS_PER_SECOND.items() if bits % size == 0]
    size, unit = max(exact)
    return f"{bits // size} {unit}"


def _message_name(message: Message) -> str:
    return f"message {message.name}"


def _message(message: Message) -> Html:
    facts = f"{message.shown_identifier}, {shown(message.period)}"
    facts += ", FD" if message.fd else ""
    cell = f'<td bgcolor="{PAPER}">{html(message.name)}<br/>{facts}</td>'
    return Html(f'<table border="0" cellborder="1" cellspacing="0"><tr>{cell}</tr></table>')
