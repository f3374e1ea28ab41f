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
from ravenchart.gen.model.system import System
from ravenchart.tools import toolchain


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of drawing: the text of a chart, that of a structure, how files end."""

    suffix: str
    chart: Callable[[Picture], str]
    structure: Callable[[System], str]


FORMATS: Mapping[str, Format] = {
    "svg": Format(".svg", chart_dot, structure_dot),
    "plantuml": Format(".puml", plantuml, structure_text.plantuml),
    "mermaid": Format(".mmd", mermaid, structure_text.mermaid),
}


def texts(system: System, form: str = "svg") -> dict[str, str]:
    """File name to text of every drawing of a system; for SVG the DOT that it is made of."""
    chosen = FORMATS[form]
    charts = (picture(c, region) for c in system.components for region in c.regions)
    made = {f"{chart.title}{chosen.suffix}": chosen.chart(chart) for chart in charts}
    return {f"structure{chosen.suffix}": chosen.structure(system), **made}


def svg(dot: str) -> str:
    """The drawing of a DOT text; ToolMissing without Graphviz."""
    return finished(toolchain.filtered("dot", ["-Tsvg"], dot), dot)
