# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Executed behaviours as text and as JSON: the same from interpreter and program.

One line is one step of one region: `0.020 motor.Motion: Idle.exit, T3.effect,
Moving.entry`. A step that executes no behaviour has no line. A value that the model
records has one, `0.020 motor.speed = 12`, behind the steps of the same instant.
"""

from __future__ import annotations

import json
from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns, Scalar


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


@dataclass(frozen=True, slots=True)
class ValueRecord:
    """A recorded value, as the model counts it: an integer, or the name of a literal."""

    at: Ns
    element: str
    value: Scalar

    def text(self) -> str:
        """As a line of text."""
        return f"{seconds(self.at)} {self.element} = {self.value}"

    def json(self) -> str:
        """As a line of JSON; the time is in ns."""
        return json.dumps({"at_ns": self.at, "element": self.element, "value": self.value})


@dataclass(frozen=True, slots=True)
class Played:
    """All that happened under stimuli."""

    steps: list[StepRecord]
    values: list[ValueRecord]

    def lines(self) -> list[StepRecord | ValueRecord]:
        """In order of time: of one instant the steps, then the values."""
        return sorted((*self.steps, *self.values), key=lambda one: one.at)


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
    return StepRecord(_instant(time), instance, region, tuple(behaviours.split(", ")))


def parsed_value(line: str) -> ValueRecord:
    """The record that `ValueRecord.text` printed as ``line``; its value is text."""
    time, element, _, value = line.split(" ")
    return ValueRecord(_instant(time), element, value)


def _instant(time: str) -> Ns:
    whole, _, decimals = time.partition(".")
    return Ns(int(whole) * 10**9 + int(decimals.ljust(9, "0")))
