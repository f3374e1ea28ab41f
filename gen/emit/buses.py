"""Buses: the controller, one procedure for each message sent, and the receiver."""

from __future__ import annotations

from ..model import Bus, End, Message, System
from .ada import (
    SPARK,
    Call,
    CaseExpr,
    Chain,
    Comment,
    Decl,
    Do,
    Expr,
    If,
    Instance,
    Object,
    Package,
    Param,
    Ref,
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
from .codecs import codec_name
from .naming import ada_case, priority, root_package, type_name
from .remote_calls import received_as
from .trace_calls import note, traced

DRIVER_STACK = 65_536
"""Bytes of stack for each task of a CAN driver on a host."""


def _sent(system: System, bus: Bus) -> tuple[Message, ...]:
    return tuple(m for m in system.messages if m.bus == bus.name and m.source is not None)


def _received(system: System, bus: Bus) -> tuple[Message, ...]:
    return tuple(m for m in system.messages if m.bus == bus.name and m.targets)


def _taker(message: Message, target: End) -> str:
    """The procedure of a receiver."""
    return f"Put_{ada_case(target.port)}" if message.call is None else received_as(message)


def _format(message: Message) -> Ref:
    return Ref(f"Ravenchart.Can.{'Extended' if message.extended else 'Standard'}")


def emit_bus(system: System, bus: Bus, header: str) -> list[Unit]:
    """The controller of a bus, sending on it, and the distribution of what it receives."""
    root, name = root_package(system), f"{root_package(system)}.{ada_case(bus.name)}"
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
        Payload=call(f"Codecs.Pack_{codec_name(message)}", Ref("Item")),
    )
    lost: list[Stmt] = [
        Do(
            "Health_Counts.Counters.Record_Fault",
            arguments(Ref("Ravenchart.Health.Queue_Overflow")),
        ),
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
    root = root_package(system)
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
            Do(f"{ada_case(t.instance)}.{_taker(message, t)}", arguments(Ref(item)))
            for t in message.targets
        )
        unpack = Do(
            f"Codecs.Unpack_{codec_name(message)}",
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
