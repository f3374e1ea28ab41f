# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How an instance calls and reads an array element by element."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ravenchart.gen.derive.calls import asking, element_bindings, gathers
from ravenchart.gen.emit.ada.declarations import Decl, Object, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import FALSE, TRUE, Aggregate, Arg, Expr, arguments
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, default_value, type_name
from ravenchart.gen.emit.ada.statements import Assign, Do, IfStatement, Stmt, do
from ravenchart.gen.language.terms import RecordType
from ravenchart.gen.model.commands import Binding, Gathered, Remote, Server
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.system import System

from .device_calls import call_body, item_params, told_full
from .gathered_answers import concluded, replies_as_one

REFUSED = "Is_Refused"
"""Whether an element, or the whole, has refused a call."""


def array_calls(
    system: System, instance: Instance, binding: Binding, lost: tuple[Stmt, ...]
) -> Iterator[Subprogram]:
    """The calls of the elements of an array, and that of the whole.

    ``lost`` counts a call that is refused, since one is under way.
    """
    waits, told = gathers(system, binding), told_full(instance, binding.need)
    parts = element_bindings(system, binding)
    more = (Param(REFUSED, "in out", "Boolean"),) if told else ()
    for part in parts:
        full: tuple[Stmt, ...] = (Assign(REFUSED, TRUE),) if told else ()
        if waits:
            assert part.need.reply is not None
            full = (*full, concluded(part.need, "Refused", default_value(system, part.need.reply)))
        refusable = _may_refuse(part)
        yield call_body(system, part, full if refusable else (), lost, more if refusable else ())
    calls: list[Stmt] = []
    first = 1
    for part in parts:
        name = f"Call_{ada_case(part.need.name)}"
        passed = (ref(REFUSED),) if told and _may_refuse(part) else ()
        calls.append(do(name, *_cut(binding, part, first), *passed))
        first += part.need.axes
    yield _whole(system, binding, calls, lost, told, waits=waits)


def _may_refuse(part: Binding) -> bool:
    """Whether an element may find no room for a call."""
    provider = part.provider
    return isinstance(provider, Server) or (
        isinstance(provider, Remote) and provider.reply is not None
    )


def _whole(
    system: System,
    binding: Binding,
    calls: list[Stmt],
    lost: tuple[Stmt, ...],
    told: tuple[Stmt, ...],
    *,
    waits: bool,
) -> Subprogram:
    """The call of all elements, in their order; unless one is under way that waits for replies."""
    need = binding.need
    declarations: tuple[Decl, ...] = ()
    body = tuple(calls)
    some = any(_may_refuse(part) for part in element_bindings(system, binding))
    if waits:
        declarations = (Object(REFUSED, "Boolean"),)
        start = do(ref(f"{ada_case(need.name)}_Gathering", "Start"), ref(REFUSED))
        body = (start, IfStatement(((ref(REFUSED), lost),), tuple(calls)))
    elif told and some:
        declarations = (Object(REFUSED, "Boolean", FALSE),)
    if told and (waits or some):
        body = (*body, IfStatement(((ref(REFUSED), told),)))
    params = item_params(system, need)
    return Subprogram(f"Call_{ada_case(need.name)}", params, declarations=declarations, body=body)


def _cut(binding: Binding, part: Binding, first: int) -> tuple[Expr, ...]:
    """The part of an argument for an element, whose first axis has that number."""
    whole, own = binding.need.argument, part.need.argument
    if whole is None or own is None:
        return ()
    if whole == own:
        return (ref("Item"),)
    if not isinstance(own, RecordType):
        return (ref("Item", f"Axis_{first}"),)
    axes = range(part.need.axes)
    rows = tuple(Arg(f"Axis_{n + 1}", ref("Item", f"Axis_{first + n}")) for n in axes)
    return (Aggregate(rows),)


def read_name(binding: Binding) -> str:
    """The procedure that reads an array."""
    return f"Read_{ada_case(binding.need.name)}"


def array_reads(
    system: System, instance: Instance, read: Callable[[Binding, DottedName], Stmt]
) -> Iterator[Subprogram]:
    """The procedures that read all elements of an array; ``read`` reads one."""
    for binding in system.bindings:
        need = binding.need
        of_array = isinstance(binding.provider, Gathered) and need.is_read
        if binding.instance != instance.name or not of_array or not asking(system, binding):
            continue
        assert need.reply is not None
        declarations: list[Decl] = []
        body: list[Stmt] = []
        parts = element_bindings(system, binding)
        held = tuple(ref(f"Part_{number}") for number in range(1, len(parts) + 1))
        for part, local in zip(parts, held, strict=True):
            assert part.need.reply is not None
            declarations.append(Object(local.last, type_name(system, part.need.reply)))
            body.append(read(part, local))
        body.append(Assign("Reply", replies_as_one(binding, parts, held)))
        params = (Param("Reply", "out", type_name(system, need.reply)),)
        yield Subprogram(
            read_name(binding), params, declarations=tuple(declarations), body=tuple(body)
        )


def read_array(binding: Binding, target: DottedName) -> Stmt:
    """All elements of an array read as one."""
    return Do(ref(read_name(binding)), arguments(target))
