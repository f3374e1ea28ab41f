# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One CAN bus: the most urgent frame on offer is sent, and nothing interrupts it but faults."""

from __future__ import annotations

from dataclasses import dataclass, field

from ravenchart.analysis.core.bus import ERROR_BITS, Bus, Frame


@dataclass(slots=True)
class QueuedFrame:
    """A queued instance of ``frame``; ``event`` began its chain, ``order`` is that of arrival."""

    frame: Frame
    number: int
    event: int
    order: int


@dataclass(slots=True)
class Wire:
    """The state of one bus.

    Arbitration begins when the bus is free and a frame is queued. A frame that is queued less
    than a bit later takes part. Of a first-in first-out queue only the oldest frame competes.
    """

    bus: Bus
    faults: tuple[int, ...] = ()
    queued: list[QueuedFrame] = field(default_factory=list)
    sending: QueuedFrame | None = None
    start: int = 0
    free: int = 0
    arbitrating: bool = False
    _fault: int = 0

    @property
    def due(self) -> int | None:
        """The end of arbitration or of the transmission, or the fault that comes before."""
        if self.arbitrating:
            return self.start + self.bus.bit_time
        if self.sending is not None:
            end = max(
                self.start + self.sending.frame.transmission_time, self.start + self.bus.bit_time
            )
            fault = self._next_fault()
            return (
                end if fault is None or fault > end else max(fault, self.start + self.bus.bit_time)
            )
        return self.free if self.queued else None

    def advance(self, now: int) -> QueuedFrame | None:
        """Process the event due at ``now``; the message that has been sent."""
        if self.arbitrating:
            self.arbitrating = False
            self.sending = min(self._competing(), key=lambda m: (m.frame.rank, m.order))
            return None
        message = self.sending
        if message is None:
            return None
        self.sending = None
        if now >= self.start + message.frame.transmission_time:
            self.free = now
            self.queued.remove(message)
            return message
        errors = self.bus.errors
        self.free = now + (errors.bits if errors else ERROR_BITS) * self.bus.bit_time
        return None

    def release(self, message: QueuedFrame) -> None:
        """Queue a message."""
        self.queued.append(message)

    def dispatch(self, now: int) -> None:
        """Begin arbitration where the bus is free and a frame is queued."""
        if self.queued and self.sending is None and not self.arbitrating and self.free <= now:
            self.start, self.arbitrating = now, True
            while (fault := self._next_fault()) is not None and fault <= now:
                self._fault += 1

    def _competing(self) -> list[QueuedFrame]:
        """The offered frames: all, but of each first-in first-out queue only the oldest."""
        oldest: dict[str, QueuedFrame] = {}
        for message in self.queued:
            if message.frame.queue:
                oldest.setdefault(message.frame.queue, message)
        return [m for m in self.queued if oldest.get(m.frame.queue, m) is m]

    def _next_fault(self) -> int | None:
        return self.faults[self._fault] if self._fault < len(self.faults) else None
