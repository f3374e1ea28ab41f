# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The units that each core of a node has for itself: health counts, trace and recording."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.derive.crossing import MAIN_CORE
from ravenchart.gen.derive.sharing import on_core
from ravenchart.gen.emit.ada.declarations import Unit
from ravenchart.gen.emit.ada.named import DottedName
from ravenchart.gen.emit.ada.naming import root_package
from ravenchart.gen.emit.ada.walking import rewritten
from ravenchart.gen.model.system import System

from .value_calls import UNIT

OWN = ("Trace", "Health_Counts", UNIT)
"""These units."""


def at_core(units: Sequence[Unit], system: System, core: int) -> tuple[Unit, ...]:
    """Units of a core, with its own health counts, trace and recording."""
    if core == MAIN_CORE:
        return tuple(units)
    root = root_package(system)

    def change(node: object) -> object:
        if isinstance(node, DottedName):
            below = 1 if node.first == root else 0
            if len(node.parts) > below and node.parts[below] in OWN:
                own = on_core(node.parts[below], core)
                return DottedName((*node.parts[:below], own, *node.parts[below + 1 :]))
        return None

    return tuple(rewritten(unit, change) for unit in units)
