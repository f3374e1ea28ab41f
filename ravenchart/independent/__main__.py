# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Check a generated program against its model, without Ravenchart."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

from .check import checked
from .findings import UnusableError


def main(arguments: Sequence[str] | None = None) -> int:
    """Check; the exit status: 0 all agrees, 1 something disagrees, 2 it cannot be checked."""
    parser = argparse.ArgumentParser(prog="independent", description=__doc__)
    parser.add_argument("model", type=Path, help="the main file of the model")
    parser.add_argument(
        "--generated", type=Path, metavar="FOLDER", help="the generated program (default: beside)"
    )
    parser.add_argument("--json", action="store_true", help="print the report as JSON")
    options = parser.parse_args(arguments)
    try:
        report = checked(options.model, options.generated)
    except UnusableError as problem:
        print(f"independent: error: {problem}", file=sys.stderr)
        return 2
    if options.json:
        print(json.dumps(report.data(), indent=2))
    else:
        print("\n".join(report.lines()))
    for one in report.disagreements:
        print(one, file=sys.stderr)
    return 0 if report.agrees else 1


if __name__ == "__main__":
    sys.exit(main())
