# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Orders of CAN identifiers that meet all deadlines of a bus, for `identifiers: audsley`.

This is Audsley's assignment over the analysis of the bus alone (`core.assignment`). A message
counts as it is declared, its sender without delay: the response of a sender may depend on
received messages, so on the identifiers that are searched for. In a queue of this node any
frame may go before any other. So its frames have the same response in every order.

Identifiers that the model gives bind places. The messages that have them keep their order, and
the room for others between two of them is limited. Where this room suffices for all that are left
or for none, an order is found whenever one exists; otherwise perhaps not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ravenchart import rounded
from ravenchart.analysis.core.assignment import Order, audsley_frames, responses_in_place
from ravenchart.analysis.core.bus import Frame
from ravenchart.analysis.core.can_response import FrameResponse
from ravenchart.analysis.core.frames import leading_of_rank
from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import System

from .network import network_of

NO_ORDER = "RV-0908"
"""No order of the identifiers of a bus meets all deadlines."""

LARGEST = 3
"""Messages that do not fit and that a diagnostic names besides the first."""

PLACES = 1 << 11
"""Values of the 11 bits that decide between frames first; others count from 1."""


@dataclass(frozen=True, slots=True)
class IdentifierPlaces:
    """The places of the frames of a bus; ``given`` are those whose rank is bound."""

    model_order: tuple[str, ...]
    given: frozenset[str]

    def candidates(self, left: Sequence[Frame], placed: Sequence[Frame]) -> list[Frame]:
        """The frames for the lowest place that is left, in the order to try.

        The longest deadline comes first, of equal ones the later in the model. But a given
        frame above which not all others have room comes last.
        """
        bound = sorted((f for f in left if f.name in self.given), key=lambda frame: frame.rank)
        open_ = [f for f in left if f.name not in self.given]
        below = next((n for n, f in enumerate(placed) if f.name in self.given), None)
        end = PLACES if below is None else leading_of_rank(placed[below].rank)
        begin = leading_of_rank(bound[-1].rank) if bound else 0
        room = end - begin - 1 - (len(placed) if below is None else below)
        found = sorted(open_, key=self._urgency, reverse=True) if room > 0 else []
        if not bound:
            return found
        above = set(range(1, begin)) - {leading_of_rank(frame.rank) for frame in bound}
        gap = begin - 1 - (leading_of_rank(bound[-2].rank) if len(bound) > 1 else 0)
        if gap >= len(open_):
            return sorted([*found, bound[-1]], key=self._urgency, reverse=True)
        return [*found, bound[-1]] if len(above) >= len(open_) else found

    def _urgency(self, frame: Frame) -> tuple[int, int]:
        return frame.deadline, self.model_order.index(frame.name)


def order_of(bus: Bus, system: System) -> tuple[str, ...] | Diagnostic:
    """The elements of the bus, most urgent first, when all deadlines are met; else the error."""
    network = network_of(system)
    frames, wire = network.frames[bus.name], network.buses[bus.name]
    given = frozenset(m.element for m in system.frames if m.given)
    places = IdentifierPlaces(tuple(frame.name for frame in frames), given)
    order = audsley_frames(frames, wire, places.candidates)
    if order.complete:
        return order.names
    return _refusal(bus, system, frames, order, places, responses_in_place(frames, wire))


def _refusal(
    bus: Bus,
    system: System,
    frames: Sequence[Frame],
    order: Order,
    places: IdentifierPlaces,
    response: Callable[[Frame, Sequence[Frame], Sequence[Frame]], FrameResponse],
) -> Diagnostic:
    """The error for the lowest place left: the messages that cannot have it, and why."""
    by_name = {frame.name: frame for frame in frames}
    messages = {message.element: message for message in system.frames}
    left = [by_name[name] for name in order.unplaced]
    placed = [by_name[name] for name in order.names]
    tried = [
        response(frame, [other for other in left if other is not frame], placed)
        for frame in places.candidates(left, placed)
    ]
    first, rest = tried[0], tried[1:]
    message = messages[first.frame.name]
    if first.frame.queue:
        text = f"no identifier helps {message.name}: its node sends in order, behind all others"
        notes = [(message.origin, text)]
    else:
        text = f"{_some(len(left) - 1)} would go before {message.name}, {len(placed)} after it"
        notes = [(message.origin, text)]
    if first.blocker:
        blocked = rounded.up(first.blocked)
        text = f"{messages[first.blocker].name} may block {message.name} for {blocked}"
        notes.append((messages[first.blocker].origin, text))
    notes += [
        (messages[one.frame.name].origin, f"{messages[one.frame.name].name} {_needs(one)}")
        for one in rest[:LARGEST]
    ]
    if len(rest) > LARGEST:
        more = _some(len(rest) - LARGEST)
        notes.append((bus.origin, f"{more} more cannot have that place"))
    kept = next((f for f in left if f.name in places.given), None)
    hint = "lengthen a `deadline:` or period of these, or raise the bit rate"
    if kept is not None:
        hint += f"; or leave out the `id` of {messages[kept.name].name}"
    return error(
        NO_ORDER,
        message.origin,
        f"no order of identifiers found that meets all deadlines of {bus.name}: {message.name} "
        f"cannot have the lowest place that is left: there it {_needs(first)}",
        notes=notes,
        hint=hint,
    )


def _some(number: int) -> str:
    """So many messages."""
    return f"{number} message{'' if number == 1 else 's'}"


def _needs(response: FrameResponse) -> str:
    """The words for a missed deadline of a message at a place."""
    if response.bound is None:
        load = rounded.percent(response.level.load)
        return f"has no bound: it and the messages before it need {load} of the bus"
    bound, deadline = rounded.against(response.bound, response.frame.deadline)
    return f"has R = {bound} > D = {deadline}"
