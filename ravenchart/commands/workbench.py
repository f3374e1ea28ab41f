"""`ravenchart workbench`: a local web page in which a model is changed and analysed."""

from __future__ import annotations

import argparse

from ravenchart.failures import OK
from ravenchart.terminal import progress

from . import common


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    common.add_port(sub)
    sub.add_argument("--no-open", action="store_true", help="print the address, open no browser")


def execute(options: argparse.Namespace) -> int:
    """Serve until it is stopped; the exit status."""
    from ravenchart.workbench.hub import Hub
    from ravenchart.workbench.server import WorkbenchPages
    from ravenchart.workbench.session import Session

    def made() -> WorkbenchPages:
        with progress(f"read and analyse {options.model}"):
            return WorkbenchPages(Hub(Session(options.model)))

    common.serve(
        options,
        made,
        browser=not options.no_open,
        what="the workbench is at",
        remark="Ctrl-C ends the workbench. Whoever has the address can change the model.",
    )
    return OK
