# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of an analysis: room left, critical instants, hops of chains, observed reactions."""

from __future__ import annotations

import io
from collections.abc import Sequence
from fractions import Fraction

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from ravenchart import rounded
from ravenchart.analysis.core.chains import Latency
from ravenchart.analysis.system.critical import GIVEN, RunningSlice
from ravenchart.analysis.units import MS

from .sentences import families

INK = "#1c2128"
"""The colour of text and axes; a page replaces it by its own."""

WAITING = "#b08900"
"""The colour of waits, as of the report's jitter."""

COLOURS = {
    "own": "#2f6fb3",
    "blocking": "#8250b8",
    "interference": "#d0743c",
    "overhead": "#7a8490",
}
"""The colours of the kinds of slices, as in the report's bars."""

LEGIBLE_GROWTH = 10.0
"""Factors above this are cut off in the picture."""


def figure_svg(figure: Figure) -> str:
    """The transparent picture, its text and axes in the colour of the page around it."""
    out = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "ravenchart"}):
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg") :].replace(INK, "currentColor")


def room(factors: Sequence[tuple[str, Fraction]], whole: Fraction | None) -> Figure:
    """The factors of the execution times of each task alone; a line for all together."""
    figure = Figure(figsize=(11, 1.1 + 0.3 * len(factors)), layout="constrained")
    axes = figure.subplots()
    names = [name for name, _ in factors]
    shown = [min(float(factor), LEGIBLE_GROWTH) for _, factor in factors]
    axes.barh(names, shown, color=COLOURS["own"], height=0.6)
    for place, (_, factor) in enumerate(factors):
        text = rounded.factor(factor) + (" (not to scale)" if factor >= LEGIBLE_GROWTH else "")
        axes.text(shown[place] + 0.06, place, text, va="center", color=INK, fontsize=8.5)
    axes.axvline(1, color=INK, linewidth=1)
    if whole is not None and whole < LEGIBLE_GROWTH:
        at, text = float(whole), f" all together: {rounded.factor(whole)}"
        axes.axvline(at, color=COLOURS["interference"], linewidth=1.4, linestyle="--")
        axes.text(at, -0.75, text, color=INK, fontsize=8.5, va="bottom")
    axes.set_xlim(0, LEGIBLE_GROWTH * 1.12)
    axes.set_xlabel("factor of execution times; 1 is the model's", color=INK)
    axes.invert_yaxis()
    _plain(axes)
    return figure


def gantt(slices: Sequence[RunningSlice], deadline: int, blocked: str = "in a section") -> Figure:
    """A critical instant; ``deadline`` counts from its beginning, ``blocked`` labels blocking."""
    label = _labels(slices, blocked)
    order: dict[str, int] = {}
    for piece in sorted(slices, key=_depth):
        order.setdefault(label[piece.name, piece.kind], len(order))
    figure = Figure(figsize=(11, 0.9 + 0.32 * len(order)), layout="constrained")
    axes = figure.subplots()
    for kind, colour in COLOURS.items():
        for piece in slices:
            if piece.kind == kind:
                at, length = piece.start / 1e3, (piece.end - piece.start) / 1e3
                row = order[label[piece.name, piece.kind]]
                axes.broken_barh([(at, length)], (row - 0.3, 0.6), color=colour, linewidth=0)
    end = max(piece.end for piece in slices)
    if deadline <= 2 * end:
        axes.axvline(deadline / 1e3, color=INK, linewidth=1.6)
        axes.text(deadline / 1e3, -0.8, "deadline", color=INK, fontsize=8.5, ha="right")
    axes.set_yticks(list(order.values()), list(order))
    axes.set_xlim(0, max(end, deadline if deadline <= 2 * end else 0) / 1e3 * 1.02)
    axes.set_ylim(len(order) - 0.4, -0.9)
    axes.set_xlabel("us from the beginning of the busy period", color=INK)
    _plain(axes)
    return figure


Piece = tuple[str, int, int, int]
"""A hop: its name, its beginning, its wait, and its response."""


def hop_pieces(found: Latency) -> list[Piece]:
    """The hops of a chain up to the first without a bound, in ns from its input."""
    pieces: list[Piece] = []
    now = 0
    for hop in found.hops:
        if hop.wait is None or hop.response is None:
            break
        pieces.append((hop.step.name, now, hop.wait, hop.response))
        now += hop.wait + hop.response
    return pieces


def hops(pieces: Sequence[Piece], reaction: int | None, limit: int) -> Figure:
    """The hops of a chain as a Gantt chart; ``limit`` is 0 where the reaction has none."""
    figure = Figure(figsize=(11, 0.9 + 0.32 * len(pieces)), layout="constrained")
    axes = figure.subplots()
    for place, (_, start, wait, response) in enumerate(pieces):
        at, between = (place - 0.3, 0.6), (start + wait) / 1e6
        axes.broken_barh([(start / 1e6, wait / 1e6)], at, color=WAITING, linewidth=0)
        axes.broken_barh([(between, response / 1e6)], at, color=COLOURS["own"], linewidth=0)
    end = max(start + wait + response for _, start, wait, response in pieces)
    lines = [("reaction", reaction)] if reaction is not None else []
    if limit and limit <= 2 * end:
        lines.append(("limit", limit))
    _lines(axes, lines)
    axes.set_yticks(range(len(pieces)), [name for name, *_ in pieces])
    axes.set_xlim(0, max(end, *(time for _, time in lines), 1) / 1e6 * 1.06)
    axes.set_ylim(len(pieces) - 0.4, -0.9)
    axes.set_xlabel("ms from an input that was just missed", color=INK)
    _plain(axes)
    return figure


BINS = 30
"""Bars of a histogram at most."""


def histogram(times: Sequence[int], lines: Sequence[tuple[str, int]], seen: str) -> Figure:
    """How often each time was observed, beside a bound and perhaps a limit."""
    unit, factor = ("ms", 1e6) if max(*times, lines[0][1]) >= MS else ("us", 1e3)
    figure = Figure(figsize=(11, 2.4), layout="constrained")
    axes = figure.subplots()
    bins = min(BINS, max(1, len(set(times))))
    axes.hist([time / factor for time in times], bins=bins, color=COLOURS["own"])
    axes.set_ylim(0, axes.get_ylim()[1] * 1.15)
    drawn = [line for line in lines if line[1] <= 2 * max(lines[0][1], *times)]
    _lines(axes, drawn, factor)
    axes.set_xlim(0, max(*times, *(time for _, time in drawn)) / factor * 1.06)
    axes.yaxis.set_major_locator(MaxNLocator(integer=True))
    axes.set_xlabel(f"{seen} in {unit}", color=INK)
    axes.set_ylabel(f"{seen}s", color=INK, fontsize=8.5)
    _plain(axes)
    return figure


def _lines(axes: Axes, lines: Sequence[tuple[str, int]], factor: float = 1e6) -> None:
    """Vertical lines at bounds and limits in ns, each with its name."""
    for name, time in lines:
        limit = name == "limit"
        colour = COLOURS["interference"] if limit else INK
        axes.axvline(time / factor, color=colour, linewidth=1.6, linestyle="--" if limit else "-")
        axes.annotate(name, (time / factor, 1), xycoords=("data", "axes fraction"), color=INK,
                      xytext=(-3, -2) if not limit else (3, -2), textcoords="offset points",
                      fontsize=8.5, ha="left" if limit else "right", va="top")  # fmt: skip


def _depth(piece: RunningSlice) -> tuple[int, int]:
    """The order of the rows: overhead first, the task itself last, blocking before it."""
    order = {"overhead": 0, "interference": 1, "blocking": 2, "own": 3}
    return order[piece.kind], piece.start


def _labels(slices: Sequence[RunningSlice], blocked: str) -> dict[tuple[str, str], str]:
    """The row of each slice; interfering tasks that differ only in the last part share one."""
    names = dict.fromkeys(piece.name for piece in slices if piece.kind == "interference")
    family = {member: name for name, members in families(names).items() for member in members}
    return {
        (piece.name, piece.kind): f"{piece.name}, {blocked}"
        if piece.kind == "blocking" and piece.name != GIVEN
        else family.get(piece.name, piece.name)
        for piece in slices
    }


def _plain(axes: Axes) -> None:
    """Axes without unneeded lines."""
    axes.tick_params(colors=INK, labelsize=8.5)
    axes.grid(axis="x", color=INK, alpha=0.13, linewidth=0.6)
    axes.set_axisbelow(True)
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(INK)
