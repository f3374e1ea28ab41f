# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Lengths and arbitration of CAN and CAN FD frames.

Classic frames follow Davis, Burns, Bril, Lukkien, Real-Time Systems 35, 2007, equation 1.
It counts one stuff bit for four bits after the first, from the start of frame
to the end of the CRC, and three bits to the next frame. A receiver has the frame
up to three bits earlier, never later.
"""

from __future__ import annotations

from dataclasses import dataclass

from .checks import natural, positive

FD_SIZES = (0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64)
"""Numbers of data bytes that a CAN FD frame can carry."""

STUFFED_STANDARD, STUFFED_EXTENDED = 34, 54
"""Bits of a classic frame that are exposed to stuffing, apart from the data (g)."""

UNSTUFFED = 13
"""CRC delimiter, acknowledgement and its delimiter, end of frame, three bits between frames."""

STANDARD_BITS, EXTENDED_BITS = 11, 29


@dataclass(frozen=True, slots=True)
class Bits:
    """The length of a frame: bits at the nominal and at the data bit rate."""

    nominal: int
    data: int = 0

    def time(self, bit_rate: int, data_rate: int = 0, second: int = 10**9) -> int:
        """Its duration in ticks, rounded up; ``second`` is the number of ticks in one.

        Rates are in bits per second, above 0; ``data_rate`` 0 means the nominal one.
        """
        fast = data_rate or bit_rate
        positive("the bus", bit_rate=bit_rate, data_rate=fast, second=second)
        return -(-(self.nominal * fast + self.data * bit_rate) * second // (bit_rate * fast))


def classic_bits(length: int, *, extended: bool = False, stuffed: bool = True) -> Bits:
    """The longest classic frame with ``length`` data bytes, 0 to 8; the shortest unless stuffed."""
    natural("a classic frame", length=length)
    if length > 8:
        raise ValueError(f"length of a classic frame must be at most 8, not {length}")
    exposed = (STUFFED_EXTENDED if extended else STUFFED_STANDARD) + 8 * length
    return Bits(exposed + UNSTUFFED + ((exposed - 1) // 4 if stuffed else 0))


def fd_bits(
    length: int, *, extended: bool = False, switched: bool = True, stuffed: bool = True
) -> Bits:
    """The longest CAN FD frame with ``length`` data bytes; the shortest unless stuffed.

    ``length`` is one of `FD_SIZES`. With ``switched`` the data rate holds from the
    bit after the switch to the CRC. Derived from the layout in ISO 11898-1 (2015);
    the tests compare it with the bits that `hw_can/simulator` writes. The rate changes in
    the middle of the switch bit and of the CRC delimiter. Both count as nominal bits, and
    so do as many stuff bits as can fall before the switch.
    Tolerated longer delimiters and acknowledgements are not counted.
    """
    if length not in FD_SIZES:
        raise ValueError(f"length of a CAN FD frame must be one of {FD_SIZES}, not {length!r}")
    head = 36 if extended else 17
    control = 1 + 4  # error state indicator, length code
    stuff = (head + control + 8 * length - 1) // 4 if stuffed else 0
    early = (head - 1) // 4 if stuffed else 0
    check, fixed = (17, 6) if length <= 16 else (21, 7)
    tail = 4 + check + fixed  # count of stuff bits, CRC, fixed stuff bits
    body = control + 8 * length + stuff - early + tail
    nominal = head + early + UNSTUFFED
    return Bits(nominal, body) if switched else Bits(nominal + body)


_LEADING_SHIFT = 20
"""Bits of a rank behind the 11 that come first."""


def rank(identifier: int, *, extended: bool = False) -> int:
    """The place of a data frame in arbitration: of two frames the lower rank wins.

    It is the frame's bits as they are compared on the wire. The 11 leading bits come
    first, then the bits by which a standard frame beats every extended one with the
    same leading bits, then the other 18. ValueError for an identifier out of range.
    """
    width = EXTENDED_BITS if extended else STANDARD_BITS
    natural("a frame", identifier=identifier)
    if identifier >= 1 << width:
        raise ValueError(f"identifier of a frame must fit {width} bits, not {identifier}")
    if not extended:
        return identifier << _LEADING_SHIFT
    first, rest = identifier >> 18, identifier & ((1 << 18) - 1)
    return first << _LEADING_SHIFT | 0b11 << 18 | rest


def leading_of_rank(rank: int) -> int:
    """The 11 leading bits of the identifier that has this rank."""
    return rank >> _LEADING_SHIFT
