"""The bus server as a process: built when it is first needed, and started."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from ravenchart.paths import ROOT, work
from ravenchart.tools import children, toolchain

from . import bus_log

PROJECT = ROOT / "hw_can" / "server" / "can_bus.gpr"
SECOND = 10**9
"""Of the simulated bus, in its own ticks: a bit must be a number of them."""


@cache
def built() -> Path:
    """The server's program, compiled if need be, and once; ToolMissing or ToolFailed."""
    options = ["-p", "-q", "-j0", "-P", PROJECT.name]
    toolchain.run("gprbuild", options, PROJECT.parent, {"MODE": "release"})
    return work() / "obj" / "bus-release" / "can_bus"


@contextmanager
def running(*told: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A bus server for the time of a block, and its channel, ``host:port``."""
    with children.running(
        [built(), *told], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True
    ) as server:
        assert server.stdout is not None
        yield server, server.stdout.readline().split()[-1]


def serve(told: Sequence[str], log: Path | None = None) -> int:
    """Run the server until it is interrupted; its exit status.

    With ``log`` all frames and error frames of the bus are written there. Raises OSError
    where that cannot be.
    """
    if log is None:
        with children.running([built(), *told], stdin=subprocess.DEVNULL) as server:
            return server.wait()
    program = built()
    with bus_log.written(log) as descriptor:
        words: list[str | Path] = [program, *told, f"log=/dev/fd/{descriptor}"]
        with children.running(words, stdin=subprocess.DEVNULL, pass_fds=(descriptor,)) as server:
            return server.wait()


def uneven(rate: int) -> str:
    """Why the server refuses a bit rate."""
    return f"a bit at {rate} bit/s is no whole number of ns"
