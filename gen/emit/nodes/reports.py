# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The end-of-run report and the main program."""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import ada_case, processor_package, root_package
from ravenchart.gen.emit.ada.syntax import (
    SPARK,
    TRUE,
    Aspect,
    Assign,
    Comment,
    Decl,
    Do,
    IfStatement,
    Loop,
    Object,
    OperatorChain,
    Package,
    Prefix,
    Ref,
    Say,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
    call,
    do,
    equal,
    number,
)
from ravenchart.gen.emit.certificate.certified import CERTIFICATE
from ravenchart.gen.emit.commands.lifecycle import UNIT as LIFECYCLE
from ravenchart.gen.emit.commands.lifecycle import has_lifecycle
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.emit.tables.trace_calls import element_constant, row_number, traced
from ravenchart.gen.emit.tables.value_calls import UNIT, recording
from ravenchart.gen.model.system import Processor, System

from .supervision import safe_state, supervised

POLL_NS = 5_000_000
"""How often the main program empties the trace and looks for a request to stop."""


def emit_reports(system: System, header: str) -> list[Unit]:
    """What is handed to the host: the trace while it runs, statistics at the end."""
    root = root_package(system)
    name = f"{root}.Reports"
    spec: list[Decl] = []
    bodies: list[Decl] = []
    if traced(system):
        spec += [Subprogram("Drain_Trace"), Comment("Hand what was traced to the host.")]
        bodies.append(_drain(system))
    spec += [Subprogram("Put_All"), Comment("Hand the statistics of all processors to the host.")]
    bodies += [_report(system, p) for p in system.processors]
    steps: list[Stmt] = [Do("Ravenchart.Hosts.Put_Now")]
    steps += [Do(f"Report_{ada_case(p.name)}") for p in system.processors]
    steps.append(Do("Health_Counts.Counters.Read", arguments(Ref("Faults"))))
    for bus in system.buses:
        log = f"{ada_case(bus.name)}_Faults"
        steps.append(Do(f"{ada_case(bus.name)}.Controller.Read_Faults", arguments(Ref(log))))
        for kind, count in (("Error_Passive", "Passive_Entries"), ("Bus_Off", "Off_Entries")):
            fault = f"Faults (Ravenchart.Health.Can_{kind})"
            steps.append(Assign(fault, Ref(f"{log}.{count}")))
    steps.append(
        Loop(
            "for Kind in Ravenchart.Health.Fault_Kind",
            (Do("Ravenchart.Hosts.Put_Fault_Count", arguments(Ref("Kind"), Ref("Faults (Kind)"))),),
        )
    )
    declarations: list[Decl] = [Object("Faults", "Ravenchart.Health.Fault_Counts")]
    if traced(system):
        declarations.append(Object("Lost", "Ravenchart.Event_Count"))
        for buffer, label in _buffers(system):
            steps.append(Assign("Lost", Ref(f"{buffer}.Lost")))
            word = Ref(f'"{label}"')
            steps.append(Do("Ravenchart.Hosts.Put_Lost", arguments(word, Ref("Lost"))))
    for bus in system.buses:
        counters = f"{ada_case(bus.name)}_Counters"
        declarations.append(Object(counters, "Ravenchart.Can.Counters"))
        log = f"{ada_case(bus.name)}_Faults"
        declarations.append(Object(log, "Ravenchart.Can.Fault_Notices.Fault_Log"))
        steps.append(Do(f"{ada_case(bus.name)}.Controller.Read_Counters", arguments(Ref(counters))))
        for field in ("Lost_Out", "Lost_In", "Rejected_Lines"):
            label = f'"{bus.name}.{field.lower()}"'
            steps.append(
                Do("Ravenchart.Hosts.Put_Lost", arguments(Ref(label), Ref(f"{counters}.{field}")))
            )
    if any(n.probe for n in system.nodes):
        declarations.append(Object("Late", "Ravenchart.Nanoseconds"))
        steps.append(Do("Host_Probe.Probe.Read", arguments(Ref("Late"))))
        steps.append(Do("Ravenchart.Hosts.Put_Host_Latency", arguments(Ref("Late"))))
    if supervised(system):
        declarations.append(Object("Fed", "Ravenchart.Event_Count"))
        steps.append(Do("Liveness_Supervision.Supervisor.Read", arguments(Ref("Fed"))))
        steps.append(Do("Ravenchart.Hosts.Put_Feeds", arguments(Ref("Fed"))))
    bodies.append(Subprogram("Put_All", declarations=tuple(declarations), body=tuple(steps)))
    context = {"Ravenchart.Hosts", "Ravenchart.Health", f"{root}.Health_Counts", f"{root}.Elements"}
    context |= {processor_package(system, p) for p in system.processors}
    context |= {f"{root}.{ada_case(b.name)}" for b in system.buses}
    if system.buses:
        context |= {"Ravenchart.Can", "Ravenchart.Can.Fault_Notices"}
    if any(n.probe for n in system.nodes):
        context.add(f"{root}.Host_Probe")
    if supervised(system):
        context.add(f"{root}.Liveness_Supervision")
    if traced(system):
        context |= {f"{root}.Trace", "Ravenchart.Queueing", "Ravenchart.Traces"}
        context |= _of_values(root) if recording(system) else set()
    return [
        Unit(header, (), Package(name, tuple(spec), (SPARK,))),
        Unit(header, tuple(sorted(context)), Package(name, tuple(bodies), (SPARK,), is_body=True)),
    ]


def _buffers(system: System) -> tuple[tuple[str, str], ...]:
    """What holds records until the host has them, and what the report calls it."""
    values = ((f"{UNIT}.Values", "values"),) if recording(system) else ()
    return (("Trace.Buffer", "trace"), *values)


def _of_values(root: str) -> set[str]:
    return {f"{root}.{UNIT}", "Ravenchart.Hosts.Value_Lines", "Ravenchart.Recorded_Values"}


def _drain(system: System) -> Subprogram:
    declarations: list[Decl] = [
        UseType("Ravenchart.Queueing.Take_Status"),
        Object("Item", "Ravenchart.Traces.Trace_Record"),
        Object("Status", "Ravenchart.Queueing.Take_Status"),
    ]
    body = [_drained("Trace.Buffer", "Item", "Ravenchart.Hosts.Put_Trace")]
    if recording(system):
        declarations.insert(2, Object("Value", "Ravenchart.Recorded_Values.Value_Record"))
        body.append(_drained(f"{UNIT}.Values", "Value", "Ravenchart.Hosts.Value_Lines.Put"))
    return Subprogram("Drain_Trace", declarations=tuple(declarations), body=tuple(body))


def _drained(buffer: str, item: str, put: str) -> Loop:
    """Hand all that a buffer holds to the host."""
    empty = equal(Ref("Status"), Ref("Ravenchart.Queueing.Empty"))
    return Loop(
        "",
        (
            Do(f"{buffer}.Take", arguments(Ref(item), Ref("Status"))),
            IfStatement(((empty, (Say("exit"),)),)),
            Do(put, arguments(Ref(item))),
        ),
    )


def _report(system: System, processor: Processor) -> Subprogram:
    package = ada_case(processor.name)
    own = Ref(f"Elements.{element_constant(processor.name, 'processor')}")
    row = row_number(processor, f"{package}.Row", "Row")
    return Subprogram(
        f"Report_{package}",
        declarations=(
            UseType("Ravenchart.Element_Id"),
            Object("Found", f"{package}.Processor.Statistics"),
        ),
        body=(
            Do(f"{package}.Processor.Observe", arguments(Ref("Found"))),
            Do(
                "Ravenchart.Hosts.Put_Processor",
                arguments(
                    own, Ref("Found.Releases"), Ref("Found.Misses"), Ref("Found.Worst_Response")
                ),
            ),
            Loop(
                f"for Row in {package}.Row",
                (
                    Do(
                        "Ravenchart.Hosts.Put_Activity",
                        arguments(row, Ref("Found.Worst_Execution (Row)")),
                    ),
                ),
            ),
        ),
    )


def emit_main(system: System, header: str) -> Unit:
    """The main program: it empties the trace, and leads the shutdown."""
    root = root_package(system)
    drain: tuple[Stmt, ...] = (Do(f"{root}.Reports.Drain_Trace"),) if traced(system) else ()
    wait: tuple[Stmt, ...] = (
        Assign("Next", OperatorChain("+", (Ref("Next"), Ref("Step")))),
        Say("delay until Next"),
    )
    shutdown = [
        Do(
            f"{root}.{ada_case(i)}.Offer",
            arguments(event_value(system.instance(i).component, e, prefix=f"{root}.")),
        )
        for i, e in system.shutdown.raises
    ]
    steps = -(-system.shutdown.grace // POLL_NS)
    begins = has_lifecycle(system)
    started = (do(f"{root}.{LIFECYCLE}.Start_All", Ref("Started")),) if begins else ()
    ended = OperatorChain("or else", (Ref("Stop"), Prefix("not", Ref("Started"))))
    body: list[Stmt] = [
        Do("Ravenchart.Hosts.Start"),
        do("Ravenchart.Hosts.Put_Model", Ref(f"{root}.{CERTIFICATE}.Model_Digest")),
        *started,
        Loop(
            "",
            (
                *drain,
                Assign("Stop", Ref("Ravenchart.Hosts.Stop_Requested")),
                IfStatement(((ended if begins else Ref("Stop"), (Say("exit"),)),)),
                *wait,
            ),
        ),
        *shutdown,
    ]
    if steps:
        body.append(Loop(f"for Unused in 1 .. {steps}", (*drain, *wait)))
    body += [
        *safe_state(system),
        *drain,
        Do(f"{root}.Reports.Put_All"),
        Do("Ravenchart.Hosts.Finish", arguments(Success=Ref("Started") if begins else TRUE)),
    ]
    withs = {"Ada.Real_Time", "Ravenchart.Hosts", "System", f"{root}.Reports"}
    withs.add(f"{root}.{CERTIFICATE}")
    withs |= {f"{root}.{LIFECYCLE}"} if begins else set()
    withs |= {f"{root}.{ada_case(i)}" for i, _ in system.shutdown.raises}
    withs |= {
        f"{root}.{ada_case(system.instance(i).component.name)}" for i, _ in system.shutdown.raises
    }
    return Unit(
        header,
        tuple(sorted(withs)),
        Subprogram(
            f"{root}_Main",
            aspects=(SPARK, Aspect("Priority", Ref("System.Priority'First"))),
            declarations=(
                UseType("Ada.Real_Time.Time"),
                Object(
                    "Step",
                    "Ada.Real_Time.Time_Span",
                    call("Ada.Real_Time.Milliseconds", number(POLL_NS // 1_000_000)),
                    constant=True,
                ),
                Object("Next", "Ada.Real_Time.Time", Ref("Ada.Real_Time.Clock")),
                Object("Stop", "Boolean"),
                *((Object("Started", "Boolean"),) if begins else ()),
            ),
            body=tuple(body),
        ),
    )
