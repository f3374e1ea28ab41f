"""Processors, buses, health, trace and the main program of a node."""

from __future__ import annotations

from ..model import Bus, Message, Node, Processor, Slot, System, Work
from ..trace import elements
from .ada import (
    SPARK,
    TRUE,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Call,
    Case,
    CaseExpr,
    Chain,
    Comment,
    Decl,
    Do,
    EnumType,
    Expr,
    If,
    Instance,
    Loop,
    Object,
    Package,
    Param,
    PlainType,
    Ref,
    Say,
    Stmt,
    Subprogram,
    Unit,
    UseType,
    arguments,
    call,
    equal,
    member,
    number,
)
from .naming import ada_case, priority, processor_package, row_name, type_name
from .trace_calls import element_constant, note, traced

DRIVER_STACK = 65_536
"""Bytes of stack for each task of a CAN driver on a host."""

PROBE_STACK = 16_384
"""Bytes of stack for the host probe."""


def emit_deployment(system: System, header: str) -> tuple[Unit, ...]:
    """Everything that is not about one component or instance."""
    units = [_health(system, header), _elements(system, header)]
    if traced(system):
        units.append(_trace(system, header))
    units += [_probe(system, n, header) for n in system.nodes if n.probe is not None]
    for bus in system.buses:
        units += _bus(system, bus, header)
    for processor in system.processors:
        units += _processor(system, processor, header)
    units += _reports(system, header)
    units.append(_main(system, header))
    return tuple(units)


def _root(system: System) -> str:
    return ada_case(system.name)


def _health(system: System, header: str) -> Unit:
    args = arguments(Ceiling=priority(system.object("health").ceiling))
    name = f"{_root(system)}.Health_Counts"
    return Unit(
        header,
        ("Ravenchart.Health_Counters", "System"),
        Instance(name, "Ravenchart.Health_Counters", args),
    )


def _trace(system: System, header: str) -> Unit:
    depth = max(n.trace_depth for n in system.nodes)
    args = arguments(Capacity=number(depth), Ceiling=priority(system.object("trace").ceiling))
    name = f"{_root(system)}.Trace"
    return Unit(
        header,
        ("Ravenchart.Trace_Buffers", "System"),
        Instance(name, "Ravenchart.Trace_Buffers", args),
    )


def _probe(system: System, node: Node, header: str) -> Unit:
    assert node.probe is not None
    level = next(t.priority for t in system.tasks if t.element == f"{node.name}.probe")
    args = arguments(
        Period=number(node.probe.period),
        Probe_Priority=priority(level),
        Stack_Bytes=number(PROBE_STACK),
    )
    name, generic = f"{_root(system)}.Host_Probe", "Ravenchart.Host_Probes"
    return Unit(header, (generic, "System"), Instance(name, generic, args))


def _elements(system: System, header: str) -> Unit:
    items: list[Decl] = [
        Comment("Numbers of the model's elements; trace.json has their names and places.")
    ]
    for item in elements(system):
        name = element_constant(item.element, item.kind)
        items.append(Object(name, "Ravenchart.Element_Id", number(item.number), constant=True))
    package = Package(f"{_root(system)}.Elements", tuple(items), (SPARK, Aspect("Pure")))
    return Unit(header, (), package)


# --- Buses -------------------------------------------------------------------


def _sent(system: System, bus: Bus) -> tuple[Message, ...]:
    return tuple(m for m in system.messages if m.bus == bus.name and m.source is not None)


def _received(system: System, bus: Bus) -> tuple[Message, ...]:
    return tuple(m for m in system.messages if m.bus == bus.name and m.targets)


def _format(message: Message) -> Ref:
    return Ref(f"Ravenchart.Can.{'Extended' if message.extended else 'Standard'}")


def _bus(system: System, bus: Bus, header: str) -> list[Unit]:
    root, name = _root(system), f"{_root(system)}.{ada_case(bus.name)}"
    sent, received = _sent(system, bus), _received(system, bus)
    transmit = system.object(f"{bus.name}.transmit").ceiling
    receive = system.object(f"{bus.name}.receive").ceiling
    driver = max(t.priority for t in system.tasks if t.element.startswith(f"{bus.name}.driver"))
    standard = [f"{m.identifier:_}" for m in received if not m.extended]
    extended = [f"{m.identifier:_}" for m in received if m.extended]
    wanted: list[tuple[str, Expr]] = []
    for label, ids in (("Standard", standard), ("Extended", extended)):
        accepts = member(Ref("Id"), " | ".join(ids)) if ids else Ref("False")
        wanted.append((f"Ravenchart.Can.{label}", accepts))
    items: list[Decl] = [
        Subprogram(
            "Accepts",
            (
                Param("Id", "in", "Ravenchart.Can.Identifier"),
                Param("Format", "in", "Ravenchart.Can.Frame_Format"),
            ),
            "Boolean",
            expression=CaseExpr(Ref("Format"), tuple(wanted)),
        ),
        Comment(f"[{bus.name}] the identifiers that this node receives"),
        Instance(
            "Controller",
            "Ravenchart.Can.Controllers",
            arguments(
                Transmit_Ceiling=priority(transmit),
                Receive_Ceiling=priority(receive),
                Driver_Priority=priority(driver),
                Transmit_Depth=number(bus.transmit_depth),
                Receive_Depth=number(bus.receive_depth),
                Stack_Bytes=number(DRIVER_STACK),
                Accepts=Ref("Accepts"),
            ),
        ),
    ]
    for message in sent:
        items.append(_send_spec(system, message))
        items.append(Comment(f"[{message.name}] hand one frame to the controller; never blocks."))
    withs = ("Ravenchart.Can", "Ravenchart.Can.Controllers", "System")
    units = [Unit(header, withs, Package(name, tuple(items), (SPARK,)))]
    if sent:
        bodies = tuple(_send_body(system, m) for m in sent)
        context = {f"{root}.Codecs", f"{root}.Health_Counts", "Ravenchart.Health"}
        if traced(system):
            context |= {f"{root}.Trace", f"{root}.Elements", "Ravenchart.Traces"}
        units.append(
            Unit(header, tuple(sorted(context)), Package(name, bodies, (SPARK,), is_body=True))
        )
    if received:
        units += _receiver(system, bus, header)
    return units


def _send_spec(system: System, message: Message) -> Subprogram:
    return Subprogram(
        f"Send_{ada_case(message.name)}", (Param("Item", "in", type_name(system, message.type)),)
    )


def _send_body(system: System, message: Message) -> Subprogram:
    frame = call(
        "Ravenchart.Can.Data_Frame",
        Id=number(message.identifier),
        Format=_format(message),
        Length=number(message.length),
        Payload=call(f"Codecs.Pack_{ada_case(message.type.name)}", Ref("Item")),
    )
    lost: list[Stmt] = [
        Do("Health_Counts.Record_Fault", arguments(Ref("Ravenchart.Health.Queue_Overflow"))),
        *note(system, "Fault", message.name, "message", _overflow_number()),
    ]
    full = Chain("/=", (Ref("Status"), Ref("Ravenchart.Can.Queued")))
    return Subprogram(
        f"Send_{ada_case(message.name)}",
        _send_spec(system, message).params,
        declarations=(
            UseType("Ravenchart.Can.Send_Status"),
            Object("Status", "Ravenchart.Can.Send_Status"),
        ),
        body=(
            Do("Controller.Send", arguments(frame, Ref("Status"))),
            *note(system, "Sent", message.name, "message"),
            If(((full, tuple(lost)),)),
        ),
    )


def _overflow_number() -> Expr:
    return Call(
        "Ravenchart.Health.Fault_Kind'Pos", arguments(Ref("Ravenchart.Health.Queue_Overflow"))
    )


def _receiver(system: System, bus: Bus, header: str) -> list[Unit]:
    root = _root(system)
    name = f"{root}.{ada_case(bus.name)}.Receiver"
    received = _received(system, bus)
    spec: tuple[Decl, ...] = (
        Subprogram("Wait"),
        Comment(f"[{bus.name}.receive.release] suspend until a frame is there."),
        Subprogram("Run_Receive"),
        Comment(f"[{bus.name}.receive] decode it and hand it to its receivers."),
    )
    rows: list[tuple[Expr, tuple[Stmt, ...]]] = []
    declarations: list[Decl] = [
        UseType("Ravenchart.Can.Identifier"),
        UseType("Ravenchart.Can.Frame_Format"),
        UseType("Ravenchart.Can.Frame_Kind"),
        UseType("Ravenchart.Can.Data_Length"),
        Object("Valid", "Boolean"),
    ]
    for message in received:
        item = f"{ada_case(message.name)}_Item"
        declarations.append(Object(item, type_name(system, message.type)))
        matches = Chain(
            "and then",
            (
                equal(Ref("Frame.Id"), number(message.identifier)),
                equal(Ref("Frame.Format"), _format(message)),
            ),
        )
        puts = tuple(
            Do(f"{ada_case(t.instance)}.Put_{ada_case(t.port)}", arguments(Ref(item)))
            for t in message.targets
        )
        unpack = Do(
            f"Codecs.Unpack_{ada_case(message.type.name)}",
            arguments(call("Ravenchart.Can.Payload", Ref("Frame")), Ref(item), Ref("Valid")),
        )
        good = Chain(
            "and then",
            (
                Ref("Valid"),
                equal(Ref("Frame.Kind"), Ref("Ravenchart.Can.Data")),
                equal(Ref("Frame.Length"), number(message.length)),
            ),
        )
        deliver = (*note(system, "Arrived", message.name, "message"), *puts)
        rows.append((matches, (unpack, If(((good, deliver),)))))
    declarations = [d for d in declarations if d != UseType("Ravenchart.Can.Data_Length")]
    body: tuple[Decl, ...] = (
        Object("Frame", "Ravenchart.Can.Frame", Ref("Ravenchart.Can.Null_Frame")),
        Subprogram("Wait", body=(Do("Controller.Wait_Frame", arguments(Ref("Frame"))),)),
        Subprogram("Run_Receive", declarations=tuple(declarations), body=(If(tuple(rows)),)),
    )
    context = {f"{root}.Codecs"}
    context |= {f"{root}.{ada_case(t.instance)}" for m in received for t in m.targets}
    if traced(system):
        context |= {f"{root}.Trace", f"{root}.Elements", "Ravenchart.Traces"}
    return [
        Unit(header, (), Package(name, spec, (SPARK,))),
        Unit(header, tuple(sorted(context)), Package(name, body, (SPARK,), is_body=True)),
    ]


# --- Processors --------------------------------------------------------------


def _processor(system: System, processor: Processor, header: str) -> list[Unit]:
    root, name = _root(system), processor_package(system, processor)
    certificate = "Timing_Certificate"
    own = ada_case(processor.name)
    rows = tuple(row_name(s) for s in processor.slots)
    items: list[Decl] = [
        Comment(f"[{processor.name}.table] the activities, in the order in which they run"),
        EnumType("Row", rows),
        Subprogram("Execute", (Param("Item", "in", "Row"),)),
        Subprogram("On_Deadline_Miss"),
    ]
    shared = arguments(
        Deadline=Ref(f"{certificate}.{own}_D"),
        Task_Priority=priority(processor.priority),
        Stack_Bytes=number(processor.stack_bytes),
        Execute=Ref("Execute"),
        On_Deadline_Miss=Ref("On_Deadline_Miss"),
    )
    if processor.released_by is None:
        generic = "Ravenchart.Periodic_Processors"
        slots = tuple(Arg(row_name(s), _slot(s)) for s in processor.slots)
        items.append(PlainType("Row_Table", "array (Row) of Ravenchart.Schedules.Slot"))
        args = arguments(
            Activity_Id=Ref("Row"),
            Table_Type=Ref("Row_Table"),
            Table=Aggregate(slots),
            Cycle=number(processor.cycle),
            Period=Ref(f"{certificate}.{own}_T"),
            Offset=number(processor.offset),
        )
    else:
        generic = "Ravenchart.Sporadic_Processors"
        args = arguments(
            Activity_Id=Ref("Row"),
            Minimum_Separation=Ref(f"{certificate}.{own}_T"),
            Wait=Ref(f"{ada_case(processor.released_by)}.Receiver.Wait"),
        )
    items.append(Comment(f"[{processor.name}]"))
    items.append(Instance("Processor", generic, (*args, *shared)))
    withs = {generic, "System", f"{root}.{certificate}"}
    if processor.released_by is None:
        withs.add("Ravenchart.Schedules")
    else:
        withs.add(f"{root}.{ada_case(processor.released_by)}.Receiver")
    context = {f"{root}.Health_Counts", "Ravenchart.Health"}
    context |= {_owner_unit(system, s) for s in processor.slots}
    context |= {f"{root}.{ada_case(i)}" for i, _ in processor.on_deadline_miss}
    context |= {
        f"{root}.{ada_case(system.instance(i).component.name)}"
        for i, _ in processor.on_deadline_miss
    }
    if traced(system):
        context |= {f"{root}.Trace", f"{root}.Elements", "Ravenchart.Traces"}
    spec = Package(name, tuple(items), (SPARK,))
    body = Package(name, _processor_body(system, processor), (SPARK,), is_body=True)
    return [
        Unit(header, tuple(sorted(withs)), spec),
        Unit(header, tuple(sorted(context - withs)), body),
    ]


def _slot(slot: Slot) -> Expr:
    return Aggregate((Arg("Divisor", number(slot.divisor)), Arg("Phase", number(slot.phase))))


def _owner_unit(system: System, slot: Slot) -> str:
    owner = f"{_root(system)}.{ada_case(slot.owner)}"
    return f"{owner}.Receiver" if slot.work is Work.BUS_RECEIVE else owner


def _processor_body(system: System, processor: Processor) -> tuple[Decl, ...]:
    rows = []
    for slot in processor.slots:
        owner = ada_case(slot.owner)
        package = f"{owner}.Receiver" if slot.work is Work.BUS_RECEIVE else owner
        rows.append((row_name(slot), (Do(f"{package}.Run_{ada_case(slot.name)}"),)))
    execute: list[Stmt] = []
    if traced(system):
        execute.append(
            Do(
                "Trace.Note",
                arguments(
                    Ref("Ravenchart.Traces.Activity"),
                    _row_number(processor, "Row", "Item"),
                    number(0),
                ),
            )
        )
    execute.append(Case(Ref("Item"), tuple(rows)))
    missed: list[Stmt] = [
        Do("Health_Counts.Record_Fault", arguments(Ref("Ravenchart.Health.Deadline_Miss"))),
        *note(
            system,
            "Fault",
            processor.name,
            "processor",
            Call(
                "Ravenchart.Health.Fault_Kind'Pos",
                arguments(Ref("Ravenchart.Health.Deadline_Miss")),
            ),
        ),
    ]
    missed += [_offer(system, i, e) for i, e in processor.on_deadline_miss]
    uses = (UseType("Ravenchart.Element_Id"),) if traced(system) else ()
    return (
        *uses,
        Subprogram("Execute", (Param("Item", "in", "Row"),), body=tuple(execute)),
        Subprogram("On_Deadline_Miss", body=tuple(missed)),
    )


def _row_number(processor: Processor, row_type: str, row: str) -> Expr:
    """The element number of a row: those of a table follow their processor's."""
    position = call("Ravenchart.Element_Id", call(f"{row_type}'Pos", Ref(row)))
    first = Ref(f"Elements.{element_constant(processor.name, 'processor')}")
    return Chain("+", (first, number(1), position))


def _offer(system: System, instance: str, event: str) -> Stmt:
    component = ada_case(system.instance(instance).component.name)
    return Do(f"{ada_case(instance)}.Offer", arguments(Ref(f"{component}.{ada_case(event)}")))


# --- Reports and main --------------------------------------------------------


def _reports(system: System, header: str) -> list[Unit]:
    root = _root(system)
    name = f"{root}.Reports"
    spec: list[Decl] = []
    bodies: list[Decl] = []
    if traced(system):
        spec += [Subprogram("Drain_Trace"), Comment("Hand what was traced to the host.")]
        bodies.append(_drain())
    spec += [Subprogram("Put_All"), Comment("Hand the statistics of all processors to the host.")]
    bodies += [_report(system, p) for p in system.processors]
    steps: list[Stmt] = [Do(f"Report_{ada_case(p.name)}") for p in system.processors]
    steps.append(Do("Health_Counts.Read", arguments(Ref("Faults"))))
    steps.append(
        Loop(
            "for Kind in Ravenchart.Health.Fault_Kind",
            (Do("Ravenchart.Hosts.Put_Fault_Count", arguments(Ref("Kind"), Ref("Faults (Kind)"))),),
        )
    )
    declarations: list[Decl] = [Object("Faults", "Ravenchart.Health.Fault_Counts")]
    if traced(system):
        declarations.append(Object("Lost", "Ravenchart.Event_Count"))
        steps.append(Assign("Lost", Ref("Trace.Lost")))
        steps.append(Do("Ravenchart.Hosts.Put_Lost", arguments(Ref('"trace"'), Ref("Lost"))))
    for bus in system.buses:
        counters = f"{ada_case(bus.name)}_Counters"
        declarations.append(Object(counters, "Ravenchart.Can.Counters"))
        steps.append(Do(f"{ada_case(bus.name)}.Controller.Read_Counters", arguments(Ref(counters))))
        for field in ("Lost_Out", "Lost_In", "Rejected_Lines"):
            label = f'"{bus.name}.{field.lower()}"'
            steps.append(
                Do("Ravenchart.Hosts.Put_Lost", arguments(Ref(label), Ref(f"{counters}.{field}")))
            )
    if any(n.probe for n in system.nodes):
        declarations.append(Object("Late", "Ravenchart.Nanoseconds"))
        steps.append(Do("Host_Probe.Read", arguments(Ref("Late"))))
        steps.append(Do("Ravenchart.Hosts.Put_Host_Latency", arguments(Ref("Late"))))
    bodies.append(Subprogram("Put_All", declarations=tuple(declarations), body=tuple(steps)))
    context = {"Ravenchart.Hosts", "Ravenchart.Health", f"{root}.Health_Counts", f"{root}.Elements"}
    context |= {processor_package(system, p) for p in system.processors}
    context |= {f"{root}.{ada_case(b.name)}" for b in system.buses}
    if system.buses:
        context.add("Ravenchart.Can")
    if any(n.probe for n in system.nodes):
        context.add(f"{root}.Host_Probe")
    if traced(system):
        context |= {f"{root}.Trace", "Ravenchart.Queueing", "Ravenchart.Traces"}
    return [
        Unit(header, (), Package(name, tuple(spec), (SPARK,))),
        Unit(header, tuple(sorted(context)), Package(name, tuple(bodies), (SPARK,), is_body=True)),
    ]


def _drain() -> Subprogram:
    empty = equal(Ref("Status"), Ref("Ravenchart.Queueing.Empty"))
    return Subprogram(
        "Drain_Trace",
        declarations=(
            UseType("Ravenchart.Queueing.Take_Status"),
            Object("Item", "Ravenchart.Traces.Trace_Record"),
            Object("Status", "Ravenchart.Queueing.Take_Status"),
        ),
        body=(
            Loop(
                "",
                (
                    Do("Trace.Take", arguments(Ref("Item"), Ref("Status"))),
                    If(((empty, (Say("exit"),)),)),
                    Do("Ravenchart.Hosts.Put_Trace", arguments(Ref("Item"))),
                ),
            ),
        ),
    )


def _report(system: System, processor: Processor) -> Subprogram:
    package = ada_case(processor.name)
    own = Ref(f"Elements.{element_constant(processor.name, 'processor')}")
    row = _row_number(processor, f"{package}.Row", "Row")
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


def _main(system: System, header: str) -> Unit:
    root = _root(system)
    drain: tuple[Stmt, ...] = (Do(f"{root}.Reports.Drain_Trace"),) if traced(system) else ()
    wait: tuple[Stmt, ...] = (
        Assign("Next", Chain("+", (Ref("Next"), Ref("Step")))),
        Say("delay until Next"),
    )
    shutdown = [
        Do(
            f"{root}.{ada_case(i)}.Offer",
            arguments(Ref(f"{root}.{ada_case(system.instance(i).component.name)}.{ada_case(e)}")),
        )
        for i, e in system.shutdown.raises
    ]
    steps = -(-system.shutdown.grace // POLL_NS)
    body: list[Stmt] = [
        Do("Ravenchart.Hosts.Start"),
        Loop(
            "",
            (
                *drain,
                Assign("Stop", Ref("Ravenchart.Hosts.Stop_Requested")),
                If(((Ref("Stop"), (Say("exit"),)),)),
                *wait,
            ),
        ),
        *shutdown,
    ]
    if steps:
        body.append(Loop(f"for Unused in 1 .. {steps}", (*drain, *wait)))
    body += [
        *drain,
        Do(f"{root}.Reports.Put_All"),
        Do("Ravenchart.Hosts.Finish", arguments(Success=TRUE)),
    ]
    withs = {"Ada.Real_Time", "Ravenchart.Hosts", "System", f"{root}.Reports"}
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
            ),
            body=tuple(body),
        ),
    )


POLL_NS = 5_000_000
"""How often the main program empties the trace and looks for a request to stop."""
