"""`ravenchart explain`: what a code of an error or warning means, and how to correct it."""

from __future__ import annotations

import argparse
import difflib
import sys

from ravenchart.failures import OK, Refused
from ravenchart.gen import explanations
from ravenchart.gen.diagnostics import CODES

from .results import ExplainResult


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    sub.add_argument(
        "code", metavar="CODE", help="the code of an error or warning, for example RV-0305"
    )
    shown = sub.add_mutually_exclusive_group()
    shown.add_argument("--wrong", action="store_true", help="print the wrong model alone")
    shown.add_argument("--corrected", action="store_true", help="print the corrected model alone")


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status."""
    code = options.code.strip("[]").upper()
    if code.isdigit():
        code = f"RV-{code:>04}"
    if code not in CODES:
        near = difflib.get_close_matches(code, CODES, 3)
        hint = f"; there are {', '.join(near)}" if near else ""
        raise Refused(f"ravenchart: error: no message has the code {options.code}{hint}")
    found = explanations.explanations().get(code)
    options.answer.result = ExplainResult(
        code,
        CODES[code],
        found.why if found else None,
        found.wrong if found else None,
        found.corrected if found else None,
        explanations.text(code),
    )
    if not options.wrong and not options.corrected:
        sys.stdout.write(explanations.text(code))
        return OK
    if found is None or found.wrong is None or found.corrected is None:
        raise Refused(f"ravenchart: error: {code} has no example model yet")
    sys.stdout.write(found.wrong if options.wrong else found.corrected)
    return OK
