# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Frames of one CAN bus, and the delays by the bus itself."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .checks import at_most, natural, positive

ERROR_BITS = 31
"""Bits lost to one error besides the frame that is sent again: Tindell and Burns 1994.

Two error flags that follow each other (6 + 6, and up to 6 of a flag that began
before), the delimiter (8), three bits to the next frame and rounding up. Others
take 23 or 29. A report names the figure that it used.
"""


INTERMISSION = 3
"""Bits between two frames: they count as part of the first one, after its reception."""


@dataclass(frozen=True, slots=True)
class Frame:
    """A message as the bus sees it.

    All times are in ticks.

        ``rank``      its place in arbitration, lower wins (`frames.rank`); of two equal ranks
                      either may go first, each time anew
        ``transmission_time``
                      C: the longest, with the three bits to the next frame, above 0
        ``period``    T: distance of its queuing events (least when ``sporadic``), above 0
        ``deadline``  D: from the event that makes the sender queue it, above 0
        ``jitter``    J: longest time from that event to the queuing: the sender's response
        ``queue``     the first-in first-out queue it is sent from; "" where the sender
                      offers its most urgent frame
        ``best``      least transmission time, these three bits included, for the jitter of
                      the items that the frame releases
        ``reloaded``  the controller gets the next frame of the queue when it has sent one, so
                      any frame may go in between; otherwise it holds the whole queue
        ``sporadic``  the period is a least distance only: the next event may come at any time
    """

    name: str
    rank: int
    period: int
    deadline: int
    transmission_time: int
    jitter: int = 0
    queue: str = ""
    best: int = 0
    reloaded: bool = False
    sporadic: bool = False

    def __post_init__(self) -> None:
        """Refuse values out of range, with a ValueError that names field and frame."""
        owner = f"message {self.name}"
        positive(
            owner,
            period=self.period,
            deadline=self.deadline,
            transmission_time=self.transmission_time,
        )
        natural(owner, rank=self.rank, jitter=self.jitter, best=self.best)
        at_most(owner, "best", self.best, self.transmission_time)

    @property
    def utilisation(self) -> Fraction:
        """Share of the bus that it needs at its longest and most frequent."""
        return Fraction(self.transmission_time, self.period)


@dataclass(frozen=True, slots=True)
class Errors:
    """At most ``burst`` errors at once, and one more every ``period`` ticks.

    Within t there are burst - 1 + ceil(t / period) errors. Each takes ``bits`` bits and
    the longest frame of the same or higher rank, which is sent again.
    """

    period: int
    burst: int = 1
    bits: int = ERROR_BITS

    def __post_init__(self) -> None:
        """Refuse values out of range, with a ValueError."""
        positive("the error model", period=self.period, burst=self.burst, bits=self.bits)


@dataclass(frozen=True, slots=True)
class Bus:
    """The properties of a bus that delay frames.

    Times are in ticks.

        ``bit_time``  one nominal bit, rounded up, above 0
        ``unknown``   longest frame that is not declared and that is less urgent than all
    """

    bit_time: int
    unknown: int = 0
    errors: Errors | None = None

    def __post_init__(self) -> None:
        """Refuse values out of range, with a ValueError."""
        positive("the bus", bit_time=self.bit_time)
        natural("the bus", unknown=self.unknown)
