# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Trace calls, present only when the node declares a trace, and reports of faults."""

from __future__ import annotations

from ravenchart.gen.emit.ada.expressions import (
    Attribute,
    Expr,
    OperatorChain,
    arguments,
    call,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import constant_name
from ravenchart.gen.emit.ada.statements import Do, Stmt, do
from ravenchart.gen.model.system import Processor, System

FAULTS = ref("Health_Counts.Faults")
"""The package that counts and traces the faults of a node."""


def traced(system: System) -> bool:
    """Does the system keep a trace?"""
    return any(n.trace_depth > 0 for n in system.nodes)


def note(
    system: System, kind: str, element: str, element_kind: str, value: Expr | None = None
) -> tuple[Stmt, ...]:
    """One trace record about ``element``, or nothing when there is no trace."""
    named = ref("Elements", element_constant(element, element_kind))
    return note_of(system, kind, named, value)


def note_of(
    system: System, kind: str, element: Expr, value: Expr | None = None
) -> tuple[Stmt, ...]:
    """The same about the element with that number."""
    if not traced(system):
        return ()
    args = arguments(ref("Ravenchart.Traces", kind), element, value or number(0))
    return (Do("Trace.Buffer.Note", args),)


def fault_number(kind: str) -> Expr:
    """The kind of a fault in its trace record."""
    return call(Attribute("Ravenchart.Health.Fault_Kind", "Pos"), ref("Ravenchart.Health", kind))


def fault(kind: str, element: str, element_kind: str) -> Stmt:
    """Count a fault about ``element``, and trace it where there is a trace."""
    named = ref("Elements", element_constant(element, element_kind))
    return do(ref(FAULTS, "Report"), ref("Ravenchart.Health", kind), named)


def fault_units(root: str) -> set[DottedName]:
    """The units that a body with such calls needs."""
    return {ref(root, "Health_Counts"), ref("Ravenchart.Health"), ref(root, "Elements")}


def element_constant(element: str, kind: str) -> str:
    """The constant that holds an element's number."""
    kinds = {"row": "_Row", "processor": "_Processor", "message": "_Message", "bus": "_Bus"}
    return constant_name(element) + kinds.get(kind, "")


def row_number(processor: Processor, row_type: Named, row: str) -> Expr:
    """The element number of a row: those of a table follow their processor's."""
    position = call("Ravenchart.Element_Id", call(Attribute(ref(row_type), "Pos"), ref(row)))
    first = ref("Elements", element_constant(processor.name, "processor"))
    return OperatorChain("+", (first, number(1), position))
