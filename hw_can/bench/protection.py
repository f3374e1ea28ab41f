# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The header that the bench writes into a message that is protected from end to end.

The bench reads the profile from the attributes of the DBC. It does not use the controller's code.
AUTOSAR FO PRS_E2EProtocol: profiles 1, 2, 5 and 11, the header at byte 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

PROFILE, DATA_IDS = "E2EProfile", "E2EDataIDs"
"""The attributes of a message: its profile, and its data identifiers as hexadecimal numbers."""

HEADER = frozenset({"E2E_CRC", "E2E_Counter", "E2E_Data_ID"})
"""The signals of the header."""


Wrong = Literal[
    "corruption", "repetition", "wrong_sequence", "loss", "insertion", "masquerade", "unprotected"
]
"""A fault of one frame, by the words of IEC 61784-3; `unprotected` has a header of zeros."""

COUNTERS = {"e2e_p5": 256, "e2e_p2": 16}
"""Values of the counter; the other profiles have 15."""


@dataclass(slots=True)
class Sender:
    """The sender of one protected message; ``counter`` is that of the next frame."""

    profile: str
    data_ids: tuple[int, ...]
    counter: int = 0

    @property
    def counters(self) -> int:
        """Values of the counter."""
        return COUNTERS.get(self.profile, 15)

    def protect(self, data: bytes, wrong: Wrong | None = None) -> bytes | None:
        """The data with their header, or with that fault; None: the frame is lost.

        The next frame has the next counter. A frame from elsewhere, or a repeated frame, takes
        no counter from the sender: its next frame is in sequence.
        """
        taken = self.counter
        if wrong in ("repetition", "wrong_sequence", "insertion", "masquerade"):
            behind = {"repetition": 1, "wrong_sequence": 2, "insertion": self.counters // 2}
            made = self._with_header(data, taken - behind.get(wrong, 0), wrong == "masquerade")
            return bytes(made)
        self.counter = (taken + 1) % self.counters
        made = self._with_header(data, taken)
        if wrong == "corruption":
            made[-1] ^= 0x80
        elif wrong == "unprotected":
            made = bytearray(data)
        return None if wrong == "loss" else bytes(made)

    def _with_header(self, data: bytes, counter: int, foreign: bool = False) -> bytearray:
        """The header of a frame with that counter, perhaps that of a ``foreign`` message."""
        made, counter = bytearray(data), counter % self.counters
        data_ids = [own ^ (0x0101 if foreign else 0) for own in self.data_ids]
        low, high = data_ids[0] & 0xFF, data_ids[0] >> 8
        if self.profile == "e2e_p5":
            made[2] = counter
            made[0:2] = crc(bytes([*made[2:], low, high]), 16, 0x1021, 0xFFFF).to_bytes(2, "little")
            return made
        upper = high << 4 & 0xF0 if self.profile.endswith("c") else made[1] & 0xF0
        made[1] = upper | counter
        if self.profile == "e2e_p2":
            own = data_ids[counter] & 0xFF
            made[0] = crc(bytes([*made[1:], own]), 8, 0x2F, 0xFF) ^ 0xFF
            return made
        before = [low, high]
        if self.profile.endswith("b"):
            before = [before[counter % 2]]
        elif self.profile.endswith("c"):
            before = [low, 0]
        made[0] = crc(bytes([*before, *made[1:]]), 8, 0x1D, 0)
        return made


def protected_sender(attributes: Mapping[str, Any]) -> Sender | None:
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
