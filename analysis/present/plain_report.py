# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The report of a plain file: the parts of a model's report that the file determines."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.analysis.core.tasks import Task
from ravenchart.analysis.findings.differences import Differences
from ravenchart.analysis.plain.results import PlainResult, loads

from .bars import row_of, slack_of
from .page import page
from .report import Execution
from .rows import chain_picture, histogram_of, hop_cells, instants_of
from .sentences import distance_lines, offset_lines, overload_lines

SHOWN = 300
"""Rows of a table; the tightest come first."""

SHOWN_HISTOGRAMS = 40
"""Histograms of executions; those nearest to their WCETs come first."""


def render_plain(
    title: str,
    result: PlainResult,
    advice: Sequence[str],
    executions: Sequence[Execution] = (),
    earlier: Differences | None = None,
) -> str:
    """The report as HTML text."""
    network, found = result.system.network, result.found
    order = sorted(found.responses, key=lambda name: _tightness(slack_of(found, name)))
    items = network.items()
    tasks = [name for name in order if isinstance(items[name], Task)]
    sent = [name for name in order if not isinstance(items[name], Task)]
    bus_of = {frame.name: bus for bus, frames in network.frames.items() for frame in frames}
    missed = sum(not found.meets(name) for name in order)
    late = [one.chain.name for one in result.latencies if not one.met]
    context = {
        "title": title,
        "good": result.met,
        "verdict": _verdict(missed, len(order), late),
        "overloads": overload_lines(loads(network)),
        "loads": [(name or "the core", share) for name, share in loads(network).items()],
        "scaling": result.scaling,
        "tasks": [_task_row(result, name) for name in tasks[:SHOWN]],
        "messages": [row_of(network, found, name) | {"bus": bus_of[name]} for name in sent[:SHOWN]],
        "left": max(0, len(tasks) - SHOWN) + max(0, len(sent) - SHOWN),
        "advice": advice,
        "pictured": [*instants_of(found, tasks), *instants_of(found, sent)],
        "chains": [
            (one.chain.name, hop_cells(one), one, chain_picture(one)) for one in result.latencies
        ],
        "shorter": [*offset_lines(found.responses.values()), *distance_lines(found)],
        "executions": executions,
        "histograms": [
            (one.row, histogram_of(one.times, [("WCET", one.wcet)], "execution"))
            for one in [one for one in executions if len(one.times) > 1][:SHOWN_HISTOGRAMS]
        ],
        "compared_with": earlier,
    }
    return page("plain.html", context)


def _task_row(result: PlainResult, name: str) -> dict[str, object]:
    """The row of a task; C is the WCET of all its rows together."""
    row = row_of(result.system.network, result.found, name)
    return row | {"longest": row["item"].longest_wcet}


def _tightness(slack: int | None) -> tuple[bool, int]:
    return slack is not None, slack or 0


def _verdict(missed: int, count: int, late: Sequence[str]) -> str:
    """The outcome in one line."""
    parts = [f"{missed} of {count} deadlines may be missed"] if missed else []
    if late:
        parts.append(f"too slow: {', '.join(late)}")
    return "; ".join(parts) or f"every deadline is met ({count} tasks and messages)"
