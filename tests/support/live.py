# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One controller at a time runs in real time: two would share a core at equal priorities."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from ravenchart.paths import work
from ravenchart.running.result import RunOutcome

LOCK = "RAVENCHART_LIVE_LOCK"
"""The environment variable with the file that workers lock; else it is one of the checkout."""

TIMES = 3
"""So often a run is played at the most."""


@contextmanager
def alone() -> Iterator[None]:
    """Wait until no other worker runs one. A test marked ``live`` has waited already."""
    place = Path(os.environ.get(LOCK) or work() / "build" / "live")
    with place.open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def played(play: Callable[[], RunOutcome], enough: Callable[[], bool] = lambda: True) -> RunOutcome:
    """The outcome of a run; where the host withheld the core and something failed, of another.

    A run that passed is repeated where it was not ``enough``.
    """
    for _ in range(TIMES):
        outcome = play()
        if enough() if outcome.passed else not outcome.not_judged:
            break
    return outcome
