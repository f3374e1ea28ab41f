# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The guard: a process that ends the children of another one that has ended.

Run as ``python -I -S guard.py``. Standard input is a pipe; each process that must not
outlive its parent writes its number there before it becomes another program. When the
last writer is gone, so is the parent: the guard kills all that is left, with everything
in their sessions and below them, and ends. It needs nothing but the standard library and /proc.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from contextlib import suppress

ROUNDS = 50
"""A process that forks while it is killed is found in the next round."""

PAUSE = 0.02
"""Between two rounds, in s."""


def stat_of(number: int) -> list[str]:
    """Fields of /proc/N/stat from the third on: state, parent, group, session ... Empty: gone."""
    with suppress(OSError), open(f"/proc/{number}/stat", encoding="utf-8", errors="replace") as s:
        return s.read().rpartition(")")[2].split()
    return []


def started(number: int) -> str:
    """When a process was started, in ticks since boot; "" for none."""
    return "".join(stat_of(number)[19:20])


def left(enrolled: dict[int, str]) -> set[int]:
    """The processes still there: those enrolled, all of their sessions, and their children.

    A number that another process has by now stands for nothing any more.
    """
    found = {number for number, start in enrolled.items() if started(number) in ("", start)}
    table = {int(name): stat_of(int(name)) for name in os.listdir("/proc") if name.isdigit()}
    alive = {number: stat for number, stat in table.items() if stat and stat[0] not in "ZX"}
    while True:
        more = {n for n, stat in alive.items() if {int(stat[1]), int(stat[3])} & found}
        if more <= found:
            return found & set(alive)
        found |= more


def main() -> None:
    """Listen until the input ends, then end the processes that are left."""
    for request in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(request, signal.SIG_IGN)
    enrolled: dict[int, str] = {}
    for line in sys.stdin:
        number = int(line)
        enrolled[number] = started(number)
    for _ in range(ROUNDS):
        numbers = left(enrolled)
        if not numbers:
            return
        enrolled.update((number, started(number)) for number in numbers)
        for number in numbers:
            with suppress(OSError):
                os.kill(number, signal.SIGKILL)
        time.sleep(PAUSE)


if __name__ == "__main__":
    main()
