"""How a value is laid out in a CAN frame: fields in order, from bit 0, no gaps.

The raw value of an integer is value - first, that of an enumeration its
position; widths are in bits, the length of a frame in bytes.
"""

from __future__ import annotations

from .model import Signal
from .terms import IntegerType, RecordType, ScalarType, Type

FRAME_BITS = 64
"""Payload of a classic CAN frame, in bits."""

FD_SIZES = (*range(1, 9), 12, 16, 20, 24, 32, 48, 64)
"""Bytes that a CAN FD frame can carry, 0 apart."""


def width_of(type_: ScalarType) -> int:
    """Bits that hold every value of the type, at least 1."""
    if isinstance(type_, IntegerType):
        return max(1, (type_.last - type_.first).bit_length())
    return max(1, (len(type_.literals) - 1).bit_length())


def signals_of(type_: Type) -> tuple[Signal, ...]:
    """The signals of a value of the type, also where they need more than a frame."""
    parts: list[tuple[str | None, ScalarType]]
    if isinstance(type_, RecordType):
        parts = [(field.name, field.type) for field in type_.fields]
    else:
        parts = [(None, type_)]
    signals: list[Signal] = []
    start = 0
    for name, scalar in parts:
        offset = scalar.first if isinstance(scalar, IntegerType) else 0
        signals.append(Signal(name, scalar, start, width_of(scalar), offset))
        start += signals[-1].width
    return tuple(signals)


def bits_of(signals: tuple[Signal, ...]) -> int:
    """Bits that the signals take together."""
    return signals[-1].start + signals[-1].width


def length_of(signals: tuple[Signal, ...], *, fd: bool = False) -> int:
    """Bytes of the frame that carries the signals, at least 1; of CAN FD the next size it has."""
    length = max(1, -(-bits_of(signals) // 8))
    return next((size for size in FD_SIZES if size >= length), length) if fd else length


def room_of(*, fd: bool) -> int:
    """Payload of a frame at most, in bits."""
    return 8 * FD_SIZES[-1] if fd else FRAME_BITS
