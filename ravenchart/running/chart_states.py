# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The states of charts of controllers that run on this machine.

They are in the snapshots that `ravenchart monitor` reads too.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ravenchart import rounded
from ravenchart.analysis.system.observed import TRACE, is_of

from .watched import WatchedController


@dataclass(frozen=True, slots=True)
class SeenChart:
    """A chart by the last snapshot of its controller; times are of `time.monotonic`, in s."""

    name: str
    state: str | None
    """The active leaf state; None while the state around the region is not active."""
    at: float
    """When the snapshot was made."""
    since: float | None
    """When the state was entered; None as ``state``."""
    lost: int
    """How many trace records were lost: a state may be an old one then."""
    ended: bool
    """Whether the controller is gone."""


class ChartWatch:
    """The charts of controllers that run on this machine. Any thread may call."""

    def __init__(self, controllers: Sequence[WatchedController]) -> None:
        self.nodes = tuple(one.name for one in controllers)
        """The nodes whose controllers are watched."""
        self._controllers = controllers
        self._lock = threading.Lock()

    def close(self) -> None:
        """See nothing any more."""
        with self._lock:
            self._controllers = ()

    def look(self) -> dict[str, SeenChart]:
        """The charts by name, as the controllers say now."""
        with self._lock:
            return {seen.name: seen for one in self._controllers for seen in _seen(one)}


def _seen(controller: WatchedController) -> Iterator[SeenChart]:
    controller.look()
    node = controller.node
    for chart in node.charts:
        since = None if chart.since is None else controller.made - (node.now - chart.since) / 1e9
        lost = sum(n for what, n in node.lost.items() if is_of(what, TRACE))
        ended = node.process is None
        yield SeenChart(chart.name, chart.state, controller.made, since, lost, ended)


def in_words(seen: SeenChart) -> str:
    """The state, and for how long it has been so."""
    if seen.state is None or seen.since is None:
        return "no active state"
    now = seen.at if seen.ended else time.monotonic()
    spent = rounded.of_seconds(max(0.0, now - seen.since))
    return f"{seen.state} for {rounded.up(spent)}"
