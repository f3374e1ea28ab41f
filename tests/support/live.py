"""One controller at a time runs in real time: two would share a core at equal priorities."""

from __future__ import annotations

import fcntl
from collections.abc import Iterator
from contextlib import contextmanager

from ravenchart.paths import work


@contextmanager
def alone() -> Iterator[None]:
    """Wait until no other worker runs one. A test marked ``live`` has waited already."""
    with (work() / "build" / "live").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield
