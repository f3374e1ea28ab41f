"""A call of gprbuild for the program of a node."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from ravenchart.tools import toolchain


@dataclass(frozen=True, slots=True)
class Compilation:
    """Its arguments, where it is called and with which scenario variables, and what it makes."""

    arguments: tuple[str, ...]
    where: Path
    scenario: Mapping[str, str]
    image: Path

    def run(self, *more: str) -> str:
        """What gprbuild says where all is well; it compiles what is not up to date."""
        return toolchain.run("gprbuild", [*self.arguments, *more], self.where, self.scenario)
