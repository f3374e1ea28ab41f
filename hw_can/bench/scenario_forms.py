# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The parts of a scenario as they are written: drives, steps, what is expected.

Quantities carry their unit (``430 mm``, ``1 mm/s``, ``8 s``); inside they are m, m/s and s.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from ravenchart.gen.language.names import LONGEST_REQUIREMENT, REQUIREMENT

from .plant import Axis
from .protection import Wrong
from .quantities import Length, Scalar, Speed, Time

Signal = Annotated[str, Field(pattern=r"^\w+\.\w+$")]
"""``message.field``"""
ElementName = Annotated[str, Field(pattern=r"^\w+(\.\w+)+$")]
"""``owner.name``: a region or port of the controller."""


Requirement = Annotated[str, Field(pattern=REQUIREMENT, max_length=LONGEST_REQUIREMENT)]
"""The id of a requirement."""


class _Form(BaseModel):
    """Unknown keys are mistakes."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, populate_by_name=True, use_attribute_docstrings=True
    )

    req: Annotated[tuple[Requirement, ...], Field(min_length=1)] = ()
    """Ids of the requirements that this tests."""


class DriveForm(_Form):
    """One simulated drive: its two messages, its axis, and what belongs to it in plots."""

    set_point: str
    """Message received; its fields are ``mode`` and ``speed`` in um/s."""
    feedback: str
    """Message sent; its fields are ``count``, ``speed``, ``limit`` and ``condition``."""
    stroke: Length
    start: Length
    low_switch: Length
    high_switch: Length
    count_at_start: int = 0
    target: Signal | None = None
    """Field of a sent message that orders a position in um from the axis's zero."""
    states: ElementName | None = None
    """Region of the controller that moves this axis."""

    def axis(self) -> Axis:
        """The axis; ValueError when the lengths do not fit together."""
        return Axis(
            stroke=self.stroke,
            start=self.start,
            low_switch=self.low_switch,
            high_switch=self.high_switch,
            count_at_start=self.count_at_start,
        )


class SendStep(_Form):
    """Send one message to the controller."""

    send: str
    fields: dict[str, Scalar] = Field(alias="with")
    wrong: Wrong | None = None
    """A fault of the frame, for a protected message."""

    def __str__(self) -> str:
        wrong = f", with {self.wrong.replace('_', ' ')}" if self.wrong else ""
        return f"send {self.send}: {_values(self.fields)}{wrong}"


class WaitFor(_Form):
    """Wait until a message arrives with that value in a field."""

    wait_for: Signal
    value: Scalar = Field(alias="is")
    within: Time

    def __str__(self) -> str:
        return f"wait for {self.wait_for} = {self.value}"


class Expect(_Form):
    """The true positions, from the point where each axis left its low switch."""

    expect: Annotated[dict[str, Length], Field(min_length=1)]
    tolerance: Length
    within: Time = 0.0

    def __str__(self) -> str:
        places = {name: f"{position * 1e3:g} mm" for name, position in self.expect.items()}
        return f"expect {_values(places)}"


class ExpectStop(_Form):
    """The true speed of one axis falls, and stays, below a limit from then on."""

    expect_stop: str
    below: Speed
    within: Time

    def __str__(self) -> str:
        return f"expect {self.expect_stop} to stop within {self.within:g} s"


class Wait(_Form):
    """Let time pass."""

    wait: Time

    def __str__(self) -> str:
        return f"wait {self.wait:g} s"


class Pull(_Form):
    """Press a limit switch by hand."""

    pull: str
    switch: Literal["low", "high"]

    def __str__(self) -> str:
        return f"pull the {self.switch} limit switch of {self.pull}"


class Release(_Form):
    """Let go of the limit switches of one axis."""

    release: str

    def __str__(self) -> str:
        return f"release the limit switch of {self.release}"


class StopFeedback(_Form):
    """One drive, or every drive (``all``), falls silent."""

    stop_feedback: str

    def __str__(self) -> str:
        return f"stop the feedback of {self.stop_feedback}"


class KillBench(_Form):
    """The bench leaves the bus at once; the axes are only watched from then on."""

    kill_bench: Literal[True]

    def __str__(self) -> str:
        return "kill the bench"


class Replay(_Form):
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


class Cut(_Form):
    """A node, and those behind it in the model, are cut off the bus at that time."""

    at: Time
    cut: str


class Mend(_Form):
    """The bus is whole again from that time on."""

    at: Time
    mend: Literal[True]


class Hold(_Form):
    """The bus is shorted to one level from that time on: no other gets through."""

    at: Time
    hold: Literal["dominant", "recessive"]


class LetGo(_Form):
    """The bus is held no more from that time on."""

    at: Time
    let_go: Literal[True]


BusEvent = Cut | Mend | Hold | LetGo

BUS_EVENTS: Mapping[str, type[BusEvent]] = {
    "cut": Cut,
    "mend": Mend,
    "hold": Hold,
    "let_go": LetGo,
}
"""Each event of the bus by the key that tells it from the others."""


class TraceCheck(_Form):
    """After the run, the controller's trace must show that a region reached a state.

    Of a bus with `watch`, `node.bus` stands for the controller of a node, and the states are
    those of its fault confinement.
    With ``within`` the state was entered at most that long after the last arrival at
    the port ``after_last``, or after the one before the longest silence at the port
    ``after_silence``. With ``then`` it went on to that state later.
    """

    region: ElementName
    reaches: str
    within: Time | None = None
    after_last: ElementName | None = None
    after_silence: ElementName | None = None
    then: str | None = None

    @property
    def port(self) -> str | None:
        """The port from whose arrival the time counts."""
        return self.after_last or self.after_silence

    def __str__(self) -> str:
        limit = ""
        if self.within is not None and self.port is not None:
            which = "of the last" if self.after_last else "of the silence at"
            limit = f" within {self.within * 1e3:g} ms {which} {self.port}"
        later = "" if self.then is None else f", then in {self.then}"
        return f"trace: {self.region} in {self.reaches}{limit}{later}"


class _Counted(_Form):
    """Something that a run counts, and how often it may: exactly ``times``, or ``at_most``."""

    times: Annotated[int, Field(ge=0)] | None = None
    at_most: Annotated[int, Field(ge=1)] | None = None
    because: Annotated[str, Field(min_length=1)]
    """The cause, for who reads the report."""

    @property
    def name(self) -> str:
        """What is counted."""
        key = next(key for key, kind in EXPECTED.items() if isinstance(self, kind))
        return str(getattr(self, key))

    def allows(self, count: int) -> bool:
        """Whether it may be counted so often."""
        return count == self.times if self.times is not None else count <= (self.at_most or 0)

    @property
    def limit(self) -> str:
        """How often it may be counted, in words."""
        return f"{self.times}" if self.times is not None else f"at most {self.at_most}"


class Lost(_Counted):
    """Frames or lines that a bus lost: a count of the controller's report."""

    lost: str


class CountedFault(_Counted):
    """A fault that the controller counted."""

    fault: Literal[
        "Overrun",
        "Queue_Overflow",
        "Stale_Input",
        "Can_Error_Passive",
        "Can_Bus_Off",
        "Silence",
        "Protection_Error",
    ]


class Missed(_Counted):
    """Deadlines that a processor missed."""

    missed: str


class Overran(_Counted):
    """The executions of a row, ``owner.name``, were longer than its ``wcet``: counted once."""

    overran: ElementName


Expected = Lost | CountedFault | Missed | Overran

EXPECTED: Mapping[str, type[Expected]] = {
    "lost": Lost,
    "fault": CountedFault,
    "missed": Missed,
    "overran": Overran,
}
"""Each expected fault by the key that tells it from the others."""


class WholeForm(_Form):
    """The whole file; what is inside its lists and mappings is read item by item."""

    scenario: str
    drives: dict[str, Any] = {}
    bus: list[Any] = []
    steps: Annotated[list[Any], Field(min_length=1)]
    expect_trace: list[Any] = []
    expect: list[Any] = []


def _values(fields: Mapping[str, object]) -> str:
    """``a 1, b 2``"""
    return ", ".join(f"{name} {value}" for name, value in fields.items())
