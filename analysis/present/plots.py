"""Pictures of an analysis: how much room is left, and the critical instant of a task."""

from __future__ import annotations

import io
from collections.abc import Sequence

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ravenchart.analysis.system.critical import Slice

from .words import families

INK = "#1c2128"
"""Of text and axes; a page replaces it by its own."""

COLOURS = {
    "own": "#2f6fb3",
    "blocking": "#8250b8",
    "interference": "#d0743c",
    "overhead": "#7a8490",
}
"""Of the kinds of slices, as the report's bars have them."""

LEGIBLE_GROWTH = 10.0
"""Factors above this are cut off in the picture."""


def svg(figure: Figure) -> str:
    """The picture on nothing, its text and axes in the colour of the page around it."""
    out = io.StringIO()
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "ravenchart"}):
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg") :].replace(INK, "currentColor")


def room(factors: Sequence[tuple[str, float]], whole: float | None) -> Figure:
    """How far the execution times of each task can be scaled alone; a line for all together."""
    figure = Figure(figsize=(11, 1.1 + 0.3 * len(factors)), layout="constrained")
    axes = figure.subplots()
    names = [name for name, _ in factors]
    shown = [min(factor, LEGIBLE_GROWTH) for _, factor in factors]
    axes.barh(names, shown, color=COLOURS["own"], height=0.6)
    for place, (_, factor) in enumerate(factors):
        text = f"{factor:.2f}" if factor < LEGIBLE_GROWTH else f"{factor:.0f} (not to scale)"
        axes.text(shown[place] + 0.06, place, text, va="center", color=INK, fontsize=8.5)
    axes.axvline(1, color=INK, linewidth=1)
    if whole is not None and whole < LEGIBLE_GROWTH:
        axes.axvline(whole, color=COLOURS["interference"], linewidth=1.4, linestyle="--")
        axes.text(whole, -0.75, f" all together: {whole:.2f}", color=INK, fontsize=8.5, va="bottom")
    axes.set_xlim(0, LEGIBLE_GROWTH * 1.12)
    axes.set_xlabel("factor of execution times; 1 is the model's", color=INK)
    axes.invert_yaxis()
    _plain(axes)
    return figure


def gantt(slices: Sequence[Slice], deadline: int) -> Figure:
    """A critical instant; ``deadline`` counts from the beginning of the busy period."""
    label = _labels(slices)
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


def _depth(piece: Slice) -> tuple[int, int]:
    """What is above all first, the task itself last, blocking before it."""
    order = {"overhead": 0, "interference": 1, "blocking": 2, "own": 3}
    return order[piece.kind], piece.start


def _labels(slices: Sequence[Slice]) -> dict[tuple[str, str], str]:
    """The row of each slice: rivals whose names differ in the last part only share one."""
    rivals = dict.fromkeys(piece.name for piece in slices if piece.kind == "interference")
    family = {member: name for name, members in families(rivals).items() for member in members}
    return {
        (piece.name, piece.kind): f"{piece.name}, in a section"
        if piece.kind == "blocking"
        else family.get(piece.name, piece.name)
        for piece in slices
    }


def _plain(axes: Axes) -> None:
    """Axes without what says nothing."""
    axes.tick_params(colors=INK, labelsize=8.5)
    axes.grid(axis="x", color=INK, alpha=0.13, linewidth=0.6)
    axes.set_axisbelow(True)
    for side, spine in axes.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(INK)
