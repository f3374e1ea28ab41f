"""`ravenchart workbench`: a local web page in which a model is changed and analysed."""

from __future__ import annotations

import argparse

from ravenchart.failures import OK

from . import common
from .results import WorkbenchResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    common.add_model(sub)
    sub.add_argument(
        "--port", type=_port, default=0, metavar="PORT",
        help="TCP port of the page, on this machine alone (default: a free one)",
    )  # fmt: skip
    sub.add_argument("--no-open", action="store_true", help="print the address, open no browser")


def _port(text: str) -> int:
    if not (text.isascii() and text.isdigit() and int(text[:6]) <= 65_535):
        raise argparse.ArgumentTypeError(f"{text!r} is not 0 .. 65535")
    return int(text)


def execute(options: argparse.Namespace) -> int:
    """Serve until it is stopped; the exit status."""
    from ravenchart.workbench import serving

    serving.serve(
        options.model,
        options.port,
        browser=not options.no_open,
        say=lambda text: print(text, flush=True),
        serves=lambda address: options.answer.serves(WorkbenchResult(address)),
    )
    return OK
