# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The layout of a value in a CAN frame: where the bits of each scalar of it stand.

Bit 0 is the least significant bit of byte 0, bit 8 that of byte 1, and so on. An Intel
signal begins at its least significant bit and goes upwards from there. A Motorola signal
begins at its most significant bit, goes down to bit 0 of that byte and on at bit 7 of the
next byte. These are the conventions of CAN databases (DBC).
"""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable, Iterator, Mapping, Set
from dataclasses import dataclass, replace
from enum import Enum

from ravenchart.gen.language.terms import IntegerType, RecordType, ScalarType, Type

FRAME_BITS = 64
"""Payload of a classic CAN frame, in bits."""

FD_SIZES = (*range(1, 9), 12, 16, 20, 24, 32, 48, 64)
"""Bytes that a CAN FD frame can carry, 0 apart."""

WORD_BITS = 64
"""Bits of a word of the codec."""

RAW_LIMIT = 2**62
"""Raw values are below this: they are counted as the model's numbers are."""


class ByteOrder(Enum):
    """Which byte of a signal goes over the bus first."""

    INTEL = "intel"
    """The least significant one."""
    MOTOROLA = "motorola"
    """The most significant one."""


@dataclass(frozen=True, slots=True)
class Piece:
    """Bits of a raw value, from bit ``low`` of it on, that stand together from ``start`` on.

    ``start`` counts from bit 0 of word number ``word`` of the frame.
    """

    word: int
    start: int
    low: int
    width: int


@dataclass(frozen=True, slots=True)
class Signal:
    """One scalar in a frame: raw value = value - ``offset``, of an enumeration its code.

    The raw value has ``width`` bits, in two's complement where it is ``signed``.
    """

    field: str | None
    type: ScalarType
    start: int
    width: int
    offset: int
    signed: bool = False
    order: ByteOrder = ByteOrder.INTEL
    codes: tuple[int, ...] = ()
    """Raw values of the literals of an enumeration; their positions where none are given."""
    other: str | None = None
    """The literal for all raw values that are no code; its own code is what is sent for it."""
    selects: bool = False
    """The multiplexor: its value tells which of the multiplexed signals are there."""
    pages: tuple[int, ...] = ()
    """Raw values of the multiplexor with which it is there; none: it always is."""
    database_name: str | None = dataclasses.field(default=None, compare=False)
    """Its name in databases; None: that in the model. No part of the layout."""
    value_names: tuple[tuple[str, str], ...] = dataclasses.field(default=(), compare=False)
    """Literals with other names in databases, and these names. No part of the layout."""

    @property
    def name(self) -> str:
        """The field's name, or `value` where the value has no fields."""
        return self.field or "value"

    @property
    def in_database(self) -> str:
        """Its name in the database of the bus."""
        return self.database_name or self.name

    @property
    def coding(self) -> tuple[int, bool, int, tuple[int, ...], str | None]:
        """The numbers that decide how raw values become values."""
        width = self.width if self.signed else 0
        return self.offset, self.signed, width, self.codes, self.other

    @property
    def raw_range(self) -> tuple[int, int]:
        """The least and the greatest raw value; with ``other`` those that are sent."""
        if isinstance(self.type, IntegerType):
            return self.type.first - self.offset, self.type.last - self.offset
        codes = self.codes or range(len(self.type.literals))
        return min(codes), max(codes)

    def raw(self, value: int | str) -> int:
        """The raw value of a value of the type."""
        if isinstance(self.type, IntegerType):
            return int(value) - self.offset
        position = self.type.literals.index(str(value))
        return self.codes[position] if self.codes else position

    def value(self, raw: int) -> int | str:
        """The value of a raw value; ValueError or IndexError where none has it."""
        if isinstance(self.type, IntegerType):
            return raw + self.offset
        if self.other is not None and raw not in self.codes:
            return self.other
        return self.type.literals[self.codes.index(raw) if self.codes else raw]

    @property
    def named_codes(self) -> dict[str, int]:
        """Literals of an enumeration with the only raw value of each, in their order."""
        if isinstance(self.type, IntegerType):
            return {}
        codes = zip(self.type.literals, self.codes or itertools.count(), strict=False)
        return {name: code for name, code in codes if name != self.other}

    @property
    def codes_in_database(self) -> dict[str, int]:
        """The same by what databases call the literals."""
        names = dict(self.value_names)
        return {names.get(name, name): code for name, code in self.named_codes.items()}

    def bits(self) -> tuple[int, ...]:
        """The frame's bit for each bit of the raw value, its least significant first."""
        return positions(self.start, self.width, self.order)

    def pieces(self) -> tuple[Piece, ...]:
        """Its bits in as few pieces as there are, the least significant first."""
        found: list[Piece] = []
        for low, bit in enumerate(self.bits()):
            word, start = divmod(bit, WORD_BITS)
            last = found[-1] if found else None
            if last is not None and (last.word, last.start + last.width) == (word, start):
                found[-1] = Piece(word, last.start, last.low, last.width + 1)
            else:
                found.append(Piece(word, start, low, 1))
        return tuple(found)

    def meets(self, other: Signal) -> bool:
        """Is there a frame in which both are?"""
        return not self.pages or not other.pages or bool(set(self.pages) & set(other.pages))


def positions(start: int, width: int, order: ByteOrder) -> tuple[int, ...]:
    """The frame's bits of a field, as DBC numbers them, the least significant first."""
    if order is ByteOrder.INTEL:
        return tuple(range(start, start + width))
    found: list[int] = []
    at = start
    for _ in range(width):
        found.append(at)
        at += 15 if at % 8 == 0 else -1
    return tuple(reversed(found))


def range_of(width: int, *, signed: bool) -> tuple[int, int]:
    """The least and the greatest raw value of so many bits."""
    return (-(1 << width - 1), (1 << width - 1) - 1) if signed else (0, (1 << width) - 1)


def width_for(low: int, high: int, *, signed: bool) -> int:
    """Bits that hold every raw value from ``low`` to ``high``, at least 1."""
    if signed:
        return max(low if low >= 0 else -low - 1, high if high >= 0 else -high - 1).bit_length() + 1
    return max(1, high.bit_length())


def scalars_of(type_: Type) -> tuple[tuple[str | None, ScalarType], ...]:
    """The scalars of a value, each with the name of its field."""
    if isinstance(type_, RecordType):
        return tuple((field.name, field.type) for field in type_.fields)
    return ((None, type_),)


def automatic(field: str | None, type_: ScalarType) -> Signal:
    """A scalar as it is coded where nothing is given: the least value is 0. It starts at 0."""
    offset = type_.first if isinstance(type_, IntegerType) else 0
    plain = Signal(field, type_, 0, 1, offset)
    return _at(plain, 0, width_for(*plain.raw_range, signed=False))


def _at(signal: Signal, start: int, width: int) -> Signal:
    return replace(signal, start=start, width=width)


def signals_of(type_: Type) -> tuple[Signal, ...]:
    """The signals of a value where nothing is given: one behind the other, without gaps."""
    return packed([automatic(*scalar) for scalar in scalars_of(type_)], {})


def packed(
    signals: Iterable[Signal], given: Mapping[str, int], held: Set[int] = frozenset()
) -> tuple[Signal, ...]:
    """The signals at the ``given`` starts, by name, and the others where there is room.

    Each of the others, which are Intel signals, comes as low as those before it, the
    given ones, and its own width allow; signals never in one frame may share bits. No signal
    comes to the bits that are ``held``.
    """
    order = list(signals)
    placed = {s.name: _at(s, given[s.name], s.width) for s in order if s.name in given}
    for signal in order:
        if signal.name in placed:
            continue
        taken = {b for other in placed.values() if signal.meets(other) for b in other.bits()}
        taken |= held
        start = 0
        while clash := taken & set(range(start, start + signal.width)):
            start = max(clash) + 1
        placed[signal.name] = _at(signal, start, signal.width)
    return tuple(placed[s.name] for s in order)


def overlaps(signals: tuple[Signal, ...]) -> Iterator[tuple[Signal, Signal]]:
    """Pairs of signals that share bits in some frame."""
    for index, signal in enumerate(signals):
        for other in signals[:index]:
            if signal.meets(other) and set(signal.bits()) & set(other.bits()):
                yield other, signal


def bits_of(signals: tuple[Signal, ...]) -> int:
    """Bits up to the last one that a signal takes."""
    return max(max(signal.bits()) for signal in signals) + 1


def length_of(signals: tuple[Signal, ...], *, fd: bool = False, trailer: int = 0) -> int:
    """Bytes of the frame that carries the signals, at least 1; of CAN FD the next size it has.

    The ``trailer`` is so many bytes behind the signals.
    """
    length = max(1, -(-bits_of(signals) // 8)) + trailer
    return next((size for size in FD_SIZES if size >= length), length) if fd else length


def room_of(*, fd: bool) -> int:
    """Payload of a frame at most, in bits."""
    return 8 * FD_SIZES[-1] if fd else FRAME_BITS


def fits_classic(signals: tuple[Signal, ...]) -> bool:
    """Is a classic frame enough?"""
    return bits_of(signals) <= FRAME_BITS
