# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Functional Mock-up Units as plants: FMI 2.0 and 3.0, co-simulation, by FMPy.

The unit goes on in steps of a fixed length, from time 0. Its inputs and tunable parameters are
inputs of the plant, its outputs and local variables are outputs.
"""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .peer import Value
from .plants import Plant, PlantError, faults_of

WHOLE = ("Int8", "UInt8", "Int16", "UInt16", "Int32", "UInt32", "Int64", "UInt64", "Integer")
REALS = ("Float32", "Float64", "Real")
LATE = 1e-9
"""s by which a step may end after the requested time: rounding."""


def loaded(path: Path, parameters: Mapping[str, Value], step: float) -> Plant:
    """The unit in a file, ready at time 0; ``step`` in s. PlantError where it cannot be had."""
    if not path.is_file():
        raise PlantError(f"there is no file {path}")
    try:
        import fmpy
    except ImportError:
        told = "an FMU needs FMPy, which is not installed: python -m pip install fmpy"
        raise PlantError(told) from None
    with faults_of(path.name):
        description = fmpy.read_model_description(str(path))
        if description.coSimulation is None:
            raise PlantError(f"{path.name} is not made for co-simulation")
        if description.fmiVersion.partition(".")[0] not in ("2", "3"):
            raise PlantError(
                f"{path.name} is of FMI {description.fmiVersion}; 2.0 and 3.0 are known"
            )
        return _Unit(path, description, parameters, step)


class _Unit(Plant):
    """One instance of a unit."""

    def __init__(
        self, path: Path, description: Any, parameters: Mapping[str, Value], step: float
    ) -> None:
        from fmpy import extract
        from fmpy.simulation import instantiate_fmu

        self._variables = {one.name: one for one in description.modelVariables}
        self.inputs = tuple(n for n, v in self._variables.items() if _may_be_set(v))
        self.outputs = tuple(
            n for n, v in self._variables.items() if v.causality in ("output", "local")
        )
        wrong = [n for n in parameters if n not in self._variables]
        if wrong:
            raise PlantError(f"{path.name} has no variable `{wrong[0]}`")
        self._new = description.fmiVersion.startswith("3")
        self._step, self._steps = step, 0
        self._folder = extract(str(path))
        self._unit = instantiate_fmu(self._folder, description, fmi_type="CoSimulation")
        if not self._new:
            self._unit.setupExperiment(startTime=0.0)
        for name, value in parameters.items():
            self._set(self._variables[name], value)
        self._unit.enterInitializationMode()
        self._unit.exitInitializationMode()

    def take(self, name: str, value: Value) -> None:
        self._set(self._variables[name], value)

    def advance(self, until: float) -> None:
        while (self._steps + 1) * self._step <= until + LATE:
            begins = self._steps * self._step
            self._unit.doStep(currentCommunicationPoint=begins, communicationStepSize=self._step)
            self._steps += 1

    def value(self, name: str) -> Value:
        variable = self._variables[name]
        getter = getattr(self._unit, f"get{self._kind(variable)}")
        (found,) = getter([variable.valueReference])[:1]
        if variable.type == "Enumeration":
            return _literal(variable, int(found))
        if variable.type == "Boolean":
            return int(bool(found))
        if variable.type in WHOLE:
            return int(found)
        return float(found) if variable.type in REALS else str(found)

    def close(self) -> None:
        self._unit.terminate()
        self._unit.freeInstance()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _set(self, variable: Any, value: Value) -> None:
        put = getattr(self._unit, f"set{self._kind(variable)}")
        put([variable.valueReference], [_converted(variable, value)])

    def _kind(self, variable: Any) -> str:
        """The type in the name of the function that reads or writes the variable."""
        if variable.type == "Enumeration":
            return "Int64" if self._new else "Integer"
        return str(variable.type)


def _may_be_set(variable: Any) -> bool:
    """Whether a variable may be set during the simulation: an input, or a tunable parameter.

    FMI 3.0, 2.4.7.4."""
    tunable = variable.causality == "parameter" and variable.variability == "tunable"
    return bool(variable.causality == "input" or tunable)


def _literal(variable: Any, number: int) -> Value:
    """The name of a literal; its number where the unit has no name for it."""
    items = variable.declaredType.items if variable.declaredType is not None else ()
    return next((str(item.name) for item in items if int(item.value) == number), number)


def _converted(variable: Any, value: Value) -> object:
    """A value in the type of the unit's variable; PlantError for one that it cannot have."""
    try:
        if variable.type == "Enumeration" and isinstance(value, str):
            return next(int(i.value) for i in variable.declaredType.items if i.name == value)
        if variable.type in WHOLE or variable.type == "Enumeration":
            return int(value)
        if variable.type == "Boolean":
            return value not in (0, "0", "False", "false")
        return float(value) if variable.type in REALS else str(value)
    except (ValueError, StopIteration, AttributeError):
        raise PlantError(f"{variable.name} cannot be `{value}`: it is a {variable.type}") from None
