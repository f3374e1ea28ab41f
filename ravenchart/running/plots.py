# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The run as a picture: position of each axis over time, its states as a band above."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from ravenchart.analysis.present.plots import INK
from ravenchart.hw_can.bench.drives import AxisTrack
from ravenchart.hw_can.bench.plant_stations import PlantTrack

PALETTE = (
    "#8aa4bf",
    "#e3b04b",
    "#c98bb9",
    "#6fb07f",
    "#3f8f8a",
    "#5c7fd6",
    "#d1603d",
    "#9b2f2f",
    "#7b6bb0",
    "#b5b54a",
    "#5aa9c9",
    "#a97c50",
)
"""Colours of the states, in the order in which they come up."""

TRUE_COLOUR = "#2f6fb3"
TARGET_COLOUR = "#d0743c"
BAND = 0.10
"""Height of the band of states, as a share of a panel."""


@dataclass(frozen=True, slots=True)
class Stay:
    """A stay in a state, in s from the bench's start."""

    state: str
    start: float
    end: float


@dataclass(frozen=True, slots=True)
class OperatorMark:
    """Something that the operator did, in s from the bench's start."""

    at: float
    text: str


def positions(
    tracks: Mapping[str, AxisTrack],
    states: Mapping[str, Sequence[Stay]],
    marks: Sequence[OperatorMark],
) -> Figure:
    """Target and true position of every axis over time, in mm from its low hard stop."""
    figure = Figure(figsize=(11, 0.9 + 2.25 * len(tracks)), layout="constrained")
    panels = figure.subplots(len(tracks), 1, sharex=True, squeeze=False)[:, 0]
    colours = _colours(states)
    for panel, (name, track) in zip(panels, tracks.items(), strict=True):
        _panel(panel, name, track)
        _bands(panel, states.get(name, ()), colours, track.time[-1] if track.time else 1.0)
        for mark in marks:
            panel.axvline(mark.at, color=INK, linewidth=0.7, linestyle=":", alpha=0.55)
    _label_marks(panels[0], marks)
    panels[-1].set_xlabel("time in s", color=INK)
    handles = [*panels[0].get_lines()[:2]]
    handles += [Patch(color=colour, label=state) for state, colour in colours.items()]
    figure.legend(
        handles=handles,
        loc="outside lower center",
        ncols=min(7, max(1, len(handles))),
        frameon=False,
        fontsize=8.5,
        labelcolor=INK,
    )
    return figure


def plant_values(tracks: Mapping[str, PlantTrack]) -> Figure:
    """Each value of each plant over time, in the unit of its field."""
    curves = [
        (f"{name}.{output}", track.time, values)
        for name, track in tracks.items()
        for output, values in track.values.items()
    ]
    figure = Figure(figsize=(11, 0.6 + 1.5 * len(curves)), layout="constrained")
    panels = figure.subplots(len(curves), 1, sharex=True, squeeze=False)[:, 0]
    for panel, (name, times, values) in zip(panels, curves, strict=True):
        panel.plot(times, values, color=TRUE_COLOUR, linewidth=1.6)
        panel.set_ylabel(name, color=INK)
        _quiet(panel)
    panels[-1].set_xlabel("time in s", color=INK)
    return figure


def png(figure: Figure) -> bytes:
    """The picture on white, at 130 dots an inch."""
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=130, facecolor="white")
    return out.getvalue()


def _panel(panel: Axes, name: str, track: AxisTrack) -> None:
    """The curves of one axis."""
    target = [math.nan if t is None else t / 1e3 for t in track.target]
    true = [p / 1e3 for p in track.position]
    panel.plot(
        track.time,
        target,
        color=TARGET_COLOUR,
        linewidth=1.4,
        linestyle="--",
        label="target",
        drawstyle="steps-post",
    )
    panel.plot(track.time, true, color=TRUE_COLOUR, linewidth=1.8, label="true position")
    panel.set_ylabel(f"{name} in mm", color=INK)
    values = [v for v in (*true, *target) if not math.isnan(v)] or [0.0]
    low, high = min(values), max(values)
    room = max(high - low, 1.0)
    panel.set_ylim(low - 0.06 * room, high + (0.08 + 2 * BAND) * room)
    _quiet(panel)


def _quiet(panel: Axes) -> None:
    """Faint lines, and no frame at the top and the right."""
    panel.tick_params(colors=INK, labelsize=9)
    panel.grid(color=INK, alpha=0.13, linewidth=0.6)
    for side, spine in panel.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(INK)


def _bands(panel: Axes, spans: Sequence[Stay], colours: Mapping[str, str], end: float) -> None:
    """The states along the upper edge, named where there is room."""
    panel.set_xlim(0, end)
    for span in spans:
        start, stop = max(0.0, span.start), min(end, span.end)
        if stop <= start:
            continue
        panel.axvspan(start, stop, 1 - BAND, 1, color=colours[span.state], linewidth=0, zorder=3)
        if (stop - start) / end > 0.0095 * len(span.state):
            panel.text(
                (start + stop) / 2,
                1 - BAND / 2,
                span.state.replace("_", " "),
                transform=panel.get_xaxis_transform(),
                ha="center",
                va="center",
                fontsize=8,
                zorder=4,
                color="#ffffff" if _dark(colours[span.state]) else "#10141a",
            )


def _label_marks(panel: Axes, marks: Sequence[OperatorMark]) -> None:
    """Write the operator's actions above the first panel."""
    for mark in marks:
        panel.text(
            mark.at,
            1.02,
            mark.text,
            transform=panel.get_xaxis_transform(),
            fontsize=8.5,
            color=INK,
            ha="left",
            va="bottom",
        )


def _colours(states: Mapping[str, Sequence[Stay]]) -> dict[str, str]:
    """One colour for each state name."""
    names = dict.fromkeys(span.state for spans in states.values() for span in spans)
    return {name: PALETTE[index % len(PALETTE)] for index, name in enumerate(names)}


def _dark(colour: str) -> bool:
    """Whether white text reads better on it."""
    red, green, blue = (int(colour[i : i + 2], 16) for i in (1, 3, 5))
    return 0.299 * red + 0.587 * green + 0.114 * blue < 140
