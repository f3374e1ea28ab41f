# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Transmission modes of messages (AUTOSAR COM): when a frame goes, besides periodically."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ravenchart.gen.language.terms import Ns


class Mode(Enum):
    """The occasions on which a frame is sent."""

    ON_CHANGE = "on_change"
    """A value that differs from the last one sent."""
    ON_EVENT = "on_event"
    """Each value given."""
    MIXED = "mixed"
    """A value that differs, and the last one again after a period."""


@dataclass(frozen=True, slots=True)
class Transmission:
    """The transmission mode of a message, in executions of the row that sends it."""

    mode: Mode
    minimum: int
    """From one frame to the next, at least: the minimum delay time."""
    renewal: int
    """In mode mixed, from one frame to the next at most; 0: without bound."""
    row: Ns
    """The period of the row."""

    @property
    def longest(self) -> Ns | None:
        """The time from one frame to the next, at most; None where nothing bounds it."""
        return Ns(self.renewal * self.row) if self.renewal else None

    @property
    def words(self) -> str:
        """The mode in words."""
        return {
            Mode.ON_CHANGE: "on change",
            Mode.ON_EVENT: "on event",
            Mode.MIXED: "periodically and on change",
        }[self.mode]
