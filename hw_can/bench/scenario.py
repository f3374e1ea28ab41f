# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A scenario: the drives on the bench, and what the operator does, step by step.

Read from YAML and checked as a whole before anything runs. Quantities carry their
unit (``430 mm``, ``1 mm/s``, ``8 s``); inside they are m, m/s and s.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field

from ravenchart.gen.diagnostics import error, render
from ravenchart.gen.files.located import FormPath, grow
from ravenchart.gen.language.names import LONGEST_REQUIREMENT, REQUIREMENT
from ravenchart.gen.origins import Origin

from .plant import Axis
from .protection import Wrong
from .quantities import Length, Scalar, Speed, Time
from .reading import KEYS, MISFIT, UNKNOWN, VALUES, Source, rendered
from .replay import fault_of_log


class ScenarioError(Exception):
    """A scenario that cannot be run: every mistake, with file, line, column, code and hint."""


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


@dataclass(frozen=True, slots=True)
class Scenario:
    """A scenario that fits together. ``lines`` are those of the steps in the file."""

    title: str
    drives: Mapping[str, DriveForm]
    steps: tuple[ScenarioStep, ...]
    lines: tuple[int, ...]
    trace_checks: tuple[TraceCheck, ...]
    bus_events: tuple[BusEvent, ...] = ()
    """What happens on the bus between several nodes; times in s since it was started."""
    expected: tuple[Expected, ...] = ()
    """Faults that the run shall or may show; any other one fails it."""
    source: Source | None = None
    """The file, to say where something stands."""

    def file_of(self, step: Replay) -> Path:
        """The log that a step replays."""
        assert self.source is not None
        return Path(self.source.file).parent / step.replay


def load_scenario(path: Path) -> Scenario:
    """The scenario in a file; ScenarioError tells everything that is wrong with it."""
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise _unreadable(path, "it is not UTF-8 text") from None
    except OSError as fault:
        raise _unreadable(path, (fault.strerror or str(fault)).lower()) from None
    return parse_scenario(text, str(path))


def _unreadable(path: Path, reason: str) -> ScenarioError:
    origin = Origin(str(path), 1, 1)
    return ScenarioError(render(error("RV-1301", origin, f"cannot read {path}: {reason}"), {}))


def parse_scenario(text: str, file: str = "scenario.yaml") -> Scenario:
    """The scenario in ``text``; ScenarioError tells everything that is wrong with it."""
    tree, found = grow(text, file)
    if tree is None and all(one.code in ("RV-0104", "RV-0203") for one in found):
        hint = "start with `scenario: A title` and `steps:`"
        found = [error("RV-1301", Origin(file, 1, 1), "a scenario is a mapping", hint=hint)]
    if tree is None or found:
        raise ScenarioError(rendered(found, file, text))
    source = Source(file, text, tree)
    form = source.read(WholeForm, tree, ())
    if form is None:
        raise ScenarioError(source.told())
    drives = {name: source.read(DriveForm, v, ("drives", name)) for name, v in form.drives.items()}
    steps = [_one_of(source, STEPS, raw, ("steps", n)) for n, raw in enumerate(form.steps)]
    bus = [_one_of(source, BUS_EVENTS, raw, ("bus", n)) for n, raw in enumerate(form.bus)]
    checks = [
        source.read(TraceCheck, raw, ("expect_trace", n)) for n, raw in enumerate(form.expect_trace)
    ]
    expected = [_one_of(source, EXPECTED, raw, ("expect", n)) for n, raw in enumerate(form.expect)]
    scenario = Scenario(
        form.scenario,
        {name: one for name, one in drives.items() if one is not None},
        tuple(one for one in steps if one is not None),
        tuple(source.at(("steps", index)).line for index in range(len(steps))),
        tuple(one for one in checks if one is not None),
        tuple(one for one in bus if one is not None),
        tuple(one for one in expected if one is not None),
        source,
    )
    if not source.found:
        _fit_together(scenario, source)
    if source.found:
        raise ScenarioError(source.told())
    return scenario


Kind = TypeVar("Kind", bound=BaseModel)


def _one_of(
    source: Source, kinds: Mapping[str, type[Kind]], raw: object, path: FormPath
) -> Kind | None:
    """A form that one of its keys tells from the others."""
    known = ", ".join(f"`{key}`" for key in kinds)
    if not isinstance(raw, dict):
        source.wrong(VALUES, path, "this must be a mapping, `{key: value}`", f"one of {known}")
        return None
    given = [key for key in raw if key in kinds]
    if len(given) != 1:
        found = " and ".join(f"`{key}`" for key in given) or "none of them"
        message = f"must have exactly one of {known}; found {found}"
        source.wrong(KEYS, path, message)
        return None
    return source.read(kinds[given[0]], raw, path)


def _fit_together(scenario: Scenario, source: Source) -> None:
    """Report impossible axes, steps about unknown drives, times out of order."""
    for name, drive in scenario.drives.items():
        try:
            drive.axis()
        except ValueError as fault:
            source.wrong(MISFIT, ("drives", name), f"the drive {name} cannot be: {fault}", key=True)
    known = ", ".join(scenario.drives)
    hint = f"the drives are {known}" if known else "the scenario has no `drives`"
    for index, step in enumerate(scenario.steps):
        if isinstance(step, Replay) and (told := fault_of_log(scenario.file_of(step))):
            source.wrong(VALUES, ("steps", index, "replay"), told)
        for path, name in _drives_of(step):
            if name not in scenario.drives:
                message = f"there is no drive `{name}`"
                source.wrong(UNKNOWN, ("steps", index, *path), message, hint, key=len(path) > 1)
    for index, check in enumerate(scenario.trace_checks):
        place = ("expect_trace", index)
        if (check.within is None) != (check.port is None):
            message = "`within` needs one of `after_last` and `after_silence`, and they need it"
            source.wrong(MISFIT, place, message)
        if check.after_last is not None and check.after_silence is not None:
            source.wrong(MISFIT, place, "give `after_last` or `after_silence`, not both")
    for index, known_fault in enumerate(scenario.expected):
        if (known_fault.times is None) == (known_fault.at_most is None):
            source.wrong(MISFIT, ("expect", index), "give `times` or `at_most`, one of them")
    for index, (one, other) in enumerate(pairwise(scenario.bus_events), 1):
        if other.at <= one.at:
            message = f"{other.at:g} s is not after {one.at:g} s of the event above"
            hint = "put the events in order of time"
            source.wrong(MISFIT, ("bus", index, "at"), message, hint)


def _drives_of(step: ScenarioStep) -> Iterator[tuple[FormPath, str]]:
    """The drives that a step names, and where."""
    match step:
        case Expect():
            yield from ((("expect", name), name) for name in step.expect)
        case ExpectStop():
            yield ("expect_stop",), step.expect_stop
        case Pull():
            yield ("pull",), step.pull
        case Release():
            yield ("release",), step.release
        case StopFeedback() if step.stop_feedback != "all":
            yield ("stop_feedback",), step.stop_feedback


def _values(fields: Mapping[str, object]) -> str:
    """``a 1, b 2``"""
    return ", ".join(f"{name} {value}" for name, value in fields.items())
