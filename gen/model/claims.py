# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The claimed bounds of an analysis, as the timing certificate takes them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ravenchart.gen.language.terms import Ns

NOTHING = Ns(0)


@dataclass(frozen=True, slots=True)
class ResponseClaim:
    """A response-time bound, from the event that leads to the job, and the windows that show it.

    ``windows`` holds one time for each job or instance of the busy period, counted from the
    start of that period: the job is done within it, or a frame can begin. ``busy`` is how long
    a bus is busy at a message's level. A processor whose response is longer than its deadline
    keeps that by its offset. ``since`` holds the time from each of its `instants.instants`
    until its job is done.
    """

    response: Ns = NOTHING
    windows: tuple[Ns, ...] = (NOTHING,)
    busy: Ns = NOTHING
    since: tuple[Ns, ...] = ()


@dataclass(frozen=True, slots=True)
class ChainClaim:
    """The latencies of one of the model's chains; ``waits`` in its queues, one after the other."""

    reaction: Ns = NOTHING
    age: Ns = NOTHING
    waits: tuple[Ns, ...] = ()


@dataclass(frozen=True, slots=True)
class Claims:
    """All claims, by element; an element that is not there claims no time at all.

    Claims are numbers only: the certificate takes their meaning from the model.
    """

    items: Mapping[str, ResponseClaim] = field(default_factory=dict)
    """Tasks and messages."""
    rows: Mapping[str, Ns] = field(default_factory=dict)
    """Responses of rows inside their jobs: those that chains need."""
    waits: Mapping[str, Ns] = field(default_factory=dict)
    """Messages of a queue that wait no longer than their bus is ever busy, where their
    own responses would let them wait longer."""
    busiest: Mapping[str, Ns] = field(default_factory=dict)
    """How long a bus is busy at most, by its name: where messages wait by that."""
    turns: Mapping[str, ResponseClaim] = field(default_factory=dict)
    """Received messages: when the reception turns to them."""
    chains: Mapping[str, ChainClaim] = field(default_factory=dict)
    """The model's chains by name."""
    residual: Mapping[str, int] = field(default_factory=dict)
    """Protected messages: the probability in 10**-18 that corruption of a frame is not found."""
    stale: Mapping[str, Ns] = field(default_factory=dict)
    """Ports of checked messages: when it is known that no usable frame comes."""

    transfers: Mapping[str, tuple[Ns, Ns]] = field(default_factory=dict)
    """Messages in several frames: the round trip of flow control, and the whole transfer."""

    def of(self, element: str) -> ResponseClaim:
        """The claim about a task or message."""
        return self.items.get(element, ResponseClaim())
