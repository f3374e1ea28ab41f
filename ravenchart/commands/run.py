# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart run`: the controller built and run, here or on a board, judged and reported."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path

from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import NOT_JUDGED, OK, WRONG, Unusable
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.bench.runner import Progress
from ravenchart.running.bus_runs import run_on_bus
from ravenchart.running.controllers import joins_a_server
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import RunRequest, run_model

from . import common, run_results, running

ALONE = "without a scenario no other node is on the bus"


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    running.add_arguments(sub)
    sub.add_argument(
        "--strict", action="store_true",
        help="exit status 3 where the run passed, but its timing could not be judged",
    )  # fmt: skip
    common.add_interface(sub, "play the scenario to a controller that runs already,")
    common.add_log(sub)
    sub.add_argument("--report", type=Path, metavar="DIR", help="folder for the report")


def execute(options: argparse.Namespace) -> int:
    """Run it; the exit status."""
    checked = common.checked(options)
    interfaces = common.interfaces(options, checked.system)
    if not interfaces:
        execute, request = _started(options, checked)
    else:
        execute = partial(run_on_bus, interfaces)
        request = running.on_bus(options, checked, [*interfaces], options.report, options.log)
    try:
        outcome = run_model(request, refuse=options.answer.fail, execute=execute)
    except BenchError as problem:
        raise Unusable(str(problem)) from problem
    if outcome is None:
        return WRONG
    options.answer.result = _judged(outcome, request.folder)
    if not outcome.passed:
        return WRONG
    return NOT_JUDGED if options.strict and outcome.not_judged else OK


def _started(
    options: argparse.Namespace, checked: Checked
) -> tuple[Callable[[RunRequest, Progress], RunOutcome], RunRequest]:
    """How the programs are run, once they are built; Unusable where they cannot be."""
    board = common.board(options, checked)
    nodes = len(programs.programs_of(checked))
    alone = options.scenario is None and not joins_a_server(checked.system, nodes)
    if options.log is not None and alone and board is None:
        raise Unusable(f"no log of {checked.system.name}: {ALONE}")
    mode = "release" if board else "checks"
    request = running.request(options, checked, board, mode, options.report, options.log)
    return partial(running.execute, board), request


def _judged(outcome: RunOutcome, folder: Path) -> run_results.RunResult:
    return run_results.RunResult(
        outcome.title,
        outcome.passed,
        outcome.verdict,
        outcome.not_judged,
        list(outcome.failures),
        list(outcome.notes),
        [
            run_results.PlayedStep(one.at, one.text, one.passed, one.outcome)
            for one in outcome.steps
        ],
        [
            run_results.Observed(one.task, one.releases, one.observed, one.bound)
            for one in outcome.compared
        ],
        [
            run_results.Observed(one.chain, one.count, one.observed, one.bound)
            for one in outcome.journeys
        ],
        str(folder / "report.html"),
    )
