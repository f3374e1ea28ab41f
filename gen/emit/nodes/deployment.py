# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Health, trace, probe and processors of a node."""

from __future__ import annotations

from ravenchart.gen.derive.crossing import MAIN_CORE, core_of, other_cores
from ravenchart.gen.derive.sharing import on_core
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    ArrayDefinition,
    Aspect,
    Decl,
    EnumType,
    GenericInstance,
    Object,
    Package,
    Param,
    Subprogram,
    TypeDeclaration,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Expr,
    Indexed,
    OperatorChain,
    StringLiteral,
    all_else,
    arguments,
    equal,
    number,
    record,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    constant_name,
    priority,
    processor_package,
    root_package,
    row_name,
)
from ravenchart.gen.emit.ada.statements import Case, Comment, Do, IfStatement, Pragma, Stmt, do
from ravenchart.gen.emit.buses.packages import emit_bus
from ravenchart.gen.emit.certificate.certified import (
    CERTIFICATE,
    agrees,
    fact,
    offset_fact,
    rows_agree,
    timed_by,
)
from ravenchart.gen.emit.tables.core_units import at_core
from ravenchart.gen.emit.tables.executions import ELEMENT_ID
from ravenchart.gen.emit.tables.trace_calls import (
    element_constant,
    fault,
    fault_units,
    row_number,
    traced,
)
from ravenchart.gen.emit.tables.trace_map import VALUE, MappedElement, elements
from ravenchart.gen.emit.tables.value_calls import UNIT, recording
from ravenchart.gen.model.instances import End, Events, Requests
from ravenchart.gen.model.nodes import InterruptLine, Node
from ravenchart.gen.model.recording import OBJECT
from ravenchart.gen.model.system import Processor, Slot, System, Work

from .cores import emit_core_reports, emit_crossings, own_task
from .reports import emit_main, emit_reports
from .supervision import emit_supervision, offer_from_outside

BUFFERS = ref("Ravenchart.Value_Buffers")

PROBE_STACK = 16_384
"""Bytes of stack for the host probe."""


def emit_deployment(system: System, header: str) -> tuple[Unit, ...]:
    """Everything that is not about one component or instance."""
    units = [_health(system, header), _elements(system, header)]
    away = other_cores(system)
    for core in (MAIN_CORE, *away):
        if core != MAIN_CORE:
            units += at_core([_health(system, header, core)], system, core)
        if traced(system):
            units.append(_trace(system, header, core))
        if recording(system):
            units.append(_recording(system, header, core))
    units += emit_crossings(system, header)
    units += [_probe(system, n, header) for n in system.nodes if n.probe is not None]
    for bus in system.buses:
        units += emit_bus(system, bus, header)
    for processor in system.processors:
        units += at_core(_processor(system, processor, header), system, processor.core)
    for core in away:
        units += emit_core_reports(system, core, header)
    units += emit_supervision(system, header)
    units += emit_reports(system, header)
    units.append(emit_main(system, header))
    return tuple(units)


def emit_without_tasks(system: System, header: str) -> tuple[Unit, ...]:
    """The units that instances need of it in a simulation."""
    crossings = emit_crossings(system, header, certified=False)
    return (_health(system, header), _elements(system, header), *crossings)


def _health(system: System, header: str, core: int = MAIN_CORE) -> Unit:
    args = arguments(Ceiling=priority(system.object(on_core("health", core)).ceiling))
    counters, reports = ref("Ravenchart.Health_Counters"), ref("Ravenchart.Fault_Reports")
    does = arguments(Record_Fault=ref("Counters.Record_Fault"))
    does += arguments(Note=ref("Trace.Buffer.Note")) if traced(system) else ()
    root = root_package(system)
    trace = (ref(root, "Trace"),) if traced(system) else ()
    items = GenericInstance("Counters", counters, args), GenericInstance("Faults", reports, does)
    package = Package(ref(root, "Health_Counts"), items, (SPARK,))
    return Unit(header, (counters, reports, ref("System"), *trace), package)


def _holding(
    system: System,
    unit: str,
    name: str,
    generic: Named,
    args: tuple[Arg, ...],
    header: str,
    checks: tuple[Decl, ...] = (),
) -> Unit:
    """A unit around an instance: gnatprove checks no ceiling in an instance that is a unit."""
    root = root_package(system)
    package = Package(ref(root, unit), (GenericInstance(name, generic, args), *checks), (SPARK,))
    return Unit(
        header, (ref(generic), ref(root, CERTIFICATE) if checks else ref("System")), package
    )


def _trace(system: System, header: str, core: int) -> Unit:
    depth = max(n.trace_depth for n in system.nodes)
    ceiling = priority(system.object(on_core("trace", core)).ceiling)
    args = arguments(Capacity=number(depth), Ceiling=ceiling)
    unit = on_core("Trace", core)
    return _holding(system, unit, "Buffer", "Ravenchart.Trace_Buffers", args, header)


def _recording(system: System, header: str, core: int) -> Unit:
    """The buffer of a core's values, as deep as the trace, and the number of each."""
    depth = max(n.trace_depth for n in system.nodes)
    ceiling = priority(system.object(on_core(OBJECT, core)).ceiling)
    args = arguments(Capacity=number(depth), Ceiling=ceiling)
    here = {
        one.element for one in system.recorded_values if core_of(system, one.of.instance) == core
    }
    values = (item for item in elements(system) if item.kind == VALUE and item.element in here)
    numbers = tuple(_numbered(constant_name(item.element), item) for item in values)
    package = Package(
        ref(root_package(system), on_core(UNIT, core)),
        (
            Comment("Numbers of the recorded values; trace.json has their names and locations."),
            *numbers,
            GenericInstance("Values", BUFFERS, args),
        ),
        (SPARK,),
    )
    return Unit(header, (BUFFERS, ref("System")), package)


def _probe(system: System, node: Node, header: str) -> Unit:
    assert node.probe is not None
    element = f"{node.name}.probe"
    args = arguments(
        Name=StringLiteral(element),
        Period=fact(element, "T"),
        Probe_Priority=fact(element, "Priority"),
        Stack_Bytes=number(PROBE_STACK),
    )
    checks = (
        UseType("Ravenchart.Nanoseconds"),
        agrees("Probe.Given_Period", fact(element, "T"), element, "period"),
        agrees("Probe.Given_Priority", fact(element, "Priority"), element, "priority"),
    )
    return _holding(system, "Host_Probe", "Probe", "Ravenchart.Host_Probes", args, header, checks)


def _elements(system: System, header: str) -> Unit:
    items: list[Decl] = [
        Comment("Numbers of the model's elements; trace.json has their names and locations.")
    ]
    for item in elements(system):
        if item.kind != VALUE:
            items.append(_numbered(element_constant(item.element, item.kind), item))
    package = Package(ref(root_package(system), "Elements"), tuple(items), (SPARK, Aspect("Pure")))
    return Unit(header, (), package)


def _numbered(name: str, item: MappedElement) -> Object:
    return Object(name, "Ravenchart.Element_Id", number(item.number), constant=True)


# --- Processors --------------------------------------------------------------


def _processor(system: System, processor: Processor, header: str) -> list[Unit]:
    root, name = root_package(system), processor_package(system, processor)
    offset = offset_fact(system, processor.name)
    rows = tuple(row_name(s) for s in processor.slots)
    items: list[Decl] = [
        Comment(f"[{processor.name}.table] the activities, in the order of execution"),
        EnumType("Row", rows),
        Subprogram("Execute", (Param("Item", "in", "Row"),)),
        Subprogram("On_Deadline_Miss"),
    ]
    shared = arguments(
        Deadline=fact(processor.name, "D"),
        Task_Priority=fact(processor.name, "Priority"),
        Ceiling=priority(system.object(f"{processor.name}.monitor").ceiling),
        Stack_Bytes=number(processor.stack_bytes),
        Execute=ref("Execute"),
        On_Deadline_Miss=ref("On_Deadline_Miss"),
    )
    if processor.released_by is None:
        generic = ref("Ravenchart.Periodic_Processors")
        slots = tuple(Arg(ref(row_name(s)), _slot(processor, s)) for s in processor.slots)
        items.append(
            TypeDeclaration("Row_Table", ArrayDefinition("Row", "Ravenchart.Schedules.Slot"))
        )
        args = arguments(
            Activity_Id=ref("Row"),
            Table_Type=ref("Row_Table"),
            Table=Aggregate(slots),
            Cycle=number(processor.cycle),
            Period=fact(processor.name, "T"),
            Offset=offset,
        )
    else:
        generic = ref("Ravenchart.Sporadic_Processors")
        args = arguments(
            Activity_Id=ref("Row"),
            Minimum_Separation=fact(processor.name, "T"),
            Wait=_wait(processor),
        )
    line = processor.released_by_interrupt
    if line is not None:
        items.append(Subprogram("Await"))
        items.append(Comment(f"[{line}] suspend the processor until an interrupt is accepted."))
    if processor.on_overrun:
        shared += arguments(On_Executed=ref("On_Executed"))
        items += _budgets(processor)
    named = arguments(Name=StringLiteral(processor.name))
    own: tuple[Decl, ...] = ()
    if processor.core == MAIN_CORE:
        items.append(Comment(f"[{processor.name}]"))
        items.append(GenericInstance("Processor", generic, (*named, *args, *shared)))
        items += _checks(processor, offset)
        withs = {generic, ref("System"), ref(root, CERTIFICATE)}
    else:
        made, own, withs = _on_other_core(processor, (*named, *args, *shared))
        items += made
        withs |= {ref("System"), ref(root, CERTIFICATE)}
    if processor.released_by is None:
        withs.add(ref("Ravenchart.Schedules"))
    elif line is None:
        withs.add(ref(root, _wait(processor).parent))
    context = fault_units(root)
    context |= {_ARRIVALS, _SOURCES} if line is not None else set()
    context |= {row_unit(system, s) for s in processor.slots}
    context |= {ref(root, ada_case(i)) for i, _ in processor.raises}
    context |= {ref(root, ada_case(system.instance(i).component.name)) for i, _ in processor.raises}
    if traced(system):
        context |= {ref(root, "Trace"), ref("Ravenchart.Traces")}
    spec = Package(name, tuple(items), (SPARK,))
    interrupts = () if line is None else _interrupts(system, processor, line)
    bodies = (*interrupts, *_processor_body(system, processor), *own)
    body = Package(name, bodies, (SPARK,), is_body=True)
    return [
        Unit(header, tuple(sorted(withs)), spec),
        Unit(header, tuple(sorted(context - withs)), body),
    ]


def _on_other_core(
    processor: Processor, given: tuple[Arg, ...]
) -> tuple[list[Decl], tuple[Decl, ...], set[DottedName]]:
    """The parts of a processor with its own task: spec, body, and the units that they need."""
    values = {str(arg.name): arg.value for arg in given}
    measured, run = ref("Ravenchart.Measured_Releases"), ref("Releases.Run")
    found: list[Decl] = []
    if processor.released_by is None:
        loop = ref("Ravenchart.Periodic_Loops")
        work = arguments(Run=run)
        taken: tuple[str, ...] = ("Name", "Cycle", "Period", "Offset")
    else:
        loop = ref("Ravenchart.Sporadic_Loops")
        work = arguments(Start_Release=ref("Releases.Start_Release"), Run=run)
        taken = ("Name", "Minimum_Separation", "Wait")
        rows = ArrayDefinition("Row", "Ravenchart.Schedules.Slot")
        found.append(TypeDeclaration("Row_Table", rows))
        every = record({"Divisor": number(1), "Phase": number(0)})
        values |= {"Table_Type": ref("Row_Table"), "Table": all_else(every)}
    parts = (
        *("Activity_Id", "Table_Type", "Table", "Deadline", "Ceiling"),
        *("Execute", "On_Deadline_Miss", "On_Executed"),
    )
    releases = tuple(Arg(name, values[name]) for name in parts if name in values)
    looped = (*(Arg(name, values[name]) for name in taken), *work)
    spec, body = own_task(
        "Processor", processor.core, values["Task_Priority"], processor.stack_bytes
    )
    if processor.on_overrun:  # the body compares
        found.append(UseType("Ravenchart.Nanoseconds"))
    found += [
        Comment(f"[{processor.name}]"),
        GenericInstance("Releases", measured, releases),
        GenericInstance("Run_All", loop, looped, kind="procedure"),
        *spec,
    ]
    return found, body, {measured, loop, ref("Ravenchart.Schedules")}


def _wait(processor: Processor) -> DottedName:
    """The call in which a sporadic processor waits: for a frame, or for what its queue takes."""
    by = processor.released_by
    if isinstance(by, InterruptLine):
        return ref("Await")
    if isinstance(by, End | Requests | Events):
        return ref(ada_case(by.instance), f"Await_{ada_case(by.name)}")
    return ref(ada_case(by or ""), "Receiver.Wait")


_ARRIVALS, _SOURCES = ref("Ravenchart.Interrupt_Releases"), ref("Ravenchart.Interrupt_Sources")
_SIGNALS = {"SIGUSR1": 10, "SIGUSR2": 12}
"""Numbers of Linux."""


def _interrupts(system: System, processor: Processor, line: InterruptLine) -> tuple[Decl, ...]:
    """Where the interrupts of a processor come from, and how it waits for them."""
    interrupt = system.node(line.node).interrupt(line.name)
    signal = 0 if interrupt.signal is None else _SIGNALS[interrupt.signal]
    source = arguments(
        Signal=number(signal), Number=number(interrupt.number or 0), Arrive=ref("Arrivals.Arrive")
    )
    lost = fault("Queue_Overflow", processor.name, "processor")
    return (
        Comment(f"[{line}]"),
        GenericInstance("Arrivals", _ARRIVALS, arguments(Separation=fact(processor.name, "T"))),
        GenericInstance("Source", _SOURCES, source),
        Pragma("Unreferenced", (ref("Source"),)),
        Subprogram(
            "Await",
            declarations=(Object("Too_Soon", "Boolean"),),
            body=(
                do(ref("Arrivals.Wait"), ref("Too_Soon")),
                IfStatement(((ref("Too_Soon"), (lost,)),)),
            ),
        ),
    )


def _checks(processor: Processor, offset: Expr) -> list[Decl]:
    """The task runs as its certificate says."""
    separation = "Period" if processor.released_by is None else "Separation"
    compared: list[tuple[str, Expr, str]] = [
        ("Given_Priority", fact(processor.name, "Priority"), "priority"),
        (f"Given_{separation}", fact(processor.name, "T"), separation.lower()),
        ("Given_Deadline", fact(processor.name, "D"), "deadline"),
    ]
    if processor.released_by is None:
        compared.append(("Given_Offset", offset, "offset"))
    found: list[Decl] = [
        UseType("Ravenchart.Nanoseconds"),
        *(
            agrees(ref("Processor", given), to, processor.name, what)
            for given, to, what in compared
        ),
    ]
    if processor.released_by is None:
        found += rows_agree(processor, "Processor.Given_Table")
    return found


def _slot(processor: Processor, slot: Slot) -> Expr:
    facts = {
        what: fact(timed_by(processor.name, processor.slots, slot), what)
        for what in ("Divisor", "Phase")
    }
    return record(facts)


def row_unit(system: System, slot: Slot) -> DottedName:
    """The package with the procedure of a row."""
    return ref(root_package(system), _package(slot))


def row_call(slot: Slot) -> Do:
    """One execution of a row."""
    name = slot.work.value if slot.of_bus else slot.name
    return do(ref(_package(slot), f"Run_{ada_case(name)}"), ref("Executed"))


def _package(slot: Slot) -> DottedName:
    """Where the procedure of a row is."""
    units = {Work.BUS_RECEIVE: ["Receiver"], Work.BUS_WATCH: ["Watch"]}
    return ref(ada_case(slot.owner), *units.get(slot.work, []))


def _processor_body(system: System, processor: Processor) -> tuple[Decl, ...]:
    rows = [(row_name(slot), (row_call(slot),)) for slot in processor.slots]
    execute: list[Stmt] = []
    if traced(system):
        execute.append(
            do(
                "Trace.Buffer.Note",
                ref("Ravenchart.Traces.Activity"),
                row_number(processor, "Row", "Item"),
                number(0),
            )
        )
    execute.append(Case(ref("Item"), tuple(rows)))
    #  each row once, and none for another
    execute.append(
        Pragma("Assert", (equal(ref("Executed"), row_number(processor, "Row", "Item")),))
    )
    missed = _fault(system, processor, "Deadline_Miss", processor.on_deadline_miss)
    uses = [UseType(ELEMENT_ID)]
    found: list[Decl] = [
        Subprogram(
            "Execute",
            (Param("Item", "in", "Row"),),
            declarations=(Object("Executed", ELEMENT_ID, number(0)),),
            body=tuple(execute),
        ),
        Subprogram("On_Deadline_Miss", body=missed),
    ]
    if processor.on_overrun:
        over = OperatorChain(">", (ref("Used"), Indexed("Budgets", ref("Item"))))
        raised = _fault(system, processor, "Overrun", processor.on_overrun)
        found.append(Subprogram("On_Executed", _EXECUTED, body=(IfStatement(((over, raised),)),)))
    return (*uses, *found)


_EXECUTED = (Param("Item", "in", "Row"), Param("Used", "in", "Ravenchart.Nanoseconds"))


def _budgets(processor: Processor) -> list[Decl]:
    """The enforced limit of each row, and the procedure that compares execution times with it."""
    rows = tuple(Arg(ref(row_name(slot)), fact(slot.element, "Wcet")) for slot in processor.slots)
    return [
        Subprogram("On_Executed", _EXECUTED),
        TypeDeclaration("Row_Budgets", ArrayDefinition("Row", "Ravenchart.Nanoseconds")),
        Comment(f"[{processor.name}.table] the enforced limit of each activity's execution time"),
        Object("Budgets", "Row_Budgets", Aggregate(rows), constant=True),
    ]


def _fault(
    system: System, processor: Processor, kind: str, events: tuple[tuple[str, str], ...]
) -> tuple[Stmt, ...]:
    """Count and note a fault of a processor, and raise its events."""
    return (
        fault(kind, processor.name, "processor"),
        *(offer_from_outside(system, instance, event) for instance, event in events),
    )
