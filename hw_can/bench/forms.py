# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The forms of a scenario's parts but its steps: drives, events of the bus, checks.

Quantities carry their unit (``430 mm``, ``1 mm/s``, ``8 s``); inside they are m, m/s and s.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from ravenchart.gen.language.names import LONGEST_REQUIREMENT, REQUIREMENT

from .axis import Axis
from .quantities import Length, Scalar, Time

Signal = Annotated[str, Field(pattern=r"^\w+\.\w+$")]
"""``message.field``"""
ElementName = Annotated[str, Field(pattern=r"^\w+(\.\w+)+$")]
"""``owner.name``: a region or port of the controller."""


Requirement = Annotated[str, Field(pattern=REQUIREMENT, max_length=LONGEST_REQUIREMENT)]
"""The id of a requirement."""


class ScenarioForm(BaseModel):
    """Unknown keys are mistakes."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, populate_by_name=True, use_attribute_docstrings=True
    )

    req: Annotated[tuple[Requirement, ...], Field(min_length=1)] = ()
    """Ids of the requirements that this tests."""


class DriveForm(ScenarioForm):
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


class PlantForm(ScenarioForm):
    """One plant that the user brings, and which values it shares with messages."""

    plant_class: Annotated[str, Field(pattern=r"^[^:]+\.py:[A-Za-z_]\w*$")] | None = Field(
        None, alias="class"
    )
    """``FILE.py:CLASS``, from the folder of the scenario."""
    fmu: Annotated[str, Field(pattern=r".+\.fmu$")] | None = None
    """File of a Functional Mock-up Unit for co-simulation, from the folder of the scenario."""
    parameters: dict[str, Scalar] = {}
    """The parameters with which the plant is made."""
    inputs: dict[str, Signal] = {}
    """For inputs of the plant the fields of messages that the controller sends."""
    outputs: dict[Signal, str] = {}
    """For fields of messages that the plant sends the outputs of the plant."""
    period: Time = 0.005
    """Time between two frames of each message that it sends: whole multiples of 5 ms."""
    step: Annotated[Time, Field(gt=0)] = 0.005
    """Communication step of a Functional Mock-up Unit."""


class BusEventForm(ScenarioForm):
    """Something that happens to a bus."""

    at: Time
    on: str | None = None
    """The bus, where the model has several."""


class Cut(BusEventForm):
    """A node, and those behind it in the model, are cut off the bus at that time."""

    cut: str


class Mend(BusEventForm):
    """The bus is whole again from that time on."""

    mend: Literal[True]


class Hold(BusEventForm):
    """The bus is shorted to one level from that time on: no other gets through."""

    hold: Literal["dominant", "recessive"]


class LetGo(BusEventForm):
    """The bus is held no more from that time on."""

    let_go: Literal[True]


BusEvent = Cut | Mend | Hold | LetGo

BUS_EVENTS: Mapping[str, type[BusEvent]] = {
    "cut": Cut,
    "mend": Mend,
    "hold": Hold,
    "let_go": LetGo,
}
"""Each event of the bus by its distinctive key."""


class TraceCheck(ScenarioForm):
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


class _Counted(ScenarioForm):
    """Something that a run counts, and how often it may: exactly ``times``, or ``at_most``."""

    times: Annotated[int, Field(ge=0)] | None = None
    at_most: Annotated[int, Field(ge=1)] | None = None
    because: Annotated[str, Field(min_length=1)]
    """The cause, for who reads the report."""

    @property
    def name(self) -> str:
        """The name of the counted item."""
        key = next(key for key, kind in EXPECTED.items() if isinstance(self, kind))
        return str(getattr(self, key))

    def allows(self, count: int) -> bool:
        """Whether this count is allowed."""
        return count == self.times if self.times is not None else count <= (self.at_most or 0)

    @property
    def limit(self) -> str:
        """The allowed count, in words."""
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
"""Each expected fault by its distinctive key."""


class WholeForm(ScenarioForm):
    """The whole file; what is inside its lists and mappings is read item by item."""

    scenario: str
    drives: dict[str, Any] = {}
    plants: dict[str, Any] = {}
    bus: list[Any] = []
    steps: Annotated[list[Any], Field(min_length=1)]
    expect_trace: list[Any] = []
    expect: list[Any] = []
