"""The steps of a scenario: what the operator does, one after the other.

Each step reads as a sentence; `STEPS` has its form by the key that tells it from the others.
"""

from __future__ import annotations

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
    """One drive, or every drive (``all``), falls silent."""

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
