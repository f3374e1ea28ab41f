# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Where the text of a model says what runs where, when, and for how long.

Names count without regard to case, as in the model. Only the text counts here, so a model with
errors has these locations, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property

from ravenchart.gen.files import spans
from ravenchart.gen.files.arrays import ALL, elements_of
from ravenchart.gen.files.located import scalar_value
from ravenchart.gen.files.schema_deployment import LARGEST_ARRAY
from ravenchart.gen.files.spans import YamlScalar

from .edits import Document

TIMES = ("period", "wcet", "deadline")
"""The keys of a row's times."""


@dataclass(frozen=True, slots=True)
class NamedEntry:
    """A named entry of a section: its file, its name, and its mapping."""

    file: str
    key: YamlScalar
    mapping: spans.YamlMapping

    @property
    def name(self) -> str:
        """Its name, as it is declared."""
        return self.key.value

    @property
    def is_array(self) -> bool:
        """Whether it is an instance with `count`."""
        return self.mapping.scalar("count") is not None

    @property
    def elements(self) -> tuple[str, ...]:
        """The names of the instances that an entry of `instances` is."""
        count = self.mapping.scalar("count")
        size = scalar_value(count.value) if count is not None else None
        if not isinstance(size, int):
            return (self.name,)
        return elements_of(self.name, min(size, LARGEST_ARRAY))


@dataclass(frozen=True, slots=True)
class ItemRow:
    """A row of a table: what it runs, and the item that says so, which may say others as well."""

    element: str
    item: YamlScalar
    number: int
    """That of the item in its list."""


@dataclass(frozen=True, slots=True)
class DeclaredRow:
    """The activity that a row of a table runs: declared once, also where several instances have it.

    ``owner`` is the component, or the bus; ``keys`` are those for its times, by `TIMES`.
    """

    owner: str
    name: str
    kind: str
    """``ports``, also of a group, ``region``, ``activity``, ``receive`` or ``watch``."""
    entry: NamedEntry
    keys: Mapping[str, str]

    def text(self, time: str) -> str | None:
        """The text of a time; None where it is not written."""
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
        """The instances; an array stands at the name of each of its elements."""
        return {
            element.lower(): entry
            for entry in self._named("instances").values()
            for element in entry.elements
        }

    @cached_property
    def arrays(self) -> dict[str, NamedEntry]:
        """The arrays of instances."""
        return {name: one for name, one in self._named("instances").items() if one.is_array}

    @cached_property
    def buses(self) -> dict[str, NamedEntry]:
        """The buses."""
        return self._named("buses")

    def _named(self, section: str) -> dict[str, NamedEntry]:
        found: dict[str, NamedEntry] = {}
        for entry in self.section(section):
            found.setdefault(entry.name.lower(), entry)
        return found

    def items(self, processor: NamedEntry) -> list[YamlScalar]:
        """The items of a table, as they are written."""
        found = processor.mapping.get("activities")
        items = found.items if isinstance(found, spans.Sequence) else []
        return [item for item in items if isinstance(item, YamlScalar)]

    def table(self, processor: NamedEntry) -> list[ItemRow]:
        """The rows of a processor: for an item with stars one for each element."""
        return [
            ItemRow(element, item, number)
            for number, item in enumerate(self.items(processor))
            for element in self.named(item.value)
        ]

    def named(self, text: str) -> list[str]:
        """The names that a reference stands for: with stars the elements of arrays, else itself."""
        heads: list[tuple[str, NamedEntry | None]] = [("", None)]
        *owners, last = text.split(".")
        for depth, segment in enumerate(owners):
            inside: list[tuple[str, NamedEntry | None]] = []
            for head, around in heads:
                entry = self._array(segment, around, is_outermost=depth == 0)
                names = (segment,) if entry is None else entry.elements
                inside += [(f"{head}{n}.", self.component_of(f"{head}{n}")) for n in names]
            heads = inside
        return [f"{head}{last}" for head, _ in heads]

    def _array(
        self, segment: str, around: NamedEntry | None, *, is_outermost: bool
    ) -> NamedEntry | None:
        """The array whose elements a part of a reference stands for."""
        if not segment.endswith(ALL):
            return None
        base = segment.removesuffix(ALL).lower()
        if is_outermost:
            return self.arrays.get(base)
        inside = None if around is None else _inner(around, "instances")
        found = None if inside is None else _inner(inside, base)
        return found if found is not None and found.is_array else None

    def row_at(self, element: str) -> tuple[NamedEntry, int] | None:
        """The processor whose table holds a row, and its number there."""
        wanted = element.lower()
        for processor in self.processors.values():
            for number, row in enumerate(self.table(processor)):
                if row.element.lower() == wanted:
                    return processor, number
        return None

    def component_of(self, instance: str) -> NamedEntry | None:
        """The component of an instance, which may be inside others: ``arm.shoulder``."""
        first, *inner = instance.lower().split(".")
        found = self._kind(self.instances.get(first))
        for name in inner:
            inside = None if found is None else _inner(found, "instances")
            found = None if inside is None else self._kind(_instance(inside, name))
        return found

    def instances_of(self, component: NamedEntry) -> list[str]:
        """The paths of the instances of a component, also those inside others."""
        return [
            path
            for entry in self._named("instances").values()
            for name in entry.elements
            for path, kind in self._inside(name, self._kind(entry), ())
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
            entry = NamedEntry(kind.file, key, mapping)
            for name in entry.elements:
                yield from self._inside(f"{path}.{name}", self._kind(entry), (*around, kind))

    def _kind(self, instance: NamedEntry | None) -> NamedEntry | None:
        """The component that an entry of `instances` names."""
        name = None if instance is None else instance.mapping.scalar("component")
        return None if name is None else self.components.get(name.value.lower())

    def row(self, element: str) -> DeclaredRow | None:
        """The declaration of the row ``owner.name``."""
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
        """The declarations of the rows that an instance of a component has to run."""
        ports = _inner(component, "port_region")
        if ports is not None:
            yield self._row(component, "ports", "ports", ports)
            groups = ports.mapping.mapping("groups")
            for key, mapping in () if groups is None else groups.mappings():
                entry = NamedEntry(component.file, key, mapping)
                yield self._row(component, key.value, "ports", entry)
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


def _instance(inside: NamedEntry, name: str) -> NamedEntry | None:
    """An instance of a section, which may be an element of an array."""
    found = _inner(inside, name)
    if found is not None and not found.is_array:
        return found
    entries = (NamedEntry(inside.file, *one) for one in inside.mapping.mappings())
    names = ((entry, element.lower()) for entry in entries for element in entry.elements)
    return next((entry for entry, element in names if element == name), None)
