# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart analyse --observed`: recorded execution times against the model's WCETs."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from ravenchart import rounded
from ravenchart.analysis.present.report import Execution, RunReport, executions
from ravenchart.analysis.system.journeys import journeys
from ravenchart.analysis.system.observed import (
    Observation,
    TraceError,
    of_model,
    read_map,
    read_trace,
)
from ravenchart.building.checking import Checked
from ravenchart.failures import Refused


def observation(checked: Checked, path: Path) -> Observation:
    """The observation in the trace that `ravenchart run` writes beside its report.

    A program that was generated from this model wrote the trace: ``generated/trace.json`` says
    what its numbers mean. `Refused` for a trace that cannot be read, or was cut off.
    """
    names = checked.generated / "trace.json"
    try:
        trace_map = read_map(names.read_text(encoding="utf-8"), str(names))
        with path.open(encoding="ascii", errors="replace") as lines:
            seen = read_trace(lines, trace_map, str(path))
        of_model(seen, checked.system.digest, str(path))
    except TraceError as fault:
        raise Refused(str(fault)) from None
    if not seen.complete:
        raise Refused(f"{path}: error: the trace was cut off: the run did not end by itself")
    return seen


def within_wcets(checked: Checked, seen: Observation, path: Path) -> bool:
    """Print every activity that was executed, nearest to its WCET first; none is above it.

    `Refused` for a trace without executions.
    """
    rows = executions(checked.analysis, seen)
    if not rows:
        raise Refused(f"{path}: error: no activity of {checked.system.name} was executed")
    every = {slot.element for processor in checked.system.processors for slot in processor.slots}
    return tell(rows, every)


def report(checked: Checked, seen: Observation, path: Path, *, within: bool) -> RunReport:
    """The section of a report on a trace: its reactions, responses and executions."""
    verdict = "every observed execution time is within its WCET"
    return RunReport(
        title=f"Observed in the trace {path}",
        passed=within,
        verdict=verdict if within else "an observed execution time is above its WCET",
        notes=(
            "The trace does not say whether the controller had real-time priorities; "
            "without them the bounds of responses do not hold for it.",
        ),
        steps=(),
        frames=(),
        comparable=True,
        observation=seen,
        journeys=journeys(checked.analysis, seen),
    )


def tell(rows: Sequence[Execution], every: Collection[str]) -> bool:
    """Print what was seen of each of ``rows``, and which of ``every`` was not; none is above."""
    for row in rows:
        longest, wcet = rounded.beside(row.observed, row.wcet)
        word = "ABOVE" if row.exceeded else "within"
        print(f"{row.row}: {longest}, {word} its WCET of {wcet}")
    for name in sorted(set(every) - {row.row for row in rows}):
        print(f"{name}: not executed in this run")
    return not any(row.exceeded for row in rows)
