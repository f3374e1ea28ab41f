# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart shell`: commands to a running controller, typed or from a script."""

from __future__ import annotations

import argparse
import signal
import sys
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from io import TextIOWrapper
from pathlib import Path

from ravenchart import terminal
from ravenchart.building import programs
from ravenchart.building.checking import Checked
from ravenchart.failures import OK, WRONG, Refused, Unusable
from ravenchart.hw_can.bench.forms import DriveForm
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.running import judge, monitoring, scenarios
from ravenchart.running.attaching import require_bus
from ravenchart.running.process import Ended, StartError
from ravenchart.running.remote import NoAnswerError, RemoteSystem, connected
from ravenchart.running.shell import Shell
from ravenchart.running.started import started
from ravenchart.running.vocabulary import BusVocabulary, WordError
from ravenchart.running.watched import WatchedController

from . import common, run_results, running
from .answer import say

SCRIPT = "stdin"
"""The name of a script in its errors: it comes by standard input."""


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    common.add_interface(sub, "speak to a controller that runs already,")
    sub.add_argument(
        "--drives", type=Path, metavar="FILE", help="simulate the drives of this scenario"
    )
    common.add_log(sub)
    common.add_snapshots(sub, "With --interface: the states of charts")


def execute(options: argparse.Namespace) -> int:
    """Carry out the lines of standard input; the exit status."""
    checked = common.checked(options)
    system = checked.system
    require_bus(system)
    interfaces = common.interfaces(options, system)
    if options.file and not interfaces:
        raise Unusable("--file goes with --interface: the shell knows those that it starts")
    drives = scenarios.checked(options.drives, system).drives if options.drives else {}
    ended: Sequence[Ended] = ()
    with ExitStack() as stack:
        if not interfaces:
            robot, ended = _started(options, checked, drives, stack)
        else:
            robot = connected(checked, interfaces, drives, options.log, options.file)
        session = _Session(options, stack.enter_context(robot))
        passed = session.typed() if sys.stdin.isatty() else session.script()
        if drives and robot.skipped:
            held = f"the host held the bench up: {robot.skipped} feedback cycles were skipped"
            say(options.answer, f"note: {held}", severity="note")
    for one in ended:
        for reason in judge.stops(one):
            say(options.answer, f"ravenchart: error: {reason}")
            passed = False
    return OK if passed else WRONG


def _started(
    options: argparse.Namespace,
    checked: Checked,
    drives: Mapping[str, DriveForm],
    stack: ExitStack,
) -> tuple[RemoteSystem, Sequence[Ended]]:
    """The controllers on this machine, for the time of the stack, and how they ended then."""
    built = running.controllers(checked, options.answer)
    folder = programs.build_home(checked, programs.default_driver(checked)) / "shell"
    vocabulary = BusVocabulary.of(checked.system)
    try:
        made = stack.enter_context(
            started(built, checked.analysis, vocabulary, folder, options.log)
        )
    except (StartError, BenchError) as fault:
        raise Refused(f"ravenchart: error: {fault}") from None
    watched = _watched(options, checked, made.snapshots, stack)
    return RemoteSystem(vocabulary, made.peer, drives, watched=watched), made.ended


def _watched(
    options: argparse.Namespace, checked: Checked, snapshots: Sequence[str], stack: ExitStack
) -> Sequence[WatchedController]:
    """The controllers whose charts are seen; none, with a note, where their snapshots are not."""
    try:
        files = monitoring.given(checked, snapshots)
        return stack.enter_context(monitoring.watching(checked, files))
    except (Refused, Unusable, OSError) as fault:
        why = str(fault).removeprefix("ravenchart: error: ")
        say(options.answer, f"note: the states of charts are not seen: {why}", severity="note")
        return ()


class _Session:
    """The lines of one call, and their answer."""

    def __init__(self, options: argparse.Namespace, robot: RemoteSystem) -> None:
        self._answer = options.answer
        self._robot = robot
        self._out = terminal.console()
        self._shell = Shell(robot, self._out)
        self._began = time.monotonic()
        self._result = run_results.ShellResult([], {}, {})
        self._answer.result = self._result

    def script(self) -> bool:
        """Lines of a pipe or file, up to the first that fails; whether all passed."""
        if isinstance(sys.stdin, TextIOWrapper):
            sys.stdin.reconfigure(errors="replace")  # such a word is no name: that is said
        for number, line in enumerate(sys.stdin, 1):
            goes_on, fault = self._done(line)
            if fault:
                say(self._answer, f"{SCRIPT}:{number}: error: {fault}")
            if not goes_on:
                return not fault
        return True

    def typed(self) -> bool:
        """Lines of a terminal, to the end; a mistake ends none."""
        print(f"{self._robot.system.name}: `help` lists the commands, Ctrl-D ends")
        with _editing(self._shell), _interruptible():
            while True:
                try:
                    goes_on, fault = self._done(input("> "))
                    if fault:
                        say(self._answer, f"error: {fault}")
                    elif not goes_on:
                        return True
                except EOFError:
                    print()
                    return True
                except KeyboardInterrupt:
                    print()

    def _done(self, line: str) -> tuple[bool, str]:
        """Carry out one line: whether another may follow, and why it failed."""
        goes_on, fault, began = True, "", time.monotonic() - self._began
        try:
            goes_on = self._shell.do(line)
        except (WordError, NoAnswerError, BenchError) as problem:
            goes_on, fault = False, str(problem)
        self._out.file.flush()
        if line.strip():
            step = run_results.PlayedStep(began, line.strip(), not fault, fault or "done")
            self._result.commands.append(step)
        self._result.status = self._robot.status
        self._result.charts = {name: one.state for name, one in self._robot.charts.items()}
        return goes_on, fault


@contextmanager
def _editing(shell: Shell) -> Iterator[None]:
    """The editing of lines, with names completed by Tab; where Python has it."""
    try:
        import readline
    except ImportError:
        yield
        return

    def complete(begun: str, number: int) -> str | None:
        before = readline.get_line_buffer()[: readline.get_begidx()]
        found = shell.completions(before, begun)
        if number >= len(found):
            return None
        return found[number] + ("" if found[number].endswith("=") or found[1:] else " ")

    readline.set_completer_delims(" \t\n=")
    readline.set_completer(complete)
    readline.parse_and_bind("tab: complete")
    try:
        yield
    finally:
        readline.set_completer(None)


@contextmanager
def _interruptible() -> Iterator[None]:
    """Ctrl-C ends the command that runs, and not the shell."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
