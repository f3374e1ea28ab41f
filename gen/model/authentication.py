# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Authentication of a message: what stands at the end of its frame (AUTOSAR SecOC)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ravenchart.gen.language.terms import Ns

AuthenticationName = Literal["secoc"]

FRESHNESS = "SecOC_Freshness"
MAC = "SecOC_MAC"
REST = "SecOC_MAC_2"
"""The names of the trailer's fields in a CAN database, whose signals have 64 bits at most."""

SIGNAL_BITS = 64
FRESHNESS_BITS = 64
"""Bits of the whole freshness value."""


@dataclass(frozen=True, slots=True)
class TrailerField:
    """A field of the trailer: its first byte in the frame and its bytes, the highest first."""

    name: str
    byte: int
    size: int


def trailer_bytes(freshness_bits: int, mac_bits: int) -> int:
    """Bytes of a frame that the freshness value and the MAC take."""
    return (freshness_bits + mac_bits) // 8


@dataclass(frozen=True, slots=True)
class Authentication:
    """The authentication of one message."""

    name: AuthenticationName
    data_id: int
    key: str
    freshness_bits: int
    mac_bits: int
    mac_wcet: Ns
    on_error: tuple[tuple[str, str], ...] = ()
    """(instance, event) raised on the node of the instance for each frame that is refused."""

    @property
    def trailer(self) -> int:
        """Bytes at the end of the frame."""
        return trailer_bytes(self.freshness_bits, self.mac_bits)

    def fields(self, length: int) -> tuple[TrailerField, ...]:
        """The fields of the trailer of a frame of so many bytes."""
        freshness, mac = self.freshness_bits // 8, self.mac_bits // 8
        first = min(mac, SIGNAL_BITS // 8)
        found = (
            TrailerField(FRESHNESS, length - mac - freshness, freshness),
            TrailerField(MAC, length - mac, first),
            TrailerField(REST, length - mac + first, mac - first),
        )
        return tuple(one for one in found if one.size)

    @property
    def random(self) -> float:
        """The probability that a frame with a guessed MAC is used."""
        return float(2.0**-self.mac_bits)

    @property
    def lost_at_most(self) -> int | None:
        """Frames in a row that may be lost, and the next one is used; None: any number."""
        return None if self.freshness_bits == FRESHNESS_BITS else 2**self.freshness_bits - 1
