# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The answers of the elements of an array to one call: how an instance puts them together.

Whoever ends a call delivers the next answer of its element afterwards. So the next call of the
array ends later, and outcomes keep their order without a lock.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.derive.calls import delivered, element_bindings, gathers
from ravenchart.gen.emit.ada.declarations import (
    Decl,
    GenericInstance,
    Object,
    Param,
    Subprogram,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Expr,
    Holder,
    Indexed,
    arguments,
    equal,
    number,
    select,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case, default_value, priority, type_name
from ravenchart.gen.emit.ada.statements import Comment, IfStatement, Stmt, do
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.language.terms import RecordType
from ravenchart.gen.model.commands import Binding, Need
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.system import System

ANSWERS = ref("Ravenchart.Answers")


def gathered(system: System, instance: Instance) -> Iterator[Binding]:
    """The commands of an instance whose replies come from the elements of an array."""
    for binding in system.bindings:
        if binding.instance == instance.name and gathers(system, binding):
            yield binding


def part_number(need: Need) -> int:
    """The number of the element that a need is for."""
    return int(need.name.rpartition("_")[2])


def gathering_objects(system: System, instance: Instance) -> Iterator[Decl]:
    """The calls of arrays that are under way."""
    for binding in gathered(system, instance):
        need, parts = binding.need, element_bindings(system, binding)
        reply = parts[0].need.reply
        assert reply is not None
        element = f"{instance.name}.{need.name}"
        yield Comment(f"[{element}] the replies of {len(parts)} elements to one call")
        args = arguments(
            Part_Type=type_name(system, reply),
            No_Part=default_value(system, reply),
            Last=number(len(parts)),
            Ceiling=priority(system.object(f"{element}.gathering").ceiling),
        )
        yield GenericInstance(_package(need), "Ravenchart.Gatherings", args)


def _package(need: Need) -> str:
    return f"{ada_case(need.command.name)}_Gathering"


def concluded(need: Need, answer: str, part: Expr) -> Stmt:
    """The call of an element has ended."""
    name = f"Conclude_{ada_case(need.command.name)}"
    return do(name, number(part_number(need)), ref(ANSWERS, answer), part)


def concluding(system: System, need: Need) -> Subprogram:
    """Takes the reply of an element."""
    assert need.reply is not None
    params = (Param("Reply", "in", type_name(system, need.reply)),)
    body = (concluded(need, "Replied", ref("Reply")),)
    return Subprogram(f"Take_{ada_case(need.name)}", params, body=body)


def conclude_bodies(system: System, instance: Instance) -> Iterator[Subprogram]:
    """For each call of an array the procedure that takes the end of each of its elements."""
    for binding in gathered(system, instance):
        yield _conclude(system, instance, binding)


def _conclude(system: System, instance: Instance, binding: Binding) -> Subprogram:
    need, parts = binding.need, element_bindings(system, binding)
    package = _package(need)
    one = parts[0].need
    assert need.reply is not None and one.reply is not None
    taken = delivered(instance.component, need)
    replies = "Parts" if taken else "Unused_Parts"
    result = ref(ANSWERS, "Outcome")
    branches: list[tuple[Expr, tuple[Stmt, ...]]] = []
    if taken:
        whole = replies_as_one(
            binding, parts, [Indexed("Parts", number(n + 1)) for n in range(len(parts))]
        )
        when = equal(ref("Result"), ref(ANSWERS, "All_Replied"))
        branches.append((when, (do(f"Take_{ada_case(need.name)}", whole),)))
    if need.on_timeout is not None:
        when = equal(ref("Result"), ref(ANSWERS, "Some_Timed_Out"))
        branches.append((when, (do("Offer", event_value(instance.component, need.on_timeout)),)))
    given = ref("Element"), ref("Given"), ref("Part"), ref("Result"), ref(replies)
    return Subprogram(
        f"Conclude_{ada_case(need.name)}",
        (
            Param("Element", "in", ref(package, "Element_Number")),
            Param("Given", "in", ref(ANSWERS, "Answer")),
            Param("Part", "in", type_name(system, one.reply)),
        ),
        declarations=(
            Object("Result", result),
            UseType(result),
            Object(replies, ref(package, "Part_List")),
        ),
        body=(do(ref(package, "Conclude"), *given), IfStatement(tuple(branches))),
    )


def replies_as_one(binding: Binding, parts: tuple[Binding, ...], values: Sequence[Holder]) -> Expr:
    """The replies of elements as one."""
    if not isinstance(binding.need.reply, RecordType):
        return values[0]
    rows: list[Arg] = []
    for part, held in zip(parts, values, strict=True):
        first = len(rows) + 1
        if isinstance(part.need.reply, RecordType):
            own = range(part.need.axes)
            rows += [Arg(f"Axis_{first + n}", select(held, f"Axis_{n + 1}")) for n in own]
        else:
            rows.append(Arg(f"Axis_{first}", held))
    return Aggregate(tuple(rows))
