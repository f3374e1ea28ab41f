# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The component view as an SVG picture, laid out in columns; colours come from the page."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as Xml

import networkx as nx

BOX_WIDTH = 150
BOX_HEIGHT = 34
COLUMN = 290
"""Distance between the left edges of two columns, in px."""
ROW = 52
"""Distance between the tops of two boxes, in px."""
MARGIN = 14
LEGIBLE = 60
"""With more boxes than this a picture is not legible."""


@dataclass(frozen=True, slots=True)
class NodeBox:
    """The left upper corner of a node, in px."""

    x: float
    y: float

    @property
    def middle(self) -> float:
        """Height of its centre."""
        return self.y + BOX_HEIGHT / 2

    @property
    def right(self) -> float:
        """Its right edge."""
        return self.x + BOX_WIDTH


def draw(view: nx.DiGraph[str]) -> str | None:
    """The picture as SVG text; None when it would not be legible."""
    if not 0 < len(view) <= LEGIBLE:
        return None
    places = _places(view)
    width = max(b.right for b in places.values()) + MARGIN
    height = max(b.y for b in places.values()) + BOX_HEIGHT + MARGIN
    svg = Xml.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "class": "graph",
            "role": "img",
            "viewBox": f"0 0 {width:g} {height:g}",
            "aria-label": "components and messages",
        },
    )
    marker = Xml.SubElement(
        Xml.SubElement(svg, "defs"),
        "marker",
        {
            "id": "tip",
            "viewBox": "0 0 8 8",
            "refX": "8",
            "refY": "4",
            "markerWidth": "7",
            "markerHeight": "7",
            "orient": "auto",
        },
    )
    Xml.SubElement(marker, "path", {"d": "M0 0 L8 4 L0 8 z", "class": "tip"})
    for source, target in view.edges:
        _edge(svg, view, places, source, target)
    for name, box in places.items():
        _box(svg, box, view.nodes[name]["label"], view.nodes[name]["kind"])
    return Xml.tostring(svg, encoding="unicode")


def _places(view: nx.DiGraph[str]) -> dict[str, NodeBox]:
    """The position of each node: instances by rank, their messages outside of them."""
    ranks = _ranks(view)
    last = max(ranks.values(), default=0)
    columns: dict[int, list[str]] = {}
    for name, rank in ranks.items():
        columns.setdefault(rank, []).append(name)
    for instance in list(ranks):
        for message in (*view.predecessors(instance), *view.successors(instance)):
            if message not in ranks and not any(message in c for c in columns.values()):
                sends = view.has_edge(instance, message)
                left = ranks[instance] == 0 and (last > 0 or not sends)
                columns.setdefault(-1 if left else last + 1, []).append(message)
    for name in view:
        if not any(name in column for column in columns.values()):
            columns.setdefault(-1, []).append(name)
    first = min(columns)
    tallest = max(len(names) for names in columns.values())
    places = {}
    for column, names in columns.items():
        step = ROW * tallest / len(names)
        for row, name in enumerate(names):
            top = MARGIN + step * row + (step - ROW) / 2
            places[name] = NodeBox(MARGIN + (column - first) * COLUMN, top)
    return places


def _ranks(view: nx.DiGraph[str]) -> dict[str, int]:
    """The column of each instance: behind its sources; edges that close a cycle do not count."""
    forward: nx.DiGraph[str] = nx.DiGraph()
    forward.add_nodes_from(n for n in view if view.nodes[n]["kind"] == "instance")
    for source, target in view.edges:
        inside = source in forward and target in forward and source != target
        if inside and not nx.has_path(forward, target, source):
            forward.add_edge(source, target)
    ranks = dict.fromkeys(forward, 0)
    for name in nx.topological_sort(forward):
        for follower in forward.successors(name):
            ranks[follower] = max(ranks[follower], ranks[name] + 1)
    return ranks


def _edge(
    svg: Xml.Element, view: nx.DiGraph[str], places: dict[str, NodeBox], source: str, target: str
) -> None:
    """An arrow; of two that run opposite, each keeps to its side."""
    a, b = places[source], places[target]
    label = ", ".join(view.edges[source, target]["ports"])
    shift = 7 if view.has_edge(target, source) else 0
    shift = -shift if a.x <= b.x else shift
    ya, yb = a.middle + shift, b.middle + shift
    if a.x < b.x:
        xa, xb, pull = a.right, b.x, 70
    elif a.x > b.x:
        xa, xb, pull = a.x, b.right, -70
    else:
        xa, xb, pull = a.right, b.right, 60
    bend = -pull if a.x == b.x else pull
    Xml.SubElement(
        svg,
        "path",
        {
            "d": f"M{xa:g} {ya:g} C{xa + pull:g} {ya:g} {xb - bend:g} {yb:g} {xb:g} {yb:g}",
            "class": "edge",
            "marker-end": "url(#tip)",
        },
    )
    middle = (xa + xb) / 2 + (45 if a.x == b.x else 0)
    text = Xml.SubElement(
        svg,
        "text",
        {
            "x": f"{middle:g}",
            "y": f"{(ya + yb) / 2 + (12 if shift > 0 else -4):g}",
            "class": "port",
            "text-anchor": "middle",
        },
    )
    text.text = label if len(label) <= 24 else label[:23] + "…"


def _box(svg: Xml.Element, box: NodeBox, label: str, kind: str) -> None:
    """One node."""
    Xml.SubElement(
        svg,
        "rect",
        {
            "x": f"{box.x:g}",
            "y": f"{box.y:g}",
            "width": str(BOX_WIDTH),
            "height": str(BOX_HEIGHT),
            "rx": "4" if kind == "instance" else "17",
            "class": kind,
        },
    )
    text = Xml.SubElement(
        svg,
        "text",
        {
            "x": f"{box.x + BOX_WIDTH / 2:g}",
            "y": f"{box.middle + 4:g}",
            "class": "label",
            "text-anchor": "middle",
        },
    )
    text.text = label if len(label) <= 21 else label[:20] + "…"
