# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Instances of components, and what joins their ports."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import Scalar
from ravenchart.gen.origins import Origin

from .component import Component


@dataclass(frozen=True, slots=True)
class End:
    """A port, row or data item of an instance: one end of a connection, or a place on a way."""

    instance: str
    name: str

    def __str__(self) -> str:
        """``instance.name``."""
        return f"{self.instance}.{self.name}"


@dataclass(frozen=True, slots=True)
class Requests:
    """The queue of a provided interface of an instance: the calls that its server executes."""

    instance: str
    name: str
    """The interface."""

    def __str__(self) -> str:
        """``instance.interface``."""
        return f"{self.instance}.{self.name}"


@dataclass(frozen=True, slots=True)
class Events:
    """The queue of a region of an instance: the events that it takes."""

    instance: str
    name: str
    """The region."""

    def __str__(self) -> str:
        """``instance.Region``."""
        return f"{self.instance}.{self.name}"


Queue = End | Requests | Events
"""A queue in an instance that can release a processor: of a port, an interface or a region."""


@dataclass(frozen=True, slots=True)
class Delegation:
    """A port or required interface that is reached by one of a composite instance around it."""

    end: End
    outside: str
    """That of the outermost composite, ``instance.name``."""
    origin: Origin
    """Where that composite is named."""


@dataclass(frozen=True, slots=True)
class Instance:
    """One component instance on a node, its parameters all set.

    One inside a composite instance is called by its path: ``arm.shoulder``.
    """

    name: str
    origin: Origin
    component: Component
    node: str
    parameters: tuple[tuple[str, Scalar], ...]
    delegations: tuple[Delegation, ...] = ()
    """How its ports and required interfaces are reached from outside of composites."""
    composites: tuple[str, ...] = ()
    """The composite components around it, outermost first: one for each name before its own."""

    def handler(self, port: str) -> str:
        """The element of the row that handles an input port."""
        return f"{self.name}.{self.component.handler(port)}"

    def outside(self, name: str) -> tuple[str, Origin]:
        """How a port or required interface is called where it can be joined, and where that is."""
        found = (one for one in self.delegations if one.end == End(self.name, name))
        at = next(found, None)
        return (f"{self.name}.{name}", self.origin) if at is None else (at.outside, at.origin)


@dataclass(frozen=True, slots=True)
class Connection:
    """An output port wired to an input port.

    In a resolved system both are on one node: between nodes there are messages, see
    `distribution`.
    """

    origin: Origin
    source: End
    target: End
    bus: str | None = None
    """The bus between nodes that the model names for it, of several."""
    logical: bool = False
    """A chain asks that its values become visible at the end of the period of their sender."""
