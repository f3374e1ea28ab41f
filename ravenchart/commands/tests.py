# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart tests`: event files that take every transition and decide every guard both ways.

The cases are found on the model, by its interpreter. The generated program then plays each case,
too. Both must execute the same behaviours at the same times. Goals that no case of the system
shows are sought in single components, with stubs for the user's code.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

from ravenchart.behaviour.cases.finding import found_cases
from ravenchart.behaviour.cases.goals import GoalKind
from ravenchart.behaviour.cases.search import EFFORT, FoundCase, SearchResult
from ravenchart.behaviour.interpreter.stimuli import written_stimuli
from ravenchart.building.checking import Checked
from ravenchart.building.generation import replace_file
from ravenchart.building.programs import build_home
from ravenchart.failures import OK, WRONG, Unusable
from ravenchart.gen.diagnostics import render
from ravenchart.running import coverage
from ravenchart.running.coverage import SourceCoverage
from ravenchart.terminal import progress

from . import common
from .results import BodyCoverage, TestCase, TestGoals, TestsResult
from .simulate import (
    build_simulation,
    left_out,
    only,
    places_of_user,
    played_by_program,
    refused_as,
    run_simulation,
    simulated_by_interpreter,
)

CASE, ALONE = "case-{:02}.yaml", "case-{:02}-{}.yaml"
"""Names of the files, of the system and of an instance; those of an earlier call are replaced."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "--folder", type=Path, metavar="DIR",
        help="folder for the event files (default: cases/ beside the model)",
    )  # fmt: skip
    sub.add_argument(
        "--effort", type=_positive, default=EFFORT, metavar="N",
        help=f"execute at the most N instants in the search (default: {EFFORT})",
    )  # fmt: skip
    sub.add_argument(
        "--no-run", action="store_true", help="do not play the cases with the generated program"
    )
    sub.add_argument(
        "--coverage", type=Path, metavar="FILE",
        help="count what the cases execute of the program, and write it as an LCOV tracefile",
    )  # fmt: skip


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 1")
    return int(text)


def execute(options: argparse.Namespace) -> int:
    """Search, write and play the cases; the exit status."""
    checked = common.checked(options, deadlines=False)
    with progress("find cases"):
        found = found_cases(checked.system, options.effort)
    folder = options.folder or checked.folder / "cases"
    files = _write(found.cases, folder)
    for case, file in zip(found.cases, files, strict=True):
        goals = common.several(len(case.shows), "goal")
        of = "" if case.instance is None else f", {case.instance} alone"
        print(f"{file}: {len(case.stimuli.entries)} stimuli, {goals}{of}")
    rows = _rows(found)
    for row in rows:
        rest = f", {row.unreachable} unreachable" if row.unreachable else ""
        print(f"{row.kind:<38} {row.shown:>4} of {row.goals}{rest}")
    for goal in found.unreachable:
        print(f"{goal.origin}: unreachable: {goal.text()}")
    for goal in found.open:
        print(f"{goal.origin}: not shown: {goal.text()}")
    different = [] if options.no_run else _different(checked, found.cases, files)
    counted = _covered(checked, found.cases, options.coverage) if options.coverage else []
    options.answer.result = TestsResult(
        [
            TestCase(str(file), [goal.text() for goal in case.shows], case.instance)
            for case, file in zip(found.cases, files, strict=True)
        ],
        rows,
        [goal.text() for goal in found.open],
        [goal.text() for goal in found.unreachable],
        [str(file) for file in different],
        [
            BodyCoverage(
                str(one.path), one.origin.value, len(one.lines), one.executed(),
                len(one.branches), one.taken(), one.left(),
            )
            for one in counted
        ],
    )  # fmt: skip
    if found.stuck:
        raise refused_as(found.stuck[0])
    return WRONG if different else OK


def _write(cases: list[FoundCase], folder: Path) -> list[Path]:
    """One file for each case; their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    files = [
        folder / (CASE.format(n) if one.instance is None else ALONE.format(n, one.instance))
        for n, one in enumerate(cases, 1)
    ]
    for old in folder.glob(CASE.replace("{:02}", "*")):
        if old not in files:
            old.unlink()
    for case, file in zip(cases, files, strict=True):
        comments = ["GENERATED by `ravenchart tests`. The first of all cases to show:"]
        comments += [f"  {goal.text()}" for goal in case.shows]
        if case.instance is not None:
            comments.append(f"Of an instance alone: `ravenchart simulate --alone {case.instance}`.")
        replace_file(file, written_stimuli(case.stimuli, comments))
    return files


def _rows(found: SearchResult) -> list[TestGoals]:
    """How many goals of each kind there are, and how many are shown."""
    every = Counter(goal.kind for goal in found.goals)
    left = Counter(goal.kind for goal in found.open)
    never = Counter(goal.kind for goal in found.unreachable)
    return [
        TestGoals(kind.value, every[kind] - left[kind] - never[kind], every[kind], never[kind])
        for kind in GoalKind
        if every[kind]
    ]


def _different(checked: Checked, cases: list[FoundCase], files: list[Path]) -> list[Path]:
    """Play the cases and print how many agree; the files whose program and interpreter differ."""
    different: list[Path] = []
    compared = 0
    for instance in dict.fromkeys(case.instance for case in cases):
        one = checked if instance is None else only(checked, instance)
        own = [pair for pair in zip(cases, files, strict=True) if pair[0].instance == instance]
        missing = left_out(one.system)
        if missing is not None:
            print(render(missing, {}), file=sys.stderr)
        program = played_by_program(one, instance)
        for case, file in own:
            played = program(case.stimuli)
            if missing is not None:
                continue
            compared += 1
            if played != simulated_by_interpreter(one.system, case.stimuli):
                print(f"{file}: error: program and interpreter execute different behaviours")
                different.append(file)
        if missing is not None:
            print(f"the program has played {common.several(len(own), 'case')} of the system")
    if compared:
        same = compared - len(different)
        print(f"program and interpreter execute the same behaviours in {same} of {compared} cases")
    return different


def _covered(checked: Checked, cases: list[FoundCase], file: Path) -> list[SourceCoverage]:
    """The coverage of the program by the cases: it is written, and its totals are printed."""
    if all(case.instance is not None for case in cases):
        raise Unusable("no case is of the system, so there is no coverage of its program")
    home = build_home(checked, "coverage")
    home.mkdir(parents=True, exist_ok=True)
    switches, scenario = coverage.switches(home)
    program = build_simulation(checked.system, checked.folder, home, switches, scenario)
    coverage.forget(home)
    for case in cases:
        if case.instance is None:
            run_simulation(checked.system, program, case.stimuli)
    found = coverage.measured(home, places_of_user(checked.system, checked.folder))
    file.parent.mkdir(parents=True, exist_ok=True)
    replace_file(file, coverage.tracefile(found))
    for origin in coverage.SourceOwner:
        some = [one for one in found if one.origin is origin]
        lines, branches = sum(len(one.lines) for one in some), sum(len(o.branches) for o in some)
        executed, taken = sum(one.executed() for one in some), sum(one.taken() for one in some)
        for what, reached, all_ in (("lines", executed, lines), ("branches", taken, branches)):
            if all_:
                print(f"{f'{what} of {origin.value} sources':<38} {reached:>4} of {all_}")
    for one in found:
        if one.left():
            print(f"{one.path}: not executed: {coverage.number_ranges(one.left())}")
    return found
