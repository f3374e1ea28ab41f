# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The code takes its facts from the timing certificate, and a build fails where it does not.

An instance of the runtime shows its parameters. The compiler compares scalars, gnatprove compares
tables and settings.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.derive.instants import has_offset
from ravenchart.gen.emit.ada.declarations import Decl
from ravenchart.gen.emit.ada.expressions import Expr, Indexed, Selected, both, equal, number
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import constant_name as name_of
from ravenchart.gen.emit.ada.naming import row_name
from ravenchart.gen.emit.ada.statements import Pragma
from ravenchart.gen.model.system import Processor, Slot, System

from .terms import differs, plus, times

CERTIFICATE = "Timing_Certificate"


def fact(element: str, what: str) -> DottedName:
    """A number of an element in the certificate, as the program sees it."""
    return ref(CERTIFICATE, f"{name_of(element)}_{what}")


def driver_element(bus: str) -> str:
    """The element with the priority of a bus's driver."""
    return f"{bus}.driver"


def timed_by(processor: str, slots: Sequence[Slot], slot: Slot) -> str:
    """The element whose divisor and phase a row has: its processor where every row always runs."""
    always = all((one.divisor, one.phase) == (1, 0) for one in slots)
    return processor if always else slot.element


def states_offset(system: System, processor: str) -> bool:
    """Whether the certificate states the offset of a processor; else it is 0."""
    return any(has_offset(system, task) for task in system.tasks if task.element == processor)


def offset_fact(system: System, processor: str) -> Expr:
    """The offset of a processor, as the program sees it."""
    return fact(processor, "O") if states_offset(system, processor) else number(0)


def first_release(system: System, processor: Processor, slot: Slot) -> Expr:
    """The release of the first execution of a row, in the names of the certificate."""
    timed = timed_by(processor.name, processor.slots, slot)
    late = times(ref(f"{name_of(timed)}_Phase"), ref(f"{name_of(processor.name)}_T"))
    own = ref(f"{name_of(processor.name)}_O")
    return plus(own if states_offset(system, processor.name) else number(0), late)


def agrees(given: Named, certified: Expr, element: str, what: str) -> Decl:
    """A build fails where an instance was given anything but what is certified."""
    return differs(ref(given), certified, element, f"has another {what} than its certificate")


def rows_agree(processor: Processor, table: Named) -> list[Decl]:
    """The same for the rows of a table."""
    found: list[Decl] = []
    for slot in processor.slots:
        row = Indexed(table, ref(row_name(slot)))
        same = [
            equal(
                Selected(row, what),
                fact(timed_by(processor.name, processor.slots, slot), what),
            )
            for what in ("Divisor", "Phase")
        ]
        found.append(Pragma("Assert", (both(*same),)))
    return found
