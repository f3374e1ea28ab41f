"""How long the check of a model may take."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

LOOK_AT_CLOCK = 8
"""Situations between two looks at the clock, which take time themselves."""


class OutOfTime(Exception):  # noqa: N818
    """The time for the check is over."""


@dataclass
class Clock:
    """How much processor time the whole check may take, and how far it has got."""

    seconds: float
    started: float = field(default_factory=time.process_time)
    situations: int = 0

    def count(self) -> None:
        """One situation more; `OutOfTime` when there is no time for it."""
        if self.situations % LOOK_AT_CLOCK == 0:
            self.check()
        self.situations += 1

    def check(self) -> None:
        """`OutOfTime` when there is no time left."""
        if time.process_time() - self.started > self.seconds:
            raise OutOfTime
