# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A response against its deadline: a row of a report, with the parts of its bar."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ravenchart.analysis.core.holistic import Holistic, Network
from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.findings.deadlines import no_bound_reason
from ravenchart.analysis.system.stream import StreamResponse

from .sentences import response_parts

KINDS = ("jitter", "blocking", "own", "interference", "overhead")
"""The parts of a response, in the order of a bar."""


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
        "longest": item.wcet if isinstance(item, Task) else item.transmission_time,
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


def stream_row(one: StreamResponse) -> dict[str, Any]:
    """The row of a stream: that of a task, without activities, marked as the lowest priority."""
    network = Network((one.response.task,))
    found = Holistic({one.name: one.response}, {}, {one.name: 0}, rounds=1)
    row = row_of(network, found, one.name)
    return row | {"name": f"{one.name} (lowest priority)", "origin": one.origin, "rows": []}


def _within(kinds: Mapping[str, int], bound: int | None) -> list[tuple[str, int]]:
    """The parts of a bar that is ``bound`` long in all; empty without a bound.

    For a later job of the busy period the periods before its release are subtracted
    from its own time first, then from the parts before and after it.
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
