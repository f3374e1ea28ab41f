# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The end-of-run report and the main program."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.crossing import MAIN_CORE, core_of, other_cores
from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    Object,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    Expr,
    Indexed,
    OperatorChain,
    Prefix,
    StringLiteral,
    call,
    number,
    plain,
    up_to,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import LOWEST, ada_case, processor_package, root_package
from ravenchart.gen.emit.ada.statements import (
    Assign,
    Comment,
    DelayUntil,
    ExitStatement,
    ForLoop,
    IfStatement,
    Loop,
    Stmt,
    do,
)
from ravenchart.gen.emit.buses.controllers import ORDERS, orders_by_priority
from ravenchart.gen.emit.certificate.certified import CERTIFICATE
from ravenchart.gen.emit.commands.lifecycle import UNIT as LIFECYCLE
from ravenchart.gen.emit.commands.lifecycle import has_lifecycle
from ravenchart.gen.emit.instances.fills import FILL, queued_regions, read_name
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.emit.tables.trace_calls import element_constant, row_number, traced
from ravenchart.gen.emit.tables.value_calls import UNIT, recording
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.nodes import DRAIN_PERIOD
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Processor, System

from .cores import (
    SUM,
    awaiting,
    buffers,
    copies_of,
    drained,
    found_on,
    of_processor,
    of_queue,
    report_unit,
    statistics_of,
)
from .supervision import safe_state, supervised


def emit_reports(system: System, header: str) -> list[Unit]:
    """The reports to the host: the trace while the program runs, statistics at its end."""
    root = root_package(system)
    name = ref(root, "Reports")
    spec: list[Decl] = []
    bodies: list[Decl] = []
    if traced(system):
        spec += [Subprogram("Drain_Trace"), Comment("Hand the trace to the host.")]
        bodies.append(_drain(system))
    spec += [Subprogram("Put_All"), Comment("Hand the statistics of all processors to the host.")]
    away = other_cores(system)
    if away:
        await_spec, await_body = awaiting(away)
        spec += [await_spec, Comment("Wait until each other core has handed over what it has.")]
        bodies.append(await_body)
    bodies += [_report(system, p) for p in system.processors]
    steps: list[Stmt] = [do("Ravenchart.Hosts.Put_Now")]
    steps += [do(ref(report_unit(core), "Board.Read"), ref(found_on(core))) for core in away]
    for core in (MAIN_CORE, *away):
        if core != MAIN_CORE:
            steps.append(do("Ravenchart.Hosts.Put_Other_Core", ref(found_on(core), "Seen")))
        steps += [_reported(p) for p in system.processors if p.core == core]
    steps += _queues(system)
    steps.append(do("Health_Counts.Counters.Read", ref("Faults")))
    steps += [_with_faults(core) for core in away]
    steps += _faults_of_buses(system)
    steps.append(
        Loop(
            ForLoop("Kind", "Ravenchart.Health.Fault_Kind"),
            (do("Ravenchart.Hosts.Put_Fault_Count", ref("Kind"), Indexed("Faults", ref("Kind"))),),
        )
    )
    declarations: list[Decl] = [Object("Faults", "Ravenchart.Health.Fault_Counts")]
    declarations += [Object("Queue_Fill", FILL) for _ in _of_queues(root, system)][:1]
    declarations += copies_of(away)
    if traced(system):
        declarations.append(Object("Lost", "Ravenchart.Event_Count"))
        for what, buffer, _ in buffers(system):
            steps.append(Assign("Lost", ref(buffer, "Lost")))
            for core in away:
                there = ref(found_on(core), f"{what}_Lost")
                steps.append(Assign("Lost", call(SUM, ref("Lost"), there)))
            word = StringLiteral(what.lower())
            steps.append(do("Ravenchart.Hosts.Put_Lost", word, ref("Lost")))
    for bus in system.buses:
        counters = f"{ada_case(bus.name)}_Counters"
        declarations.append(Object(counters, "Ravenchart.Can.Counters"))
        log = f"{ada_case(bus.name)}_Faults"
        declarations.append(Object(log, "Ravenchart.Can.Fault_Notices.Fault_Log"))
        steps.append(do(ref(ada_case(bus.name), "Controller.Read_Counters"), ref(counters)))
        for field in ("Lost_Out", "Lost_In", "Rejected_Lines"):
            word = StringLiteral(f"{bus.name}.{field.lower()}")
            steps.append(do("Ravenchart.Hosts.Put_Lost", word, ref(counters, field)))
    if any(n.probe for n in system.nodes):
        declarations.append(Object("Late", "Ravenchart.Nanoseconds"))
        steps.append(do("Host_Probe.Probe.Read", ref("Late")))
        steps.append(do("Ravenchart.Hosts.Put_Host_Latency", ref("Late")))
    if supervised(system):
        declarations.append(Object("Fed", "Ravenchart.Event_Count"))
        steps.append(do("Liveness_Supervision.Supervisor.Read", ref("Fed")))
        steps.append(do("Ravenchart.Hosts.Put_Feeds", ref("Fed")))
    bodies.append(Subprogram("Put_All", declarations=tuple(declarations), body=tuple(steps)))
    context = tuple(sorted(_context(system, root)))
    return [
        Unit(header, (), Package(name, tuple(spec), (SPARK,))),
        Unit(header, context, Package(name, tuple(bodies), (SPARK,), is_body=True)),
    ]


def _context(system: System, root: str) -> set[DottedName]:
    """The units that the reports need."""
    away = other_cores(system)
    context = {
        ref("Ravenchart.Hosts"),
        ref("Ravenchart.Health"),
        ref(root, "Health_Counts"),
        ref(root, "Elements"),
    }
    context |= {processor_package(system, p) for p in system.processors}
    context |= set(_of_queues(root, system))
    context |= {ref(root, ada_case(b.name)) for b in system.buses}
    if system.buses:
        context |= {ref("Ravenchart.Can"), ref("Ravenchart.Can.Fault_Notices")}
    context |= {ref(root, report_unit(core)) for core in away}
    context |= {ref("Ada.Real_Time")} if away else set()
    if any(n.probe for n in system.nodes):
        context.add(ref(root, "Host_Probe"))
    if supervised(system):
        context.add(ref(root, "Liveness_Supervision"))
    if traced(system):
        context |= {ref(root, "Trace"), ref("Ravenchart.Queueing"), ref("Ravenchart.Traces")}
        context |= _of_values(root) if recording(system) else set()
    return context


def _faults_of_buses(system: System) -> Iterator[Stmt]:
    """Count the faults of the controllers of all buses."""
    for bus in system.buses:
        log = f"{ada_case(bus.name)}_Faults"
        yield do(ref(ada_case(bus.name), "Controller.Read_Faults"), ref(log))
        for kind, count in (("Error_Passive", "Passive_Entries"), ("Bus_Off", "Off_Entries")):
            fault = Indexed("Faults", ref("Ravenchart.Health", f"Can_{kind}"))
            found: Expr = ref(log, count)
            if bus != system.buses[0]:
                found = call(SUM, fault, found)
            yield Assign(fault, found)


def _queued(system: System) -> Iterator[tuple[Instance, Region]]:
    """The regions that have a queue of events."""
    for instance in system.instances:
        for region in queued_regions(instance.component):
            yield instance, region


def _queues(system: System) -> Iterator[Stmt]:
    """Hand the fill of each queue of events to the host."""
    for instance, region in _queued(system):
        own = element_constant(f"{instance.name}.{region.name}", "region")
        found, core = ref("Queue_Fill"), core_of(system, instance.name)
        if core == MAIN_CORE:
            yield do(ref(ada_case(instance.name), read_name(region)), found)
        else:
            found = ref(found_on(core), of_queue(instance, region))
        yield do("Ravenchart.Hosts.Put_Queue", ref("Elements", own), found)


def _of_queues(root: str, system: System) -> Iterator[DottedName]:
    """The units that this needs: none where no region has a queue."""
    for instance, _ in _queued(system):
        if core_of(system, instance.name) == MAIN_CORE:
            yield from (ref(root, ada_case(instance.name)), ref("Ravenchart.Queueing"))


def _of_values(root: str) -> set[DottedName]:
    return {ref(root, UNIT), ref("Ravenchart.Hosts.Value_Lines"), ref("Ravenchart.Recorded_Values")}


def _drain(system: System) -> Subprogram:
    declarations: list[Decl] = [
        UseType("Ravenchart.Queueing.Take_Status"),
        Object("Item", "Ravenchart.Traces.Trace_Record"),
        Object("Status", "Ravenchart.Queueing.Take_Status"),
    ]
    put_trace = do("Ravenchart.Hosts.Put_Trace", ref("Item"))
    put_value = do("Ravenchart.Hosts.Value_Lines.Put", ref("Value"))
    away = [ref(report_unit(core)) for core in other_cores(system)]
    body = [drained(ref("Trace.Buffer"), "Item", put_trace)]
    body += [drained(ref(unit, "Trace_Out"), "Item", put_trace) for unit in away]
    if recording(system):
        declarations.insert(2, Object("Value", "Ravenchart.Recorded_Values.Value_Record"))
        body.append(drained(ref(UNIT, "Values"), "Value", put_value))
        body += [drained(ref(unit, "Values_Out"), "Value", put_value) for unit in away]
    return Subprogram("Drain_Trace", declarations=tuple(declarations), body=tuple(body))


def _with_faults(core: int) -> Loop:
    """Add the faults of another core."""
    own, there = Indexed("Faults", ref("Kind")), Indexed(f"{found_on(core)}.Faults", ref("Kind"))
    return Loop(
        ForLoop("Kind", "Ravenchart.Health.Fault_Kind"), (Assign(own, call(SUM, own, there)),)
    )


def _reported(processor: Processor) -> Stmt:
    """The call that hands the statistics of a processor to the host."""
    away = processor.core != MAIN_CORE
    given = [ref(found_on(processor.core), of_processor(processor))] if away else []
    return do(f"Report_{ada_case(processor.name)}", *given)


def _report(system: System, processor: Processor) -> Subprogram:
    package = ada_case(processor.name)
    own = ref("Elements", element_constant(processor.name, "processor"))
    row = row_number(processor, ref(package, "Row"), "Row")
    here = processor.core == MAIN_CORE
    kept = (Object("Found", statistics_of(processor)),) if here else ()
    observed = (do(ref(package, "Processor.Observe"), ref("Found")),) if here else ()
    return Subprogram(
        f"Report_{package}",
        () if here else (Param("Found", "in", statistics_of(processor)),),
        declarations=(UseType("Ravenchart.Element_Id"), *kept),
        body=(
            *observed,
            do(
                "Ravenchart.Hosts.Put_Processor",
                own,
                ref("Found.Releases"),
                ref("Found.Misses"),
                ref("Found.Worst_Response"),
                ref("Found.Last_Response"),
            ),
            Loop(
                ForLoop("Row", ref(package, "Row")),
                (
                    do(
                        "Ravenchart.Hosts.Put_Activity",
                        row,
                        Indexed("Found.Worst_Execution", ref("Row")),
                    ),
                ),
            ),
        ),
    )


def _pinned(system: System) -> tuple[Aspect, ...]:
    """Where there are several cores, the main program and the tasks that it starts have one."""
    return (Aspect("CPU", plain(MAIN_CORE)),) if other_cores(system) else ()


def emit_main(system: System, header: str) -> Unit:
    """The main program: it empties the trace, and leads the shutdown."""
    root = root_package(system)
    drain: tuple[Stmt, ...] = (do(ref(root, "Reports.Drain_Trace")),) if traced(system) else ()
    wait: tuple[Stmt, ...] = (
        Assign("Next", OperatorChain("+", (ref("Next"), ref("Step")))),
        DelayUntil(ref("Next")),
    )
    shutdown = [
        do(ref(root, ada_case(i), "Offer"), event_value(system.instance(i).component, e, root=root))
        for i, e in system.shutdown.raises
    ]
    steps = -(-system.shutdown.grace // DRAIN_PERIOD)
    begins = has_lifecycle(system)
    started = (do(ref(root, LIFECYCLE, "Start_All"), ref("Started")),) if begins else ()
    ended = OperatorChain("or else", (ref("Stop"), Prefix("not", ref("Started"))))
    ordered = orders_by_priority(system)
    body: list[Stmt] = [
        *ordered,
        do("Ravenchart.Hosts.Start"),
        do("Ravenchart.Hosts.Put_Model", ref(root, CERTIFICATE, "Model_Digest")),
        *started,
        Loop(
            None,
            (
                *drain,
                Assign("Stop", ref("Ravenchart.Hosts.Stop_Requested")),
                IfStatement(((ended if begins else ref("Stop"), (ExitStatement(),)),)),
                *wait,
            ),
        ),
        *shutdown,
    ]
    if steps:
        body.append(Loop(ForLoop("Unused", up_to(plain(steps))), (*drain, *wait)))
    body += [
        *safe_state(system),
        *((do(ref(root, "Reports.Await_Looks")),) if other_cores(system) else ()),
        *drain,
        do(ref(root, "Reports.Put_All")),
        do("Ravenchart.Hosts.Finish", Success=ref("Started") if begins else TRUE),
    ]
    withs = {ref("Ada.Real_Time"), ref("Ravenchart.Hosts"), ref("System"), ref(root, "Reports")}
    withs.add(ref(root, CERTIFICATE))
    withs |= {ref(root, LIFECYCLE)} if begins else set()
    withs |= {ref(ORDERS)} if ordered else set()
    withs |= {ref(root, ada_case(i)) for i, _ in system.shutdown.raises}
    withs |= {
        ref(root, ada_case(system.instance(i).component.name)) for i, _ in system.shutdown.raises
    }
    return Unit(
        header,
        tuple(sorted(withs)),
        Subprogram(
            f"{root}_Main",
            aspects=(SPARK, Aspect("Priority", LOWEST), *_pinned(system)),
            declarations=(
                UseType("Ada.Real_Time.Time"),
                Object(
                    "Step",
                    "Ada.Real_Time.Time_Span",
                    call("Ada.Real_Time.Milliseconds", number(DRAIN_PERIOD // 1_000_000)),
                    constant=True,
                ),
                Object("Next", "Ada.Real_Time.Time", ref("Ada.Real_Time.Clock")),
                Object("Stop", "Boolean"),
                *((Object("Started", "Boolean"),) if begins else ()),
            ),
            body=tuple(body),
        ),
    )
