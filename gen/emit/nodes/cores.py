# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Nodes with several cores: what goes from core to core, and the tasks of other cores.

Each core counts its own faults and keeps its own trace. The main program runs on the first core.
On each other one a task of the lowest priority looks at what the main program reports, and hands
it over; neither waits for the other.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ravenchart.gen.derive.crossing import MAIN_CORE, Crossing, core_of, crossings, reporter
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    GenericInstance,
    Object,
    Package,
    Param,
    RecordComponent,
    RecordDeclaration,
    SingleTask,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    Arg,
    Expr,
    OperatorChain,
    StringLiteral,
    all_else,
    arguments,
    call,
    equal,
    number,
    plain,
    up_to,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import (
    LOWEST,
    ada_case,
    constant_name,
    default_value,
    processor_package,
    root_package,
    type_name,
)
from ravenchart.gen.emit.ada.statements import (
    Assign,
    Comment,
    DelayUntil,
    ExitStatement,
    ForLoop,
    IfStatement,
    Loop,
    Pragma,
    Stmt,
    do,
)
from ravenchart.gen.emit.certificate.certified import CERTIFICATE, fact
from ravenchart.gen.emit.instances.fills import FILL, queued_regions, read_name
from ravenchart.gen.emit.tables.core_units import at_core
from ravenchart.gen.emit.tables.port_calls import CROSSINGS, VISIBLE
from ravenchart.gen.emit.tables.trace_calls import fault, fault_units, note, traced
from ravenchart.gen.emit.tables.value_calls import UNIT, recording
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.component import PortKind
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.nodes import DRAIN_PERIOD
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Processor, System

STACK = 32_768
"""Bytes of stack for the task that hands reports over."""

LOOKS = 200
"""How often the main program waits DRAIN_PERIOD for a look at another core, at most."""

BOARDS, QUEUES = ref("Ravenchart.Crossing_Boards"), ref("Ravenchart.Crossing_Queues")
SAMPLES, LOOPS = ref("Ravenchart.Crossing_Samples"), ref("Ravenchart.Periodic_Loops")
LOGICAL = ref("Ravenchart.Logical_Samples")
SUM = "Ravenchart.Sum"


# --- Values ----------------------------------------------------------------------------


def emit_crossings(system: System, header: str, *, certified: bool = True) -> list[Unit]:
    """The mailboxes of `crossings`, and the calls of senders; ``certified``: by a certificate."""
    found = crossings(system)
    if not found:
        return []
    root = root_package(system)
    spec: list[Decl] = []
    bodies: list[Decl] = []
    context: set[DottedName] = set()
    for one in found:
        spec += _mailbox(system, one, certified)
        (sent,) = at_core([_putting(system, one, header)], system, one.sent_on)
        assert isinstance(sent.item, Package)
        bodies += sent.item.items
        context |= set(sent.withs)
    generics = {_generic(one) for one in found}
    if certified and any(one.logical is not None for one in found):
        generics.add(ref(root, CERTIFICATE))
    name = ref(root, CROSSINGS)
    return [
        Unit(header, tuple(sorted(generics)), Package(name, tuple(spec), (SPARK,))),
        Unit(header, tuple(sorted(context)), Package(name, tuple(bodies), (SPARK,), is_body=True)),
    ]


def _mailbox(system: System, one: Crossing, certified: bool) -> Iterator[Decl]:
    own, element = constant_name(one.element), type_name(system, one.port.type)
    args = arguments(Element_Type=element, Null_Element=default_value(system, one.port.type))
    cores = f"from core {one.sent_on} to core {one.taken_on}"
    if one.logical is not None:
        cores = f"visible {shown(one.logical.lasting)} after the release of {one.senders[0]}"
        depth = fact(one.element, "Depth") if certified else number(one.logical.depth)
        args += arguments(Depth=depth)
    elif one.port.kind is PortKind.QUEUED:
        args += arguments(Capacity=number(one.port.depth))
    yield Comment(f"[{one.element}] {cores}")
    yield GenericInstance(own, _generic(one), args)
    yield Subprogram(f"Put_{own}", _value(system, one))
    yield Comment(f"[{one.element}.mailbox] called by {one.senders[0]} alone; never waits.")


def _generic(one: Crossing) -> DottedName:
    """The generic of a mailbox."""
    if one.logical is not None:
        return LOGICAL
    return SAMPLES if one.port.kind is PortKind.SAMPLED else QUEUES


def _value(system: System, one: Crossing) -> tuple[Param, ...]:
    item = Param("Item", "in", type_name(system, one.port.type))
    return (item,) if one.logical is None else (item, VISIBLE)


def _putting(system: System, one: Crossing, header: str) -> Unit:
    """The call of the sender, as it would stand on the first core."""
    root, own = root_package(system), constant_name(one.element)
    noted = note(system, "Arrived", one.element, "port")
    declarations: list[Decl] = []
    if one.port.kind is PortKind.SAMPLED:
        given = [ref(param.name) for param in _value(system, one)]
        body: list[Stmt] = [*noted, do(ref(own, "Put"), *given)]
    else:
        declarations += [
            UseType("Ravenchart.Queueing.Put_Status"),
            Object("Status", "Ravenchart.Queueing.Put_Status"),
        ]
        lost = OperatorChain("/=", (ref("Status"), ref("Ravenchart.Queueing.Queued")))
        told = fault("Queue_Overflow", one.element, "port")
        put = do(ref(own, "Put"), ref("Item"), ref("Status"))
        body = [*noted, put, IfStatement(((lost, (told,)),))]
    sub = Subprogram(
        f"Put_{own}", _value(system, one), declarations=tuple(declarations), body=tuple(body)
    )
    context = {ref("Ravenchart.Queueing"), ref(root, "Elements"), *fault_units(root)}
    if traced(system):
        context |= {ref(root, "Trace"), ref("Ravenchart.Traces")}
    return Unit(header, tuple(sorted(context)), Package("Sending", (sub,)))


# --- Tasks -----------------------------------------------------------------------------


def own_task(
    name: str, core: int, level: Expr, stack: int
) -> tuple[tuple[Decl, ...], tuple[Decl, ...]]:
    """The spec and body of a task on a core, whose work is `Run_All`.

    The CPU of a task has to be static, so no generic can have it as a parameter (RM D.7).
    """
    silent = Pragma(
        "Warnings",
        (
            ref("GNATprove"),
            ref("Off"),
            StringLiteral('pragma "Storage_Size" ignored*'),
            Arg("Reason", StringLiteral("stack use is not a matter of proof")),
        ),
    )
    aspects = (
        Aspect("Priority", level),
        Aspect("CPU", plain(core)),
        Aspect("Storage_Size", number(stack)),
    )
    return (silent, SingleTask(name, aspects)), (SingleTask(name, body=(do("Run_All"),)),)


class _Reported(NamedTuple):
    """One item that the main program reports of another core."""

    name: str
    type: DottedName
    read: Stmt
    """Fills it in, on that core."""


def report_unit(core: int) -> str:
    """The package of what the main program reports of another core."""
    return f"Reports_{core}"


def found_on(core: int) -> str:
    """The main program's copy of it."""
    return f"Found_{core}"


def of_processor(processor: Processor) -> str:
    """The statistics of a processor there."""
    return f"Of_{ada_case(processor.name)}"


def of_queue(instance: Instance, region: Region) -> str:
    """The fill of a region's queue there."""
    return f"Of_{constant_name(f'{instance.name}.{region.name}')}"


def statistics_of(processor: Processor) -> DottedName:
    """The type of a processor's statistics."""
    own = "Processor" if processor.core == MAIN_CORE else "Releases.Monitor"
    return ref(ada_case(processor.name), own, "Statistics")


def buffers(system: System) -> Iterator[tuple[str, DottedName, DottedName]]:
    """The buffers of records of a core: unit and buffer, the records, and a name for both."""
    if traced(system):
        yield "Trace", ref("Trace.Buffer"), ref("Ravenchart.Traces.Trace_Record")
    if recording(system):
        record = ref("Ravenchart.Recorded_Values.Value_Record")
        yield "Values", ref(UNIT, "Values"), record


def _reported(system: System, core: int) -> Iterator[_Reported]:
    for processor in system.processors:
        if processor.core == core:
            name, package = of_processor(processor), ada_case(processor.name)
            read = do(ref(package, "Releases.Observe"), ref("Found", name))
            yield _Reported(name, statistics_of(processor), read)
    for instance in system.instances:
        if core_of(system, instance.name) == core:
            for region in queued_regions(instance.component):
                name = of_queue(instance, region)
                read = do(ref(ada_case(instance.name), read_name(region)), ref("Found", name))
                yield _Reported(name, FILL, read)
    read = do("Health_Counts.Counters.Read", ref("Found.Faults"))
    yield _Reported("Faults", ref("Ravenchart.Health.Fault_Counts"), read)


def emit_core_reports(system: System, core: int, header: str) -> tuple[Unit, ...]:
    """The task of a core that looks at what the main program reports of it."""
    node, root = system.nodes[0], root_package(system)
    element = reporter(node, core)
    items = list(_reported(system, core))
    count = "Ravenchart.Event_Count"
    fields = [
        RecordComponent("Looks", count, number(0)),
        RecordComponent("Seen", "Ravenchart.Nanoseconds", number(0)),
    ]
    for item in items:
        initial = all_else(number(0) if item.name == "Faults" else BOX)
        fields.append(RecordComponent(item.name, item.type, initial))
    lost = [f"{name}_Lost" for name, _, _ in buffers(system)]
    fields += [RecordComponent(name, count, number(0)) for name in lost]
    run = (Param("Unused_Release", "in", "Natural"), Param("Unused_Due", "in", TIME))
    spec_task, body_task = own_task("Reporter", core, LOWEST, STACK)
    spec: list[Decl] = [
        Comment("Looks counts how often the task has looked; Seen is when it began to."),
        RecordDeclaration("Findings", tuple(fields)),
        GenericInstance(
            "Board", BOARDS, arguments(Element_Type=ref("Findings"), Initial=all_else(BOX))
        ),
        *_ways_out(system),
        Subprogram("Look", run),
        Comment(f"Hand over what has come on core {core} since the last time."),
        GenericInstance(
            "Run_All",
            LOOPS,
            arguments(
                Name=StringLiteral(element),
                Cycle=number(1),
                Period=number(DRAIN_PERIOD),
                Offset=number(0),
                Run=ref("Look"),
            ),
            kind="procedure",
        ),
        Comment(f"[{element}]"),
        *spec_task,
    ]
    body: list[Decl] = [
        Comment("Of the task alone"),
        Object("Looks", count, number(0)),
        Subprogram("Look", run, declarations=tuple(_variables(system)), body=_look(system, items)),
        *body_task,
    ]
    withs = {BOARDS, LOOPS, TIME.parent, ref("System"), ref("Ravenchart.Health")}
    withs |= {processor_package(system, p) for p in system.processors if p.core == core}
    context = {ref("Ravenchart.Epochs"), ref(root, "Health_Counts")}
    here = [i for i in system.instances if core_of(system, i.name) == core]
    queued = [i for i in here if queued_regions(i.component)]
    context |= {ref(root, ada_case(i.name)) for i in queued}
    withs |= {ref("Ravenchart.Queueing")} if queued else set()
    if lost:
        context.add(ref("Ravenchart.Queueing"))
        withs |= {QUEUES, *(record.parent for _, _, record in buffers(system))}
        context |= {ref(root, buffer.first) for _, buffer, _ in buffers(system)}
    name = ref(root, report_unit(core))
    units = (
        Unit(header, tuple(sorted(withs)), Package(name, tuple(spec), (SPARK,))),
        Unit(
            header,
            tuple(sorted(context - withs)),
            Package(name, tuple(body), (SPARK,), is_body=True),
        ),
    )
    return at_core(units, system, core)


TIME = ref("Ada.Real_Time.Time")


def _ways_out(system: System) -> Iterator[Decl]:
    """The queues of records to the main program, each as deep as the buffer."""
    depth = max(node.trace_depth for node in system.nodes)
    for name, _, record in buffers(system):
        args = arguments(
            Element_Type=record,
            Null_Element=ref(record.parent, "Null_Record"),
            Capacity=number(depth),
        )
        yield GenericInstance(f"{name}_Out", QUEUES, args)


def _variables(system: System) -> Iterator[Decl]:
    if any(buffers(system)):
        yield UseType("Ravenchart.Queueing.Take_Status")
    yield Object("Found", "Findings")
    for name, _, record in buffers(system):
        yield Object(f"{name}_Item", record)
    if any(buffers(system)):
        yield Object("Taken", "Ravenchart.Queueing.Take_Status")
        yield Object("Unused_Put", "Ravenchart.Queueing.Put_Status")
        yield Object("Lost", "Ravenchart.Event_Count")


def _look(system: System, items: Sequence[_Reported]) -> tuple[Stmt, ...]:
    body: list[Stmt] = [
        Assign("Looks", call("Ravenchart.Next", ref("Looks"))),
        Assign("Found.Looks", ref("Looks")),
        do("Ravenchart.Epochs.Since_Start", ref("Found.Seen")),
        *(item.read for item in items),
    ]
    for name, buffer, _ in buffers(system):
        out, item = f"{name}_Out", f"{name}_Item"
        body.append(
            drained(buffer, item, do(ref(out, "Put"), ref(item), ref("Unused_Put")), status="Taken")
        )
        body += [
            Assign(f"Found.{name}_Lost", ref(buffer, "Lost")),
            Assign("Lost", ref(out, "Lost")),
            Assign(f"Found.{name}_Lost", call(SUM, ref(f"Found.{name}_Lost"), ref("Lost"))),
        ]
    return (*body, do("Board.Write", ref("Found")))


def drained(buffer: Named, item: str, put: Stmt, status: str = "Status") -> Loop:
    """Hand over all that a buffer holds."""
    empty = equal(ref(status), ref("Ravenchart.Queueing.Empty"))
    return Loop(
        None,
        (
            do(ref(buffer, "Take"), ref(item), ref(status)),
            IfStatement(((empty, (ExitStatement(),)),)),
            put,
        ),
    )


def awaiting(cores: Sequence[int]) -> tuple[Subprogram, Subprogram]:
    """Of the main program: wait until the task of each other core has looked once more."""
    later = OperatorChain("+", (ref("Next"), call("Ada.Real_Time.Milliseconds", _STEP)))
    body: list[Stmt] = []
    for core in cores:
        found = ref(found_on(core))
        read = do(ref(report_unit(core), "Board.Read"), found)
        enough = OperatorChain(">=", (ref(found, "Looks"), call(SUM, ref("Before"), number(2))))
        waiting = (
            IfStatement(((enough, (ExitStatement(),)),)),
            Assign("Next", later),
            DelayUntil(ref("Next")),
            read,
        )
        body += [read, Assign("Before", ref(found, "Looks"))]
        body.append(Loop(ForLoop("Unused", up_to(plain(LOOKS))), waiting))
    return (
        Subprogram("Await_Looks"),
        Subprogram(
            "Await_Looks",
            declarations=(
                UseType(TIME),
                UseType("Ravenchart.Event_Count"),
                *copies_of(cores),
                Object("Next", TIME, ref("Ada.Real_Time.Clock")),
                Object("Before", "Ravenchart.Event_Count"),
            ),
            body=tuple(body),
        ),
    )


def copies_of(cores: Sequence[int]) -> Iterator[Decl]:
    """The main program's copies of what was found on these cores."""
    for core in cores:
        yield Object(found_on(core), ref(report_unit(core), "Findings"))


_STEP = number(DRAIN_PERIOD // 1_000_000)
