"""`ravenchart run`: the controller built and run, here or on a board, judged and reported."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from ravenchart.building import generation, programs, targets
from ravenchart.failures import NOT_JUDGED, OK, WRONG, Unusable
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.running import boards, scenarios
from ravenchart.running.result import RunResult
from ravenchart.running.runs import (
    RunRequest,
    controller,
    joins_a_server,
    run_model,
    run_on_this_machine,
)
from ravenchart.terminal import progress

from . import common, results
from .answer import say

ALONE = "without a scenario nobody is on the bus of one node"


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    common.add_target(sub)
    sub.add_argument("--scenario", type=Path, help="play this scenario on its CAN bus")
    sub.add_argument(
        "--seconds", type=float, default=10.0, help="how long without a scenario (default 10)"
    )
    sub.add_argument(
        "--strict", action="store_true",
        help="exit status 3 where the run passed, but its timing could not be judged",
    )  # fmt: skip
    common.add_log(sub)
    sub.add_argument("--report", type=Path, metavar="DIR", help="where the report goes")


def execute(options: argparse.Namespace) -> int:
    """Run it; the exit status."""
    checked = common.checked(options)
    board = common.board(options, checked)
    made_of = programs.programs_of(checked)
    if board is not None and (options.scenario, options.log, len(made_of)) != (None, None, 1):
        raise Unusable(f"{board.target.name} runs one node, without `--scenario` and `--log`")
    if options.scenario is not None:
        scenarios.checked(options.scenario, checked.system)
    alone = options.scenario is None and not joins_a_server(checked.system, len(made_of))
    if options.log is not None and alone:
        raise Unusable(f"ravenchart: error: no log of {checked.system.name}: {ALONE}")
    common.tell_written(generation.write_program(checked), options.answer)
    controllers = []
    warn = partial(say, options.answer, severity="warning")
    for made in made_of:
        with progress(f"compile {made.node}"):
            controllers.append(controller(made, warn, board))
        print(f"built {controllers[-1].executable}")
    target = board.target if board else None
    driver = programs.default_driver(checked, target)
    home = programs.build_home(checked, driver, target.name if target else targets.NATIVE)
    request = RunRequest(
        checked.analysis,
        tuple(controllers),
        checked.generated,
        options.scenario,
        options.seconds,
        options.report or home / "report",
        options.log,
    )
    try:
        execute = partial(boards.run_board, board) if board else run_on_this_machine
        outcome = run_model(request, refuse=options.answer.fail, execute=execute)
    except BenchError as problem:
        raise Unusable(str(problem)) from problem
    if outcome is None:
        return WRONG
    options.answer.result = _judged(outcome, request.folder)
    if not outcome.passed:
        return WRONG
    return NOT_JUDGED if options.strict and outcome.not_judged else OK


def _judged(outcome: RunResult, folder: Path) -> results.RunResult:
    return results.RunResult(
        outcome.title,
        outcome.passed,
        outcome.verdict,
        outcome.not_judged,
        list(outcome.failures),
        list(outcome.notes),
        [results.Step(one.at, one.text, one.passed, one.outcome) for one in outcome.steps],
        [
            results.Observed(one.task, one.releases, one.observed, one.bound)
            for one in outcome.compared
        ],
        [
            results.Observed(one.chain, one.count, one.observed, one.bound)
            for one in outcome.journeys
        ],
        str(folder / "report.html"),
    )
