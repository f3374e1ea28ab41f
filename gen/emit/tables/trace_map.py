# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Element ids: numbers in the generated program, names and locations in trace.json.

The numbers follow model order. The rows of a processor follow its own number
directly, so that row k of the table is the processor's number + 1 + k; the
events of an instance follow each other.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

from ravenchart.gen.emit.language.configurations import Configurations
from ravenchart.gen.model.commands import Remote, RemoteRead
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin

VALUE = "value"
"""The kind of a recorded value."""

CONTROLLER_STATES = ("Stopped", "Error_Active", "Error_Passive", "Bus_Off")
"""The states of a controller, in order of number (Ravenchart.Can.Controller_State)."""


@dataclass(frozen=True, slots=True)
class MappedElement:
    """One traced element.

    ``leaves`` are the states of a region or of a bus, and ``transitions`` those of a region, in
    order of number. A recorded value has the ``literals`` of its enumeration, or the ``unit`` that
    one count of its integers stands for.
    """

    number: int
    element: str
    kind: str
    origin: Origin
    leaves: tuple[str, ...] = ()
    transitions: tuple[str, ...] = ()
    literals: tuple[str, ...] = ()
    unit: str | None = None


def elements(system: System) -> tuple[MappedElement, ...]:
    """Every traced element of the system, numbered from 1."""
    found: list[MappedElement] = []

    def add(
        element: str,
        kind: str,
        origin: Origin,
        leaves: tuple[str, ...] = (),
        transitions: tuple[str, ...] = (),
    ) -> None:
        number = len(found) + 1
        found.append(MappedElement(number, element, kind, origin, leaves, transitions))

    for processor in system.processors:
        add(processor.name, "processor", processor.origin)
        for slot in processor.slots:
            add(slot.element, "row", slot.origin)
    for instance in system.instances:
        component = instance.component
        for port in component.ports:
            add(f"{instance.name}.{port.name}", "port", port.origin)
        for binding in system.bindings:
            need = binding.need
            provider = binding.provider
            late = isinstance(provider, RemoteRead)
            late = late or (need.is_part and isinstance(provider, Remote) and bool(provider.reply))
            if binding.instance == instance.name and late:
                add(f"{instance.name}.{need.name}", "port", need.origin)
        for provided in component.provides:
            if provided.server is not None:
                add(f"{instance.name}.{provided.name}", "port", provided.origin)
        for event in component.events:
            add(f"{instance.name}.{event.name}", "event", event.origin)
        for region in component.regions:
            chart = Configurations(region)
            for one in reversed(chart.concurrent):
                fired = () if one.owner else tuple(f.name for f in chart.compounds.firings)
                add(
                    f"{instance.name}.{chart.traced(one)}",
                    "region",
                    region.origin,
                    leaves=chart.literals(one),
                    transitions=fired,
                )
    for message in system.messages:
        add(message.name, "message", message.origin)
    found += _controllers(system, len(found))
    return (*found, *_values(system, len(found)))


def _controllers(system: System, last: int) -> tuple[MappedElement, ...]:
    """The controllers of each bus with `watch`, ``node.bus``, numbered behind ``last``."""
    watched = [bus for bus in system.buses if bus.watch is not None]
    homes = [(b, n) for b, n in product(watched, system.nodes) if system.joins(b.name, n.name)]
    return tuple(
        MappedElement(
            number, f"{node.name}.{bus.name}", "bus", bus.origin, leaves=CONTROLLER_STATES
        )
        for number, (bus, node) in enumerate(homes, last + 1)
    )


def _values(system: System, last: int) -> Iterator[MappedElement]:
    """The recorded values, numbered behind ``last``."""
    for number, one in enumerate(system.recorded_values, last + 1):
        yield MappedElement(
            number,
            one.element,
            VALUE,
            one.of.item.origin,
            literals=one.literals,
            unit=one.unit,
        )


def trace_json(system: System) -> str:
    """The map from numbers to names and model lines, and the digest of the model."""
    rows = []
    for item in elements(system):
        row: dict[str, object] = {
            "id": item.number,
            "element": item.element,
            "kind": item.kind,
            "origin": _location(item.origin, system.origin),
        }
        if item.kind == "region":
            row |= {"leaves": item.leaves, "transitions": item.transitions}
        if item.kind == "bus":
            row["leaves"] = item.leaves
        if item.literals:
            row["literals"] = item.literals
        if item.unit is not None:
            row["unit"] = item.unit
        rows.append(row)
    document: dict[str, object] = {"system": system.name, "digest": system.digest}
    if system.libraries:
        document["libraries"] = [
            {"name": one.name, "version": one.version, "digest": one.digest}
            for one in system.libraries
        ]
    if system.most_cores > 1:
        document["cores"] = system.most_cores
    document["elements"] = rows
    return json.dumps(document, indent=1, ensure_ascii=True) + "\n"


def _location(origin: Origin, model: Origin) -> str:
    """Where an element stands, from the model's folder: the same wherever that is."""
    return f"{origin.beside(model)}:{origin.column}"
