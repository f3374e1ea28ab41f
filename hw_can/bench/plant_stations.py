# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Plants on the bench: their values from and to the messages of the bus."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from . import fmi, plants
from .forms import PlantForm
from .peer import FrameValues, Peer, Value
from .plants import Plant, PlantFaultError, faults_of


def plant_of(form: PlantForm, folder: Path) -> Plant:
    """The plant of a scenario in ``folder``; PlantError where it cannot be had."""
    if form.fmu is not None:
        return fmi.loaded(folder / form.fmu, form.parameters, form.step)
    assert form.plant_class is not None
    return plants.loaded(form.plant_class, folder, form.parameters)


@dataclass(slots=True)
class PlantTrack:
    """The outputs of a plant: times in s from the bench's start, a number for each time."""

    time: list[float] = field(default_factory=list)
    values: dict[str, list[float]] = field(default_factory=dict)


@dataclass(slots=True)
class PlantStation:
    """One plant with its messages; a fault of its code is a PlantFaultError that names its line."""

    name: str
    form: PlantForm
    plant: Plant
    track: PlantTrack = field(default_factory=PlantTrack)
    silent: bool = False

    def take(self, message: str, values: FrameValues) -> None:
        """Take a message of the controller."""
        for name, signal in self.form.inputs.items():
            owner, _, wanted = signal.partition(".")
            if owner == message and wanted in values:
                self.set(name, values[wanted])

    def set(self, name: str, value: Value) -> None:
        """Give this value to an input."""
        with faults_of(self.file, PlantFaultError):
            self.plant.take(name, value)

    def advance(self, until: float) -> None:
        """Go on to that time, in s."""
        with faults_of(self.file, PlantFaultError):
            self.plant.advance(until)

    def value(self, name: str) -> Value:
        """The value of an output now."""
        with faults_of(self.file, PlantFaultError):
            return self.plant.value(name)

    def send(self, peer: Peer, now: float, grid: float) -> None:
        """Send the messages that are due at ``now``, a multiple of ``grid``; both in s."""
        if self.silent or round(now / grid) % round(self.form.period / grid):
            return
        for message, fields in outgoing(self.form).items():
            peer.send(message, {name: _whole(self.value(out)) for name, out in fields.items()})

    def record(self, now: float) -> None:
        """Add an entry to the track."""
        self.track.time.append(now)
        for name in dict.fromkeys(self.form.outputs.values()):
            value = self.value(name)
            if isinstance(value, (int, float)):
                self.track.values.setdefault(name, []).append(float(value))

    def close(self) -> None:
        """Power off."""
        with faults_of(self.file, PlantFaultError):
            self.plant.close()

    @property
    def file(self) -> str:
        """The name of the file that it is from."""
        return (self.form.fmu or self.form.plant_class or "").partition(":")[0]


def outgoing(form: PlantForm) -> Mapping[str, Mapping[str, str]]:
    """The messages that a plant sends: of each the output that fills a field."""
    found: dict[str, dict[str, str]] = {}
    for signal, output in form.outputs.items():
        message, _, name = signal.partition(".")
        found.setdefault(message, {})[name] = output
    return found


def _whole(value: Value) -> Value:
    """A number without a fraction as a whole number, which fields with named values need."""
    return int(value) if isinstance(value, float) and value.is_integer() else value
