# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end protection of a message: the published profiles in numbers (AUTOSAR E2E)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

ProfileName = Literal["e2e_p1", "e2e_p1b", "e2e_p1c", "e2e_p2", "e2e_p5", "e2e_p11", "e2e_p11c"]

COUNTER = "E2E_Counter"
CHECK = "E2E_CRC"
NIBBLE = "E2E_Data_ID"
"""The names of the header's fields in a CAN database."""


@dataclass(frozen=True, slots=True)
class HeaderField:
    """A field of the header: its first bit and its bits, Intel."""

    name: str
    start: int
    width: int


@dataclass(frozen=True, slots=True)
class Profile:
    """A profile, as PRS_E2EProtocol has it, with the header at byte 0."""

    kind: str
    """The profile in Ada, and below the mode in which the data identifier is included."""
    mode: str
    crc_bits: int
    counters: int
    """Values of the counter."""
    id_last: int
    """The largest data identifier; of profile 2 the largest of its list."""
    longest: int
    """Bytes of a frame in which `found_bits` wrong bits are always found."""
    found_bits: int
    fields: tuple[HeaderField, ...]

    @property
    def header(self) -> frozenset[int]:
        """The bits of the frame that the header takes."""
        return frozenset(
            bit for one in self.fields for bit in range(one.start, one.start + one.width)
        )


_EIGHT = (HeaderField(CHECK, 0, 8), HeaderField(COUNTER, 8, 4))
_WITH_NIBBLE = (*_EIGHT, HeaderField(NIBBLE, 12, 4))
_SIXTEEN = (HeaderField(CHECK, 0, 16), HeaderField(COUNTER, 16, 8))

PROFILES: dict[ProfileName, Profile] = {
    "e2e_p1": Profile("Profile_1", "Both", 8, 15, 0xFFFF, 24, 2, _EIGHT),
    "e2e_p1b": Profile("Profile_1", "Alternating", 8, 15, 0xFFFF, 24, 2, _EIGHT),
    "e2e_p1c": Profile("Profile_1", "Nibble", 8, 15, 0x0FFF, 24, 2, _WITH_NIBBLE),
    "e2e_p2": Profile("Profile_2", "Both", 8, 16, 0xFF, 12, 3, _EIGHT),
    "e2e_p5": Profile("Profile_5", "Both", 16, 256, 0xFFFF, 64, 3, _SIXTEEN),
    "e2e_p11": Profile("Profile_11", "Both", 8, 15, 0xFFFF, 24, 2, _EIGHT),
    "e2e_p11c": Profile("Profile_11", "Nibble", 8, 15, 0x0FFF, 24, 2, _WITH_NIBBLE),
}


@dataclass(frozen=True, slots=True)
class Protection:
    """The protection of one message."""

    name: ProfileName
    data_id: int
    data_ids: tuple[int, ...]
    """By counter, in profile 2; else empty."""
    max_delta: int
    sync: int
    on_error: tuple[tuple[str, str], ...] = ()
    """(instance, event) raised on the node of the instance for each faulty frame."""

    @property
    def profile(self) -> Profile:
        """The profile in numbers."""
        return PROFILES[self.name]

    @property
    def residual(self) -> float:
        """The probability that a frame of random data is used: right CRC, counter in sequence.

        A frame whose counter is 15 in a profile that has 15 of them is refused. So the bits of
        the counter in the header count, not the values that the profile uses.
        """
        bits = next(one.width for one in self.profile.fields if one.name == COUNTER)
        nibble = sum(one.width for one in self.profile.fields if one.name == NIBBLE)
        return float(2.0 ** -(self.profile.crc_bits + nibble) * self.max_delta / 2**bits)

    def share(self, counter: int) -> tuple[str, int]:
        """The share of the data identifier in the CRC of a frame with that counter."""
        if self.data_ids:
            return "list", self.data_ids[counter]
        low, high = self.data_id & 0xFF, self.data_id >> 8
        if self.profile.crc_bits == 16:
            return "16 bits", self.data_id
        read = {
            "Both": (low, high),
            "Alternating": ((low, high)[counter % 2],),
            "Nibble": (low, 0),
        }
        return "8 bits", crc_8(bytes(read[self.profile.mode]))

    def passes_for(self, other: Protection) -> bool:
        """Is there a counter with which a frame of this message is intact as one of the other?

        Both have the same length and the same identifier on the bus: the worst that can be.
        """
        if self.profile.mode == other.profile.mode == "Nibble" and (
            self.data_id >> 8 != other.data_id >> 8
        ):
            return False
        counters = range(min(self.profile.counters, other.profile.counters))
        return any(self.share(counter) == other.share(counter) for counter in counters)


def crc_8(data: bytes) -> int:
    """The remainder of profiles 1 and 11: generator 1D (SAE J1850), start value 0."""
    register = 0
    for byte in data:
        register ^= byte
        for _ in range(8):
            register = (register << 1) ^ (0x11D if register & 0x80 else 0)
    return register
