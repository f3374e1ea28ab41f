# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A picture of a chart as PlantUML text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from .picture import Area, DrawnVertex, Picture, Shape

_STEREOTYPES: Mapping[Shape, str] = {
    Shape.FINAL: "end",
    Shape.CHOICE: "choice",
    Shape.JUNCTION: "start",
    Shape.HISTORY: "history",
    Shape.DEEP_HISTORY: "history*",
    Shape.FORK: "fork",
    Shape.JOIN: "join",
    Shape.TERMINATE: "terminate",
}


def plantuml(picture: Picture) -> str:
    """The text of a chart. Its first lines name the parts that PlantUML cannot draw."""
    shapes = {vertex.shape for vertex, _ in picture.vertices()}
    lines = ["@startuml", f"title {picture.title}", *_remarks(picture, shapes)]
    lines += ["hide empty description", *_area(picture.area)]
    for arrow in picture.arrows:
        label = ("local: " if arrow.local else "") + arrow.label.text
        lines.append(f"{arrow.source} --> {arrow.target}{_after_colon(label)}")
    return "".join(f"{line}\n" for line in (*lines, "@enduml"))


def _remarks(picture: Picture, shapes: set[Shape]) -> Iterator[str]:
    if Shape.JUNCTION in shapes:
        yield "' PlantUML has no junction: it is drawn as an initial pseudostate."
    if Shape.TERMINATE in shapes:
        yield "' PlantUML has no terminate pseudostate: it is drawn as a state."
    if any(arrow.local for arrow in picture.arrows):
        yield "' PlantUML has no local transitions: their labels say so."


def _area(area: Area) -> Iterator[str]:
    for vertex in area.vertices:
        yield from _vertex(vertex)
    if area.initial is not None:
        yield f"[*] --> {area.initial}{_after_colon(area.effect.text)}"


def _vertex(vertex: DrawnVertex) -> Iterator[str]:
    stereotype = _STEREOTYPES.get(vertex.shape)
    head = f"state {vertex.name}" + (f" <<{stereotype}>>" if stereotype else "")
    if not vertex.is_composite:
        yield head
    else:
        yield f"{head} {{"
        for index, area in enumerate(vertex.areas):
            if index > 0:
                yield "  --"
            if len(vertex.areas) > 1:
                yield f"  ' region {area.name}"
            yield from (f"  {line}" for line in _area(area))
        yield "}"
    for behaviour in vertex.behaviours:
        yield f"{vertex.name} : {behaviour.text}"


def _after_colon(text: str) -> str:
    return f" : {text}" if text else ""
