# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values that travel as several classic frames (ISO-TP, ISO 15765-2, normal addressing)."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns

FIRST_BYTES, NEXT_BYTES = 6, 7
"""Bytes of the value in the first segment, and in each one that follows."""
LONGEST = 64
"""Bytes of a value at most."""
MICROSECOND = 1000


def code_of(separation: Ns) -> int | None:
    """The code of a separation time STmin; None where the standard has none for it."""
    if separation % (1000 * MICROSECOND) == 0 and separation <= 127_000 * MICROSECOND:
        return separation // (1000 * MICROSECOND)
    if separation % (100 * MICROSECOND) == 0 and separation < 1000 * MICROSECOND:
        return 0xF0 + separation // (100 * MICROSECOND)
    return None


def distance_of(separation: Ns, row: Ns) -> int:
    """Executions of a row that are further apart than the separation, whatever its jitter."""
    if not separation:
        return 1
    return -(-(separation // MICROSECOND) // (row // MICROSECOND)) + 1


@dataclass(frozen=True, slots=True)
class Transport:
    """How the value of a message is cut into segments."""

    flow: str
    """The message of flow control."""
    flow_identifier: int
    block: int
    """Segments between two of flow control; 0: all that are left."""
    separation: Ns
    """STmin, that the receiver asks for."""
    waits: int
    """How often in a row it may ask to wait: N_WFTmax."""
    timeout: Ns
    """N_Bs and N_Cr."""
    length: int
    """Bytes of the value."""
    row: Ns
    """The period of the row that sends."""

    @property
    def segments(self) -> int:
        """Those of a value."""
        return 1 + -(-(self.length - FIRST_BYTES) // NEXT_BYTES)

    @property
    def rounds(self) -> int:
        """How often flow control is sent for a value."""
        return -(-(self.segments - 1) // self.block) if self.block else 1

    @property
    def distance(self) -> int:
        """Executions of the row from one segment to the next, at least."""
        return distance_of(self.separation, self.row)
