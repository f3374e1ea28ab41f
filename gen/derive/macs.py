# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The MACs of authenticated messages in the WCETs of rows."""

from __future__ import annotations

from dataclasses import replace

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import Processor, Slot, System, Work

from .senders import sending_rows


def with_macs(system: System) -> System:
    """The system with the time for each MAC in the row that has it computed.

    A row that sends has one computed for each message; the reception has one for each frame.
    """
    if not any(message.authentication for message in system.messages):
        return system
    sent: dict[str, int] = {}
    for message in system.messages:
        for row in sending_rows(system, message) if message.authentication else ():
            sent[row] = sent.get(row, 0) + _wcet(message)

    def longer(slot: Slot, processor: Processor) -> Slot:
        macs = sent.get(slot.element, 0)
        if slot.work is Work.BUS_RECEIVE:
            received = system.received(slot.owner, processor.node)
            macs = max((_wcet(one.message) for one in received), default=0)
        timing = replace(slot.timing, wcet=Ns(slot.timing.wcet + macs))
        return replace(slot, timing=timing) if macs else slot

    processors = tuple(
        replace(one, slots=tuple(longer(slot, one) for slot in one.slots))
        for one in system.processors
    )
    return replace(system, processors=processors)


def _wcet(message: Message) -> int:
    return 0 if message.authentication is None else message.authentication.mac_wcet
