# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Calls that put a value into an input port, and take it: on one core, or from core to core."""

from __future__ import annotations

from ravenchart.gen.derive.crossing import crosses
from ravenchart.gen.emit.ada.declarations import Param
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, constant_name
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import System

CROSSINGS = "Crossings"
"""The package of all that goes from core to core, or is visible at its instants only."""

VISIBLE = Param("Visible", "in", "Ravenchart.Nanoseconds")
"""From when on a value is visible, where its sender has a logical execution time."""


def put_of(system: System, end: End) -> DottedName:
    """The procedure that puts a value into an input port, with the unit that has it."""
    if crosses(system, end):
        return ref(CROSSINGS, f"Put_{constant_name(str(end))}")
    return ref(ada_case(end.instance), f"Put_{ada_case(end.name)}")


def mailbox_of(system: System, end: End) -> DottedName:
    """The package of the mailbox, as the instance of the port sees it."""
    if crosses(system, end):
        return ref(CROSSINGS, constant_name(str(end)))
    return ref(f"{ada_case(end.name)}_Mailbox")
