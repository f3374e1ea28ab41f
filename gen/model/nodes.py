# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The nodes of a system: the overheads of their platforms, and their supervision."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import NO_TIME, Ns, named
from ravenchart.gen.origins import Origin

from .statechart import Timing

PROBE = "probe"
"""A node's host probe, as a task."""


SUPERVISOR = "supervisor"
"""The liveness supervision of a node, as a task."""


STREAM = "stream"
"""The stream of a node, as a task of the analysis."""

TRACE_LIMIT = 65_536
"""Records that a trace may hold."""

DRAIN_PERIOD = Ns(5_000_000)
"""How often the main program empties the trace and looks for a request to stop."""

SNAPSHOT_PERIOD = Ns(100_000_000)
"""Least time between two snapshots of a node."""


@dataclass(frozen=True, slots=True)
class MonitorStream:
    """The trace and the snapshots of a node, as work of the main program at the lowest priority.

    ``wcet`` is the longest execution of one snapshot and of the drains of the trace within one
    `SNAPSHOT_PERIOD`.
    """

    origin: Origin
    wcet: Ns


@dataclass(frozen=True, slots=True)
class Tick:
    """A timer that interrupts a node every ``period`` for up to ``wcet``."""

    period: Ns
    wcet: Ns


@dataclass(frozen=True, slots=True)
class Supervision:
    """The liveness supervision of a node: a task that looks at all processors every ``period``.

    A processor is silent when a release has not completed by its deadline and ``margin``.
    """

    period: Ns
    wcet: Ns
    margin: Ns


@dataclass(frozen=True, slots=True)
class Interrupt:
    """An interrupt of a node; the processor that it releases says how far two of them are apart.

    ``signal`` stands for it where the program runs under Linux, ``number`` is that of a board.
    ``wcet`` counts above all tasks.
    """

    name: str
    origin: Origin
    signal: str | None
    number: int | None
    wcet: Ns


@dataclass(frozen=True, slots=True)
class InterruptLine:
    """The interrupt of a node that releases a processor."""

    node: str
    name: str

    def __str__(self) -> str:
        """``node.interrupt``."""
        return f"{self.node}.{self.name}"


@dataclass(frozen=True, slots=True)
class Node:
    """One processor core or several alike, with platform figures, all worst cases in ns."""

    name: str
    origin: Origin
    context_switch: Ns
    critical_section: Ns
    """Longest time inside any protected operation of the runtime on this node."""
    trace_depth: int
    """Records that the trace holds between two looks at it; 0: no trace."""
    probe: Timing | None = None
    """The host probe: a task above all others that measures how late it wakes."""
    release: Ns = NO_TIME
    """Work above all tasks that makes one job ready."""
    tick: Tick | None = None
    """The tick that makes timed releases late by up to its period; None: an exact timer."""
    cores: int = 1
    supervision: Supervision | None = None
    stream: MonitorStream | None = None
    interrupts: tuple[Interrupt, ...] = ()
    database_name: str | None = None
    """Its name in databases; None: that in the model."""

    def interrupt(self, name: str) -> Interrupt:
        """The interrupt called ``name``; KeyError where there is none."""
        return named(self.interrupts, name)

    @property
    def in_database(self) -> str:
        """Its name in the databases of its buses."""
        return self.database_name or self.name

    @property
    def core_names(self) -> tuple[str, ...]:
        """The cores by name: that of the node where there is one, ``node.1`` and on otherwise."""
        if self.cores == 1:
            return (self.name,)
        return tuple(f"{self.name}.{number}" for number in range(1, self.cores + 1))

    def core_name(self, number: int) -> str:
        """The name of the core with that number, from 1."""
        return self.core_names[number - 1]
