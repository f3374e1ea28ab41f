# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Authenticated frames by an independent implementation of AES-CMAC (RFC 4493)."""

from __future__ import annotations

from dataclasses import dataclass

from cryptography.hazmat.primitives.ciphers.algorithms import AES128
from cryptography.hazmat.primitives.cmac import CMAC

VALVE = bytes.fromhex("2b7e151628aed2a6abf7158809cf4f3c")
PUMP = bytes.fromhex("603deb1015ca71be2b73aef0857d7781")
"""The keys of the feature model."""


def cmac(key: bytes, data: bytes) -> bytes:
    """The MAC of the data."""
    made = CMAC(AES128(key))
    made.update(data)
    return made.finalize()


@dataclass(frozen=True, slots=True)
class Secured:
    """What sender and receiver of one message know."""

    key: bytes
    data_id: int
    freshness: int
    """Bytes of the freshness value in the frame."""
    mac: int
    """Bytes of the MAC in the frame."""

    def seal(self, data: bytes, value: int) -> bytes:
        """The frame: data, low bytes of the freshness value, first bytes of the MAC."""
        whole = value.to_bytes(8, "big")
        mac = cmac(self.key, self.data_id.to_bytes(2, "big") + data + whole)
        return data + whole[8 - self.freshness :] + mac[: self.mac]

    def data(self, frame: bytes) -> bytes:
        """What stands before the freshness value."""
        return frame[: len(frame) - self.freshness - self.mac]

    def shown(self, frame: bytes) -> int:
        """What the frame has of its freshness value."""
        size = len(frame) - self.mac
        return int.from_bytes(frame[size - self.freshness : size], "big")

    def accepts(self, frame: bytes, value: int) -> bool:
        """Is it the frame with that freshness value?"""
        return frame == self.seal(self.data(frame), value)
