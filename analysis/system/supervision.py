# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The time until the silence of each processor is found, or the lack of supervision."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.nodes import SUPERVISOR

from .timing import Analysis


@dataclass(frozen=True, slots=True)
class Silence:
    """One processor under supervision; times count from when a release was due.

    It is silent after ``limit`` without completion, and found at ``found`` at the latest: None
    where the supervisor has no bound.
    """

    processor: str
    limit: Ns
    found: Ns | None
    raises: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Watch:
    """A node with its processors; ``silences`` is None where they have no supervision."""

    node: str
    processors: tuple[str, ...]
    silences: tuple[Silence, ...] | None


def watches(analysis: Analysis) -> tuple[Watch, ...]:
    """Each node that has processors."""
    system = analysis.system
    found: list[Watch] = []
    for node in system.nodes:
        here = [p for p in system.processors if p.node == node.name]
        names = tuple(p.name for p in here)
        own = node.supervision
        if not here:
            continue
        if own is None:
            found.append(Watch(node.name, names, None))
            continue
        response = analysis.found.from_event(f"{node.name}.{SUPERVISOR}")
        silences = []
        for one in here:
            limit = Ns(one.deadline + own.margin)
            latest = None if response is None else Ns(limit + own.period + response)
            raised = tuple(f"{instance}.{event}" for instance, event in one.on_silence)
            silences.append(Silence(one.name, limit, latest, raised))
        found.append(Watch(node.name, names, tuple(silences)))
    return tuple(found)
