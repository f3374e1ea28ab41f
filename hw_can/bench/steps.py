# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The steps of a scenario: what the operator does, one after the other.

Each step reads as a sentence; `STEPS` has its form by the key that tells it from the others.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

from pydantic import Field

from .forms import ScenarioForm, Signal
from .protection import Wrong
from .quantities import Length, Scalar, Speed, Time


class SendStep(ScenarioForm):
    """Send one message to the controller."""

    send: str
    fields: dict[str, Scalar] = Field(alias="with")
    wrong: Wrong | None = None
    """A fault of the frame, for a protected message."""

    def __str__(self) -> str:
        wrong = f", with {self.wrong.replace('_', ' ')}" if self.wrong else ""
        return f"send {self.send}: {_values(self.fields)}{wrong}"


class WaitFor(ScenarioForm):
    """Wait until a message arrives with that value in a field."""

    wait_for: Signal
    value: Scalar = Field(alias="is")
    within: Time

    def __str__(self) -> str:
        return f"wait for {self.wait_for} = {self.value}"


class Expect(ScenarioForm):
    """The true positions, from the point where each axis left its low switch."""

    expect: Annotated[dict[str, Length], Field(min_length=1)]
    tolerance: Length
    within: Time = 0.0

    def __str__(self) -> str:
        places = {name: f"{position * 1e3:g} mm" for name, position in self.expect.items()}
        return f"expect {_values(places)}"


class ExpectStop(ScenarioForm):
    """The true speed of one axis falls, and stays, below a limit from then on."""

    expect_stop: str
    below: Speed
    within: Time

    def __str__(self) -> str:
        return f"expect {self.expect_stop} to stop within {self.within:g} s"


class SetInput(ScenarioForm):
    """An input of a plant gets a value: a disturbance, a fault, a hand."""

    set_input: Signal = Field(alias="set")
    """``plant.input``"""
    to: Scalar

    @property
    def plant(self) -> str:
        """The plant."""
        return self.set_input.partition(".")[0]

    @property
    def name(self) -> str:
        """Its input."""
        return self.set_input.partition(".")[2]

    def __str__(self) -> str:
        return f"set {self.set_input} to {self.to}"


class ExpectOutput(ScenarioForm):
    """An output of a plant has a value, or comes into a range."""

    expect_output: Signal
    """``plant.output``"""
    value: Scalar | None = Field(None, alias="is")
    at_least: float | None = None
    at_most: float | None = None
    within: Time = 0.0

    @property
    def plant(self) -> str:
        """The plant."""
        return self.expect_output.partition(".")[0]

    @property
    def name(self) -> str:
        """Its output."""
        return self.expect_output.partition(".")[2]

    def accepts(self, value: Scalar) -> bool:
        """Whether the output may have it."""
        if self.value is not None:
            return value == self.value
        if not isinstance(value, (int, float)):
            return False
        low = -math.inf if self.at_least is None else self.at_least
        high = math.inf if self.at_most is None else self.at_most
        return low <= value <= high

    def __str__(self) -> str:
        if self.value is not None:
            return f"expect {self.expect_output} = {self.value}"
        low = "" if self.at_least is None else f"{self.at_least:g} <= "
        high = "" if self.at_most is None else f" <= {self.at_most:g}"
        return f"expect {low}{self.expect_output}{high}"


class Wait(ScenarioForm):
    """Let time pass."""

    wait: Time

    def __str__(self) -> str:
        return f"wait {self.wait:g} s"


class Pull(ScenarioForm):
    """Press a limit switch by hand."""

    pull: str
    switch: Literal["low", "high"]

    def __str__(self) -> str:
        return f"pull the {self.switch} limit switch of {self.pull}"


class Release(ScenarioForm):
    """Let go of the limit switches of one axis."""

    release: str

    def __str__(self) -> str:
        return f"release the limit switch of {self.release}"


class StopFeedback(ScenarioForm):
    """One drive or plant, or every one (``all``), falls silent."""

    stop_feedback: str

    def __str__(self) -> str:
        return f"stop the feedback of {self.stop_feedback}"


class KillBench(ScenarioForm):
    """The bench leaves the bus at once; the axes are only watched from then on."""

    kill_bench: Literal[True]

    def __str__(self) -> str:
        return "kill the bench"


class Replay(ScenarioForm):
    """Send the frames of a log that come from outside, at the times that it gives."""

    replay: str
    """File, from the folder of the scenario: BLF, ASC or the format of candump."""

    def __str__(self) -> str:
        return f"replay {self.replay}"


ScenarioStep = (
    SendStep
    | Replay
    | WaitFor
    | Expect
    | ExpectStop
    | SetInput
    | ExpectOutput
    | Wait
    | Pull
    | Release
    | StopFeedback
    | KillBench
)
STEPS: Mapping[str, type[ScenarioStep]] = {
    "send": SendStep,
    "replay": Replay,
    "wait_for": WaitFor,
    "expect": Expect,
    "expect_stop": ExpectStop,
    "set": SetInput,
    "expect_output": ExpectOutput,
    "wait": Wait,
    "pull": Pull,
    "release": Release,
    "stop_feedback": StopFeedback,
    "kill_bench": KillBench,
}
"""Each step by the key that tells it from the others."""


def _values(fields: Mapping[str, object]) -> str:
    """``a 1, b 2``"""
    return ", ".join(f"{name} {value}" for name, value in fields.items())
