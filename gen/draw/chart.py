# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A picture of a chart as a graph for Graphviz, drawn as UML draws it.

A composite state is a cluster, its orthogonal regions are dashed clusters in
it. Two things keep the drawing legible. Every label is a node in the middle of
its transition, so that it has room of its own, outside what the transition
leaves and enters. And edges join nodes only: those of a composite state end at
a node inside it and are clipped at its border.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from ravenchart.gen.model.statechart import RegionId

from .dot import (
    Attributes,
    Defaults,
    DotEdge,
    DotItem,
    DotNode,
    Group,
    Html,
    cluster,
    digraph,
    html,
)
from .look import FONT, INK, LEFT, PAPER, ROOM, SHADES, SMALL
from .order import Arrangement
from .picture import Area, Arrow, DrawnVertex, Picture, Shape
from .wrapping import wrapped

BACKWARD = {"dir": "back", "arrowtail": "vee"}
"""An edge from what is read first, with its arrow there."""

_SYMBOLS: Mapping[Shape, Attributes] = {
    Shape.FINAL: {"shape": "doublecircle", "fillcolor": INK, "width": "0.14"},
    Shape.CHOICE: {"shape": "diamond", "width": "0.34", "height": "0.34"},
    Shape.JUNCTION: {"shape": "circle", "fillcolor": INK, "width": "0.13"},
    Shape.HISTORY: {"shape": "circle", "width": "0.3", "label": "H"},
    Shape.DEEP_HISTORY: {"shape": "circle", "width": "0.3", "label": "H*"},
    Shape.FORK: {"shape": "box", "fillcolor": INK, "width": "1.1", "height": "0.06"},
    Shape.JOIN: {"shape": "box", "fillcolor": INK, "width": "1.1", "height": "0.06"},
    Shape.TERMINATE: {
        "shape": "none",
        "width": "0.45",
        "height": "0.45",
        "label": "\u00d7",
        "fontsize": "26",
    },
}
_INITIAL: Attributes = {
    "shape": "circle", "style": "filled", "fillcolor": INK, "fixedsize": "true",
    "width": "0.16", "label": "",
}  # fmt: skip


def chart_dot(picture: Picture) -> str:
    """The DOT text of a chart."""
    return digraph(picture.title, _Drawing(picture).items())


class _Drawing:
    """The statements of one chart."""

    def __init__(self, picture: Picture) -> None:
        self.picture = picture
        self.reading = Arrangement(picture)
        self.vertex = {vertex.name: vertex for vertex, _ in picture.vertices()}
        self.labels: dict[RegionId, list[DotNode]] = {region: [] for region, _ in picture.areas()}
        self.edges = [*self._defaults(), *self._arrows()]

    def items(self) -> Iterator[DotItem]:
        """The whole graph."""
        title = html(self.picture.title, "b") + LEFT
        remark = f'<font point-size="{SMALL}">{html(self.picture.remark)}{LEFT}</font>'
        yield Defaults("graph", {
            "label": Html(title + (remark if self.picture.remark else "")), "labelloc": "t",
            "labeljust": "l", "compound": "true", "newrank": "true", "fontname": FONT,
            "fontsize": "13", "nodesep": "0.3", "ranksep": "0.28", "color": INK, "pad": "0.15",
        })  # fmt: skip
        yield Defaults("node", {"fontname": FONT, "fontsize": "11", "color": INK})
        yield Defaults("edge", {"color": INK, "arrowhead": "vee", "arrowsize": "0.7"})
        yield from self._area(self.picture.area, None, 0)
        yield from self.edges

    # --- vertices

    def _area(self, area: Area, owner: str | None, depth: int) -> Iterator[DotItem]:
        if area.initial is not None:
            yield DotNode(_initial(RegionId(owner, area.name)), _INITIAL)
        for vertex in sorted(area.vertices, key=lambda v: self.reading.position[v.name]):
            yield self._drawn(vertex, depth)
        yield from self.labels[RegionId(owner, area.name)]

    def _drawn(self, vertex: DrawnVertex, depth: int) -> DotItem:
        if vertex.is_composite:
            return self._composite(vertex, depth)
        if vertex.shape is Shape.STATE:
            return DotNode(vertex.name, {"shape": "plain", "label": _box(vertex)})
        style = {"style": "filled", "fillcolor": PAPER, "fixedsize": "true", "label": ""}
        return DotNode(vertex.name, style | _SYMBOLS[vertex.shape])

    def _composite(self, vertex: DrawnVertex, depth: int) -> Group:
        look = {
            "label": "", "style": "rounded,filled", "fillcolor": SHADES[depth % len(SHADES)],
            "margin": "8",
        }  # fmt: skip
        header = DotNode(_header(vertex.name), {"shape": "plain", "label": _top(vertex)})
        inside: list[DotItem] = [Defaults("graph", look), header]
        for area in vertex.areas:
            parts = tuple(self._area(area, vertex.name, depth + 1))
            if len(vertex.areas) == 1:
                inside += parts
            else:
                name = f'<font point-size="{SMALL}">{html(area.name, "i")}</font>'
                frame = {"label": Html(name), "style": "dashed", "labeljust": "l"}
                group = (Defaults("graph", frame), *parts)
                inside.append(Group(cluster(f"{vertex.name} {area.name}"), group))
            if area.initial is not None:
                first = _initial(RegionId(vertex.name, area.name))
                inside.append(DotEdge(header.name, first, {"style": "invis", "weight": "8"}))
        inside += self._foot(vertex)
        return Group(cluster(vertex.name), tuple(inside))

    def _foot(self, vertex: DrawnVertex) -> Iterator[DotItem]:
        """Below all that is in a composite state: where the edges that leave it end."""
        yield DotNode(_foot(vertex.name), {"shape": "point", "style": "invis", "width": "0.01"})
        for area in vertex.areas:
            for inner in area.vertices:
                above = _foot(inner.name) if inner.is_composite else inner.name
                yield DotEdge(above, _foot(vertex.name), {"style": "invis", "minlen": "0"})
                below = _header(inner.name) if inner.is_composite else inner.name
                yield DotEdge(_header(vertex.name), below, {"style": "invis", "weight": "0"})

    # --- edges

    def _defaults(self) -> Iterator[DotEdge]:
        for region, area in self.picture.areas():
            if area.initial is not None:
                text = wrapped(area.effect)
                yield from self._forward(_initial(region), area.initial, text, region)

    def _arrows(self) -> Iterator[DotEdge]:
        bundles: dict[tuple[str, str, bool], list[Arrow]] = {}
        for arrow in self.picture.arrows:
            bundles.setdefault((arrow.source, arrow.target, arrow.local), []).append(arrow)
        for (source, target, local), arrows in bundles.items():
            text = tuple(line for arrow in arrows for line in wrapped(arrow.label))
            yield from self._arrow(source, target, text, local)

    def _arrow(
        self, source: str, target: str, text: tuple[str, ...], local: bool
    ) -> Iterator[DotEdge]:
        inner = source in self.reading.chain(target)[1:]
        within = inner or target in self.reading.chain(source)
        if inner and local:
            region = next(r for r in self.reading.regions[target] if r.owner == source)
            label = self._label(source, target, text, region)
            yield DotEdge(_header(source), label, {"arrowhead": "none"})
            yield from self._edge(label, target, region)
            return
        region = self.reading.common(source, target)
        if within:
            label = self._label(source, target, text, region)
            yield from self._edge(source, label, region, arrowhead="none")
            yield from self._edge(target, label, region, **BACKWARD)
        elif not self.reading.is_back(source, target):
            yield from self._forward(source, target, text, region)
        elif text:
            label = self._label(source, target, text, region)
            yield from self._edge(target, label, region, **BACKWARD)
            yield from self._edge(label, source, region, arrowhead="none")
        else:
            yield from self._edge(target, source, region, **BACKWARD)

    def _forward(
        self, source: str, target: str, text: tuple[str, ...], region: RegionId
    ) -> Iterator[DotEdge]:
        if not text:
            yield from self._edge(source, target, region)
            return
        label = self._label(source, target, text, region)
        yield from self._edge(source, label, region, arrowhead="none")
        yield from self._edge(label, target, region)

    def _label(self, source: str, target: str, text: tuple[str, ...], region: RegionId) -> str:
        """The node of a label, drawn in ``region``; its name. Without text, a bend of the line."""
        name = f"{source} to {target}" + (" inside" if region.owner == source else "")
        look: Attributes = {"shape": "point", "width": "0.01"}
        if text:
            inside = f'<font point-size="{SMALL}">{_left(text)}</font>'
            table = '<table border="0" cellborder="0" cellspacing="0" cellpadding="2">'
            row = Html(f'{table}<tr><td align="left">{inside}</td></tr></table>')
            look = {"shape": "plain", "label": row}
        self.labels[region].append(DotNode(name, look))
        return name

    def _edge(self, tail: str, head: str, region: RegionId, **look: str) -> Iterator[DotEdge]:
        """An edge between nodes or composite states, these clipped at their border.

        A second edge, not seen, keeps the vertex of ``region`` around one end
        above that around the other.
        """
        attributes: Attributes = dict(look)
        above, below = tail, head
        if self._is_composite(tail):
            attributes["ltail"], above = cluster(tail), _foot(tail)
        if self._is_composite(head):
            attributes["lhead"], below = cluster(head), _header(head)
        yield DotEdge(above, below, attributes)
        outer, lower = self._standing(tail, region), self._standing(head, region)
        if (outer, lower) != (tail, head):
            above = _foot(outer) if self._is_composite(outer) else outer
            below = _header(lower) if self._is_composite(lower) else lower
            yield DotEdge(above, below, {"style": "invis", "weight": "0"})

    def _is_composite(self, name: str) -> bool:
        return name in self.vertex and self.vertex[name].is_composite

    def _standing(self, name: str, region: RegionId) -> str:
        """The node, or the state around it, that stands in ``region`` itself."""
        if name not in self.vertex:
            return name
        regions = self.reading.regions[name]
        return self.reading.chain(name)[regions.index(region)]


def _header(name: str) -> str:
    return f"header {name}"


def _foot(name: str) -> str:
    return f"foot {name}"


def _initial(region: RegionId) -> str:
    return f"initial {region.owner or ''} {region.name}"


def _left(lines: Iterable[str]) -> str:
    """Lines of HTML, each to the left."""
    return "".join(f"{html(line)}{ROOM}{LEFT}" for line in lines)


def _behaviours(vertex: DrawnVertex) -> str:
    """The lines of a state's compartment, as HTML."""
    lines = [line for behaviour in vertex.behaviours for line in wrapped(behaviour)]
    return f'<font point-size="{SMALL}">{_left(lines)}</font>'


def _box(vertex: DrawnVertex) -> Html:
    """A simple state: its name, and its behaviours below a line."""
    rows = f'<tr><td cellpadding="5">{html(vertex.name, "b")}</td></tr>'
    if vertex.behaviours:
        rows += f'<hr/><tr><td cellpadding="4" align="left">{_behaviours(vertex)}</td></tr>'
    table = f'<table border="1" style="rounded" bgcolor="{PAPER}" cellborder="0" cellspacing="0"'
    return Html(f"{table}>{rows}</table>")


def _top(vertex: DrawnVertex) -> Html:
    """The top of a composite state."""
    rows = f"<tr><td>{html(vertex.name, 'b')}</td></tr>"
    if vertex.behaviours:
        rows += f'<tr><td align="left">{_behaviours(vertex)}</td></tr>'
    return Html(f'<table border="0" cellborder="0" cellspacing="0">{rows}</table>')
