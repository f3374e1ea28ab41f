# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart measure`: longest execution times of a run, beside their WCETs."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

from ravenchart import terminal
from ravenchart.analysis.system.observed import Observation, TraceError
from ravenchart.building import targets, variants
from ravenchart.building.checking import Checked
from ravenchart.failures import OK, WRONG, Refused, Unusable
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.bench.scenario import ScenarioError
from ravenchart.running import measured, summary
from ravenchart.running.result import RunOutcome

from . import bounds, common, running
from .answer import say
from .results import MeasureResult

MOST = 1_000
"""The largest margin, in percent."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    running.add_arguments(sub)
    sub.add_argument(
        "--margin", type=_margin, default=20, metavar="PERCENT",
        help="what a proposed `wcet` has in addition to the longest time (default 20)",
    )  # fmt: skip
    bounds.add_arguments(sub)
    sub.add_argument(
        "--out", type=Path, metavar="FILE", help="write the measurement there, as YAML"
    )


def _margin(text: str) -> int:
    if re.fullmatch(r"[0-9]{1,4} ?%?", text) is None or int(text.rstrip(" %")) > MOST:
        raise argparse.ArgumentTypeError(f"{text!r} is no percentage such as 20%, up to {MOST}%")
    return int(text.rstrip(" %"))


def execute(options: argparse.Namespace) -> int:
    """Run the model and print its execution times; the exit status."""
    checked = common.checked(options, deadlines=False)
    given = bounds.of_model(options, checked)
    board = common.board(options, checked)
    outcome = _run(options, checked, board)
    seen = _observation(outcome)
    for reason in outcome.failures:
        say(options.answer, f"warning: the run failed: {reason}", severity="warning")
    emulator = board.target.facts.emulator if board else None
    found = measured.measured(
        checked.system,
        seen,
        board.target.name if board else variants.NATIVE,
        emulator.time if emulator else measured.OF_THIS_MACHINE,
        outcome.title,
        options.margin,
        given,
    )
    summary.print_measurement(terminal.console(), found)
    if options.out is not None:
        options.out.write_text(measured.text(found, checked.system), encoding="utf-8")
        print(f"written {options.out}")
    options.answer.result = MeasureResult(found)
    for text in bounds.findings(found.rows, given, checked.system):
        say(options.answer, text)
    return WRONG if any(one.words for one in found.rows) else OK


def _run(options: argparse.Namespace, checked: Checked, board: targets.Board | None) -> RunOutcome:
    """The run, in mode release: contracts are not executed in what is measured."""
    request = running.request(options, checked, board, "release", None)
    try:
        with terminal.progress("start the controller") as progress:
            return running.execute(board, request, progress)
    except BenchError as fault:
        raise Unusable(str(fault)) from fault
    except (ScenarioError, TraceError) as fault:
        raise Refused(str(fault)) from fault


def _observation(outcome: RunOutcome) -> Observation:
    """The observation of the run; Refused where the run did not reach its end."""
    seen = outcome.observation
    if seen is not None and seen.complete and seen.executions:
        return seen
    reason = next(iter(outcome.failures), "nothing was executed")
    raise Refused(f"ravenchart: error: nothing is measured: {reason}")
