# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The program for simulation: the generated code without tasks and buses, in virtual time.

Components, regions and instances are those of the controller, by the same
emitters; each behaviour and each step only says that it was executed. A stimulus
is a number and integers: events, then input ports, of each instance in model
order; a literal by its position, a record field by field.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from ravenchart.gen.derive.completion import on_one_core, on_one_node
from ravenchart.gen.emit.ada.declarations import (
    ArrayDefinition,
    Decl,
    GenericInstance,
    Object,
    Param,
    RangeDefinition,
    Subprogram,
    TypeDeclaration,
    Unit,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    OTHERS,
    TRUE,
    Aggregate,
    Arg,
    Attribute,
    Choice,
    Expr,
    Indexed,
    OperatorChain,
    Prefix,
    StringLiteral,
    all_else,
    arguments,
    call,
    equal,
    number,
    plain,
    up_to,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case, component_name, root_package, type_name
from ravenchart.gen.emit.ada.statements import Assign, Case, IfStatement, RaiseStatement, Stmt, do
from ravenchart.gen.emit.commands.lifecycle import UNIT as LIFECYCLE
from ravenchart.gen.emit.commands.lifecycle import has_lifecycle
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.emit.tables.executions import ELEMENT_ID
from ravenchart.gen.emit.tables.port_calls import CROSSINGS, put_of
from ravenchart.gen.language.terms import IntegerType, RecordType, ScalarType, Type, Value
from ravenchart.gen.model.component import Port
from ravenchart.gen.model.instances import End, Events, Instance
from ravenchart.gen.model.logical import links_by_port, logical_links
from ravenchart.gen.model.nodes import InterruptLine
from ravenchart.gen.model.system import Processor, Slot, System

INTEGER = ref("Long_Long_Integer")
"""The type of times and of the numbers of stimuli."""

Stimulus = tuple[str, str, Type | None]
"""Instance, event or input port, and the type of its value; or node and interrupt."""


def simulated(system: System) -> System:
    """The part of a system that can be simulated: no bus, no trace, all on one node and core."""
    system = on_one_core(on_one_node(system))
    processors = tuple(p for p in system.processors if not isinstance(p.released_by, str))
    nodes = tuple(replace(n, trace_depth=0, probe=None, supervision=None) for n in system.nodes)
    return replace(system, nodes=nodes, buses=(), messages=(), processors=processors)


def stimuli(system: System) -> tuple[Stimulus, ...]:
    """All stimuli, in order of their numbers from 1."""
    found: list[Stimulus] = []
    for instance in system.instances:
        component = instance.component
        found += [(instance.name, e.name, e.type) for e in component.events]
        found += [(instance.name, p.name, p.type) for p in component.inputs()]
    lines = (one.released_by_interrupt for one in system.processors)
    found += [(line.node, line.name, None) for line in lines if line is not None]
    return tuple(found)


def numbers(of_type: Type | None, value: Value | None) -> list[int]:
    """A value as the integers of a stimulus."""
    if of_type is None or value is None:
        return []
    if isinstance(of_type, RecordType):
        assert isinstance(value, tuple)
        given = {field.lower(): item for field, item in value}
        return [_number(f.type, given[f.name.lower()]) for f in of_type.fields]
    return [_number(of_type, value)]


def _number(of_type: ScalarType, value: Value) -> int:
    if isinstance(of_type, IntegerType):
        assert isinstance(value, int)
        return value
    literals = [literal.lower() for literal in of_type.literals]
    return literals.index(str(value).lower())


def emit_simulation(system: System, header: str) -> Unit:
    """The main program."""
    root = root_package(system)
    urgent = sorted(system.processors, key=lambda p: -p.priority)
    order = [processor for processor in urgent if processor.released_by is None]
    woken = [processor for processor in urgent if processor.released_by is not None]
    last = len(order)
    withs = {ref(root, ada_case(i.name)) for i in system.instances}
    withs |= {ref(root, component_name(i.component)) for i in system.instances}
    withs |= {ref("Ravenchart.Simulated_Runs"), ref("Ravenchart.Steps")}
    withs |= {ref(root, CROSSINGS)} if logical_links(system) else set()
    withs |= {ref(root, LIFECYCLE)} if has_lifecycle(system) else set()
    releases: list[tuple[Choice, tuple[Stmt, ...]]] = []
    for position, processor in enumerate(order, 1):
        rows: list[Stmt] = []
        for slot in processor.slots:
            if slot.of_bus:
                continue
            run = _run(root, slot)
            above = sum(one.priority > processor.priority for one in woken)
            if above:
                rows.append(do("Release_Waiting", number(above)))
            turn = OperatorChain("mod", (ref("Count"), number(slot.divisor)))
            due = equal(turn, number(slot.phase))
            rows += run if slot.divisor == 1 else (IfStatement(((due, run),)),)
        releases.append((plain(position), tuple(rows)))
    executes = any(rows for _, rows in releases)
    takes: list[tuple[Choice, tuple[Stmt, ...]]] = [
        (plain(k), _taken(system, root, woken, (name, what, of_type)))
        for k, (name, what, of_type) in enumerate(stimuli(system), 1)
    ]
    width = max((len(_scalars(t)) for _, _, t in stimuli(system) if t is not None), default=0)
    taken: list[Decl] = []
    if width:
        taken.append(Object("V", _integers(width)))
    return Unit(
        header,
        tuple(sorted(withs)),
        Subprogram(
            f"{root}_Simulation",
            declarations=(
                TypeDeclaration("Processor", RangeDefinition(up_to(plain(last)))),
                TypeDeclaration("Instants", ArrayDefinition("Processor", INTEGER)),
                *_waiting(root, woken),
                Subprogram(
                    "Release",
                    (Param("P", "in", "Processor"), Param("Count", "in", "Natural")),
                    declarations=(Object("Executed", ELEMENT_ID),) if executes else (),
                    body=(Case(ref("P"), tuple(releases)),),
                ),
                Subprogram(
                    "Take",
                    (Param("Number", "in", "Positive"),),
                    declarations=tuple(taken),
                    body=(Case(ref("Number"), (*takes, (OTHERS, ()))),),
                ),
                GenericInstance(
                    "Run",
                    "Ravenchart.Simulated_Runs",
                    arguments(
                        Processor=ref("Processor"),
                        Instants=ref("Instants"),
                        Offsets=_instants([p.offset for p in order]),
                        Periods=_instants([p.period for p in order]),
                        Release=ref("Release"),
                        Take=ref("Take"),
                        **({"End_Instant": ref("End_Instant")} if woken else {}),
                    ),
                    kind="procedure",
                ),
                *((Object("Started", "Boolean"),) if has_lifecycle(system) else ()),
                *((Object("Unused", ELEMENT_ID),) if _starts(root, woken) else ()),
            ),
            body=(*_start(system), *_starts(root, woken), do("Run")),
        ),
    )


def _run(root: str, slot: Slot) -> tuple[Stmt, ...]:
    """One execution of a row."""
    name = ref(root, ada_case(slot.owner), f"Run_{ada_case(slot.name)}")
    return Assign("Executed", number(0)), do(name, ref("Executed"))


def _waiting(root: str, woken: Sequence[Processor]) -> Iterator[Decl]:
    """The processors that queues release: the first ``Last`` of them run what waits and is due."""
    if not woken:
        return
    body: list[Stmt] = []
    for number_, processor in enumerate(woken, 1):
        end, earliest = processor.released_by_value, Indexed("Earliest", plain(number_))
        assert end is not None
        now = ref("Ravenchart.Steps.Now")
        due = OperatorChain(">=", (ref("Last"), number(number_)))
        late = OperatorChain(">=", (now, earliest))
        following = Assign(earliest, OperatorChain("+", (now, number(processor.period))))
        rows = [stmt for slot in processor.slots for stmt in _run(root, slot)]
        ask: Stmt
        if isinstance(end, InterruptLine):
            ask = Assign("Waiting", ref(_accepted(processor)))
            rows.insert(0, Assign(_accepted(processor), FALSE))
        else:
            asked = ref(root, ada_case(end.instance), f"Ask_{ada_case(end.name)}")
            ask = do(asked, ref("Waiting"))
        run = IfStatement(((ref("Waiting"), (following, *rows)),))
        body.append(IfStatement(((OperatorChain("and then", (due, late)), (ask, run)),)))
    for processor in woken:
        if processor.released_by_interrupt is not None:
            yield Object(_accepted(processor), "Boolean", FALSE)
    times = _integers(len(woken))
    yield Object("Earliest", times, all_else(number(0)))
    yield Subprogram(
        "Release_Waiting",
        (Param("Last", "in", "Positive"),),
        declarations=(Object("Executed", ELEMENT_ID), Object("Waiting", "Boolean")),
        body=tuple(body),
    )
    yield Subprogram("End_Instant", body=(do("Release_Waiting", number(len(woken))),))


def _start(system: System) -> tuple[Stmt, ...]:
    """Start all devices, where there are such as need it."""
    if not has_lifecycle(system):
        return ()
    words = StringLiteral("a device has not started")
    failed = RaiseStatement(ref("Program_Error"), words)
    start = do(ref(root_package(system), LIFECYCLE, "Start_All"), ref("Started"))
    return start, IfStatement(((Prefix("not", ref("Started")), (failed,)),))


def _accepted(processor: Processor) -> str:
    """Whether an interrupt has been accepted that has not released its processor."""
    return f"{ada_case(processor.name)}_Accepted"


def _interrupted(woken: Sequence[Processor], node: str, name: str) -> tuple[Stmt, ...]:
    """Accept an interrupt once the separation of its processor is over; () for another name."""
    for number_, one in enumerate(woken, 1):
        if one.released_by == InterruptLine(node, name):
            earliest = Indexed("Earliest", plain(number_))
            due = OperatorChain(">=", (ref("Ravenchart.Steps.Now"), earliest))
            return (IfStatement(((due, (Assign(_accepted(one), TRUE),)),)),)
    return ()


def _starts(root: str, woken: Sequence[Processor]) -> tuple[Stmt, ...]:
    """The starts of regions whose events release a processor: before the first instant."""
    found: list[Stmt] = []
    for taken in (processor.released_by for processor in woken):
        if isinstance(taken, Events):
            run = ref(root, ada_case(taken.instance), f"Run_{ada_case(taken.name)}")
            found += [Assign("Unused", number(0)), do(run, ref("Unused"))]
    return tuple(found)


def _integers(count: int) -> ArrayDefinition:
    return ArrayDefinition(up_to(plain(count)), INTEGER)


def _instants(times: list[int]) -> Expr:
    return Aggregate(tuple(Arg(plain(i), number(t)) for i, t in enumerate(times, 1)))


def _scalars(of_type: Type) -> list[ScalarType]:
    if isinstance(of_type, RecordType):
        return [f.type for f in of_type.fields]
    return [of_type]


def _taken(
    system: System, root: str, woken: Sequence[Processor], stimulus: Stimulus
) -> tuple[Stmt, ...]:
    name, what, of_type = stimulus
    if accepted := _interrupted(woken, name, what):
        return accepted
    instance: Instance = system.instance(name)
    steps: list[Stmt] = []
    value: Expr | None = None
    if of_type is not None:
        scalars = _scalars(of_type)
        steps += [do("Ravenchart.Steps.Get", _given(k)) for k in range(len(scalars))]
        parts = [_read(system, t, _given(k)) for k, t in enumerate(scalars)]
        value = parts[0]
        if isinstance(of_type, RecordType):
            fields = zip(of_type.fields, parts, strict=True)
            value = Aggregate(
                tuple(Arg(ada_case(f.name), part) for f, part in fields),
                type_name(system, of_type),
            )
    target = ref(root, ada_case(name))
    ports: tuple[Port, ...] = instance.component.inputs()
    if any(p.name == what for p in ports):
        assert value is not None
        end = End(name, what)
        links = links_by_port(system)
        now = (call("Ravenchart.Nanoseconds", ref("Ravenchart.Steps.Now")),) if end in links else ()
        steps.append(do(ref(root, put_of(system, end)), value, *now))
    else:
        event = event_value(instance.component, what, value, root=root)
        steps.append(do(ref(target, "Offer"), event))
    return tuple(steps)


def _given(position: int) -> Indexed:
    """One of the integers of a stimulus."""
    return Indexed("V", plain(position + 1))


def _read(system: System, of_type: ScalarType, item: Expr) -> Expr:
    name = type_name(system, of_type)
    return call(name if isinstance(of_type, IntegerType) else Attribute(name, "Val"), item)
