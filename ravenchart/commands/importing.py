# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart import`: a model of the messages of a CAN database."""

from __future__ import annotations

import argparse
from pathlib import Path

from ravenchart.databases import database
from ravenchart.failures import OK, WRONG
from ravenchart.terminal import progress

from .answer import say
from .results import ImportResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "database", type=Path, metavar="FILE", help="the database: DBC, KCD, SYM or ARXML"
    )
    seen = sub.add_mutually_exclusive_group(required=True)
    seen.add_argument("--node", help="the node of the database that the model describes")
    seen.add_argument("--all", action="store_true", help="a node that receives every message")
    sub.add_argument("--bus", help="import only the messages of this bus of the database")
    sub.add_argument(
        "--period", metavar="TIME",
        help="least time between frames of a message whose database has no cycle time: `100 ms`",
    )  # fmt: skip
    sub.add_argument(
        "--periods", type=Path, metavar="FILE",
        help="the same for single messages, in YAML: `message: 20 ms`",
    )  # fmt: skip
    sub.add_argument(
        "--parts", action="store_true",
        help="print only types, ports and messages, for a model that includes them",
    )  # fmt: skip
    sub.add_argument(
        "--lenient", action="store_true",
        help="read a database whose signals share bits or reach beyond their frame",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status."""
    given = database.periods(options.period, options.periods)
    with progress(f"read {options.database.name}"):
        found = database.imported(
            options.database,
            options.node,
            given,
            lenient=options.lenient,
            bus=options.bus,
            parts=options.parts,
        )
    options.answer.result = ImportResult(found.text)
    print(found.text, end="")
    for problem in found.problems:
        say(options.answer, problem)
    return WRONG if found.problems else OK
