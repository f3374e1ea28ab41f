# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An example of one node, built with the driver `bus`, on a bus server with tools of others."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path

from ravenchart.building import checking, programs
from ravenchart.paths import ROOT
from ravenchart.running import server
from ravenchart.running.process import ControllerProcess

PATIENCE = 60.0
"""Seconds within which something must have happened: a host may be slow."""


@cache
def built(name: str) -> Path:
    """The program of an example."""
    checked = checking.check(ROOT / "examples" / name / "model.yaml")
    return programs.programs_of(checked)[0].build(driver="bus")


@contextmanager
def bus_of(bit_rate: int) -> Iterator[str]:
    """A bus server for classic frames; its channel."""
    with server.running("port=0", f"bitrate={bit_rate}", "data_bitrate=0") as (_, channel):
        yield channel


@contextmanager
def running(name: str, channel: str, trace: Path) -> Iterator[None]:
    """The example as a node of that bus, which must end in order."""
    names = {"RAVENCHART_BUS_PORT": channel.rpartition(":")[2], "RAVENCHART_BUS_NAME": name}
    process = ControllerProcess(built(name), trace, 0, **names)
    try:
        process.wait_until_joined()
        yield
    finally:
        ended = process.stop(0.0)
    assert ended.exit_code == 0, ended.warnings


def becomes(look: Callable[[], object]) -> bool:
    """Whether ``look()`` becomes true in time."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if look():
            return True
        time.sleep(0.01)
    return False
