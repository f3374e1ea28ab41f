"""Rows and pictures of a report that models and plain files have in common."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from markupsafe import Markup

from ravenchart.analysis.core.chains import Hop, Latency
from ravenchart.analysis.core.holistic import Holistic, Network
from ravenchart.analysis.core.responses import Response
from ravenchart.analysis.findings.deadlines import no_bound_reason
from ravenchart.analysis.system.critical import frame_schedule, schedule

from . import plots
from .words import response_parts

SHOWN_INSTANTS = 6
"""How many critical instants of each kind a report draws."""

KINDS = ("jitter", "blocking", "own", "interference", "overhead")
"""What a response is made of, in the order of a bar."""

HOPS = {
    Hop.RELEASED: "at once",
    Hop.SAMPLED: "samples, every T",
    Hop.QUEUED: "takes the oldest of a queue",
}
"""How data come to a step of a chain, in words."""


def slack_of(found: Holistic, name: str) -> int | None:
    """Deadline less response; negative when missed, None without a bound."""
    needed = found.from_event(name)
    return None if needed is None else found.deadline(name) - needed


def row_of(network: Network, found: Holistic, name: str) -> dict[str, Any]:
    """The row of a task or message, its parts as shares of the deadline (or of R if longer)."""
    response = found.responses[name]
    bound, deadline = found.from_event(name), found.deadline(name)
    item = network.items()[name]
    parts = response_parts(response, network.released_by.get(name))
    scale = max(deadline, bound or 0)
    kinds = {kind: sum(p.time for p in parts if p.kind == kind) for kind in KINDS}
    met = found.meets(name)
    return {
        "name": name,
        "response": response,
        "item": item,
        "cost": item.cost,
        "deadline": deadline,
        "jitter": item.jitter + found.inherited.get(name, 0),
        "bound": bound,
        "slack": slack_of(found, name),
        "word": "ok" if met else "NONE" if bound is None else "MISS",
        "met": met,
        "reason": "" if bound is not None else no_bound_reason(response),
        "shares": parts,
        "deadline_at": 100 * deadline / scale,
        "bar": [(k, 100 * time / scale) for k, time in _within(kinds, bound) if time > 0],
    }


def hops_of(found: Latency) -> list[tuple[str, str, int | None, int | None, int | None]]:
    """Each hop: its name, how data come to it, what it waits, takes and is renewed after."""
    return [
        (hop.step.name, HOPS[hop.step.hop], hop.wait, hop.response, hop.renewal)
        for hop in found.hops
    ]


def chain_picture(found: Latency) -> Markup | None:
    """The hops of a chain one after the other; none where the first has no bound."""
    pieces = plots.hop_pieces(found)
    if not pieces:
        return None
    return Markup(plots.svg(plots.hops(pieces, found.reaction, found.chain.reaction_limit)))


def instants_of(found: Holistic, names: Iterable[str]) -> list[tuple[str, int, Markup]]:
    """Pictures of the first critical instants that can be drawn, with where they end."""
    drawn: list[tuple[str, int, Markup]] = []
    for name in names:
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
            drawn.append((name, slices[-1].end, Markup(plots.svg(picture))))
    return drawn


def _within(kinds: Mapping[str, int], bound: int | None) -> list[tuple[str, int]]:
    """The parts of a bar that is ``bound`` long in all; empty without a bound.

    For a later job of the busy period the periods before its release are taken
    off its own time first, then off what stands before and after it.
    """
    if bound is None:
        return []
    debt = sum(kinds.values()) - bound
    kept = dict(kinds)
    for kind in ("own", *KINDS):
        less = min(debt, kept[kind])
        kept[kind] -= less
        debt -= less
    return list(kept.items())
