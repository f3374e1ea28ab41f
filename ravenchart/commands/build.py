# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart build`: generated and compiled."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ravenchart.building import unchanged, variants
from ravenchart.failures import OK
from ravenchart.terminal import stages

from . import common
from .answer import say
from .build_results import BuildResult, Built

if TYPE_CHECKING:
    from ravenchart.building.programs import Program
    from ravenchart.building.targets import Board


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    common.add_target(sub)
    common.add_driver(sub)
    sub.add_argument(
        "--mode", choices=("checks", "release"), default="checks",
        help="checks: every contract is executed; release: -O2, proof stands for checks",
    )  # fmt: skip
    sub.add_argument(
        "--registers", choices=variants.REGISTERS, default="simulated",
        help="simulated: the bodies in simulated/; hardware: at the addresses of the devices",
    )  # fmt: skip
    sub.add_argument(
        "--memory", type=Path, metavar="FILE",
        help="write the stacks and the memory there; of several nodes FILE-NODE for each",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Build every program of the model; the exit status."""
    before = unchanged.build(options.model, _switches(options)) if _is_common(options) else None
    if before is None:
        _build(options)
    else:
        _build_again(options, before)
    return OK


def _is_common(options: argparse.Namespace) -> bool:
    """Whether a build is of the kind of which records are kept."""
    return options.target == variants.NATIVE and options.memory is None


def _switches(options: argparse.Namespace) -> tuple[str, ...]:
    return options.mode, options.driver or "", options.registers


def _build(options: argparse.Namespace) -> None:
    """All of it."""
    checked = common.checked(options, library=True)
    board = common.board(options, checked)
    from ravenchart.building import programs, stacks, targets

    written, generated = common.write(checked, options.answer)
    unchanged.keep(checked, written)
    options.answer.result = BuildResult(generated, [])
    found = programs.programs_of(checked)
    if checked.system.is_library:
        with stages(f"compile {checked.system.name}") as tell:
            home = found[0].compile(options.mode, _warn(options), tell)
        print(f"compiled {checked.system.name}: {home}")
        return
    done = []
    for made in found:
        done.append(_built(options, made, board))
        if options.memory:
            stacks.write(
                done[-1].memory, _file(options.memory, made.node if len(found) > 1 else "")
            )
        _tell(options, done[-1])
    if _is_common(options):
        facts = stacks.facts_of(targets.target(variants.NATIVE))
        unchanged.keep_build(checked, written, _switches(options), done, facts)


def _build_again(options: argparse.Namespace, before: unchanged.Build) -> None:
    """Call gprbuild again; where it has made another program, examine that too."""
    generated = common.generated_before(before.generation, options.answer)
    options.answer.result = BuildResult(generated, [])
    for one in before.programs:
        with stages(f"compile {one.node}") as tell:
            said = one.compilation.run(tell=tell)
        if said.strip():
            _warn(options)(said.rstrip())
        _tell(options, one if before.holds() else _examined(options, one.node))


def _examined(options: argparse.Namespace, node: str) -> unchanged.BuiltNode:
    """The program of a node, built and examined; its model has been reported already."""
    from ravenchart.building import checking, programs

    found = programs.programs_of(checking.check(options.model))
    return _built(options, next(one for one in found if one.node == node), None)


def _built(options: argparse.Namespace, made: Program, board: Board | None) -> unchanged.BuiltNode:
    from ravenchart.building import stacks

    choice = options.mode, options.driver, options.registers
    with stages(f"compile {made.node}") as tell:
        image = made.build(*choice, _warn(options), board, tell=tell)
    return unchanged.BuiltNode(made.node, made.compilation(*choice, board), stacks.kept(image))


def _warn(options: argparse.Namespace) -> Callable[[str], None]:
    return partial(say, options.answer, severity="warning")


def _tell(options: argparse.Namespace, one: unchanged.BuiltNode) -> None:
    image = one.compilation.image
    options.answer.result.programs.append(Built(one.node, str(image), one.memory))
    print(f"built {image}\n  {one.memory.shown()}")


def _file(path: Path, node: str) -> Path:
    """The file of a node: that which is given, or one beside it with the name of the node."""
    return path.with_name(f"{path.stem}-{node}{path.suffix}") if node else path
