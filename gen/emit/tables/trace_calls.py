# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Trace calls: present only when the node declares a trace."""

from __future__ import annotations

from ravenchart.gen.emit.ada.expressions import (
    Attribute,
    Expr,
    OperatorChain,
    arguments,
    call,
    number,
)
from ravenchart.gen.emit.ada.named import Named, ref
from ravenchart.gen.emit.ada.naming import constant_name
from ravenchart.gen.emit.ada.statements import Do, Stmt
from ravenchart.gen.model.system import Processor, System


def traced(system: System) -> bool:
    """Does the system keep a trace?"""
    return any(n.trace_depth > 0 for n in system.nodes)


def note(
    system: System, kind: str, element: str, element_kind: str, value: Expr | None = None
) -> tuple[Stmt, ...]:
    """One trace record about ``element``, or nothing when there is no trace."""
    if not traced(system):
        return ()
    args = arguments(
        ref("Ravenchart.Traces", kind),
        ref("Elements", element_constant(element, element_kind)),
        value or number(0),
    )
    return (Do("Trace.Buffer.Note", args),)


def fault_number(kind: str) -> Expr:
    """What a trace record about a fault says of its kind."""
    return call(Attribute("Ravenchart.Health.Fault_Kind", "Pos"), ref("Ravenchart.Health", kind))


def element_constant(element: str, kind: str) -> str:
    """The constant that holds an element's number."""
    kinds = {"row": "_Row", "processor": "_Processor", "message": "_Message", "bus": "_Bus"}
    return constant_name(element) + kinds.get(kind, "")


def row_number(processor: Processor, row_type: Named, row: str) -> Expr:
    """The element number of a row: those of a table follow their processor's."""
    position = call("Ravenchart.Element_Id", call(Attribute(ref(row_type), "Pos"), ref(row)))
    first = ref("Elements", element_constant(processor.name, "processor"))
    return OperatorChain("+", (first, number(1), position))
