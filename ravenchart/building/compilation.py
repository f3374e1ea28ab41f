# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A call of gprbuild for the program of a node."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from ravenchart.tools import steps, toolchain


@dataclass(frozen=True, slots=True)
class Compilation:
    """Its arguments, where it is called and with which scenario variables, and what it makes."""

    arguments: tuple[str, ...]
    where: Path
    scenario: Mapping[str, str]
    image: Path

    def run(self, *more: str, tell: Callable[[str], None] = lambda _: None) -> str:
        """Compile the units that are not up to date; the output of a gprbuild that succeeds.

        ``tell`` gets the progress.
        """
        words = [steps.OF_GPRBUILD, *self.arguments, *more]
        taken = steps.Announced(steps.COMPILING, tell).takes
        return toolchain.run("gprbuild", words, self.where, self.scenario, taken)
