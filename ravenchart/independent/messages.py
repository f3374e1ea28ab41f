# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Messages as they travel: one frame for a value, or several and flow control (ISO 15765-2)."""

from __future__ import annotations

from dataclasses import dataclass, field

from .frames import Frame
from .model import Mapping

FIRST_BYTES, NEXT_BYTES = 6, 7
"""Bytes of a value in its first frame and in each consecutive frame (ISO 15765-2, 9.2)."""
SECOND = 10**9
MICROSECOND = 1000


@dataclass(frozen=True, slots=True)
class Transfer:
    """A value in several frames."""

    length: int
    """Bytes of the value."""
    row: int
    """The period of the row that sends its frames."""
    flow_id: int
    block: int
    """Consecutive frames for each frame of flow control; 0: all."""
    separation: int
    timeout: int

    @property
    def further(self) -> int:
        """Its consecutive frames."""
        return -(-(self.length - FIRST_BYTES) // NEXT_BYTES)

    @property
    def rounds(self) -> int:
        """Its frames of flow control."""
        return -(-self.further // self.block) if self.block else 1

    @property
    def apart(self) -> int:
        """The least time between two of its frames: whole executions of the row.

        One execution more than the separation needs, since an execution may be late.
        """
        if not self.separation:
            return self.row
        needed = -(-(self.separation // MICROSECOND) // (self.row // MICROSECOND))
        return (needed + 1) * self.row


def transfer_of(form: Mapping, length: int, row: int) -> Transfer | None:
    """How a message with a value of so many bytes travels; None: in one frame."""
    own = form.map("transport")
    if not own:
        return None
    return Transfer(
        length=length,
        row=row,
        flow_id=own.number("flow_id", 0),
        block=own.number("block", 0),
        separation=own.time("separation", 0),
        timeout=own.time("timeout", SECOND),
    )


@dataclass(slots=True)
class Message:
    """A frame on a bus."""

    name: str
    bus: str
    period: int
    deadline: int
    length: int
    frame: Frame
    source: str | None = None
    """`instance.port`."""
    node: str | None = None
    """The node that sends it."""
    targets: list[str] = field(default_factory=list)
    identifier: int | None = None
    extended: bool = False
    mac: int = 0
    """The time to compute the MAC of a frame, where it has one."""
    renewal: int = 0
    """The longest time from one frame to the next in transmission mode mixed."""
    transfer: Transfer | None = None
    flow: Message | None = None
    """The flow control of its transfer."""
    controls: bool = False
    """It is the flow control of another one."""

    @property
    def element(self) -> str:
        """`bus.message`."""
        return f"{self.bus}.{self.name}"

    @property
    def sending(self) -> str:
        """The driver's work on sending it."""
        return f"{self.bus}.driver_tx.{self.name}"

    @property
    def leading(self) -> int:
        """The first 11 bits of the identifier."""
        own = self.identifier or 0
        return own >> 18 if self.extended else own

    @property
    def rank(self) -> tuple[int, bool, int]:
        """The lesser wins the arbitration."""
        return self.leading, self.extended, self.identifier or 0
