# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A scenario: the drives on the bench, and the steps of the operator.

A scenario is read from YAML and checked as a whole before anything runs. Quantities carry
their unit (``430 mm``, ``1 mm/s``, ``8 s``); inside they are m, m/s and s.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import TypeVar

from pydantic import BaseModel

from ravenchart.gen.diagnostics import error, render
from ravenchart.gen.files.located import FormPath, grow
from ravenchart.gen.language.names import nearest_hint
from ravenchart.gen.origins import Origin

from .forms import (
    BUS_EVENTS,
    EXPECTED,
    BusEvent,
    DriveForm,
    Expected,
    PlantForm,
    TraceCheck,
    WholeForm,
)
from .plant_stations import outgoing
from .quantities import PERIOD
from .reading import KEYS, MISFIT, UNKNOWN, VALUES, Source, keys_of_form, rendered
from .replay import fault_of_log
from .steps import (
    STEPS,
    Expect,
    ExpectOutput,
    ExpectStop,
    Pull,
    Release,
    Replay,
    ScenarioStep,
    SetInput,
    StopFeedback,
)

TINY = 1e-6
"""Rounding of a ratio of times."""


class ScenarioError(Exception):
    """A scenario that cannot be run: every mistake, with file, line, column, code and hint."""


@dataclass(frozen=True, slots=True)
class Scenario:
    """A scenario that fits together. ``lines`` are those of the steps in the file."""

    title: str
    drives: Mapping[str, DriveForm]
    steps: tuple[ScenarioStep, ...]
    lines: tuple[int, ...]
    trace_checks: tuple[TraceCheck, ...]
    bus_events: tuple[BusEvent, ...] = ()
    """The events on the bus between several nodes; times in s since the bus was started."""
    expected: tuple[Expected, ...] = ()
    """Faults that the run shall or may show; any other one fails it."""
    plants: Mapping[str, PlantForm] = field(default_factory=dict)
    source: Source | None = None
    """The file, for the locations of errors."""

    def file_of(self, step: Replay) -> Path:
        """The log that a step replays."""
        return self.folder / step.replay

    def simulated(self) -> frozenset[str]:
        """The messages that drives and plants send."""
        drives = {one.feedback for one in self.drives.values()}
        return frozenset(drives.union(*(outgoing(one) for one in self.plants.values())))

    @property
    def folder(self) -> Path:
        """The folder of the file, in which the files that it names are searched for."""
        assert self.source is not None
        return Path(self.source.file).parent


def load_scenario(path: Path) -> Scenario:
    """The scenario in a file; ScenarioError has all errors of the file."""
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
    """The scenario in ``text``; ScenarioError has all errors of the text."""
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
    plants = {name: source.read(PlantForm, v, ("plants", name)) for name, v in form.plants.items()}
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
        {name: one for name, one in plants.items() if one is not None},
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
        hint = "write an entry for each" if given else _meant(kinds, [str(key) for key in raw])
        source.wrong(KEYS, path, message, hint)
        return None
    return source.read(kinds[given[0]], raw, path)


def _meant(kinds: Mapping[str, type[Kind]], keys: list[str]) -> str | None:
    """A hint for keys of which one is a slip: the nearest one of a form that has all others."""
    for key in keys:
        others = {one for one in keys if one != key}
        fitting = [kind for kind, form in kinds.items() if others <= {*keys_of_form(form)}]
        if hint := nearest_hint(key, fitting):
            return hint
    return None


def _fit_together(scenario: Scenario, source: Source) -> None:
    """Report impossible axes, steps about unknown drives, times out of order."""
    for name, drive in scenario.drives.items():
        try:
            drive.axis()
        except ValueError as fault:
            source.wrong(MISFIT, ("drives", name), f"the drive {name} cannot be: {fault}", key=True)
    for name, plant in scenario.plants.items():
        _check_plant(name, plant, scenario, source)
    _check_steps(scenario, source)
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


def _check_steps(scenario: Scenario, source: Source) -> None:
    """Logs that can be read, drives and plants that are there, ranges that are not empty."""
    for index, step in enumerate(scenario.steps):
        if isinstance(step, Replay) and (told := fault_of_log(scenario.file_of(step))):
            source.wrong(VALUES, ("steps", index, "replay"), told)
        for path, name, kinds in _named_in(step):
            known = [one for kind in kinds for one in getattr(scenario, kind)]
            if name not in known:
                both = " or ".join(kind[:-1] for kind in kinds)
                message = f"there is no {both} `{name}`"
                none = f"the scenario has no `{kinds[0]}`"
                hint = f"the {kinds[0]} are {', '.join(known)}" if known else none
                source.wrong(UNKNOWN, ("steps", index, *path), message, hint, key=len(path) > 1)
        if isinstance(step, ExpectOutput):
            _check_range(step, ("steps", index), source)


def _check_plant(name: str, plant: PlantForm, scenario: Scenario, source: Source) -> None:
    """One source of the plant, a period on the grid of the bench, a name of its own."""
    place = ("plants", name)
    if (plant.plant_class is None) == (plant.fmu is None):
        source.wrong(KEYS, place, "must have exactly one of `class` and `fmu`", key=True)
    ticks = plant.period / PERIOD
    if round(ticks) < 1 or abs(ticks - round(ticks)) > TINY:
        told = (
            f"{plant.period * 1e3:g} ms is no multiple of {PERIOD * 1e3:g} ms, the bench's period"
        )
        source.wrong(VALUES, (*place, "period"), told)
    if name in scenario.drives:
        source.wrong(MISFIT, place, f"`{name}` is a drive too", "choose another name", key=True)


def _check_range(step: ExpectOutput, place: FormPath, source: Source) -> None:
    """A value or a range, not empty."""
    bounds = (step.at_least, step.at_most)
    if (step.value is None) == (bounds == (None, None)):
        told = "give `is`, or `at_least` or `at_most` or both"
        source.wrong(MISFIT, place, told)
    elif None not in bounds and bounds[0] > bounds[1]:  # type: ignore[operator]
        source.wrong(MISFIT, place, f"no value is at least {bounds[0]:g} and at most {bounds[1]:g}")


def _named_in(step: ScenarioStep) -> Iterator[tuple[FormPath, str, tuple[str, ...]]]:
    """The drives and plants that a step names, where, and which of the two they may be."""
    drives, plants = ("drives",), ("plants",)
    match step:
        case Expect():
            yield from ((("expect", name), name, drives) for name in step.expect)
        case ExpectStop():
            yield ("expect_stop",), step.expect_stop, drives
        case Pull():
            yield ("pull",), step.pull, drives
        case Release():
            yield ("release",), step.release, drives
        case StopFeedback() if step.stop_feedback != "all":
            yield ("stop_feedback",), step.stop_feedback, (*drives, *plants)
        case SetInput():
            yield ("set",), step.plant, plants
        case ExpectOutput():
            yield ("expect_output",), step.plant, plants
