# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The ages of gnatprove that Ravenchart is proved with, and what differs between them.

A gnatprove belongs to a version of GNAT. That of GNAT 12 comes with the prover CVC4; those from
GNAT 13 on come with cvc5, and write their results in another form, which `spark_results` reads as
well. The switches that both accept are in switches.gpr, so gnatprove called by hand succeeds too.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from ravenchart.gen.emit.nodes.termination import TerminationForm
from ravenchart.tools import toolchain

_PART = re.compile(r"\b(Why3|CVC4|cvc5|Z3|Alt-Ergo)(?: for gnatprove)? version v?(\d[^\s,]*)")


@dataclass(frozen=True, slots=True)
class Age:
    """One age: its name, which is that of the folder of its records, and its own switches."""

    name: str
    switches: tuple[str, ...]
    """Two provers; a check that is not proved is an error."""
    termination: TerminationForm
    """How a subprogram is declared to terminate."""


GNAT_12 = Age("gnat-12", ("--prover=z3,cvc4", "--checks-as-errors"), TerminationForm.ANNOTATION)
GNAT_14 = Age(
    "gnat-14", ("--prover=z3,cvc5", "--checks-as-errors=on", "--timeout=30"), TerminationForm.ASPECT
)
"""A few checks take its provers more than the 10 s of the project files."""
AGES = (GNAT_14, GNAT_12)
"""The one that users get now comes first."""


@cache
def version() -> str:
    """The output of ``gnatprove --version``; ToolMissing without one on PATH."""
    return toolchain.run("gnatprove", ["--version"], Path.cwd(), {})


def switches() -> tuple[str, ...]:
    """The switches that are those of the age of the gnatprove on PATH."""
    return age_of(version()).switches


def run(
    arguments: Sequence[str],
    where: Path,
    scenario: Mapping[str, str],
    taken: Callable[[str], bool] = lambda _: False,
) -> str:
    """Run the gnatprove on PATH with the switches of its age, as `toolchain.run` does."""
    return toolchain.run("gnatprove", [*arguments, *switches()], where, scenario, taken)


def age_of(version: str) -> Age:
    """The age of a tool by what ``gnatprove --version`` prints: a line for each prover it finds."""
    return GNAT_14 if "cvc5" in version else GNAT_12


def tool_text(version: str) -> str:
    """The tool and its provers in one line: ``gnatprove 12.1, Why3 1.4.0, CVC4 1.8, Z3 4.8.12``."""
    first, _, rest = version.partition("\n")
    parts = {name: number for name, number in _PART.findall(rest)}
    return ", ".join(
        [f"gnatprove {first.strip()}", *(f"{name} {number}" for name, number in parts.items())]
    )
