# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`ravenchart explain`: what a code of an error or warning means, and how to correct it."""

from __future__ import annotations

import argparse
import difflib
import re
import sys
from pathlib import Path

from ravenchart.failures import OK, Refused, Unusable
from ravenchart.gen.diagnostics import CODES
from ravenchart.gen.explanations import ENCODING, Example, explanations, text

from .results import ExampleResult, ExplainResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare the arguments of the command."""
    sub.add_argument(
        "code", metavar="CODE", help="the code of an error or warning, for example RV-0305"
    )
    shown = sub.add_mutually_exclusive_group()
    shown.add_argument("--wrong", action="store_true", help="print the wrong files alone")
    shown.add_argument("--corrected", action="store_true", help="print the corrected files alone")
    sub.add_argument(
        "--out", type=Path, metavar="FOLDER",
        help="with --wrong or --corrected: write the files there instead",
    )  # fmt: skip


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status."""
    code = options.code.strip("[]").upper()
    if number := re.fullmatch(r"(?:RV-?)?(\d{1,4})", code):
        code = f"RV-{number[1]:>04}"
    if code not in CODES:
        near = difflib.get_close_matches(code, CODES, 3)
        hint = f"; similar codes: {', '.join(near)}" if near else ""
        raise Refused(f"ravenchart: error: no message has the code {options.code}{hint}")
    found = explanations()[code]
    options.answer.result = ExplainResult(
        code, found.meaning, found.why, _result(found.wrong), _result(found.corrected), text(code)
    )
    if not options.wrong and not options.corrected:
        if options.out is not None:
            raise Unusable("--out needs --wrong or --corrected")
        sys.stdout.write(text(code))
        return OK
    example = found.wrong if options.wrong else found.corrected
    if options.out is None:
        _print(example)
    else:
        write(example, options.out)
    return OK


def _result(example: Example) -> ExampleResult:
    return ExampleResult(list(example.commands), dict(example.files))


def _print(example: Example) -> None:
    """The files one after another; where there are several, each below its name."""
    sys.stdout.flush()
    for name, content in example.files.items():
        head = f"==> {name} <==\n" if len(example.files) > 1 else ""
        sys.stdout.buffer.write(f"{head}{content}".encode(*ENCODING))


def write(example: Example, folder: Path) -> None:
    """Write the files of an example to a folder."""
    for name, content in example.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode(*ENCODING))
