# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""An error that several instances have is reported once: inside a composite component, or of the
elements of an array."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import replace

from ravenchart.gen.diagnostics import Diagnostic
from ravenchart.gen.files.arrays import ALL, InstanceArray
from ravenchart.gen.model.instances import Instance

SHOWN = 8
"""Instances that a note lists."""

PATH = re.compile(r"\w+(?:\.\w+)+")

_REFERENCE = re.compile(r"\w+(?:\.\w+)*")
_NUMBER = re.compile(r"_[0-9]+\b")


def folded(found: Iterable[Diagnostic], instances: Iterable[Instance]) -> tuple[Diagnostic, ...]:
    """Findings at one line that differ by the composite instance alone are one.

    It is that of the first, with the number of the others and a note that lists them.
    """
    composites = {
        ".".join(instance.name.split(".")[:depth]): name
        for instance in instances
        for depth, name in enumerate(instance.composites, 1)
    }
    if not composites:
        return tuple(found)
    groups: dict[object, list[tuple[Diagnostic, str]]] = {}
    for one in found:
        said, path = _of_any(one.message, composites)
        alike = (one.code, one.severity, one.origin, said) if path else one
        others = groups.setdefault(alike, [])
        if all(path != other for _, other in others):
            others.append((one, path))
    return tuple(_counted(*group) for group in groups.values())


def _of_any(message: str, composites: dict[str, str]) -> tuple[str, str]:
    """A message with the composite in place of its instance, and the first of these instances."""
    paths: list[str] = []

    def named(match: re.Match[str]) -> str:
        names = match[0].split(".")
        for depth in range(len(names) - 1, 0, -1):
            path = ".".join(names[:depth])
            if path in composites:
                paths.append(path)
                return ".".join((composites[path], *names[depth:]))
        return match[0]

    return PATH.sub(named, message), " ".join(paths[:1])


def folded_elements(
    found: Iterable[Diagnostic], arrays: Iterable[InstanceArray]
) -> tuple[Diagnostic, ...]:
    """Findings at one line that differ by the element of an array alone are one.

    It is that of the first element, with the number of the others and a note that lists them.
    """
    elements = {name for array in arrays for name in array.elements}
    if not elements:
        return tuple(found)
    groups: dict[object, list[tuple[Diagnostic, str]]] = {}
    for one in found:
        named = (_element(path, elements) for path in _REFERENCE.findall(one.message))
        name = next(filter(None, named), "")
        said = _NUMBER.sub(ALL, one.message)
        alike = (one.code, one.severity, one.origin, said) if name else one
        others = groups.setdefault(alike, [])
        if all(one.message != other.message for other, _ in others):
            others.append((one, name))
    return tuple(_counted(*group, noun="element") for group in groups.values())


def _element(path: str, elements: set[str]) -> str:
    """The path of the innermost element that another path leads through; empty without."""
    names = path.split(".")
    depths = (depth for depth in range(len(names), 0, -1) if names[depth - 1] in elements)
    return ".".join(names[: next(depths, 0)])


def _counted(
    first: tuple[Diagnostic, str], *others: tuple[Diagnostic, str], noun: str = "instance"
) -> Diagnostic:
    """The first of several findings, which says how many more there are."""
    found = first[0]
    if not others:
        return found
    count = len(others)
    listed = ", ".join(path for _, path in others[:SHOWN])
    more = f" and {count - SHOWN} more" if count > SHOWN else ""
    return replace(
        found,
        message=f"{found.message} (and {count} more {noun}{'s' if count > 1 else ''})",
        notes=(
            *found.notes,
            (found.origin, f"the others are {'in ' if noun == 'instance' else ''}{listed}{more}"),
        ),
    )
