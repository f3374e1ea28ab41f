"""How far a run of gnatprove is, from the lines that its switch ``--ide-progress-bar`` prints.

It compiles every unit first, and then proves each; it counts the units of either phase from one.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable

SWITCH = "--ide-progress-bar"
_DONE = re.compile(r"completed (\d+) out of (\d+) \(\d+%\)\.\.\.\s*")


class Announced:
    """Tells after each unit how many are done, and how long the others take at that pace."""

    def __init__(
        self, tell: Callable[[str], None], clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._tell = tell
        self._clock = clock
        self._begun = clock()
        self._before = 0
        self._proving = False

    def takes(self, line: str) -> bool:
        """Whether the line is about progress, and no message."""
        found = _DONE.fullmatch(line)
        if found is None:
            return False
        done, units = int(found[1]), int(found[2])
        if done <= self._before:
            self._proving = True
        if not self._proving:
            self._begun = self._clock()  # proving has not begun
        self._before = done
        self._tell(self._text(done, units))
        return True

    def _text(self, done: int, units: int) -> str:
        if not self._proving:
            return f"{done} of {units} units read"
        left = (self._clock() - self._begun) / done * (units - done)
        text = f"{done} of {units} units proved"
        return f"{text}, about {_span(left)} left" if done < units else text


def _span(seconds: float) -> str:
    """In whole minutes from 90 s on."""
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
