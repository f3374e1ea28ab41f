# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Overheads of the run-time system of one core, apart from the tasks themselves."""

from __future__ import annotations

from dataclasses import dataclass

from .checks import natural


@dataclass(frozen=True, slots=True)
class Platform:
    """Overheads of one core, all in ticks; zero where there is none.

    Each job has two context switches (to it and back), whatever it interrupts,
    and two more each further time that it suspends itself. ``release``
    is the work of the timer or interrupt that makes one job ready, each time. It runs
    above all tasks, for releases of less urgent tasks too.
    A periodic tick takes ``tick_wcet`` every ``tick_period`` above all tasks. A task
    that the tick releases (`Task.timed`) may be late by one period of it.
    Burns, Tindell and Wellings, Effective analysis for engineering real-time
    fixed priority schedulers (IEEE TSE 21, 1995), whose tick scheduling this
    simplifies to the safe side.
    """

    context_switch: int = 0
    release: int = 0
    tick_period: int = 0
    tick_wcet: int = 0

    def __post_init__(self) -> None:
        """Refuse negative overheads, and a tick that takes time but has no period."""
        natural(
            "the platform",
            context_switch=self.context_switch,
            release=self.release,
            tick_period=self.tick_period,
            tick_wcet=self.tick_wcet,
        )
        if self.tick_wcet and not self.tick_period:
            raise ValueError("tick_period of the platform must be above 0 where a tick takes time")
