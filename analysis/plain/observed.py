# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Observed execution times, as plain rows: `task`, `row` or `message`."""

from __future__ import annotations

from dataclasses import replace

from ravenchart.analysis.core.holistic import Network
from ravenchart.analysis.core.tasks import Task

from .columns import LONG, NEEDED, Kinds, values
from .entries import Problem, read_rows

SEEN = replace(LONG, former="cost")
KINDS: Kinds = {
    "task": {"observed": SEEN},
    "row": {"task": NEEDED, "observed": SEEN},
    "message": {"observed": SEEN},
}
"""The kinds of rows; a row of a table needs its task."""


def longest_times(network: Network) -> dict[str, int]:
    """C of each task, row (``task.row``) and message, in ns.

    For a task with a table it is that of its longest job.
    """
    found = {}
    for name, item in network.items().items():
        if isinstance(item, Task):
            jobs = [item.wcet + sum(row.wcet for row in rows) for rows in item.frames]
            found[name] = max(jobs, default=item.wcet)
            found |= {f"{name}.{row.name}": row.wcet for row in item.rows}
        else:
            found[name] = item.transmission_time
    return found


def observed(text: str, file: str, network: Network) -> dict[str, list[int]] | tuple[Problem, ...]:
    """The observed times of each item in the file, in ns, or the problems of the file."""
    reading = read_rows(text, file)
    known = longest_times(network)
    found: dict[str, list[int]] = {}
    for entry in reading.entries:
        row = values(entry, reading, KINDS)
        if row is None:
            continue
        name = f"{row.word('task')}.{row.name}" if entry.kind == "row" else row.name
        if name not in known:
            reading.complain(entry.line, f"there is no {entry.kind} {name}")
        else:
            found.setdefault(name, []).append(row.number("observed"))
    if not reading.problems and not found:
        reading.complain(0, "no execution time was observed")
    return tuple(reading.problems) or found
