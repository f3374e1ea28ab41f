"""The `ravenchart` command: the table of its commands, and how each of them ends.

A command is a module of `commands` with ``add_arguments`` and ``execute``. It is imported
when it is called, so that `--help` does not wait for libraries that it has no use for.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import NoReturn

from .failures import STATUSES, UNUSABLE, Failure
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
        "put the periodic rows of a model into processors anew, and check",
    ),
    "run": ("run", "build and run the controller on this machine"),
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
    "explain": ("explain", "explain the code of an error or warning"),
    "clean": ("clean", "delete build results"),
}
"""Name to the module that does it, and what it does."""

ALIASES = {"import": ("import-dbc",)}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command; the exit status."""
    told = sys.argv[1:] if arguments is None else list(arguments)
    options = _parser(told).parse_args(told)
    try:
        status: int = options.execute(options)
    except Failure as failure:
        print(failure.shown(), file=sys.stderr)
        return failure.status
    except BrokenPipeError:
        raise  # nobody reads the output: `start` tells that from other broken pipes
    except OSError as problem:
        print(f"ravenchart: error: {said_of(problem)}", file=sys.stderr)
        return UNUSABLE
    except KeyboardInterrupt:
        print("ravenchart: interrupted", file=sys.stderr)
        return 130
    return status


class _Version(argparse.Action):
    """Prints the version; it is looked up only then."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        print(f"ravenchart {version()}")
        parser.exit()


def said_of(problem: OSError) -> str:
    """What the system says of a file, with its name and without a number."""
    reason = problem.strerror or str(problem)
    reason = f"{reason[:1].lower()}{reason[1:]}"
    return reason if problem.filename is None else f"{problem.filename}: {reason}"


def _parser(told: Sequence[str]) -> argparse.ArgumentParser:
    """The parser, with the options of the one command that is called."""
    parser = argparse.ArgumentParser(
        prog="ravenchart",
        description="From one model of a real-time controller to a proved SPARK Ada program, "
        "its timing analysis and its CAN bench.",
        epilog=STATUSES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print the version and end")
    called = next((word for word in told if not word.startswith("-")), None)
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")
    for name, (module, help_text) in COMMANDS.items():
        aliases = ALIASES.get(name, ())
        sub = commands.add_parser(name, aliases=aliases, help=help_text, description=help_text)
        if called == name or called in aliases:
            command = import_module(f"ravenchart.commands.{module}")
            command.add_arguments(sub)
            sub.set_defaults(execute=command.execute)
    return parser
