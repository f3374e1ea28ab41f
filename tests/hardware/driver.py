# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A driver, in a program that echoes, tried by python-can on an interface of Linux.

Run as ``python -P -m tests.hardware.driver PROGRAM INTERFACE``, where PROGRAM is
tests/ada/can_echo.adb, built with ``CAN_DRIVER=socketcan``. With ``--near``, python-can is on
another interface of the same bus. As root, for the interface is taken down and up again. With
``--driver ctucanfd`` INTERFACE is what the program finds in RAVENCHART_CTUCANFD.
"""

from __future__ import annotations

import argparse
import json
import sys
from dataclasses import asdict
from pathlib import Path

from ravenchart.commands.loopback import answered, show
from ravenchart.hw_can.bench.peer import BenchError
from ravenchart.hw_can.conformance.ends import Ends, Setup, opened
from ravenchart.hw_can.conformance.suite import SuiteResult, run

from .driver_cases import LIMIT, VARIABLES, cases, started


def tried(
    program: Path, channel: str, near: str, *, emulated: bool, name: str = "socketcan"
) -> SuiteResult:
    """Run all cases; BenchError when the program or python-can cannot open its interface."""
    setup = Setup("socketcan", near, "socketcan", near)
    with started(program, channel, emulated=emulated, name=name) as driver:
        if not driver.echo.came(lambda: driver.echo.now.state == "ERROR_ACTIVE", LIMIT):
            raise BenchError(f"{program} does not open {channel}: {' '.join(driver.echo.said)}")
        bus = opened(setup.interface, near, setup)
        ends = Ends(setup, bus, bus)
        try:
            return run(ends, cases=cases(driver))
        finally:
            ends.close()


def main() -> int:
    """0 when nothing failed and something passed, 1 otherwise, 2 when nothing could be run."""
    parser = argparse.ArgumentParser(prog="driver")
    parser.add_argument("program", type=Path, metavar="PROGRAM")
    parser.add_argument("channel", metavar="INTERFACE")
    parser.add_argument("--near", metavar="INTERFACE", help="of python-can (default: the same)")
    parser.add_argument("--json", action="store_true", help="print what came of it as JSON")
    parser.add_argument("--driver", choices=tuple(VARIABLES), default="socketcan")
    parser.add_argument("--emulated", action="store_true", help="an SJA1000 of QEMU is on the bus")
    options = parser.parse_args()
    near = options.near or options.channel
    try:
        result = tried(
            options.program,
            options.channel,
            near,
            emulated=options.emulated,
            name=options.driver,
        )
    except (BenchError, OSError) as problem:
        print(f"driver: error: {problem}", file=sys.stderr)
        return 2
    if options.json:
        print(json.dumps({"result": asdict(answered(result))}))
    else:
        show(result)
    return 0 if result.passed else 1


if __name__ == "__main__":
    raise SystemExit(main())
