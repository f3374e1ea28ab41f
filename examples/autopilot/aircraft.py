# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A small aircraft with its sensors, and the pilot on the ground.

Angles in 0.01 degrees, rates in 0.01 degrees a second, speeds in cm/s, heights in cm, as in the
messages. The dynamics are those of a slow and stable model aircraft, each axis by itself.
"""

from collections.abc import Mapping
from math import radians, sin, tan

from ravenchart.hw_can.bench.plants import Plant

GRAVITY = 981.0  # cm/s^2
LIMIT = 30_000  # of a gyro
GYROS, PROBES = (1, 2, 3), (1, 2, 3)
OFFSETS = {1: 12, 2: -7, 3: 3}  # of the gyros, which the model takes off


class Aircraft(Plant):
    """It flies at 18 m/s in a height of 100 m from power-on."""

    inputs = ("left", "right", "rudder", "throttle", "stuck_gyro")
    outputs = (
        *(f"gyro_{n}_{axis}" for n in GYROS for axis in ("roll", "pitch", "yaw")),
        *(f"probe_{n}_{item}" for n in PROBES for item in ("speed", "height")),
        "roll",
        "height",
    )

    def __init__(self, parameters: Mapping[str, object]) -> None:
        """Start in level flight."""
        self.surfaces = {"left": 0.0, "right": 0.0, "rudder": 0.0, "throttle": 0.0}
        self.rates = {"roll": 0.0, "pitch": 0.0, "yaw": 0.0}
        self.roll = self.pitch = 0.0
        self.speed, self.height, self.time = 1800.0, 10_000.0, 0.0
        self.stuck = 0

    def take(self, name: str, value: object) -> None:
        """A servo has moved, or the gyro of that number is stuck (0: none is)."""
        number = float(str(value))
        if name == "stuck_gyro":
            self.stuck = int(number)
        else:
            self.surfaces[name] = number

    def advance(self, until: float) -> None:
        """Go on in steps of at most 5 ms."""
        while self.time < until:
            step = min(0.005, until - self.time)
            self._step(step)
            self.time += step

    def _step(self, step: float) -> None:
        aileron = (self.surfaces["left"] - self.surfaces["right"]) / 2
        elevator = (self.surfaces["left"] + self.surfaces["right"]) / 2
        self.rates["roll"] += (40 * aileron - 4 * self.rates["roll"]) * step
        self.rates["pitch"] += (40 * elevator - 4 * self.rates["pitch"]) * step
        turn = GRAVITY / max(self.speed, 500.0) * tan(radians(self.roll / 100)) * 5730
        self.rates["yaw"] = turn + self.surfaces["rudder"] / 10
        self.roll = _within(self.roll + self.rates["roll"] * step, 6_000)
        self.pitch = _within(self.pitch + self.rates["pitch"] * step, 3_000)
        climb = self.speed * sin(radians(self.pitch / 100))
        self.height = max(0.0, self.height + climb * step)
        pull = 0.6 * self.surfaces["throttle"] - 300 * (self.speed / 1800) ** 2
        pull -= GRAVITY * sin(radians(self.pitch / 100))
        self.speed = max(1000.0, self.speed + pull * step)

    def value(self, name: str) -> object:
        """A sensor, or for the scenario the bank in degrees and the height in m."""
        if name == "roll":
            return self.roll / 100
        if name == "height":
            return self.height / 100
        kind, number, item = name.split("_")
        if kind == "probe":
            return round(self.speed if item == "speed" else self.height)
        if int(number) == self.stuck:
            return LIMIT
        return round(_within(self.rates[item] + OFFSETS[int(number)], LIMIT))


class Pilot(Plant):
    """The stick of the pilot on the ground: roll and pitch in 0.01 degrees, thrust in 0.1 %."""

    inputs = outputs = ("roll", "pitch", "thrust")

    def __init__(self, parameters: Mapping[str, object]) -> None:
        """Hands off."""
        self.stick = dict.fromkeys(self.inputs, 0)

    def take(self, name: str, value: object) -> None:
        """Move the stick."""
        self.stick[name] = int(float(str(value)))

    def advance(self, until: float) -> None:
        """Nothing moves by itself."""

    def value(self, name: str) -> object:
        """The stick as it is sent."""
        return self.stick[name]


def _within(value: float, limit: float) -> float:
    return max(-limit, min(value, limit))
