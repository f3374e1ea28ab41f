# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Recorded values of a run as a picture: a panel for each, over time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ravenchart.analysis.present.plots import INK, svg
from ravenchart.analysis.system.observed import Observation

from .plots import TRUE_COLOUR
from .traces.values import Point, Series, extremes, series_of

MOST_PANELS = 24
"""Values that are drawn: the first ones of the model."""

MOST_INTERVALS = 500
"""Of more values the first and last, the least and greatest of each interval are drawn."""


def pictures(seen: Observation | None) -> Iterator[tuple[str, str]]:
    """Caption and SVG text of the values that a run has recorded; none where there are none."""
    recorded = [one for one in series_of(seen, "") if one.points] if seen else []
    if recorded:
        left = len(recorded) - MOST_PANELS
        caption = "Recorded values over time, in the time of the controller."
        caption += f" {left} more are in the trace." if left > 0 else ""
        yield caption, svg(values(recorded[:MOST_PANELS]))


def values(series: Sequence[Series]) -> Figure:
    """Each value holds until the next one is recorded."""
    figure = Figure(figsize=(11, 0.6 + 1.1 * len(series)), layout="constrained")
    panels = figure.subplots(len(series), 1, sharex=True, squeeze=False)[:, 0]
    for panel, one in zip(panels, series, strict=True):
        _panel(panel, one)
    panels[-1].set_xlabel("time in s", color=INK)
    return figure


def _panel(panel: Axes, series: Series) -> None:
    quantity, points = series.quantity, list(thinned(series.points))
    times = [at / 1e9 for at, _ in points]
    heights = [number if quantity.literals else quantity.value(number) for _, number in points]
    panel.plot(times, heights, color=TRUE_COLOUR, linewidth=1.4, drawstyle="steps-post")
    if quantity.literals:
        there = sorted({number for _, number in points})
        panel.set_yticks(there, [quantity.literals[number] for number in there])
    unit = f" in {quantity.unit}" if quantity.unit else ""
    panel.set_title(f"{series.name}{unit}", color=INK, fontsize=9, loc="left")
    panel.tick_params(colors=INK, labelsize=8)
    panel.grid(color=INK, alpha=0.13, linewidth=0.6)
    for side, spine in panel.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(INK)


def thinned(points: Sequence[Point]) -> Iterator[Point]:
    """The points, or of too many what still shows their extremes, in order of time."""
    if len(points) <= 4 * MOST_INTERVALS:
        yield from points
        return
    first, span = points[0][0], points[-1][0] - points[0][0] + 1
    for _, group in groupby(points, lambda one: (one[0] - first) * MOST_INTERVALS // span):
        yield from extremes(list(group))
