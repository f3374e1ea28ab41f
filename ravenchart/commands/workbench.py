# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart workbench`: a local web page in which a model is changed and analysed."""

from __future__ import annotations

import argparse
from pathlib import Path

from ravenchart.failures import OK, Unusable
from ravenchart.terminal import progress

from . import common


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    common.add_port(sub)
    sub.add_argument(
        "--replay", type=Path, action="append", default=[], metavar="FILE",
        help="show a recorded run in place of running controllers: trace.txt, or what `simulate` "
        "printed; once for each of several nodes, trace-NODE.txt",
    )  # fmt: skip
    common.add_snapshots(sub, "Without it: those of `run`, `shell` and `measure`")
    common.add_interface(sub, "show in Live the bus", builds=False)
    common.add_scheduler(sub)
    sub.add_argument("--no-open", action="store_true", help="print the address, open no browser")


def execute(options: argparse.Namespace) -> int:
    """Serve until it is stopped; the exit status."""
    from ravenchart.running.attaching import interfaces_of
    from ravenchart.workbench.hub import Hub
    from ravenchart.workbench.live import LiveView
    from ravenchart.workbench.replay import ReplayView
    from ravenchart.workbench.server import WorkbenchPages
    from ravenchart.workbench.session import Session

    bus = common.named_interface(options)
    if bus is not None and options.replay:
        raise Unusable("--replay shows a recorded run: leave --interface out")
    if options.file and options.replay:
        raise Unusable("--replay shows a recorded run: leave --file out")

    def made() -> WorkbenchPages:
        with progress(f"read and analyse {options.model}"):
            session = Session(options.model)
        if options.replay:
            with progress("read the trace"):
                return WorkbenchPages(Hub(session, ReplayView(options.model, options.replay)))
        saved = session.saved.analysis
        if bus is not None and saved is not None:
            interfaces_of(saved.system, *bus)
        live = LiveView(options.model, bus, options.file)
        if options.file and saved is not None:
            with progress("look for the controllers"):
                live.begin(saved.system.digest)
        return WorkbenchPages(Hub(session, live, options.scheduler))

    common.serve(
        options,
        made,
        browser=not options.no_open,
        what="the workbench is at",
        remark="Ctrl-C ends the workbench. Whoever has the address can change the model.",
    )
    return OK
