"""`ravenchart build`: generated and compiled."""

from __future__ import annotations

import argparse
from functools import partial

from ravenchart.building import generation, programs
from ravenchart.failures import OK
from ravenchart.terminal import progress

from . import common
from .answer import say
from .results import BuildResult, Built


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    common.add_target(sub)
    sub.add_argument("--driver", choices=programs.DRIVERS, help="the CAN driver")
    sub.add_argument(
        "--mode", choices=("checks", "release"), default="checks",
        help="checks: every contract is executed; release: -O2, proof stands for checks",
    )  # fmt: skip
    sub.add_argument(
        "--registers", choices=programs.REGISTERS, default="simulated",
        help="simulated: the bodies in simulated/; hardware: at the addresses of the devices",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Build every program of the model; the exit status."""
    checked = common.checked(options)
    board = common.board(options, checked)
    generated = common.tell_written(generation.write_program(checked), options.answer)
    answer = options.answer.result = BuildResult(generated, [])
    warn = partial(say, options.answer, severity="warning")
    for made in programs.programs_of(checked):
        with progress(f"compile {made.node}"):
            program = made.build(options.mode, options.driver, options.registers, warn, board)
        memory = made.memory(program)
        answer.programs.append(Built(made.node, str(program), memory))
        print(f"built {program}\n  {memory.shown()}")
    return OK
