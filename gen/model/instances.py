"""Instances of components, and what joins their ports."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import Scalar
from ravenchart.gen.origins import Origin

from .component import Component


@dataclass(frozen=True, slots=True)
class End:
    """One end of a connection: a port of an instance."""

    instance: str
    port: str

    def __str__(self) -> str:
        """``instance.port``."""
        return f"{self.instance}.{self.port}"


@dataclass(frozen=True, slots=True)
class Instance:
    """One component instance on a node, its parameters all set."""

    name: str
    origin: Origin
    component: Component
    node: str
    parameters: tuple[tuple[str, Scalar], ...]


@dataclass(frozen=True, slots=True)
class Connection:
    """An output port wired to an input port.

    In a resolved system both are on one node: between nodes there are messages, see
    `distribution`.
    """

    origin: Origin
    source: End
    target: End
