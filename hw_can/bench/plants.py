# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Plants of the bench that users bring: the class to derive from, and its loading from a file.

A plant is the process that the controller acts on. It takes values of messages that the controller
sends, and gives the values of messages that it receives. A file beside the scenario has the class:

    from ravenchart.hw_can.bench.plants import Plant

    class Tank(Plant):
        inputs = ("inflow",)
        outputs = ("level",)

        def __init__(self, parameters):
            self.area = parameters.get("area", 1.0)
            self.inflow = self.level = self.time = 0.0

        def take(self, name, value):
            self.inflow = value

        def advance(self, until):
            self.level += self.inflow * (until - self.time) / self.area
            self.time = until

        def value(self, name):
            return self.level
"""

from __future__ import annotations

import importlib.util
import sys
import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from .peer import BenchError, Value

Outcome = TypeVar("Outcome")


class Plant(ABC):
    """The process that a controller acts on. One thread calls it, and times only grow.

    Values are those of the CAN database: whole numbers in the units of the model, numbers with
    a fraction where the database scales, names of literals.
    """

    inputs: Sequence[str] = ()
    """Names that `take` knows: messages or the step `set` may give their values."""
    outputs: Sequence[str] = ()
    """Names that `value` knows: messages or the step `expect_output` may ask for their values."""

    @abstractmethod
    def __init__(self, parameters: Mapping[str, Value]) -> None:
        """Power on at time 0, with the ``parameters`` of the scenario; ValueError for wrong ones.

        The bench may make and close it several times before the run, to check the scenario.
        """

    @abstractmethod
    def take(self, name: str, value: Value) -> None:
        """Give this value to an input from now on; ``advance`` was called up to now before."""

    @abstractmethod
    def advance(self, until: float) -> None:
        """Go on to ``until``, in s since power-on, with the inputs as they are."""

    @abstractmethod
    def value(self, name: str) -> Value:
        """The value of an output at the time advanced to."""

    def close(self) -> None:  # noqa: B027 - most plants hold nothing
        """Power off: nothing is called after it."""


class PlantError(ValueError):
    """A plant that cannot be loaded; the text has the reason."""


class PlantFaultError(BenchError):
    """The code of a plant raised during a run; the text has its line."""


def loaded(reference: str, folder: Path, parameters: Mapping[str, Value]) -> Plant:
    """The plant of ``FILE.py:CLASS``, a file below ``folder``; PlantError."""
    name, _, kind = reference.partition(":")
    found = _class(folder / name, kind)
    with faults_of(name):
        plant = found(parameters)
    assert isinstance(plant, Plant)
    return plant


def _class(path: Path, name: str) -> Callable[[Mapping[str, Value]], object]:
    if not path.is_file():
        raise PlantError(f"there is no file {path}")
    spec = importlib.util.spec_from_file_location(f"ravenchart_plant_{path.stem}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    sys.path.insert(0, str(path.parent))  # for the modules beside it
    try:
        with faults_of(path.name):
            spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(path.parent))
    found = getattr(module, name, None)
    if not isinstance(found, type):
        raise PlantError(f"{path.name} has no class `{name}`")
    if not issubclass(found, Plant):
        raise PlantError(f"{name} is not derived from ravenchart.hw_can.bench.plants.Plant")
    missing = sorted(found.__abstractmethods__)
    if missing:
        raise PlantError(f"{name} does not define `{missing[0]}`")
    return found


@contextmanager
def faults_of(name: str, kind: type[Exception] = PlantError) -> Iterator[None]:
    """Turn an exception of a plant's code into a ``kind`` with its line: a user wrote the code."""
    try:
        yield
    except (PlantError, BenchError):
        raise
    except Exception as fault:
        own = [
            frame.lineno
            for frame in traceback.extract_tb(fault.__traceback__)
            if Path(frame.filename).name == name
        ]
        if isinstance(fault, SyntaxError):
            own = [fault.lineno]
        where = f"{name}:{own[-1]}" if own else f"{name}"
        text = fault.msg if isinstance(fault, SyntaxError) else str(fault)
        raise kind(f"{where}: {type(fault).__name__}: {text}") from fault
