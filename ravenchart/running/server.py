# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The bus server as a process: built when it is first needed, and started."""

from __future__ import annotations

import re
import subprocess
from collections.abc import Callable, Iterator, Sequence
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
def running(
    *told: str, log: Path | None = None, beside: Path | None = None, bus: str = ""
) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A bus server for the time of a block, and its channel, ``host:port``.

    With ``log`` all frames and error frames of the bus are written there; the file is complete
    after the block. Raises OSError where that cannot be. They are shown to others by a ring
    ``beside`` a program, as of that ``bus`` where there are several.
    """
    with (
        _commanded(told, log, beside, bus) as (words, descriptors),
        children.running(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            text=True,
            pass_fds=descriptors,
        ) as server,
    ):
        assert server.stdout is not None
        yield server, server.stdout.readline().split()[-1]


def serve(told: Sequence[str], log: Path | None = None) -> int:
    """Run the server until it is interrupted; its exit status. ``log`` as of `running`."""
    with (
        _commanded(told, log) as (words, descriptors),
        children.running(words, stdin=subprocess.DEVNULL, pass_fds=descriptors) as server,
    ):
        return server.wait()


def announced(
    told: Sequence[str],
    log: Path | None,
    serves: Callable[[str], None],
    say: Callable[[str], None],
) -> int:
    """The same; ``serves`` gets the channel, and ``say`` each other line of the server."""
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    with (
        _commanded(told, log) as (words, descriptors),
        children.running(words, stdin=subprocess.DEVNULL, pass_fds=descriptors, **pipes) as server,
    ):
        assert server.stdout is not None
        for line in server.stdout:
            found = CHANNEL.fullmatch(line)
            if found:
                serves(found[1])
            else:
                say(line.rstrip())
        return server.wait()


@contextmanager
def _commanded(
    told: Sequence[str], log: Path | None, beside: Path | None = None, bus: str = ""
) -> Iterator[tuple[list[str | Path], tuple[int, ...]]]:
    """The command, and the descriptors that it inherits."""
    words: list[str | Path] = [built(), *told]
    if log is None and beside is None:
        yield words, ()
    else:
        with bus_log.written(log, beside, bus) as descriptor:
            yield [*words, f"log=/dev/fd/{descriptor}"], (descriptor,)


CHANNEL = re.compile(r"bus .* at (\S+:\d+)\n")
"""The line that the server prints when processes can join the bus."""


def uneven(rate: int) -> str:
    """Why the server refuses a bit rate."""
    return f"a bit at {rate} bit/s is no whole number of ns"
