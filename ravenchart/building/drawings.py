# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The drawings of a system: the text of each, and what Graphviz makes of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ravenchart.gen.draw import structure_text
from ravenchart.gen.draw.chart import chart_dot
from ravenchart.gen.draw.mermaid import mermaid
from ravenchart.gen.draw.picture import Picture, picture
from ravenchart.gen.draw.plantuml import plantuml
from ravenchart.gen.draw.structure import structure_dot
from ravenchart.gen.draw.svg import finished
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System
from ravenchart.tools import toolchain


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of drawing: the text of a chart, that of a structure, how files end."""

    suffix: str
    chart: Callable[[Picture], str]
    structure: Callable[[System], str]


STRUCTURE = "structure"
"""The name of the drawing of the structure; that of a chart is ``Component.Region``."""

FORMATS: Mapping[str, Format] = {
    "svg": Format(".svg", chart_dot, structure_dot),
    "plantuml": Format(".puml", plantuml, structure_text.plantuml),
    "mermaid": Format(".mmd", mermaid, structure_text.mermaid),
}


def charts(system: System) -> dict[str, tuple[Component, Region]]:
    """The charts of a system by the names of their drawings."""
    return {
        f"{c.name}.{region.name}": (c, region) for c in system.components for region in c.regions
    }


def names(system: System) -> tuple[str, ...]:
    """The drawings of a system."""
    return (STRUCTURE, *charts(system))


def text(system: System, name: str, form: str = "svg") -> str | None:
    """The text of a drawing, of SVG the DOT that it is made of; None of one that is not there."""
    if name == STRUCTURE:
        return FORMATS[form].structure(system)
    found = charts(system).get(name)
    return None if found is None else FORMATS[form].chart(picture(*found))


def texts(system: System, form: str = "svg") -> dict[str, str]:
    """File name to text of every drawing of a system."""
    made = ((name, text(system, name, form)) for name in names(system))
    return {f"{name}{FORMATS[form].suffix}": one for name, one in made if one is not None}


def svg(dot: str) -> str:
    """The drawing of a DOT text; ToolMissing without Graphviz."""
    return finished(toolchain.filtered("dot", ["-Tsvg"], dot), dot)
