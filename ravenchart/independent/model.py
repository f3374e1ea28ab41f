# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The files of a model, read with PyYAML: text with the file and line it stands at.

Nothing is checked here that Ravenchart checks; where a model cannot be read as expected,
the check ends as unusable.
"""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import yaml

from .findings import UnusableError

UNITS = {
    **{"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9},
    **{"bit/s": 1, "kbit/s": 10**3, "Mbit/s": 10**6},
}

LOADER: type = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
"""That of libyaml where PyYAML was built with it: ten times as fast."""


class Text(str):
    """A scalar as it is written."""

    file: Path
    line: int


class Items(list["Value"]):
    """A sequence."""


class Mapping(dict[str, "Value"]):
    """A mapping in the order of the file; `get_name` finds a key whatever its case."""

    file: Path
    line: int

    def name(self, key: str) -> str | None:
        """The key as it is declared."""
        return next((own for own in self if own.lower() == key.lower()), None)

    def text(self, key: str) -> str | None:
        """A scalar value; None where there is none."""
        value = self.get(key)
        return str(value) if isinstance(value, Text) else None

    def map(self, key: str) -> Mapping:
        """A mapping; an empty one where there is none."""
        value = self.get(key)
        return value if isinstance(value, Mapping) else _nothing(self)

    def texts(self, key: str) -> list[str]:
        """A list of scalars, or a single one."""
        value = self.get(key)
        if isinstance(value, Text):
            return [str(value)]
        return [str(v) for v in value or () if isinstance(v, Text)] if value else []

    def time(self, key: str, default: int | None = None) -> int:
        """A duration in ns, or a bit rate in bit/s."""
        text = self.text(key)
        if text is None:
            if default is None:
                raise UnusableError(f"{self.file}:{self.line}: no `{key}` here")
            return default
        return quantity(text)

    def number(self, key: str, default: int) -> int:
        """A number."""
        text = self.text(key)
        return default if text is None else integer(text)

    def true(self, key: str) -> bool:
        """A Boolean that is false unless given."""
        return (self.text(key) or "").lower() in ("true", "yes")

    def maps(self) -> Iterator[tuple[str, Mapping]]:
        """Its entries that are mappings."""
        return ((k, v) for k, v in self.items() if isinstance(v, Mapping))


Value = Text | Items | Mapping


def _nothing(near: Mapping) -> Mapping:
    found = Mapping()
    found.file, found.line = near.file, near.line
    return found


def handlers_of(component: Mapping) -> list[tuple[str, Mapping]]:
    """The rows that handle input ports, each with its times: the port region, then its groups."""
    region = component.map("port_region")
    return [("ports", region), *region.map("groups").maps()]


def handler_of(component: Mapping, port: str) -> str:
    """The row that takes the values of an input port."""
    groups = component.map("port_region").map("groups").maps()
    naming = (name for name, own in groups if port.lower() in map(str.lower, own.texts("ports")))
    return next(naming, "ports")


def integer(text: str) -> int:
    """A number, decimal or 0x..."""
    return int(text.replace("_", ""), 0)


def quantity(text: str) -> int:
    """A duration in ns, or a bit rate in bit/s; 0 needs no unit."""
    match = re.fullmatch(r"([0-9_.]+) ?([a-zA-Z/]*)", text)
    if match is None or (match[2] and match[2] not in UNITS):
        raise UnusableError(f"`{text}` is not a quantity")
    value = Fraction(match[1].replace("_", "")) * UNITS.get(match[2], 1)
    if value.denominator != 1:
        raise UnusableError(f"`{text}` is no whole number of ns")
    return value.numerator


@dataclass(slots=True)
class Model:
    """The sections of all files, and SHA-256 of their bytes in the order read."""

    main: Path
    digest: str = ""
    top: Mapping = field(default_factory=Mapping)
    """Each section, with the entries of all files."""
    homes: dict[str, tuple[str, Path]] = field(default_factory=dict)
    """The library of a component, by its name in lower case, and the folder of its code."""

    def home(self, component: str, program: Path) -> tuple[str, Path]:
        """The root package of a component, and the folder of its code, given the program's."""
        return self.homes.get(component.lower(), (self.name, program))

    @property
    def name(self) -> str:
        """The name of the system."""
        return self.top.text("system") or ""

    def section(self, key: str) -> Mapping:
        """A section that is a mapping."""
        return self.top.map(key)

    @property
    def connections(self) -> list[Mapping]:
        """The connections."""
        return [one for one in self.top.get("connections", ()) if isinstance(one, Mapping)]

    @property
    def bindings(self) -> list[Mapping]:
        """The bindings."""
        return [one for one in self.top.get("bindings", ()) if isinstance(one, Mapping)]


def parted(path: Path) -> tuple[Path, str]:
    """The main file, and the deployment behind it: `model.yaml@bench`; "" without."""
    name, mark, chosen = path.name.rpartition("@")
    is_marked = mark and name.lower().endswith((".yaml", ".yml"))
    return (path.with_name(name), chosen) if is_marked else (path, "")


def generated_name(main: Path) -> str:
    """The folder of the code, beside a main file."""
    usual = main.name.lower() in ("model.yaml", "library.yaml")
    return "generated" if usual else f"generated-{main.name.removesuffix('.yaml')}"


def read(path: Path) -> Model:
    """A model from its main file, with what that includes, and the file of a deployment."""
    main, chosen = parted(path)
    model = Model(main)
    model.top.file, model.top.line = main, 1
    digest, seen = hashlib.sha256(), set[str]()

    def take(path: Path, library: tuple[str, Path] | None = None) -> None:
        identity = os.path.normpath(os.path.abspath(path))
        if identity in seen:
            return
        seen.add(identity)
        try:
            content = path.read_bytes()
            digest.update(content)
            node = yaml.compose(content.decode("utf-8-sig"), Loader=LOADER)
        except (OSError, ValueError, yaml.YAMLError) as problem:
            raise UnusableError(f"cannot read {path}: {problem}") from problem
        tree = _grown(node, path)
        if not isinstance(tree, Mapping):
            raise UnusableError(f"{path} is not a mapping")
        _merge(model.top, tree)
        if tree.text("library"):
            library = tree.text("library") or "", path.parent / generated_name(path)
        if library is not None:
            model.homes |= {name.lower(): library for name in tree.map("components")}
        for name in tree.texts("include"):
            take(path.parent / name, library)

    take(main)
    files = model.top.map("deployments")
    if files or chosen:
        file = files.text(files.name(chosen) or "")
        if file is None:
            raise UnusableError(f"{main}: no deployment `{chosen}`; there are {', '.join(files)}")
        take(main.parent / file)
    model.digest = digest.hexdigest()
    if not model.name:
        raise UnusableError(f"{main} has no `system`")
    return model


def _grown(node: yaml.Node | None, file: Path) -> Value:
    """A tree of values with their places."""
    if isinstance(node, yaml.MappingNode):
        found = Mapping()
        found.file, found.line = file, node.start_mark.line + 1
        for key, value in node.value:
            grown = _grown(value, file)
            if isinstance(grown, Mapping):
                grown.line = key.start_mark.line + 1  # the line of its name
            found[key.value] = grown
        return found
    if isinstance(node, yaml.SequenceNode):
        return Items(_grown(item, file) for item in node.value)
    text = Text(node.value if isinstance(node, yaml.ScalarNode) else "")
    text.file, text.line = file, 1 if node is None else node.start_mark.line + 1
    return text


def _merge(top: Mapping, tree: Mapping) -> None:
    for key, value in tree.items():
        before = top.get(key)
        if isinstance(before, Mapping) and isinstance(value, Mapping):
            before.update(value)
        elif isinstance(before, Items) and isinstance(value, Items):
            before.extend(value)
        elif before is None:
            top[key] = value
