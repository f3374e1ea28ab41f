# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The time of a value that travels in several frames (ISO-TP), from the bounds of its frames.

The row of the sender makes a segment at the end of an execution, at most one in so many
executions. The reception of the receiver asks for flow control, the next execution of the port
region sends it, and the next execution of the row that begins after its reception goes on:

    round trip   d = max(T, ceil((D + T_p + F) / T_r) T_r)
    transfer     b d + (n - 1 - b) T + D, from the release that sends the first segment
    cycle        b d + (n - 1 - b) T + T, from one value to the next

Here n is the number of segments and b that of blocks. T is the distance of segments, T_r the
period of the row, and T_p that of the port region. D and F are the delivery of a segment and of
flow control, from their releases.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Message, Reception
from ravenchart.gen.model.system import System
from ravenchart.gen.model.transport import Transport

if TYPE_CHECKING:
    from .latencies import Delivery


@dataclass(frozen=True, slots=True)
class Transfer:
    """The transfer of one value; the times are None where a frame has no bound."""

    reception: Reception
    transport: Transport
    flow: Message
    segment: Ns | None
    """Delivery of a segment, and below of flow control."""
    answer: Ns | None

    @property
    def message(self) -> Message:
        """The message that is sent in segments."""
        return self.reception.message

    @property
    def round_trip(self) -> Ns | None:
        """From a segment that ends a block, or the first one, to the next one."""
        if self.segment is None or self.answer is None:
            return None
        row = self.transport.row
        heard = self.segment + self.flow.period + self.answer
        return Ns(max(self.message.period, -(-heard // row) * row))

    @property
    def last(self) -> Ns | None:
        """From the first segment to the last one."""
        trip, rounds = self.round_trip, self.transport.rounds
        if trip is None:
            return None
        return Ns(rounds * trip + (self.transport.segments - 1 - rounds) * self.message.period)

    @property
    def bound(self) -> Ns | None:
        """From the release that sends the first segment until the value is handed over."""
        if self.last is None or self.segment is None:
            return None
        return Ns(self.last + self.segment)

    @property
    def cycle(self) -> Ns | None:
        """From one value to the next, where one waits."""
        return None if self.last is None else Ns(self.last + self.message.period)

    @property
    def in_time(self) -> bool:
        """Whether no time-out passes while no frame is lost."""
        if self.round_trip is None or self.segment is None:
            return False
        return self.round_trip + self.segment <= self.transport.timeout


def transfers(system: System, delivered: Mapping[str, Delivery]) -> dict[str, Transfer]:
    """The transfers of a system, by the element of the reception of their segments."""
    flows = {message.controls: message for message in system.messages if message.controls}
    found: dict[str, Transfer] = {}
    for message in system.messages:
        flow = flows.get(message.name)
        if message.transport is None or flow is None:
            continue
        ends = (*system.receptions(message), *system.receptions(flow))
        if len(ends) == 2:  # and not the part of a node
            times = [_bound(delivered, one) for one in ends]
            found[ends[0].element] = Transfer(ends[0], message.transport, flow, *times)
    return found


def _bound(delivered: Mapping[str, Delivery], one: Reception) -> Ns | None:
    delivery = delivered.get(one.element)
    return None if delivery is None or delivery.bound is None else Ns(delivery.bound)
