# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The source of a trace file: a run, or a simulation."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from itertools import chain
from pathlib import Path
from typing import TypeVar

from ravenchart.building.checking import Checked
from ravenchart.failures import Unusable
from ravenchart.gen.model.system import System

from .files import NodeTrace, read_traces
from .simulated import is_simulated
from .simulated_runs import observed_simulation

T = TypeVar("T")

HEAD = 64
"""So many octets of a file say what it is."""

FOREIGN = {
    rb"LOGG|date |\(\d+\.\d+\) |;\$FILEVERSION": (
        "a log of a bus: it has frames and no states; the step `replay` of a scenario sends them"
    ),
    rb'MDF |time_ns,node|\{"displayTimeUnit"': (
        "no trace any more: `ravenchart trace` wrote it; name the trace that it was made from"
    ),
}
"""How other files begin, and what they are."""

ReadSimulation = Callable[[System, Iterable[str], str], T]
"""Reads the lines of a simulation; a string names the file."""


def simulation_in(checked: Checked, paths: Sequence[Path], read: ReadSimulation[T]) -> T | None:
    """The simulation in the one file, as ``read`` has it; None where the files are of a run.

    Unusable where there are other files beside a simulation, and where a file is known to be no
    trace of either.
    """
    for path in paths:
        _not_foreign(path)
        with path.open(encoding="utf-8", errors="replace") as lines:
            first = next((line.strip() for line in lines if line.strip()), "")
            if is_simulated(first):
                if len(paths) > 1:
                    raise Unusable("a simulation has one trace for all nodes: give one file")
                return read(checked.system, chain([first], lines), str(path))
    return None


def _not_foreign(path: Path) -> None:
    """Unusable for a file that is known to be something else."""
    with path.open("rb") as file:
        head = file.read(HEAD)
    for begin, what in FOREIGN.items():
        if re.match(begin, head):
            raise Unusable(f"{path} is {what}")


def recorded_nodes(checked: Checked, paths: Sequence[Path]) -> dict[str, NodeTrace]:
    """The traces by node; that of a simulation by the name of the system.

    Raises as `read_traces` and `simulation_in`.
    """
    simulated = simulation_in(checked, paths, observed_simulation)
    if simulated is None:
        return read_traces(checked, paths)
    return {checked.system.name: NodeTrace(simulated, simulated=True)}
