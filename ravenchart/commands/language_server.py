# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart language-server`: diagnostics, completion and rename for editors, over stdio."""

from __future__ import annotations

import argparse
import os
import sys

from ravenchart.failures import OK


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "--stdio", action="store_true",
        help="talk over standard input and output: the only way, which some editors ask for",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Serve until the editor ends it; the exit status."""
    from ravenchart.language_server.server import server

    with open(os.dup(sys.stdout.fileno()), "wb") as out:  # the server closes it at its end
        server().start_io(stdout=out)
    return OK
