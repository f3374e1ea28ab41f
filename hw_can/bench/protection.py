"""What the bench writes into the header of a message that is protected from end to end.

It reads the profile from the attributes of the DBC and knows nothing of the controller's code.
AUTOSAR FO PRS_E2EProtocol: profiles 1, 2, 5 and 11, the header at byte 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

PROFILE, DATA_IDS = "E2EProfile", "E2EDataIDs"
"""The attributes of a message: its profile, and its data identifiers as hexadecimal numbers."""

HEADER = frozenset({"E2E_CRC", "E2E_Counter", "E2E_Data_ID"})
"""The signals of the header."""


@dataclass(slots=True)
class Sender:
    """The sender of one protected message; ``counter`` is that of the next frame."""

    profile: str
    data_ids: tuple[int, ...]
    counter: int = 0

    def protect(self, data: bytes) -> bytes:
        """The data with their header; the next frame has the next counter."""
        made = bytearray(data)
        low, high = self.data_ids[0] & 0xFF, self.data_ids[0] >> 8
        if self.profile == "e2e_p5":
            made[2] = self.counter
            check = crc(bytes([*made[2:], low, high]), 16, 0x1021, 0xFFFF)
            made[0:2] = check.to_bytes(2, "little")
            self.counter = (self.counter + 1) % 256
            return bytes(made)
        upper = high << 4 & 0xF0 if self.profile.endswith("c") else made[1] & 0xF0
        made[1] = upper | self.counter
        if self.profile == "e2e_p2":
            own = self.data_ids[self.counter]
            made[0] = crc(bytes([*made[1:], own]), 8, 0x2F, 0xFF) ^ 0xFF
            self.counter = (self.counter + 1) % 16
            return bytes(made)
        before = [low, high]
        if self.profile.endswith("b"):
            before = [before[self.counter % 2]]
        elif self.profile.endswith("c"):
            before = [low, 0]
        made[0] = crc(bytes([*before, *made[1:]]), 8, 0x1D, 0)
        self.counter = (self.counter + 1) % 15
        return bytes(made)


def sender_of(attributes: Mapping[str, Any]) -> Sender | None:
    """The sender of a message with these attributes; None where it is not protected."""
    if PROFILE not in attributes or DATA_IDS not in attributes:
        return None
    texts = str(attributes[DATA_IDS].value).split()
    return Sender(str(attributes[PROFILE].value), tuple(int(text, 16) for text in texts))


def crc(data: bytes, width: int, polynomial: int, start: int) -> int:
    """The remainder of the data, the highest bit of each byte first."""
    register, top = start, 1 << (width - 1)
    for byte in data:
        register ^= byte << (width - 8)
        for _ in range(8):
            high = register & top
            register = (register << 1) & (2 * top - 1)
            if high:
                register ^= polynomial
    return register
