"""Executed behaviours as text and as JSON: the same from interpreter and program.

One line is one step of one region: `0.020 motor.Motion: Idle.exit, T3.effect,
Moving.entry`. A step that executes no behaviour has no line.
"""

from __future__ import annotations

import json
from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns


@dataclass(frozen=True, slots=True)
class StepRecord:
    """The behaviours that one step of a region executed, in order."""

    at: Ns
    instance: str
    region: str
    behaviours: tuple[str, ...]

    def text(self) -> str:
        """As a line of text."""
        return f"{seconds(self.at)} {self.instance}.{self.region}: {', '.join(self.behaviours)}"

    def json(self) -> str:
        """As a line of JSON; the time is in ns."""
        fields = {
            "at_ns": self.at,
            "instance": self.instance,
            "region": self.region,
            "behaviours": self.behaviours,
        }
        return json.dumps(fields)


def seconds(time: Ns) -> str:
    """A time in s, exact, with 3, 6 or 9 decimals."""
    whole, rest = divmod(time, 10**9)
    digits = f"{rest:09}"
    while len(digits) > 3 and digits.endswith("000"):
        digits = digits[:-3]
    return f"{whole}.{digits}"


def parsed(line: str) -> StepRecord:
    """The record that `StepRecord.text` printed as ``line``."""
    head, _, behaviours = line.partition(": ")
    time, _, element = head.partition(" ")
    instance, _, region = element.rpartition(".")
    whole, _, decimals = time.partition(".")
    at = Ns(int(whole) * 10**9 + int(decimals.ljust(9, "0")))
    return StepRecord(at, instance, region, tuple(behaviours.split(", ")))
