"""`ravenchart explain`: what a code of an error or warning means."""

from __future__ import annotations

import argparse
import difflib

from ravenchart.failures import OK, Refused
from ravenchart.gen.diagnostics import CODES, GROUPS


def add_arguments(sub: argparse.ArgumentParser) -> None:
    """Declare what the command is told."""
    sub.add_argument("code", metavar="CODE", help="as it stands in a message: RV-0305")


def execute(options: argparse.Namespace) -> int:
    """Print it; the exit status."""
    code = options.code.strip("[]").upper()
    if code.isdigit():
        code = f"RV-{code:>04}"
    if code not in CODES:
        near = difflib.get_close_matches(code, CODES, 3)
        hint = f"; there are {', '.join(near)}" if near else ""
        raise Refused(f"ravenchart: error: no message has the code {options.code}{hint}")
    print(f"{code}  {GROUPS[code[3:5]]}\n{CODES[code]}")
    return OK
