# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Tasks and the rows of their tables, as the checker derives them from a model."""

from __future__ import annotations

import math
from dataclasses import dataclass, field


def ada(element: str) -> str:
    """An element as a part of a name in the certificate."""
    words = element.replace(".", "_").split("_")
    return "_".join(word[:1].upper() + word[1:] for word in words)


@dataclass(slots=True)
class Row:
    """One entry of a table."""

    element: str
    period: int
    wcet: int
    deadline: int
    divisor: int = 1
    phase: int = 0
    is_open: bool = False
    """The generator chose its phase; the certificate says which."""


@dataclass(slots=True)
class Task:
    """One task: a processor, the driver's work on a message, a supervisor or a probe."""

    element: str
    node: str
    period: int
    deadline: int
    wcet: int
    priority: int = 0
    offset: int = 0
    rows: list[Row] = field(default_factory=list)
    bus: str | None = None  # that releases a processor
    port: str | None = None  # the same
    after: str | None = None
    """The task or message that releases the driver."""
    core: int = 1
    lasting: int = 0
    """How long after its releases what it sends is visible; 0: when it is sent."""

    @property
    def place(self) -> tuple[str, int]:
        """The node and the core of it that the task runs on."""
        return self.node, self.core

    @property
    def sporadic(self) -> bool:
        """It waits for a frame or value, and for its separation."""
        return self.bus is not None or self.port is not None

    @property
    def works(self) -> dict[int, int]:
        """The WCET of the rows of every n-th release, by n; 1 is there always."""
        found = {1: 0} if self.rows else {1: self.wcet}
        for row in self.rows:
            found[row.divisor] = found.get(row.divisor, 0) + row.wcet
        return found

    @property
    def longest(self) -> int:
        """The WCET of the rows of a release that has the most to do, by their phases."""
        if not self.rows:
            return self.wcet
        cycle = math.lcm(*(row.divisor for row in self.rows))
        return max(
            sum(row.wcet for row in self.rows if k % row.divisor == row.phase) for k in range(cycle)
        )
