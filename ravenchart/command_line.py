# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The `ravenchart` command: the table of its commands, and how each of them ends.

A command is a module of `commands` with ``add_arguments`` and ``execute``. It is imported
when it is called, so that `--help` does not wait for libraries that it has no use for.
"""

from __future__ import annotations

import argparse
import re
import sys
import textwrap
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

from .building.garbage import without_collector
from .failures import INTERNAL, INTERNAL_TEXT, STATUSES, UNUSABLE, Failure, said_of
from .paths import version

COMMANDS = {
    "new": ("new", "create a project that checks, builds, runs and proves"),
    "doctor": ("doctor", "report installed and missing tools, with the command that installs each"),
    "check": ("check", "check the model: its rules and its deadlines"),
    "generate": ("generate", "write generated/ beside the model"),
    "build": ("build", "generate, and compile the controller"),
    "prove": ("prove", "generate, and prove the controller with gnatprove"),
    "analyse": ("analyse", "response times against deadlines, of a model or of CSV or JSON"),
    "allocate": (
        "allocate",
        "allocate the periodic rows of a model to processors anew, and check",
    ),
    "workbench": ("workbench", "change and analyse the model in a local web page"),
    "language-server": (
        "language_server",
        "answer an editor that speaks the Language Server Protocol",
    ),
    "check-certificate": (
        "check_certificate",
        "compare the generated program with the model, by independent code",
    ),
    "run": ("run", "build and run the controller on this machine"),
    "shell": ("shell", "send commands to the running controller, and print its answers"),
    "monitor": ("monitor", "watch the running controller: responses, states, losses"),
    "trace": ("trace", "write the trace of a run or simulation as CSV, for Perfetto or as MDF 4"),
    "measure": ("measure", "run the controller, and measure the execution time of each row"),
    "requirements": (
        "requirements",
        "trace requirements to elements, code, claims and tests, and back",
    ),
    "evidence": ("evidence", "write the evidence for an assessor as a folder"),
    "draw": ("draw", "draw the charts and the component structure"),
    "loopback": (
        "loopback",
        "test any python-can interface that has two ends on one bus",
    ),
    "bus": ("bus", "put a simulated CAN bus behind a TCP port, for any number of processes"),
    "import": (
        "importing",
        "print the messages of a CAN database as types, ports and messages of a model",
    ),
    "export-dbc": ("export_dbc", "print the CAN database of a bus of the model"),
    "simulate": ("simulate", "run the model in virtual time, step by step"),
    "tests": ("tests", "find event files that take every transition and decide every guard"),
    "explain": ("explain", "explain the code of an error or warning"),
    "clean": ("clean", "delete build results"),
    "completion": ("completion", "print the completion script of a shell"),
}
"""Name to the module that does it, and what it does."""

ALIASES = {"import": ("import-dbc",)}

JSON = "--json"

WITHOUT_JSON = ("language-server",)
"""Its output is a protocol, JSON-RPC, which an answer would disturb."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit status."""
    told = sys.argv[1:] if arguments is None else list(arguments)
    try:
        with without_collector():  # what is imported stays
            options = _parser(told).parse_args(told)
    except _WrongCall as wrong:
        if JSON in told:
            _answer(told, wrong.message, UNUSABLE)
        raise
    except Exception:  # an installation without a package, for example
        if JSON in told:
            _answer(told, INTERNAL_TEXT, INTERNAL)
        raise
    from .commands.answer import Answer, printed

    options.answer = Answer(options.command)
    if getattr(options, "json", False):
        return printed(options.answer, lambda: _executed(options))
    return _executed(options)


def _executed(options: argparse.Namespace) -> int:
    """Execute the command; the exit status. A failure is printed and put into the answer."""
    try:
        status: int = options.execute(options)
    except Failure as failure:
        print(failure.shown(), file=sys.stderr)
        options.answer.fail(failure.shown(), failure.found)
        return failure.status
    except BrokenPipeError:
        raise  # the reader of the output is gone: `start` distinguishes other broken pipes
    except OSError as problem:
        text = f"ravenchart: error: {said_of(problem)}"
        print(text, file=sys.stderr)
        options.answer.fail(text)
        return UNUSABLE
    except KeyboardInterrupt:
        print("ravenchart: interrupted", file=sys.stderr)
        return 130
    return status


class _WrongCall(SystemExit):
    """The call is wrong: argparse has printed how."""

    def __init__(self, message: str) -> None:
        super().__init__(UNUSABLE)
        self.message = message


class _Parser(argparse.ArgumentParser):
    """Says as a `_WrongCall` what is wrong with a call."""

    def error(self, message: str) -> NoReturn:
        if found := re.match("argument COMMAND: invalid choice: '(.*?)'", message):
            from ravenchart.gen.language.names import meant  # only here: every call would wait

            hint = meant(found[1], COMMANDS) or f"`{self.prog} --help` lists them"
            message = f"there is no command `{found[1]}`: {hint}"
        self.print_usage(sys.stderr)
        print(f"{self.prog}: error: {message}", file=sys.stderr)
        raise _WrongCall(message)


def _answer(told: Sequence[str], problem: str, status: int) -> None:
    """Print the answer to a call with `--json` that came to no command."""
    from .commands.answer import Answer

    answer = Answer(_called(told))
    answer.tell(problem)
    sys.stdout.write(answer.text(status))


def _called(told: Sequence[str]) -> str | None:
    """The command that is called, by its own name."""
    word = next((word for word in told if not word.startswith("-")), None)
    names = {alias: name for name, aliases in ALIASES.items() for alias in aliases}
    found = names.get(word or "", word)
    return found if found in COMMANDS else None


class _Help(argparse.RawDescriptionHelpFormatter):
    """Keeps the lines of the table of exit statuses, and wraps those that are too long."""

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        found: list[str] = []
        for line in text.splitlines():
            column = re.match(r" +\S.*?  +", line)
            behind = " " * (column.end() if column else 0)
            found += textwrap.wrap(line, width, subsequent_indent=behind)
        return "".join(f"{indent}{line}\n" for line in found)


class _Version(argparse.Action):
    """Prints the version; it is looked up only then."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        print(f"ravenchart {version()}")
        parser.exit()


def whole_parser() -> argparse.ArgumentParser:
    """The parser with the options of every command."""
    return _parser((), whole=True)


def _parser(told: Sequence[str], *, whole: bool = False) -> argparse.ArgumentParser:
    """The parser, with the options of the one command that is called, or the ``whole``."""
    parser = _Parser(
        prog="ravenchart",
        description="From one model of a real-time controller to a proved SPARK Ada program, "
        "its timing analysis and its CAN bench.",
        epilog=STATUSES,
        formatter_class=_Help,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and end")
    called = _called(told)
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for name, (module, help_text) in COMMANDS.items():
        aliases = ALIASES.get(name, ())
        sub = commands.add_parser(name, aliases=aliases, help=help_text, description=help_text)
        if whole or called == name:
            from .commands.answer import add_option

            command = import_module(f"ravenchart.commands.{module}")
            command.add_arguments(sub)
            if name not in WITHOUT_JSON and not any(JSON in a.option_strings for a in sub._actions):
                add_option(sub)
            sub.set_defaults(execute=command.execute, command=name, parser=whole_parser)
    return parser
