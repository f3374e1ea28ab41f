# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Arrivals and late releases of jobs: the choices that the analysis leaves open."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from ravenchart.analysis.core.blocking import Section

Choice = Callable[[int], int]
"""A number of ticks for job k, from 0 on."""


def none(_: int) -> int:
    """No ticks, whichever job."""
    return 0


@dataclass(frozen=True, slots=True)
class InsideSection:
    """A job is inside the object of ``section`` from its tick ``start`` on."""

    start: int
    section: Section


@dataclass(frozen=True, slots=True)
class Phase:
    """One way in which a task or message can behave.

    All times are in ticks.

        ``first``   arrival of the first job: the offset of a task that has one; unused for
                    an item that another one releases
        ``late``    from arrival to release of job k, at most its jitter
        ``more``    how much more than a period passes between the arrivals of jobs k and k + 1
        ``frame``   the job of the table's cycle that the first job executes
        ``inside``  the sections of a job, in order, none overlapping another
    """

    first: int = 0
    late: Choice = none
    more: Choice = none
    frame: int = 0
    inside: tuple[InsideSection, ...] = ()


@dataclass(frozen=True, slots=True)
class PhaseScenario:
    """The phases of a network's items by name (all others arrive at 0, or at their offsets) and
    faults of buses.

    ``faults`` has, by bus, the instants at which the frame being sent is destroyed, in order.
    """

    phases: Mapping[str, Phase] = field(default_factory=dict)
    faults: Mapping[str, tuple[int, ...]] = field(default_factory=dict)
