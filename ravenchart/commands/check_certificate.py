# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart check-certificate`: the generated program against its model, by independent code."""

from __future__ import annotations

import argparse
from pathlib import Path

from ravenchart.failures import OK, Refused, Unusable
from ravenchart.independent.check import checked
from ravenchart.independent.findings import UnusableError

from . import common
from .results import CertificateResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    common.add_model(sub)
    sub.add_argument(
        "--generated", type=Path, metavar="FOLDER",
        help="the generated program; default: the folder beside the model",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Compare them; the exit status."""
    try:
        report = checked(options.model, options.generated)
    except UnusableError as problem:
        raise Unusable(str(problem)) from problem
    options.answer.result = CertificateResult(
        report.agrees, dict(report.counts), dict(report.not_derived)
    )
    print("\n".join(report.lines()))
    if not report.agrees:
        raise Refused("\n".join(map(str, report.disagreements)))
    return OK
