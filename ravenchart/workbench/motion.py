# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The data from which a page draws a controller: charts with active states, values over time."""

from __future__ import annotations

from collections import defaultdict, deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from typing import Any

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.recording import RecordedValue
from ravenchart.gen.model.system import System
from ravenchart.running.monitored import WatchedEvent, WatchedNode
from ravenchart.running.traces.values import Point, Quantity

Json = dict[str, Any]

WINDOW = Ns(30_000_000_000)
"""The time that a plot shows, in ns."""

MOST_PLOTS = 24
"""Values that are plotted: the first ones of the model."""

Lines = Mapping[str, tuple[Quantity, Sequence[Point], int]]
"""Of each value what its numbers mean, what it was when, and how many were recorded in that time.

There are fewer points where not all of them are known, or are drawn.
"""


def shown_node(
    system: System, node: WatchedNode, last: Sequence[WatchedEvent], lines: Lines
) -> Json:
    """A node as the page gets it; ``last`` are its last transitions and faults."""
    return asdict(node) | {
        "last": [asdict(one) for one in last],
        "drawn": list(_charts(system, node)),
        "window": WINDOW,
        "plots": {name: _plot(*found) for name, found in lines.items() if found[1]},
    }


def plotted(system: System) -> Sequence[RecordedValue]:
    """The values that have a plot."""
    return system.recorded_values[:MOST_PLOTS]


def _plot(quantity: Quantity, points: Sequence[Point], recorded: int) -> Json:
    value = int if quantity.literals else quantity.value
    drawn = [(at, value(number)) for at, number in points]
    return {"literals": list(quantity.literals), "points": drawn, "recorded": recorded}


class LastValues:
    """The values of a running controller that were looked at, in the time of a plot.

    A snapshot has the last value only: those between two snapshots are counted.
    """

    def __init__(self, system: System, start: Ns | None) -> None:
        """``start``: that of the controller, by the clock of its machine."""
        self.start = start
        self._quantities = {
            one.element: Quantity.of(one.literals, one.unit) for one in plotted(system)
        }
        self._points: defaultdict[str, deque[tuple[Point, int]]] = defaultdict(deque)

    def look(self, node: WatchedNode) -> Lines:
        """The values with those of a node as it is now."""
        for one in node.values:
            quantity = self._quantities.get(one.name)
            if quantity is None:
                continue
            points = self._points[one.name]
            if not points or points[-1][1] != one.count:
                points.append(((Ns(one.last), quantity.number(one.value)), one.count))
            while len(points) > 1 and points[1][0][0] <= node.now - WINDOW:
                points.popleft()
        return {
            name: (
                self._quantities[name],
                [point for point, _ in found],
                found[-1][1] - found[0][1] + 1,
            )
            for name, found in self._points.items()
        }


# --- Charts


def _charts(system: System, node: WatchedNode) -> Iterator[Json]:
    """The charts of a node with the drawing of each, its active states, and what it took last."""
    watched = {one.name: one for one in node.charts}
    for instance in system.instances:
        for region in instance.component.regions:
            name = f"{instance.name}.{region.name}"
            if name not in watched:
                continue
            leaves = [
                one.state
                for inside, one in watched.items()
                if one.state is not None and (inside == name or inside.startswith(f"{name}."))
            ]
            active = dict.fromkeys(state for leaf in leaves for state in region.ancestors(leaf))
            taken = watched[name].taken
            yield {
                "name": name,
                "drawing": f"{instance.component.name}.{region.name}",
                "active": list(active),
                "last": {"taken": [] if taken is None else [taken]},
            }
