"""A scenario: the drives on the bench, and what the operator does, step by step.

Read from YAML and checked as a whole before anything runs. Quantities carry their
unit (``430 mm``, ``1 mm/s``, ``8 s``); inside they are m, m/s and s.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

import yaml
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError

from .plant import Axis

_QUANTITY = re.compile(r"(-?\d+(?:\.\d+)?) ?([a-z/]+)")
_LENGTHS = {"um": 1e-6, "mm": 1e-3, "m": 1.0}
_SPEEDS = {"um/s": 1e-6, "mm/s": 1e-3, "m/s": 1.0}
_TIMES = {"us": 1e-6, "ms": 1e-3, "s": 1.0}


class ScenarioError(Exception):
    """A scenario that cannot be run: one line for each mistake, with file and line."""


def _quantity(value: object, units: Mapping[str, float]) -> float:
    """A number with one of ``units``, in the unit whose factor is 1."""
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None or match[2] not in units:
        known = [*units]
        raise ValueError(f"expected a number and one of {', '.join(known)}, such as 5 {known[1]}")
    return float(match[1]) * units[match[2]]


Length = Annotated[float, BeforeValidator(lambda value: _quantity(value, _LENGTHS))]
Speed = Annotated[float, BeforeValidator(lambda value: _quantity(value, _SPEEDS))]
Time = Annotated[float, BeforeValidator(lambda value: _quantity(value, _TIMES)), Field(ge=0)]
Scalar = bool | int | str
Signal = Annotated[str, Field(pattern=r"^\w+\.\w+$")]
"""``message.field``"""
Element = Annotated[str, Field(pattern=r"^\w+\.\w+$")]
"""``owner.name``: a region or port of the controller."""


class _Form(BaseModel):
    """Unknown keys are mistakes."""

    model_config = ConfigDict(extra="forbid", frozen=True, populate_by_name=True)


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
    states: Element | None = None
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


class Send(_Form):
    """Send one message to the controller."""

    send: str
    fields: dict[str, Scalar] = Field(alias="with")

    def __str__(self) -> str:
        return f"send {self.send}: {_values(self.fields)}"


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


Step = Send | WaitFor | Expect | ExpectStop | Wait | Pull | Release | StopFeedback | KillBench
STEPS: Mapping[str, type[Step]] = {
    "send": Send,
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


class TraceCheck(_Form):
    """After the run, the controller's trace must show that a region reached a state.

    With ``within`` the state was entered at most that long after the last arrival at
    the port ``after_last``, or after the one before the longest silence at the port
    ``after_silence``. With ``then`` it went on to that state later.
    """

    region: Element
    reaches: str
    within: Time | None = None
    after_last: Element | None = None
    after_silence: Element | None = None
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


class _File(_Form):
    """The whole file; its steps are checked one by one."""

    scenario: str
    drives: dict[str, DriveForm] = {}
    bus: list[Cut | Mend] = []
    steps: Annotated[list[dict[str, Any]], Field(min_length=1)]
    expect_trace: list[TraceCheck] = []


@dataclass(frozen=True, slots=True)
class Scenario:
    """A scenario that fits together. ``lines`` are those of the steps in the file."""

    title: str
    drives: Mapping[str, DriveForm]
    steps: tuple[Step, ...]
    lines: tuple[int, ...]
    trace_checks: tuple[TraceCheck, ...]
    bus_events: tuple[Cut | Mend, ...] = ()
    """What happens on the bus between several nodes; times in s since it was started."""


def load_scenario(path: Path) -> Scenario:
    """The scenario in a file; ScenarioError tells everything that is wrong with it."""
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as fault:
        raise ScenarioError(f"{path}: error: cannot be read: {fault}") from None
    return parse_scenario(text, path.name)


def parse_scenario(text: str, file: str = "scenario.yaml") -> Scenario:
    """The scenario in ``text``; ScenarioError tells everything that is wrong with it."""
    try:
        root = yaml.compose(text, Loader=yaml.SafeLoader)
        content = yaml.safe_load(text)
    except yaml.MarkedYAMLError as fault:
        line = fault.problem_mark.line + 1 if fault.problem_mark else 1
        raise ScenarioError(f"{file}:{line}: error: {fault.problem}") from None
    if not isinstance(content, dict):
        raise ScenarioError(f"{file}:1: error: a scenario is a mapping")
    problems: list[tuple[int, str]] = []

    def note(fault: ValidationError, where: tuple[int | str, ...] = ()) -> None:
        for item in fault.errors():
            place = (*where, *item["loc"])
            name = ".".join(str(part) for part in place)
            message = item["msg"].removeprefix("Value error, ")
            problems.append((_line(root, place), f"{name}: {message}"))

    try:
        form = _File.model_validate(content)
    except ValidationError as fault:
        note(fault)
        raise _failure(file, problems) from None
    steps: list[Step] = []
    for index, raw in enumerate(form.steps):
        kinds = [key for key in raw if key in STEPS]
        if len(kinds) != 1:
            line = _line(root, ("steps", index))
            problems.append((line, f"steps.{index}: exactly one of {', '.join(STEPS)} is wanted"))
            continue
        try:
            steps.append(STEPS[kinds[0]].model_validate(raw))
        except ValidationError as fault:
            note(fault, ("steps", index))
    for place, message in _misfits(form, steps):
        problems.append((_line(root, place), message))
    if problems:
        raise _failure(file, problems)
    lines = tuple(_line(root, ("steps", index)) for index in range(len(steps)))
    return Scenario(
        form.scenario,
        form.drives,
        tuple(steps),
        lines,
        tuple(form.expect_trace),
        tuple(form.bus),
    )


def _misfits(form: _File, steps: list[Step]) -> Iterator[tuple[tuple[int | str, ...], str]]:
    """What does not fit together: impossible axes, steps about unknown drives."""
    for name, drive in form.drives.items():
        try:
            drive.axis()
        except ValueError as fault:
            yield ("drives", name), f"drives.{name}: {fault}"
    if len(steps) < len(form.steps):
        return
    for index, step in enumerate(steps):
        for name in _drives_of(step):
            if name not in form.drives:
                yield ("steps", index), f"steps.{index}: there is no drive {name}"
    for index, check in enumerate(form.expect_trace):
        place = ("expect_trace", index)
        if (check.within is None) != (check.port is None):
            what = "within and after_last or after_silence go together"
            yield place, f"expect_trace.{index}: {what}"
        if check.after_last is not None and check.after_silence is not None:
            yield place, f"expect_trace.{index}: after_last or after_silence, not both"
    times = [event.at for event in form.bus]
    for index, (one, other) in enumerate(pairwise(times), 1):
        if other <= one:
            yield ("bus", index), f"bus.{index}: comes no later than the event before it"


def _drives_of(step: Step) -> tuple[str, ...]:
    """The drives that a step names."""
    match step:
        case Expect():
            return tuple(step.expect)
        case ExpectStop():
            return (step.expect_stop,)
        case Pull():
            return (step.pull,)
        case Release():
            return (step.release,)
        case StopFeedback() if step.stop_feedback != "all":
            return (step.stop_feedback,)
    return ()


def _line(node: yaml.Node | None, place: tuple[int | str, ...]) -> int:
    """The line of the innermost node on the way to ``place``, from 1."""
    line = 1
    for part in place:
        if node is None:
            break
        line = node.start_mark.line + 1
        below: yaml.Node | None = None
        if isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                if key.value == str(part):
                    below, line = value, key.start_mark.line + 1
        elif isinstance(node, yaml.SequenceNode) and isinstance(part, int):
            below = node.value[part]
            line = node.value[part].start_mark.line + 1
        node = below
    return line


def _failure(file: str, problems: list[tuple[int, str]]) -> ScenarioError:
    """One line for each problem, in the order of the file."""
    return ScenarioError("\n".join(f"{file}:{n}: error: {text}" for n, text in sorted(problems)))


def _values(fields: Mapping[str, object]) -> str:
    """``a 1, b 2``"""
    return ", ".join(f"{name} {value}" for name, value in fields.items())
