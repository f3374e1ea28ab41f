# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The trace files of a run, one for each node, read by the names of its program."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ravenchart.analysis.system.observed import Observation, of_model, read_map, read_trace
from ravenchart.building.checking import Checked
from ravenchart.building.programs import TRACE_MAP, programs_of
from ravenchart.failures import Unusable

from .reports import report_lines

COUNTS = frozenset("NPAQHLWF")
"""The first letters of lines that count something."""


@dataclass(slots=True)
class NodeTrace:
    """The trace of one node."""

    seen: Observation
    reports: list[list[str]] = field(default_factory=list)
    """The lines of each report of counts. It begins with an N line, where the trace has one."""
    said: list[str] = field(default_factory=list)
    """Other lines of the controller of a board: why it ended, for example."""
    simulated: bool = False
    """Whether `ravenchart simulate` printed it: then nothing of it counts."""


def read_traces(checked: Checked, paths: Sequence[Path]) -> dict[str, NodeTrace]:
    """The traces by node. TraceError where one does not fit the model.

    Unusable where a file does not name its node, or the program is not generated.
    """
    programs = {one.node: one for one in programs_of(checked)}
    found: dict[str, NodeTrace] = {}
    for path in paths:
        node = path.stem.removeprefix("trace-") if len(programs) > 1 else next(iter(programs))
        if node not in programs:
            names = ", ".join(f"trace-{one}.txt" for one in programs)
            raise Unusable(f"{path} does not name its node: {checked.system.name} has {names}")
        names_of = programs[node].generated / TRACE_MAP
        if not names_of.exists():
            text = f"the names of its elements are missing: {names_of}; `ravenchart generate"
            raise Unusable(f"{path}: {text} {checked.path}` writes them")
        trace_map = read_map(names_of.read_text(encoding="utf-8"), str(names_of))
        reports: list[list[str]] = []
        said: list[str] = []
        with path.open(encoding="ascii", errors="replace") as lines:
            report = report_lines(lines, said, str(path))
            seen = read_trace(_noting(report, reports), trace_map, str(path))
        of_model(seen, checked.system.digest, str(path))
        found[node] = NodeTrace(seen, reports, said)
    return found


def _noting(lines: Iterable[str], reports: list[list[str]]) -> Iterator[str]:
    """The lines as they are; those that count go to ``reports`` as well."""
    for line in lines:
        first = line[:1]
        if first in COUNTS:
            if first == "N" or not reports:
                reports.append([])
            reports[-1].append(line)
        yield line
