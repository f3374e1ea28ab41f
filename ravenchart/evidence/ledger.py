# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The ledger of assumptions: which of its entries a controller rests on.

The text is that of proofs/assumptions.md. An entry that this module does not know counts as in
use: it is better to show one too many.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from ravenchart.gen.emit.commands.lifecycle import has_lifecycle
from ravenchart.gen.emit.commands.registers import types_with_registers
from ravenchart.gen.model.system import System
from ravenchart.paths import ROOT

PAGE = ROOT / "proofs" / "assumptions.md"
ENTRY = re.compile(r"^## (ASM-\d+): (.*?)$(.*?)(?=^## |\Z)", re.M | re.S)


@dataclass(frozen=True, slots=True)
class Assumption:
    """An entry of the ledger."""

    id: str
    title: str
    text: str


Touched = Callable[[System, str], bool]
"""Whether an entry touches a system with a CAN driver."""


def _never(_: System, __: str) -> bool:
    return False


def _driver(*names: str) -> Touched:
    return lambda _, driver: driver in names


WHERE: Mapping[str, Touched] = {
    "ASM-005": _driver("slcan", "bus", "socketcan"),
    "ASM-007": _never,  # withdrawn
    "ASM-010": _never,  # the bus server: a bench
    "ASM-011": _driver("socketcan"),
    "ASM-013": _driver("ctucanfd"),
    "ASM-022": _driver("xilinx"),
    "ASM-015": lambda system, _: any(node.supervision for node in system.nodes),
    "ASM-017": _never,  # the simulated runtime
    "ASM-018": lambda system, _: bool(types_with_registers(system)),
    "ASM-019": lambda system, _: has_lifecycle(system),
    "ASM-023": lambda system, _: system.most_cores > 1,
    "ASM-024": lambda system, _: any(node.interrupts for node in system.nodes),
}
"""Where an entry is in use; every other one always is."""


def entries() -> tuple[Assumption, ...]:
    """The whole ledger; empty where the page is missing."""
    if not PAGE.is_file():
        return ()
    found = ENTRY.findall(PAGE.read_text(encoding="utf-8"))
    return tuple(Assumption(id_, title, " ".join(text.split())) for id_, title, text in found)


def in_use(system: System, driver: str) -> tuple[Assumption, ...]:
    """The entries that a controller of a system with a CAN driver rests on."""
    return tuple(one for one in entries() if one.id not in WHERE or WHERE[one.id](system, driver))
