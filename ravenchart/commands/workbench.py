"""`ravenchart workbench`: a local web page in which a model is changed and analysed."""

from __future__ import annotations

import argparse

from ravenchart.failures import OK
from ravenchart.terminal import progress

from . import common
from .results import WorkbenchResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    common.add_port(sub)
    sub.add_argument("--no-open", action="store_true", help="print the address, open no browser")


def execute(options: argparse.Namespace) -> int:
    """Serve until it is stopped; the exit status."""
    from ravenchart.workbench import serving
    from ravenchart.workbench.hub import Hub
    from ravenchart.workbench.server import WorkbenchPages
    from ravenchart.workbench.session import Session

    def made() -> WorkbenchPages:
        with progress(f"read and analyse {options.model}"):
            return WorkbenchPages(Hub(Session(options.model)))

    def serves(address: str) -> None:
        options.answer.serves(WorkbenchResult(address))
        common.say_at_once(f"{options.model}: the workbench is at {address}")
        common.say_at_once(
            "Ctrl-C ends the workbench. Whoever has the address can change the model."
        )

    serving.serve(
        made, options.port, browser=not options.no_open, say=common.say_at_once, serves=serves
    )
    return OK
