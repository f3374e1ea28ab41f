# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rows and pictures of a report that models and plain files have in common."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from markupsafe import Markup

from ravenchart.analysis.core.chains import ChainStep, HopKind, Latency
from ravenchart.analysis.core.holistic import Holistic
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.system.critical import frame_schedule, schedule

from . import plots

SHOWN_INSTANTS = 6
"""Critical instants of each kind that a report draws at most."""

HOPS = {
    HopKind.RELEASED: "at once",
    HopKind.SAMPLED: "samples, every T",
    HopKind.QUEUED: "takes the oldest of a queue",
    HopKind.WOKEN: "released by a queue",
}
"""How data reach a step of a chain, in words."""


def hop_cells(found: Latency) -> list[tuple[str, str, int | None, int | None, int | None]]:
    """Each hop: its name, how data reach it, its wait, its response and its renewal."""
    return [
        (hop.step.name, _how(hop.step), hop.wait, hop.response, hop.renewal) for hop in found.hops
    ]


def _how(step: ChainStep) -> str:
    """How data reach a step."""
    return "samples, at known instants" if step.lasting else HOPS[step.hop]


def chain_picture(found: Latency) -> Markup | None:
    """The hops of a chain one after the other; none where the first has no bound."""
    pieces = plots.hop_pieces(found)
    if not pieces:
        return None
    return Markup(plots.figure_svg(plots.hops(pieces, found.reaction, found.chain.reaction_limit)))


def histogram_of(times: Sequence[int], lines: Sequence[tuple[str, int]], seen: str) -> Markup:
    """How often each time was observed, beside its bounds."""
    return Markup(plots.figure_svg(plots.histogram(times, lines, seen)))


def instants_of(found: Holistic, names: Iterable[str]) -> list[tuple[str, int, Markup]]:
    """Pictures of the first critical instants that can be drawn, each with its end."""
    drawn: list[tuple[str, int, Markup]] = []
    for name in names:
        if name in found.ends:
            continue  # the picture would be that of the longer bound
        response = found.responses[name]
        if len(drawn) == SHOWN_INSTANTS:
            break
        if isinstance(response, Response):
            slices, deadline = schedule(response), response.task.deadline
            blocked = "in a section"
        else:
            slices, deadline = frame_schedule(response), response.frame.deadline
            blocked = "already being sent"
        if slices:
            picture = plots.gantt(slices, deadline + response.lead, blocked)
            drawn.append((name, slices[-1].end, Markup(plots.figure_svg(picture))))
    return drawn
