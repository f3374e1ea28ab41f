# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A snapshot of the pump as its controller writes it, and files of them that someone holds."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from ravenchart.analysis.system.observed import TraceMap, read_map
from ravenchart.paths import ROOT
from ravenchart.running.snapshots import FIRST_LINE

PUMP = ROOT / "examples" / "pump" / "model.yaml"
GENERATED = PUMP.parent / "generated"

HOLDER = """
import fcntl, sys
with open(sys.argv[1], "r+") as file:
    fcntl.lockf(file, fcntl.LOCK_EX)
    print("held", flush=True)
    sys.stdin.read()
"""


@cache
def trace_map() -> TraceMap:
    """The numbered elements of the pump."""
    return read_map((GENERATED / "trace.json").read_text("utf-8"))


def number(name: str, kind: str) -> int:
    """The number of an element of the pump."""
    return trace_map().named(name, kind).number


def snapshot(
    sequence: int, *lines: str, digest: str | None = None, start: int = 84385114343632
) -> str:
    """A whole snapshot with these lines of a report; ``start`` is the machine's clock at its 0."""
    head = [f"E {start}", f"M {digest or trace_map().digest}"]
    last = f"S {sequence:010}"
    body = "".join(f"{line}\n" for line in (*head, *lines, last))
    return f"{last} {FIRST_LINE + len(body):08}\n{body}"


def processors(releases: int, *, misses: int = 0) -> Sequence[str]:
    """The counts of both processors at 2 s."""
    return (
        "N 2000000000",
        f"P {number('reception', 'processor')} 5 0 30000 20000",
        f"P {number('control', 'processor')} {releases} {misses} 401195 301195",
        f"Q {number('bed.Infusion', 'region')} 2 7",
        f"Q {number('bed.Keys', 'region')} 0 1",
        "H Deadline_Miss 0",
        "H Overrun 0",
        "H Queue_Overflow 0",
        "L trace 0",
        "L ward.lost_out 3",
        "L ward.sent 9",
        "L snapshot 0",
    )


@contextmanager
def held(path: Path) -> Iterator[int]:
    """The file locked as by a controller: the number of the process."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLDER, path], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as process:
        assert process.stdout is not None
        assert process.stdin is not None
        assert process.stdout.readline() == b"held\n"
        yield process.pid
        process.stdin.close()
