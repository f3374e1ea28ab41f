"""`ravenchart check`: the rules of a model, its behaviour and its deadlines."""

from __future__ import annotations

import argparse

from ravenchart.failures import OK, Unusable

from . import common
from .results import CheckResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    sub.add_argument(
        "--watch", action="store_true",
        help="check again whenever a file of the model changes, until Ctrl-C",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Check it; the exit status."""
    if options.watch:
        from . import watching

        if options.json:
            raise Unusable("--watch goes without --json: it has no end to answer at")
        watching.watch(options.model)
    found = common.checked(options, finish=True)
    system = found.system
    options.answer.result = CheckResult(
        system.name,
        system.digest,
        len(system.instances),
        len(system.processors),
        len(system.messages),
    )
    print(common.verdict(found))
    return OK
