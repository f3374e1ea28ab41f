# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claims as a tree in Goal Structuring Notation, as SVG.

Goals are rectangles, the strategy is a parallelogram, solutions are circles, assumptions are
ellipses and contexts are rounded. A diamond below a goal says that it is not developed: nothing
here shows it. GSN Community Standard, version 3.
"""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as Xml

from .claim import Claim, ClaimKind, Shown

MOST = 30
"""Claims of a kind that are drawn one by one; of more only their number."""
STEP = 44
"""Height of a row."""
COLUMNS = (20, 270, 500, 800, 1250)
"""Where goal, strategy, goals of kinds, claims and solutions begin."""
WIDTHS = (210, 190, 260, 410, 36)
WIDTH = 1330
FILLS = {
    Shown.MET: ("#e4f4ea", "#176b3a"),
    Shown.PARTLY: ("#fdf3d7", "#8a6500"),
    Shown.NOT_MET: ("#fce9e8", "#a11d1d"),
    Shown.NOT_SHOWN: ("#fce9e8", "#a11d1d"),
    Shown.USERS: ("#eef1f5", "#57606a"),
}
PLAIN = ("#ffffff", "#1c2128")
RANK = (Shown.MET, Shown.PARTLY, Shown.USERS, Shown.NOT_SHOWN, Shown.NOT_MET)
"""From the best to the worst."""


def worst(claims: Sequence[Claim]) -> Shown:
    """The worst verdict of several claims."""
    return max((claim.verdict for claim in claims), key=RANK.index, default=Shown.NOT_SHOWN)


@dataclass(slots=True)
class _Row:
    text: str
    verdict: Shown
    told: str = ""
    """The text that appears when a reader points at it."""


def draw(system: str, digest: str, claims: Sequence[Claim], assumptions: Sequence[str]) -> str:
    """The whole tree as SVG text."""
    groups = [(kind, [c for c in claims if c.kind is kind]) for kind in ClaimKind]
    groups = [(kind, found) for kind, found in groups if found]
    rows = [(kind, found, _rows(found)) for kind, found in groups]
    height = STEP * sum(max(2, len(listed)) for _, _, listed in rows) + 60 + 12 * len(rows)
    svg = Xml.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "viewBox": f"0 0 {WIDTH} {max(height, 420)}",
            "font-family": "DejaVu Sans, Arial, sans-serif",
            "font-size": "11",
            "role": "img",
            "aria-label": f"Claim tree of {system} in GSN",
        },
    )
    middle = max(height, 420) / 2
    top = 30.0
    number = 2
    for kind, found, listed in rows:
        size = STEP * max(2, len(listed))
        centre = top + size / 2
        _line(svg, COLUMNS[1] + WIDTHS[1], middle, COLUMNS[2], centre)
        _goal(svg, 2, centre, f"G{number}", kind.value, worst(found), 50)
        for index, row in enumerate(listed):
            at = top + size / 2 + STEP * (index - (len(listed) - 1) / 2)
            _line(svg, COLUMNS[2] + WIDTHS[2], centre, COLUMNS[3], at)
            _goal(svg, 3, at, f"G{number}.{index + 1}", row.text, row.verdict, STEP - 8)
            _end(svg, at, f"Sn{number}.{index + 1}", row)
        top += size + 12
        number += 1
    _goal(svg, 0, middle, "G1", f"{system} does what its model says, in time", worst(claims), 60)
    _line(svg, COLUMNS[0] + WIDTHS[0], middle, COLUMNS[1], middle)
    _strategy(svg, middle)
    _context(svg, middle - 130, f"C1 Model with the digest {digest[:16]}...")
    _assumption(svg, middle + 130, f"A1 {len(assumptions)} assumptions: {', '.join(assumptions)}")
    Xml.indent(svg, " ")
    return Xml.tostring(svg, encoding="unicode") + "\n"


def _rows(claims: Sequence[Claim]) -> list[_Row]:
    if len(claims) <= MOST:
        return [
            _Row(
                f"{c.id}: {c.verdict.value}", c.verdict, f"{c.statement}. By {c.method}; {c.tool}."
            )
            for c in claims
        ]
    rows = []
    for verdict in RANK:
        count = sum(claim.verdict is verdict for claim in claims)
        if count:
            rows.append(_Row(f"{count} of {len(claims)} claims: {verdict.value}", verdict))
    return rows


def _line(svg: Xml.Element, x1: float, y1: float, x2: float, y2: float) -> None:
    half = (x1 + x2) / 2
    path = f"M{x1:g} {y1:g} C{half:g} {y1:g} {half:g} {y2:g} {x2:g} {y2:g}"
    Xml.SubElement(svg, "path", {"d": path, "fill": "none", "stroke": "#7a8490"})


def _goal(
    svg: Xml.Element, column: int, y: float, label: str, text: str, verdict: Shown, height: int
) -> None:
    x, width = COLUMNS[column], WIDTHS[column]
    fill, stroke = FILLS[verdict]
    box = {"x": f"{x}", "y": f"{y - height / 2:g}", "width": f"{width}", "height": f"{height}"}
    Xml.SubElement(svg, "rect", {**box, "fill": fill, "stroke": stroke})
    _text(svg, x + 8, y, f"{label} {text}", (width - 16) // 6)


def _strategy(svg: Xml.Element, y: float) -> None:
    x, width = COLUMNS[1], WIDTHS[1]
    high, low = f"{y - 30:g}", f"{y + 30:g}"
    points = f"{x + 16},{high} {x + width},{high} {x + width - 16},{low} {x},{low}"
    Xml.SubElement(svg, "polygon", {"points": points, "fill": PLAIN[0], "stroke": PLAIN[1]})
    _text(svg, x + 24, y, "S1 Argument over each kind of claim, claim by claim", 24)


def _context(svg: Xml.Element, y: float, text: str) -> None:
    x, width = COLUMNS[0], WIDTHS[0]
    box = {"x": f"{x}", "y": f"{y - 25:g}", "width": f"{width}", "height": "50", "rx": "20"}
    Xml.SubElement(svg, "rect", {**box, "fill": PLAIN[0], "stroke": PLAIN[1]})
    _text(svg, x + 16, y, text, 30)
    _dashed(svg, y + 25, y + 100)


def _assumption(svg: Xml.Element, y: float, text: str) -> None:
    x, width = COLUMNS[0], WIDTHS[0] + 30
    middle = {"cx": f"{x + width / 2:g}", "cy": f"{y:g}", "rx": f"{width / 2:g}", "ry": "62"}
    Xml.SubElement(svg, "ellipse", {**middle, "fill": PLAIN[0], "stroke": PLAIN[1]})
    _text(svg, x + 38, y, text, 28)
    _dashed(svg, y - 100, y - 62)


def _dashed(svg: Xml.Element, y1: float, y2: float) -> None:
    x = COLUMNS[0] + WIDTHS[0] / 2
    ends = {"x1": f"{x:g}", "y1": f"{y1:g}", "x2": f"{x:g}", "y2": f"{y2:g}"}
    Xml.SubElement(svg, "line", {**ends, "stroke": "#7a8490", "stroke-dasharray": "4 3"})


def _end(svg: Xml.Element, y: float, label: str, row: _Row) -> None:
    """A solution where something shows the claim, else the diamond of what is not developed."""
    x = COLUMNS[4] + 18
    fill, stroke = FILLS[row.verdict]
    _line(svg, COLUMNS[3] + WIDTHS[3], y, x - 18, y)
    if row.verdict in (Shown.NOT_SHOWN, Shown.USERS):
        points = f"{x},{y - 15:g} {x + 15},{y:g} {x},{y + 15:g} {x - 15},{y:g}"
        Xml.SubElement(svg, "polygon", {"points": points, "fill": PLAIN[0], "stroke": stroke})
        return
    circle = {"cx": f"{x}", "cy": f"{y:g}", "r": "18", "fill": fill, "stroke": stroke}
    Xml.SubElement(Xml.SubElement(svg, "circle", circle), "title").text = row.told
    middle = {"x": f"{x}", "y": f"{y + 3:g}", "text-anchor": "middle", "font-size": "9"}
    Xml.SubElement(svg, "text", middle).text = label


def _text(svg: Xml.Element, x: float, y: float, text: str, columns: int) -> None:
    lines = textwrap.wrap(text, columns, max_lines=8, placeholder=" ...")
    first = y - 6.5 * (len(lines) - 1) + 4
    holder = Xml.SubElement(svg, "text", {"fill": PLAIN[1]})
    for index, line in enumerate(lines):
        place = {"x": f"{x:g}", "y": f"{first + 13 * index:g}"}
        Xml.SubElement(holder, "tspan", place).text = line
