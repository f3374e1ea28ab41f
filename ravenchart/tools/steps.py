# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How far a run of gprbuild or gnatprove is, from the lines in which it counts its units.

gprbuild counts them once, and finds more on the way. gnatprove compiles every unit first, and then
proves each; it counts the units of either phase from one.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable

OF_GPRBUILD = "-d"
OF_GNATPROVE = "--ide-progress-bar"
"""The switches with which they print such lines."""
COMPILING = ("compiled",)
PROVING = ("read", "proved")
"""The action on a unit in each phase."""
_DONE = re.compile(r"completed (\d+) out of (\d+) \(\d+%\)\.\.\.\s*")


class Announced:
    """Reports after each unit how many are done, and how long the others of the last phase take
    at that pace.
    """

    def __init__(
        self,
        phases: tuple[str, ...],
        tell: Callable[[str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._left = list(phases)
        self._tell = tell
        self._clock = clock
        self._begun = clock()
        self._before = 0

    def takes(self, line: str) -> bool:
        """Whether the line is about progress, and no message."""
        found = _DONE.fullmatch(line)
        if found is None:
            return False
        done, units = int(found[1]), int(found[2])
        if done <= self._before and len(self._left) > 1:
            self._left.pop(0)
        if len(self._left) > 1:
            self._begun = self._clock()  # the last phase has not begun
        self._before = done
        self._tell(self._text(done, units))
        return True

    def _text(self, done: int, units: int) -> str:
        text = f"{done} of {units} units {self._left[0]}"
        if len(self._left) > 1 or done == units:
            return text
        left = (self._clock() - self._begun) / done * (units - done)
        return f"{text}, about {_span(left)} left"


def _span(seconds: float) -> str:
    """In whole minutes from 90 s on."""
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"
