# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A picture of a chart as a Mermaid state diagram (``stateDiagram-v2``)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ravenchart.gen.model.statechart import RegionId

from .order import Arrangement
from .picture import Area, Arrow, DrawnVertex, Picture, Shape

_STEREOTYPES: Mapping[Shape, str] = {
    Shape.CHOICE: "choice",
    Shape.JUNCTION: "choice",
    Shape.FORK: "fork",
    Shape.JOIN: "join",
}
_WORDS: Mapping[Shape, str] = {
    Shape.HISTORY: "H",
    Shape.DEEP_HISTORY: "H*",
    Shape.TERMINATE: "terminate",
}
"""The text in the box of a vertex that Mermaid has no shape for."""


_ENTITIES = str.maketrans({";": "#59;", ":": "#58;", "<": "#lt;", ">": "#gt;"})
_RESERVED = frozenset(
    [
        "as",
        "choice",
        "class",
        "classdef",
        "click",
        "default",
        "direction",
        "end",
        "fork",
        "hide",
        "join",
        "note",
        "state",
        "style",
    ]
)


def mermaid(picture: Picture) -> str:
    """The text of a chart. Its first lines name the parts that Mermaid cannot draw."""
    lines = ["---", f"title: {picture.title}", "---", "stateDiagram-v2"]
    lines += [f"  {line}" for line in (*_remarks(picture), *_Drawing(picture).lines())]
    return "".join(f"{line}\n" for line in lines)


def _remarks(picture: Picture) -> Iterator[str]:
    shapes = {vertex.shape for vertex, _ in picture.vertices()}
    if shapes & {Shape.HISTORY, Shape.DEEP_HISTORY, Shape.TERMINATE}:
        yield "%% Mermaid has no history and no terminate pseudostate: they are boxes."
    if Shape.JUNCTION in shapes:
        yield "%% Mermaid has no junction: it is drawn as a choice."
    if any(vertex.is_composite and vertex.behaviours for vertex, _ in picture.vertices()):
        yield "%% Mermaid has no compartments in composite states: their behaviours are notes."
    if any(arrow.local for arrow in picture.arrows):
        yield "%% Mermaid has no local transitions: their labels say so."
    yield "%% Mermaid may refuse a transition between the insides of two composite states."


class _Drawing:
    """The statements of one chart, each transition in the area around both its ends."""

    def __init__(self, picture: Picture) -> None:
        self.picture = picture
        self.arrows: dict[RegionId, list[Arrow]] = {region: [] for region, _ in picture.areas()}
        reading = Arrangement(picture)
        for arrow in picture.arrows:
            self.arrows[reading.common(arrow.source, arrow.target)].append(arrow)

    def lines(self) -> Iterator[str]:
        """All of them."""
        return self._area(self.picture.area, None)

    def _area(self, area: Area, owner: str | None) -> Iterator[str]:
        for vertex in area.vertices:
            yield from self._vertex(vertex)
        if area.initial is not None:
            yield f"[*] --> {_id(area.initial)}{_after_colon(area.effect.text)}"
        ends = {vertex.name for vertex in area.vertices if vertex.shape is Shape.FINAL}
        for arrow in self.arrows[RegionId(owner, area.name)]:
            target = "[*]" if arrow.target in ends else _id(arrow.target)
            label = ("local: " if arrow.local else "") + arrow.label.text
            yield f"{_id(arrow.source)} --> {target}{_after_colon(label)}"

    def _vertex(self, vertex: DrawnVertex) -> Iterator[str]:
        name = _id(vertex.name)
        if vertex.is_composite:
            yield f"state {name} {{"
            for index, area in enumerate(vertex.areas):
                if index > 0:
                    yield "  --"
                yield from (f"  {line}" for line in self._area(area, vertex.name))
            yield "}"
            if vertex.behaviours:
                yield f"note right of {name}"
                yield from (f"  {_safe(behaviour.text)}" for behaviour in vertex.behaviours)
                yield "end note"
        elif vertex.shape in _STEREOTYPES:
            yield f"state {name} <<{_STEREOTYPES[vertex.shape]}>>"
        elif vertex.shape is not Shape.FINAL:
            words = _WORDS.get(vertex.shape, vertex.name)
            yield f'state "{words}" as {name}' if words != name else name
            yield from (f"{name}{_after_colon(b.text)}" for b in vertex.behaviours)


def _id(name: str) -> str:
    """The name, changed where Mermaid would take it for a word of its own."""
    return f"{name}_" if name.lower() in _RESERVED else name


def _safe(text: str) -> str:
    """The text with entities for what Mermaid would take for the end of it, or for HTML."""
    return text.translate(_ENTITIES)


def _after_colon(text: str) -> str:
    return f" : {_safe(text)}" if text else ""
