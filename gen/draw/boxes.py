# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which instances a drawing shows in one box: those inside a composite, as their paths say."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System


@dataclass(frozen=True, slots=True)
class Box:
    """A composite instance by its path, with the boxes and instances inside."""

    name: str
    component: str
    inside: tuple[Instance | Box, ...]


def boxes(system: System, node: Node) -> tuple[Instance | Box, ...]:
    """The instances of a node, those inside composites in their boxes."""
    return boxed(one for one in system.instances if one.node == node.name)


def boxed(instances: Iterable[Instance], depth: int = 1) -> tuple[Instance | Box, ...]:
    """Instances whose paths agree in one name less than ``depth``, by the next name."""
    found: dict[str, list[Instance]] = {}
    for one in instances:
        found.setdefault(".".join(one.name.split(".")[:depth]), []).append(one)
    return tuple(
        own[0]
        if own[0].name == name
        else Box(name, own[0].composites[depth - 1], boxed(own, depth + 1))
        for name, own in found.items()
    )
