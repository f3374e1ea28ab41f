"""Load of the CAN buses, with the longest form that each frame can take."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from gen.model import Bus, Message, System
from gen.terms import Ns

STANDARD_BITS = 55
"""Frame with an 11-bit identifier and no data: worst stuffing, 3 bits to the next frame."""

EXTENDED_BITS = 80
"""The same with a 29-bit identifier."""

BITS_PER_BYTE = 10
"""Each data byte with its worst stuffing."""


@dataclass(frozen=True, slots=True)
class MessageLoad:
    """One message at its shortest period: bits of the longest frame, its time, its share."""

    message: Message
    bits: int
    time: Ns
    share: Fraction


@dataclass(frozen=True, slots=True)
class BusLoad:
    """What the messages of one bus need of it at most, in model order."""

    bus: Bus
    messages: tuple[MessageLoad, ...]

    @property
    def share(self) -> Fraction:
        """Share of the bus's time that is taken."""
        return sum((load.share for load in self.messages), Fraction(0))


def frame_bits(length: int, *, extended: bool) -> int:
    """Longest classic CAN frame with ``length`` data bytes, in bits."""
    return (EXTENDED_BITS if extended else STANDARD_BITS) + BITS_PER_BYTE * length


def bus_loads(system: System) -> tuple[BusLoad, ...]:
    """The load of every bus of ``system``."""
    return tuple(
        BusLoad(bus, tuple(_load(m, bus) for m in system.messages if m.bus == bus.name))
        for bus in system.buses
    )


def _load(message: Message, bus: Bus) -> MessageLoad:
    """What one message takes of its bus."""
    bits = frame_bits(message.length, extended=message.extended)
    time = Ns(-(-bits * 1_000_000_000 // bus.bit_rate))
    return MessageLoad(message, bits, time, Fraction(time, message.period))
