# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A program with the CAN driver `bus`, as a process that says how it stands (can_echo.adb)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.support.echo import Echo, Standing

JOINED = "can: joined the bus at 127.0.0.1:"
LIMIT = 20.0
"""Seconds within which something must have happened."""


class CanNode(Echo):
    """A node of the bus; what is waited for comes, or the test fails."""

    def wait(self, condition: Callable[[Standing], bool]) -> Standing:
        """Wait until ``condition`` holds of how it stands; that standing."""
        held: list[Standing] = []

        def holds() -> bool:
            held[:] = [self.now]
            return condition(held[0])

        assert self.came(holds, LIMIT), f"{self.now} {self.said}; running: {self.is_running}"
        return held[0]

    def wait_for(self, state: str) -> Standing:
        """Wait until it is in this state."""
        return self.wait(lambda now: now.state == state)


@contextmanager
def node(program: Path, number: int, channel: str, **environment: str) -> Iterator[CanNode]:
    """Node ``number`` at the bus server of ``channel``; it ends with the block."""
    names = {"RAVENCHART_BUS_PORT": channel.rpartition(":")[2], **environment}
    one = CanNode(program, names, number)
    try:
        yield one
    finally:
        one.close()
