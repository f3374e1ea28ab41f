# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart trace`: the trace of a run or a simulation, as CSV, for Perfetto or as MDF 4."""

from __future__ import annotations

import argparse
from pathlib import Path

from ravenchart.analysis.system.observed import TraceError
from ravenchart.building.checking import Checked
from ravenchart.failures import OK, Refused
from ravenchart.running.traces.files import read_traces
from ravenchart.running.traces.formats import FORMATS
from ravenchart.running.traces.simulated import of_simulation
from ravenchart.running.traces.sources import simulation_in
from ravenchart.running.traces.timeline import Timeline, of_run

from . import common
from .answer import say
from .results import TraceResult

SUFFIXES = ", ".join(FORMATS)


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "trace", type=Path, metavar="FILE", nargs="+",
        help="trace.txt of a run, trace-NODE.txt of each of several nodes, or what `simulate` "
        "printed",
    )  # fmt: skip
    sub.add_argument(
        "--out", type=_out, metavar="FILE", required=True,
        help="the file to write; its suffix chooses the format: .csv, .json for Perfetto, or .mf4 "
        "for recorded values as MDF 4",
    )  # fmt: skip


def _out(text: str) -> Path:
    if Path(text).suffix not in FORMATS:
        raise argparse.ArgumentTypeError(f"{text!r} has no suffix of {SUFFIXES}")
    return Path(text)


def execute(options: argparse.Namespace) -> int:
    """Write it in the other format; the exit status."""
    checked = common.checked(options, deadlines=False)
    try:
        timeline, said = _timeline(checked, options.trace)
    except TraceError as fault:
        raise Refused(str(fault)) from None
    options.out.write_bytes(FORMATS[options.out.suffix](timeline))
    for text in said:
        say(options.answer, f"warning: the controller said: {text}")
    if not timeline.complete:
        say(options.answer, "warning: the trace was cut off: the counts of its end are missing")
    if timeline.gaps:
        what = common.several(timeline.gaps, "trace record")
        say(options.answer, f"warning: {what} lost: the trace has gaps")
    if timeline.values_lost:
        what = common.several(timeline.values_lost, "recorded value")
        say(options.answer, f"warning: {what} lost: the values have gaps")
    for what, number in timeline.lost.items():
        print(f"lost: {what}, {common.several(number, 'time')}")
    events = sum(row.at is not None for row in timeline.rows)
    print(f"{options.out}: {common.several(events, 'record')}")
    options.answer.result = TraceResult(
        str(options.out), events, len(timeline.slices), timeline.lost, timeline.complete
    )
    return OK


def _timeline(checked: Checked, paths: list[Path]) -> tuple[Timeline, list[str]]:
    """The timeline of the files, and the texts of controllers; TraceError where they do not fit."""
    simulated = simulation_in(checked, paths, of_simulation)
    if simulated is not None:
        return simulated, []
    traces = read_traces(checked, paths)
    said = [text for one in traces.values() for text in one.said]
    return of_run(checked.system, {node: one.seen for node, one in traces.items()}), said
