# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the text of a model says what runs where, when, and for how long.

Names count without regard to case, as in the model. What is found here is text: it is there also
where the model has errors.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from ravenchart.gen.files import spans
from ravenchart.gen.files.spans import YamlScalar

from .edits import Document

TIMES = ("period", "wcet", "deadline")
"""What a row says of its time."""


@dataclass(frozen=True, slots=True)
class NamedEntry:
    """A named entry of a section: the file that it stands in, its name, and what it says."""

    file: str
    key: YamlScalar
    mapping: spans.YamlMapping

    @property
    def name(self) -> str:
        """Its name, as it is declared."""
        return self.key.value


@dataclass(frozen=True, slots=True)
class DeclaredRow:
    """What a row of a table runs: declared once, also where several instances have it.

    ``owner`` is the component, or the bus; ``keys`` are those for its times, by `TIMES`.
    """

    owner: str
    name: str
    kind: str
    """``ports``, ``region``, ``activity``, ``receive`` or ``watch``."""
    entry: NamedEntry
    keys: Mapping[str, str]

    def text(self, time: str) -> str | None:
        """What is written of a time; None where nothing is."""
        key = self.keys.get(time)
        found = None if key is None else self.entry.mapping.scalar(key)
        return None if found is None else found.value


@dataclass(frozen=True)
class ModelPlaces:
    """The files of a model by name, main file first; None where one is not YAML."""

    documents: Mapping[str, Document | None]

    def section(self, name: str) -> Iterator[NamedEntry]:
        """The entries of a section, in the order of the files."""
        for file, document in self.documents.items():
            found = None if document is None else document.root.mapping(name)
            for key, mapping in () if found is None else found.mappings():
                yield NamedEntry(file, key, mapping)

    @cached_property
    def processors(self) -> dict[str, NamedEntry]:
        """The processors, by name in lower case."""
        return self._named("processors")

    @cached_property
    def components(self) -> dict[str, NamedEntry]:
        """The components."""
        return self._named("components")

    @cached_property
    def instances(self) -> dict[str, NamedEntry]:
        """The instances."""
        return self._named("instances")

    @cached_property
    def buses(self) -> dict[str, NamedEntry]:
        """The buses."""
        return self._named("buses")

    def _named(self, section: str) -> dict[str, NamedEntry]:
        found: dict[str, NamedEntry] = {}
        for entry in self.section(section):
            found.setdefault(entry.name.lower(), entry)
        return found

    def table(self, processor: NamedEntry) -> list[YamlScalar]:
        """The rows of a processor."""
        found = processor.mapping.get("activities")
        items = found.items if isinstance(found, spans.Sequence) else []
        return [item for item in items if isinstance(item, YamlScalar)]

    def row_at(self, element: str) -> tuple[NamedEntry, int] | None:
        """The processor whose table holds a row, and its number there."""
        wanted = element.lower()
        for processor in self.processors.values():
            for number, item in enumerate(self.table(processor)):
                if item.value.lower() == wanted:
                    return processor, number
        return None

    def component_of(self, instance: str) -> NamedEntry | None:
        """The component of an instance, which may be inside others: ``arm.shoulder``."""
        first, *inner = instance.lower().split(".")
        found = self._kind(self.instances.get(first))
        for name in inner:
            inside = None if found is None else _inner(found, "instances")
            found = None if inside is None else self._kind(_inner(inside, name))
        return found

    def instances_of(self, component: NamedEntry) -> list[str]:
        """The paths of the instances of a component, also those inside others."""
        return [
            path
            for entry in self.instances.values()
            for path, kind in self._inside(entry.name, self._kind(entry), ())
            if kind.key is component.key
        ]

    def _inside(
        self, path: str, kind: NamedEntry | None, around: tuple[NamedEntry, ...]
    ) -> Iterator[tuple[str, NamedEntry]]:
        """An instance and those inside it, each with its component; no component twice."""
        if kind is None or any(one.key is kind.key for one in around):
            return
        yield path, kind
        found = kind.mapping.mapping("instances")
        for key, mapping in () if found is None else found.mappings():
            inner = self._kind(NamedEntry(kind.file, key, mapping))
            yield from self._inside(f"{path}.{key.value}", inner, (*around, kind))

    def _kind(self, instance: NamedEntry | None) -> NamedEntry | None:
        """The component that an entry of `instances` names."""
        name = None if instance is None else instance.mapping.scalar("component")
        return None if name is None else self.components.get(name.value.lower())

    def row(self, element: str) -> DeclaredRow | None:
        """What ``owner.name`` runs."""
        owner, _, name = element.lower().rpartition(".")
        component = self.component_of(owner)
        if component is not None:
            return next((one for one in self.rows(component) if one.name.lower() == name), None)
        bus = self.buses.get(owner)
        if bus is not None and name == "receive":
            return DeclaredRow(bus.name, name, name, bus, {"wcet": "driver_wcet"})
        watch = None if bus is None or name != "watch" else _inner(bus, name)
        return None if bus is None or watch is None else self._row(bus, name, name, watch)

    def rows(self, component: NamedEntry) -> Iterator[DeclaredRow]:
        """What an instance of a component has to run."""
        ports = _inner(component, "port_region")
        if ports is not None:
            yield self._row(component, "ports", "ports", ports)
        for section, kind in (("regions", "region"), ("activities", "activity")):
            found = component.mapping.mapping(section)
            for key, mapping in () if found is None else found.mappings():
                yield self._row(
                    component, key.value, kind, NamedEntry(component.file, key, mapping)
                )

    def _row(self, owner: NamedEntry, name: str, kind: str, entry: NamedEntry) -> DeclaredRow:
        return DeclaredRow(owner.name, name, kind, entry, {time: time for time in TIMES})


def _inner(around: NamedEntry, name: str) -> NamedEntry | None:
    """A mapping inside an entry."""
    found = around.mapping.entry(name)
    if found is None or not isinstance(found[1], spans.YamlMapping):
        return None
    return NamedEntry(around.file, found[0], found[1])
