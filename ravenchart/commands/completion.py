# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart completion`: the script by which a shell completes commands, options and files.

A script is made of the parsers, once: pressing Tab starts no Python.
"""

from __future__ import annotations

import argparse

from ravenchart.failures import OK

from .results import CompletionResult

SHELLS = ("bash", "zsh", "fish")


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument("shell", choices=SHELLS, help="the shell that reads the script")


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status."""
    from ravenchart.completions import SCRIPTS
    from ravenchart.grammar import grammar

    script = SCRIPTS[options.shell](grammar(options.parser()))
    options.answer.result = CompletionResult(options.shell, script)
    print(script, end="")
    return OK
