"""CAN identifiers for messages that have none given: by deadline, shortest first.

As for tasks (Leung and Whitehead 1982), the more urgent goes before the less urgent; of
two with one deadline the earlier in the model. On a bus this is a good guess, and the
analysis tells whether it suffices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from .model import Message

OPEN = -1
"""Stands where the model gives no identifier."""

LEADING_SHIFT = 18
"""Bits of an extended identifier behind the 11 that are compared with a standard one."""


def leading(identifier: int, *, extended: bool) -> int:
    """The first 11 bits of an identifier, which decide between frames first."""
    return identifier >> LEADING_SHIFT if extended else identifier


def identified(messages: Sequence[Message]) -> tuple[Message, ...]:
    """The messages with identifiers: those given are kept, the others by deadline.

    They count from 1 on each bus and step over given ones; of an extended identifier
    the 11 leading bits count, and the others are 0, so that the order holds for both formats.
    """
    taken = {
        (m.bus, leading(m.identifier, extended=m.extended))
        for m in messages
        if m.identifier != OPEN
    }
    chosen: dict[str, int] = {}
    for message in sorted((m for m in messages if m.identifier == OPEN), key=lambda m: m.limit):
        place = next(n for n in range(1, len(messages) + 2) if (message.bus, n) not in taken)
        taken.add((message.bus, place))
        chosen[message.name] = place << LEADING_SHIFT if message.extended else place
    return tuple(replace(m, identifier=chosen.get(m.name, m.identifier)) for m in messages)
