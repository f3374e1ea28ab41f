# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Shared parts of the commands that run a model: its programs, built, and where they are run."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from functools import partial
from pathlib import Path

from ravenchart.building import gateways, programs, targets, variants
from ravenchart.building.checking import Checked
from ravenchart.building.programs import TRACE_MAP
from ravenchart.failures import Unusable
from ravenchart.hw_can.bench.runner import Progress
from ravenchart.running import boards, scenarios
from ravenchart.running.controllers import Controller, controller
from ravenchart.running.result import RunOutcome
from ravenchart.running.runs import RunRequest, run_on_this_machine
from ravenchart.terminal import stages

from . import common
from .answer import Answer, say

REPORTS = {"run": "report", "measure": "measurement"}
"""The folder of what each command writes, beside what is built."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what is run, where and for how long."""
    common.add_model(sub)
    common.add_target(sub)
    sub.add_argument("--scenario", type=Path, help="play this scenario on its CAN buses")
    sub.add_argument(
        "--seconds",
        type=float,
        default=10.0,
        help="duration of a run without a scenario (default 10)",
    )


def request(
    options: argparse.Namespace,
    checked: Checked,
    board: targets.Board | None,
    mode: str,
    folder: Path | None,
    log: Path | None = None,
) -> RunRequest:
    """The programs, generated and built in that mode; Unusable where they cannot be run so.

    They write to ``folder``, or beside the build results.
    """
    gateway = None
    if board is not None:
        nodes = len(programs.programs_of(checked))
        gateway = _gateway(board, nodes, options.scenario, log)
    if options.scenario is not None:
        scenarios.checked(options.scenario, checked.system)
    made = controllers(checked, options.answer, board, gateway, mode)
    target = board.target if board else None
    driver = gateway.driver if gateway else programs.default_driver(checked, target)
    home = programs.build_home(checked, driver, target.name if target else variants.NATIVE)
    return RunRequest(
        checked.analysis,
        made,
        checked.generated,
        options.scenario,
        options.seconds,
        folder or home / REPORTS[options.command],
        log,
    )


def controllers(
    checked: Checked,
    answer: Answer,
    board: targets.Board | None = None,
    gateway: targets.Gateway | None = None,
    mode: str = "checks",
) -> tuple[Controller, ...]:
    """The program of each node, generated and built."""
    common.write(checked, answer)
    warn = partial(say, answer, severity="warning")
    made: list[Controller] = []
    for one in programs.programs_of(checked):
        with stages(f"compile {one.node}") as tell:
            if board is None or gateway is None:
                made.append(controller(one, warn, board, mode, tell))
            else:
                image, memory = gateways.build(one, board, gateway, warn, tell)
                trace_map = one.generated / TRACE_MAP
                made.append(Controller(one.node, image, trace_map, memory))
        print(f"built {made[-1].executable}")
    return tuple(made)


def on_bus(
    options: argparse.Namespace,
    checked: Checked,
    buses: Sequence[str],
    folder: Path | None,
    log: Path | None,
) -> RunRequest:
    """The scenario alone, for a controller that runs already on these buses; Unusable without."""
    if options.target != variants.NATIVE:
        raise Unusable("--interface and --target exclude each other: nothing is built")
    if options.scenario is None:
        raise Unusable("--interface needs --scenario: what is to be played there")
    scenarios.checked(options.scenario, checked.system, buses)
    home = programs.build_home(checked, "interface")
    return RunRequest(
        checked.analysis,
        (),
        checked.generated,
        options.scenario,
        options.seconds,
        folder or home / REPORTS[options.command],
        log,
    )


def _gateway(
    board: targets.Board, nodes: int, scenario: Path | None, log: Path | None
) -> targets.Gateway | None:
    """How the bus of a board is joined to others; Unusable where it has to be and is not."""
    name, emulator = board.target.name, board.target.facts.emulator
    if scenario is None and nodes == 1:
        if log is not None:
            raise Unusable(f"without `--scenario` no other node is on the bus of {name}: no log")
        return None
    if emulator is None or emulator.gateway is None:
        raise Unusable(f"{name} has no gateway between its bus and this machine")
    return emulator.gateway


def execute(board: targets.Board | None, request: RunRequest, progress: Progress) -> RunOutcome:
    """Run it on this machine or on a board. Raises as `run_controller`."""
    if board is None:
        return run_on_this_machine(request, progress)
    return boards.run_board(board, request, progress)
