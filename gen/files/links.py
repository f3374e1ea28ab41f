# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which element of a model names which requirements: a table beside the `System`.

Read from the forms, so nothing that the emitter, the analysis or the rules see depends on it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ravenchart.gen.origins import Origin

from .arrays import elements_of
from .reference import TITLES
from .schema import ModelFile
from .schema_base import REQUIREMENTS, Element

PathPart = str | int
"""A key of a mapping, or the number of an item of a list."""


@dataclass(frozen=True, slots=True)
class Link:
    """An element of a model, and the requirements that it names."""

    element: str
    """Its name from the outside to the inside: `Pump.Infusion.Alarm`."""
    kind: str
    """Its kind, as the headings of the model reference call it."""
    path: tuple[PathPart, ...]
    """From the root of the file: `components`, `Pump`, `regions`, ..."""
    ids: tuple[str, ...]
    origin: Origin
    count: int | None = None
    """The number of elements of an array of instances."""

    @property
    def elements(self) -> tuple[str, ...]:
        """The names of the instances that an entry of `instances` is."""
        name = str(self.path[-1])
        return (name,) if self.count is None else elements_of(name, self.count)

    @property
    def section(self) -> str:
        """The section of the file that holds it; "" of the file itself."""
        return str(self.path[0]) if self.path else ""


def links(forms: Iterable[ModelFile]) -> tuple[Link, ...]:
    """The elements with requirements, by file and in the order of the file format."""
    return tuple(link for form in forms for link in _of_element(form, (), ()))


def _of_element(
    form: Element, path: tuple[PathPart, ...], names: tuple[str, ...]
) -> Iterator[Link]:
    """The links of an element and of all that is inside it."""
    if form.req:
        kind = TITLES[type(form).__name__].lower() if path else "model"
        element = ".".join(names) or getattr(form, "system", None) or "model"
        count = getattr(form, "count", None)
        yield Link(element, kind, path, tuple(form.req), form.origin, count)
    for name, field in type(form).model_fields.items():
        if name != REQUIREMENTS:
            key = field.alias or name
            yield from _of_value(getattr(form, name), (*path, key), names, key)


def _of_value(
    value: object, path: tuple[PathPart, ...], names: tuple[str, ...], key: str
) -> Iterator[Link]:
    """The links in the value of a key: in a mapping the entries have names, in a list numbers."""
    if isinstance(value, Element):
        yield from _of_element(value, path, (*names, key))
    elif isinstance(value, dict):
        for name, inner in value.items():
            if isinstance(inner, Element):
                yield from _of_element(inner, (*path, name), (*names, str(name)))
    elif isinstance(value, list):
        for number, inner in enumerate(value):
            if isinstance(inner, Element):
                yield from _of_element(inner, (*path, number), (*names, f"{key}[{number + 1}]"))
