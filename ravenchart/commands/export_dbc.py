# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart export-dbc`: the CAN database of a bus of a model, for other tools."""

from __future__ import annotations

import argparse
from pathlib import Path

from ravenchart.databases import exporting
from ravenchart.failures import OK, Refused
from ravenchart.gen.language.names import meant

from . import common
from .answer import say
from .results import ExportResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument("--bus", help="the bus; needed where the model has several")
    sub.add_argument(
        "--like", type=Path, metavar="FILE",
        help="the database that messages were imported from: take names, comments, attributes "
        "and scales from it",
    )  # fmt: skip
    sub.add_argument(
        "--lenient", action="store_true",
        help="read FILE although signals share bits or reach beyond their frame",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status."""
    system = common.checked(options, deadlines=False).system
    buses = {bus.name: bus for bus in system.buses}
    given = {bus.lower(): bus for bus in buses}.get((options.bus or "").lower())
    name = given or options.bus or (next(iter(buses)) if len(buses) == 1 else None)
    if not buses:
        raise Refused(f"{options.model}: error: the model has no bus")
    if name not in buses:
        hint = meant(options.bus or "", buses) or f"one of: {', '.join(buses)}"
        told = "name one with `--bus`" if options.bus is None else f"no bus is called {options.bus}"
        raise Refused(f"{options.model}: error: {told}: {hint}")
    found = exporting.exported(system, buses[name], options.like, lenient=options.lenient)
    options.answer.result = ExportResult(name, found.text)
    print(found.text, end="")
    for note in found.notes:
        say(options.answer, f"note: {note}")
    return OK
