# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The buses of a running system as pages see them."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ravenchart.building.checking import Checked
from ravenchart.failures import Failure
from ravenchart.hw_can.bench.interfaces import BusEnd
from ravenchart.running import monitoring
from ravenchart.running.attaching import interfaces_of
from ravenchart.running.bus_watch import BusWatch

PAUSE = 1.0
"""Seconds between two attempts to watch a bus."""


class LiveBuses:
    """The buses that are named, or those of a run; one that was gone is watched again."""

    def __init__(self, named: tuple[str, Sequence[str]] | None) -> None:
        """``named`` is an interface of python-can, and the channel of each bus."""
        self.text = ""
        """Why no bus is seen."""
        self._named = named
        self._watches: dict[str, BusWatch] = {}
        self._next = 0.0

    @property
    def are_seen(self) -> bool:
        """Whether any bus is watched, or was until it was gone."""
        return bool(self._watches)

    def look(self) -> list[dict[str, Any]]:
        """The buses as they are now."""
        return [asdict(watch.look()) for watch in self._watches.values()]

    def join(self, checked: Checked, *, runs: bool, rings: bool) -> None:
        """Watch each bus that is not watched; say why not where that cannot be.

        A controller ``runs``; ``rings``: the buses of runs count.
        """
        wanted = len(checked.system.buses if self._named is None else self._named[1])
        works = [bus for bus, watch in self._watches.items() if watch.look().gone is None]
        now = time.monotonic()
        if len(works) == wanted or now < self._next:
            return
        self._next = now + PAUSE
        faults: list[str] = []
        try:
            ends = self._ends(checked, runs=runs, rings=rings)
        except Failure as problem:
            ends = {}
            faults.append(_said(problem))
        for bus, end in ends.items():
            if bus not in works:
                try:
                    watch = BusWatch(checked.analysis, end, checked.system.bus(bus))
                except Failure as problem:
                    if bus not in self._watches:  # else its table says that it is gone
                        faults.append(_said(problem))
                else:
                    if bus in self._watches:
                        self._watches[bus].close()
                    self._watches[bus] = watch
        self.text = " ".join(faults)

    def _ends(self, checked: Checked, *, runs: bool, rings: bool) -> Mapping[str, BusEnd | Path]:
        """Those of the buses that were named; else the rings of the run that is watched, if any."""
        if self._named is not None:
            return interfaces_of(checked.system, *self._named)
        return monitoring.buses_of_run(checked) if runs and rings else {}

    def close(self) -> None:
        """Leave them."""
        for watch in self._watches.values():
            watch.close()
        self._watches, self.text, self._next = {}, "", 0.0


def _said(problem: Failure) -> str:
    return str(problem).removeprefix("ravenchart: error: ")
