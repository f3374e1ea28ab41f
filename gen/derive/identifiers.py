# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""CAN identifiers for messages that have none given, in an order of urgency.

A shorter deadline goes first, as for tasks (Leung and Whitehead 1982); of two messages with one
deadline the earlier in the model. On a bus this is a good guess, and the analysis shows whether
it suffices. `with_order` numbers an order that the analysis found.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import count

from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System

OPEN = -1
"""Stands where the model gives no identifier."""

LEADING_SHIFT = 18
"""Bits of an extended identifier behind the 11 that are compared with a standard one."""


def leading(message: Message) -> int:
    """The first 11 bits of a message's identifier, which decide between frames first."""
    return message.identifier >> LEADING_SHIFT if message.extended else message.identifier


def _numbered(message: Message, place: int) -> Message:
    """The message with these leading bits, and 0 behind them, where none are given."""
    identifier = place << LEADING_SHIFT if message.extended else place
    return replace(message, identifier=identifier, given=False)


def identified(messages: Sequence[Message]) -> tuple[Message, ...]:
    """The messages with identifiers: those given are kept, the others by deadline.

    Numbers count from 1 on each bus and step over given ones. Of an extended identifier the
    11 leading bits count and the others are 0, so that the order holds for both formats.
    """
    taken = {(m.bus, leading(m)) for m in messages if m.identifier != OPEN}
    chosen: dict[str, Message] = {}
    for message in sorted((m for m in messages if m.identifier == OPEN), key=lambda m: m.limit):
        place = next(n for n in range(1, len(messages) + 2) if (message.bus, n) not in taken)
        taken.add((message.bus, place))
        chosen[message.name] = _numbered(message, place)
    return tuple(chosen.get(m.name, m) for m in messages)


def with_order(system: System, order: Sequence[str]) -> System:
    """The system with identifiers in the order of these elements, all of one bus.

    Given ones are kept, and there must be room between them; each other message has the
    first place behind the message before it, with 0 behind the 11 leading bits.
    """
    frames = {message.element: message for message in system.frames}
    taken = {leading(frames[name]) for name in order if frames[name].given}
    last = 0
    for name in order:
        message = frames[name]
        if message.given:
            last = leading(message)
        else:
            last = next(place for place in count(last + 1) if place not in taken)
            frames[name] = _numbered(message, last)
    return replace(system, messages=tuple(frames[m.element] for m in system.messages))
