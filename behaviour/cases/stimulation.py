# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The stimuli that a search can give to a system: its events, and values for its input ports."""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravenchart.behaviour.interpreter.stimuli import Arrived, Raised
from ravenchart.behaviour.rules.cells import actions, expressions
from ravenchart.behaviour.rules.outside import external_events
from ravenchart.gen.language.terms import (
    EnumerationType,
    Expression,
    IntegerType,
    Literal,
    Ns,
    Operation,
    Scalar,
    ScalarType,
    Set,
    Type,
    Value,
)
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.system import System

PartialValue = Mapping[str | None, Scalar]
"""Some fields of a value, or a scalar without a field."""

REUSED = 0.3
"""How often a number equals one that the component has at that time."""
WANTED = 0.3
"""How often a value is one that a decision needs, where one is known."""


@dataclass(frozen=True, slots=True)
class Choice:
    """An event of an instance, or an input port; ``type`` is that of the value."""

    instance: str
    name: str
    is_port: bool
    type: Type | None
    numbers: tuple[int, ...]
    """The numbers that the component compares with, and their neighbours."""
    events: tuple[str, ...] = ()
    """The events that a port raises on arrival, staleness or overflow."""
    max_age: Ns | None = None
    """The age above which a value of the port is stale."""
    wanted: tuple[PartialValue, ...] = ()
    """Values that decisions of the component need."""

    def drawn(
        self,
        at: Ns,
        chance: random.Random,
        known: PartialValue | None = None,
        present: Sequence[int] = (),
    ) -> Raised | Arrived:
        """The stimulus with a value drawn at random, more often one that matters.

        The fields that ``known`` leaves open are drawn. Now and then a number is one
        of those ``present``: a step may need two equal numbers.
        """
        value = None if self.type is None else self._value(self.type, chance, known, present)
        if self.is_port:
            assert value is not None
            return Arrived(at, End(self.instance, self.name), value)
        return Raised(at, self.instance, self.name, value)

    def _value(
        self,
        kind: Type,
        chance: random.Random,
        known: PartialValue | None,
        present: Sequence[int],
    ) -> Value:
        if known is None:
            known = {}
            if self.wanted and chance.random() < WANTED:
                known = chance.choice(self.wanted)
        if isinstance(kind, IntegerType | EnumerationType):
            return self._part(kind, chance, known.get(None), present)
        return tuple(
            (one.name, self._part(one.type, chance, known.get(one.name), present))
            for one in kind.fields
        )

    def _part(
        self, kind: ScalarType, chance: random.Random, known: Scalar | None, present: Sequence[int]
    ) -> Scalar:
        if present and isinstance(kind, IntegerType) and chance.random() < REUSED:
            inside = [number for number in present if kind.first <= number <= kind.last]
            if inside:
                return chance.choice(inside)
        return self._scalar(kind, chance) if known is None else known

    def _scalar(self, kind: ScalarType, chance: random.Random) -> Scalar:
        if isinstance(kind, EnumerationType):
            return chance.choice(kind.literals)
        inside = [number for number in self.numbers if kind.first <= number <= kind.last]
        if inside and chance.random() < 0.7:
            return chance.choice(inside)
        return chance.choice((kind.first, kind.last, chance.randint(kind.first, kind.last)))


def choices(
    system: System, wanted: Mapping[tuple[str, str], Sequence[PartialValue]] | None = None
) -> list[Choice]:
    """The stimuli that may come from outside, in model order.

    ``wanted`` has values that decisions need, by component and event or port.
    """
    fed = {connection.target for connection in system.connections}
    return [
        replace(one, wanted=tuple(_wanted(one, instance.component.name, wanted or {})))
        for instance in system.instances
        for one in _of_instance(instance, system, fed)
    ]


def _wanted(
    choice: Choice, component: str, wanted: Mapping[tuple[str, str], Sequence[PartialValue]]
) -> Iterator[PartialValue]:
    """The values that decisions need of an event or port, or of the events that a port raises."""
    for name in (choice.name, *choice.events):
        yield from wanted.get((component, name), ())


def _of_instance(instance: Instance, system: System, fed: set[End]) -> Iterator[Choice]:
    component = instance.component
    numbers = _numbers(component, instance)
    raised = external_events(component, system)
    names = {event for event, row in raised if row not in component.handlers()}
    for event in component.events:
        if event.name in names:
            yield Choice(instance.name, event.name, False, event.type, numbers)
    for port in component.inputs():
        if End(instance.name, port.name) not in fed:
            told = tuple(e for e in (port.on_arrival, port.on_stale, port.on_overflow) if e)
            yield Choice(instance.name, port.name, True, port.type, numbers, told, port.max_age)


def _numbers(component: Component, instance: Instance) -> tuple[int, ...]:
    """The numbers that a component compares with, and those beside them."""
    found = {value for _, value in instance.parameters if isinstance(value, int)}
    decided = [*expressions(component)]
    decided += [one.value for one in actions(component) if isinstance(one, Set)]
    for expression in decided:
        found.update(_literals(expression))
    return tuple(sorted({number + beside for number in found for beside in (-1, 0, 1)}))


def _literals(expression: Expression) -> Iterator[int]:
    match expression:
        case Literal(value=int(value)):
            yield value
        case Operation(operands=operands):
            for operand in operands:
                yield from _literals(operand)
