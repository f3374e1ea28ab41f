"""`ravenchart build`: generated and compiled."""

from __future__ import annotations

import argparse
from functools import partial
from pathlib import Path

from ravenchart.building import programs
from ravenchart.building.stacks import kept, write
from ravenchart.failures import OK
from ravenchart.terminal import stages

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
    sub.add_argument(
        "--memory", type=Path, metavar="FILE",
        help="write the stacks and the memory there; of several nodes FILE-NODE for each",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Build every program of the model; the exit status."""
    checked = common.checked(options)
    board = common.board(options, checked)
    generated = common.generated(checked, options.answer)
    answer = options.answer.result = BuildResult(generated, [])
    warn = partial(say, options.answer, severity="warning")
    found = programs.programs_of(checked)
    for made in found:
        with stages(f"compile {made.node}") as tell:
            program = made.build(
                options.mode, options.driver, options.registers, warn, board, tell=tell
            )
        memory = kept(program)
        answer.programs.append(Built(made.node, str(program), memory))
        if options.memory:
            write(memory, _file(options.memory, made.node if len(found) > 1 else ""))
        print(f"built {program}\n  {memory.shown()}")
    return OK


def _file(path: Path, node: str) -> Path:
    """The file of a node: that which is given, or one beside it with the name of the node."""
    return path.with_name(f"{path.stem}-{node}{path.suffix}") if node else path
