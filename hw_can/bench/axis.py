# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""One simulated drive: a motor that moves an axis between two hard stops.

The model is deterministic: the same commands at the same steps give the same motion. The
state is in SI units; values on the bus are in um and um/s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum

STEP = 0.0005
"""Integration step in s."""

UM = 1e6
"""um in a metre."""


class DriveMode(Enum):
    """The command to the drive: let go and brake, or follow the speed set point."""

    DISABLED = "Disabled"
    ENABLED = "Enabled"


class Limit(Enum):
    """The state of the limit switches; the low one takes precedence."""

    CLEAR = "Clear"
    LOW_END = "Low_End"
    HIGH_END = "High_End"


class Condition(Enum):
    """Whether the drive can follow a set point."""

    READY = "Ready"
    FAULTED = "Faulted"


class Push(Enum):
    """A switch that is pressed by hand."""

    NONE = "none"
    LOW = "low"
    HIGH = "high"


@dataclass(frozen=True, slots=True)
class Axis:
    """Mechanics, motor and switches of one axis; positions in m from the low hard stop."""

    stroke: float
    """Distance between the hard stops in m."""
    start: float
    """The position of the axis at power-on."""
    low_switch: float
    """The low switch is pressed below this position."""
    high_switch: float
    """The high switch is pressed above this position."""
    switch_travel: float = 0.001
    """A pressed switch is released this far, in m, from where it was pressed."""
    count_at_start: int = 0
    """The reading of the encoder at power-on, in um: it has no origin."""
    mass: float = 8.0
    """Moving mass in kg, the motor's inertia included."""
    force_limit: float = 24.0
    """The largest force of the motor in N: 3 m/s2 for the mass above."""
    coulomb: float = 2.0
    """Dry friction in N."""
    viscous: float = 6.0
    """Friction in N per m/s."""
    brake: float = 36.0
    """Further dry friction in N while the drive is disabled."""
    loop_time: float = 0.012
    """Time constant of the inner speed loop in s."""
    integral_time: float = 0.060
    """Time constant of its integral part in s."""
    watchdog: float = 0.100
    """Without a set point for this long, in s, an enabled drive stops and faults."""

    def __post_init__(self) -> None:
        """Refuse lengths that do not make an axis."""
        if not 0 <= self.low_switch < self.high_switch <= self.stroke:
            raise ValueError("0 <= low_switch < high_switch <= stroke must hold")
        if not 0 <= self.start <= self.stroke:
            raise ValueError("start lies outside of the stroke")


class Drive:
    """A drive in motion. `command` sets its mode and speed, `step` moves it on by STEP."""

    def __init__(self, axis: Axis) -> None:
        """At power-on: at rest, disabled, no set point received."""
        self.axis = axis
        self.position = axis.start
        self.speed = 0.0
        self.force = 0.0
        self.mode = DriveMode.DISABLED
        self.set_speed = 0.0
        self.condition = Condition.READY
        self.push = Push.NONE
        self._low = axis.start < axis.low_switch
        self._high = axis.start > axis.high_switch
        self._integral = 0.0
        self._silence = 0.0
        self._heard = False

    def command(self, mode: DriveMode, speed: float) -> None:
        """A set point arrived; ``speed`` in m/s."""
        self.mode, self.set_speed = mode, speed
        self._silence, self._heard = 0.0, True
        self.condition = Condition.READY

    def step(self) -> None:
        """Move on by STEP."""
        self._watch()
        following = self.mode is DriveMode.ENABLED and self.condition is Condition.READY
        self.force = self._motor() if following else self._release()
        dry = self.axis.coulomb + (0.0 if following else self.axis.brake)
        self._accelerate(dry)
        self._move()

    @property
    def limit(self) -> Limit:
        """The state of the switches, pressed by the axis or by hand."""
        if self.push is Push.LOW or self._low:
            return Limit.LOW_END
        if self.push is Push.HIGH or self._high:
            return Limit.HIGH_END
        return Limit.CLEAR

    @property
    def on_low_switch(self) -> bool:
        """Whether the axis itself presses its low switch."""
        return self._low

    @property
    def count(self) -> int:
        """The encoder in um, counted from power-on."""
        moved = (self.position - self.axis.start) * UM
        return self.axis.count_at_start + math.floor(moved + 0.5)

    @property
    def position_um(self) -> float:
        """True position in um from the low hard stop."""
        return self.position * UM

    @property
    def speed_um(self) -> float:
        """True speed in um/s."""
        return self.speed * UM

    def _watch(self) -> None:
        """Fault when an enabled drive receives no more set points."""
        self._silence += STEP
        if self._heard and self.mode is DriveMode.ENABLED and self._silence > self.axis.watchdog:
            self.condition = Condition.FAULTED

    def _motor(self) -> float:
        """Force of the inner speed loop in N; its integral waits while the limit is reached."""
        gain = self.axis.mass / self.axis.loop_time
        error = self.set_speed - self.speed
        wanted = gain * error + self._integral
        force = max(-self.axis.force_limit, min(self.axis.force_limit, wanted))
        if force == wanted or error * wanted < 0:
            self._integral += gain / self.axis.integral_time * error * STEP
        return force

    def _release(self) -> float:
        """No force; the next start is from scratch."""
        self._integral = 0.0
        return 0.0

    def _accelerate(self, dry: float) -> None:
        """Change the speed by motor, viscous and dry friction; dry friction only ever stops."""
        free = self.speed + (self.force - self.axis.viscous * self.speed) / self.axis.mass * STEP
        loss = dry / self.axis.mass * STEP
        self.speed = math.copysign(max(0.0, abs(free) - loss), free)

    def _move(self) -> None:
        """Change the position; a hard stop takes all speed towards it."""
        self.position += self.speed * STEP
        if self.position <= 0.0:
            self.position, self.speed = 0.0, max(0.0, self.speed)
        elif self.position >= self.axis.stroke:
            self.position, self.speed = self.axis.stroke, min(0.0, self.speed)
        axis = self.axis
        self._low = self.position < axis.low_switch + (axis.switch_travel if self._low else 0.0)
        self._high = self.position > axis.high_switch - (axis.switch_travel if self._high else 0.0)
