# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Buses: the controller, one procedure for each message sent, and the receiver."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    GenericInstance,
    Object,
    Package,
    Param,
    Subprogram,
    Unit,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    OTHERS,
    Aggregate,
    Arg,
    CaseExpr,
    Expr,
    Indexed,
    OperatorChain,
    arguments,
    both,
    call,
    equal,
    member,
    number,
    plain,
    result,
    select,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, priority, root_package, type_name
from ravenchart.gen.emit.ada.statements import Comment, IfStatement, Pragma, Return, Stmt, do
from ravenchart.gen.emit.certificate.certified import CERTIFICATE, driver_element, fact
from ravenchart.gen.emit.commands.remote_calls import received_as
from ravenchart.gen.emit.tables.executions import ELEMENT_ID, EXECUTED, bus_row, executed, run_spec
from ravenchart.gen.emit.tables.port_calls import put_of
from ravenchart.gen.emit.tables.trace_calls import fault, fault_units, note, traced
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.system import System, Work

from . import authentication
from .authentication import AUTHENTICATION
from .codecs import codec_name, words_of
from .controllers import bus_place, controller_checks, controller_setting
from .layout_tables import ANY, FD, LAYOUTS, is_framed, is_received
from .protection import (
    PROTECTION,
    checked,
    protecting,
    receiver_of,
    setting_of,
    states_of_senders,
)
from .transmission import (
    TRANSMISSIONS,
    keep_value,
    mode_of,
    recorded,
    transmit_body,
    transmit_spec,
    values_of,
)
from .transport import (
    ISO_TP,
    RECEIVERS,
    STAMP,
    body_units,
    is_plain,
    noticed,
    received_value,
    receiver_bodies,
    receiver_objects,
    receiver_spec,
    reception_declarations,
    sender_bodies,
    sender_objects,
    sender_spec,
    transport_units,
)
from .transport import taken as segment_taken
from .watch import emit_watch, offer

DRIVER_STACK = 65_536
"""Bytes of stack for each task of a CAN driver on a host."""


def _sent(system: System, bus: Bus) -> tuple[Message, ...]:
    return tuple(m for m in system.messages if m.bus == bus.name and m.source is not None)


def _received(system: System, bus: Bus) -> tuple[Message, ...]:
    return tuple(m for m in system.messages if m.bus == bus.name and m.targets)


def _taker(system: System, message: Message, target: End) -> DottedName:
    """The procedure of a receiver."""
    if message.call is not None:
        return ref(ada_case(target.instance), received_as(message))
    return put_of(system, target)


def _format(message: Message) -> DottedName:
    return ref("Ravenchart.Can", "Extended" if message.extended else "Standard")


def emit_bus(system: System, bus: Bus, header: str) -> list[Unit]:
    """The controller of a bus, sending on it, and the distribution of what it receives."""
    root = root_package(system)
    name = ref(root, ada_case(bus.name))
    sent, received = _sent(system, bus), _received(system, bus)
    transmit = system.object(f"{bus.name}.transmit").ceiling
    receive = system.object(f"{bus.name}.receive").ceiling
    standard = [fact(m.element, "Id") for m in received if not m.extended]
    extended = [fact(m.element, "Id") for m in received if m.extended]
    wanted: list[tuple[DottedName, Expr]] = []
    for label, ids in (("Standard", standard), ("Extended", extended)):
        accepts = member(ref("Id"), *ids) if ids else FALSE
        wanted.append((ref("Ravenchart.Can", label), accepts))
    items: list[Decl] = [
        Subprogram(
            "Accepts",
            (
                #  GNAT takes this word as: not referenced, and meant so
                Param("Id" if received else "Unused_Id", "in", "Ravenchart.Can.Identifier"),
                Param("Format", "in", "Ravenchart.Can.Frame_Format"),
            ),
            "Boolean",
            expression=CaseExpr(ref("Format"), tuple(wanted)),
        ),
        Comment(f"[{bus.name}] whether this node receives frames with the identifier Id"),
        GenericInstance(
            "Controller",
            "Ravenchart.Can.Controllers",
            arguments(
                Transmit_Ceiling=priority(transmit),
                Receive_Ceiling=priority(receive),
                Driver_Priority=fact(driver_element(bus.name), "Priority"),
                Transmit_Depth=number(bus.transmit_depth),
                Receive_Depth=number(bus.receive_depth),
                Stack_Bytes=number(DRIVER_STACK),
                Accepts=ref("Accepts"),
                Setting=controller_setting(bus),
                **bus_place(system, bus),
            ),
        ),
    ]
    items += controller_checks(bus)
    if received:
        items.append(
            Comment(
                f"[{bus.name}] the filter accepts each received message, whose frame holds all "
                "its signals"
            )
        )
        plain = [m for m in received if is_plain(m)]
        items += [Pragma("Assert", (is_received(m, codec_name(m)),)) for m in plain]
    kept = [m for m in (*sent, *received) if m.check is not None]
    for message in dict.fromkeys(kept):
        items += setting_of(message)
    items += authentication.settings_of(dict.fromkeys(kept))
    items += (item for m in sent for item in mode_of(m))
    if not all(m.fd or not is_plain(m) for m in sent):
        items.append(UseType("Interfaces.Unsigned_64"))
    if any(m.fd for m in sent):
        items += [UseType(ref(FD, "Fd_Words")), UseType(ref(FD, "Bit_Rate_Use"))]
    items += (item for m in (*sent, *received) for item in _segmented_spec(system, m))
    for message in filter(is_plain, sent):
        items.append(_frame_spec(system, bus, message))
        items.append(
            Comment(
                f"[{message.name}] the frame by the layout table; no bit of the data is cut off."
            )
        )
        items.append(_send_spec(system, message))
        items.append(Comment(_task_of_sending(message)))
        items += transmit_spec(message)
    withs = _spec_withs(root, sent, received)
    units = [Unit(header, tuple(sorted(withs)), Package(name, tuple(items), (SPARK,)))]
    if sent:
        made = (_frame_body(system, bus, m) for m in sent if is_plain(m))
        handed = (_send_bodies(system, m) for m in sent if is_plain(m))
        pairs = tuple(
            one for first, rest in zip(made, handed, strict=True) for one in (first, *rest)
        )
        values = (one for m in sent for one in values_of(system, m))
        segmented = _segmented(system, (*sent, *received))
        states = (*states_of_senders(sent), *authentication.states_of_senders(sent))
        bodies = (*states, *values, *pairs, *segmented)
        context = fault_units(root)
        context |= authentication.context(root, sent)
        context |= body_units(root, sent, received) if segmented else set()
        if traced(system):
            context |= {ref(root, "Trace"), ref("Ravenchart.Traces")}
        units.append(
            Unit(header, tuple(sorted(context)), Package(name, bodies, (SPARK,), is_body=True))
        )
    if received:
        units += _receiver(system, bus, header)
    return units + emit_watch(system, bus, header)


def _send_spec(system: System, message: Message) -> Subprogram:
    return Subprogram(
        f"Send_{ada_case(message.name)}", (Param("Item", "in", type_name(system, message.type)),)
    )


def _frame_name(message: Message) -> str:
    return f"Frame_Of_{ada_case(message.name)}"


def _frame_spec(system: System, bus: Bus, message: Message) -> Subprogram:
    """The frame that carries an item: as the layout table has it, with all that is packed."""
    made = result(_frame_name(message))
    facts = [is_framed(message, made)]
    if message.fd:
        facts += [
            equal(call(ref(ANY, "Words"), made), _packed(message)),
            equal(select(made, "Fd.Rate"), _rate(bus)),
        ]
    else:
        facts.append(equal(call(ref(ANY, "Payload"), made), _packed(message)))
    return Subprogram(
        _frame_name(message),
        _send_spec(system, message).params,
        ref(ANY, "Any_Frame"),
        aspects=(Aspect("Post", both(*facts)),),
    )


def _packed(message: Message) -> Expr:
    """All words that carry an item."""
    packed: Expr = call(ref("Codecs", codec_name(message), "Pack"), ref("Item"))
    if message.fd and words_of(message) == 1:
        rows = Arg(plain(0), packed), Arg(OTHERS, number(0))
        return Aggregate(rows, of_type=ref(FD, "Fd_Words"))
    return packed


def _rate(bus: Bus) -> DottedName:
    return ref(FD, f"{'Constant' if bus.data_rate is None else 'Switched'}_Rate")


def _frame_body(system: System, bus: Bus, message: Message) -> Subprogram:
    head = {
        "Id": fact(message.element, "Id"),
        "Format": _format(message),
        "Length": fact(message.element, "Length"),
    }
    if message.fd:
        carried = {"Words": _packed(message), "Rate": _rate(bus)}
    else:
        carried = {"Payload": _packed(message)}
    made = call(ref(ANY, "Whole_Frame"), **head, **carried)
    spec = _frame_spec(system, bus, message)
    return Subprogram(spec.name, spec.params, spec.result, body=(Return(made),))


def _spec_withs(root: str, sent: Sequence[Message], received: Sequence[Message]) -> set[DottedName]:
    """The units that the spec of a bus needs."""
    withs = {
        ref("Ravenchart.Can"),
        ref("Ravenchart.Can.Controllers"),
        ref("System"),
        ref(root, CERTIFICATE),
    }
    if sent or received:
        withs |= {ref(root, "Codecs"), LAYOUTS}
    if sent:
        withs |= {ANY, ref("Interfaces")}
    if any(m.fd for m in sent):
        withs |= {FD}
    if any(m.check for m in (*sent, *received)):
        withs |= {PROTECTION, AUTHENTICATION}
    if any(m.transmission for m in sent):
        withs |= {TRANSMISSIONS}
    for message in (*sent, *received):
        withs |= transport_units(message)
    return withs


def _task_of_sending(message: Message) -> str:
    if message.transmission is not None:
        return f"[{message.name}] keep the value until the end of the execution."
    return f"[{message.name}] hand one frame to the controller; never blocks."


def _segmented_spec(system: System, message: Message) -> list[Decl]:
    """The declarations that a value in several frames needs at this end of it."""
    if message.transport is None:
        return []
    if message.source is not None:
        return sender_spec(system, message, message.transport)
    return receiver_spec(system, message, message.transport)


def _segmented(system: System, messages: Sequence[Message]) -> tuple[Decl, ...]:
    """The bodies of these, and what they keep."""
    objects: list[Decl] = []
    bodies: list[Decl] = []
    for message in messages:
        transport = message.transport
        if transport is None:
            continue
        if message.source is not None:
            objects += sender_objects(system, message)
            ended = _counted(message, "Stale_Input")
            bodies += sender_bodies(system, message, *_handed(system, message), ended)
        else:
            flow = next(m for m in messages if m.controls == message.name)
            objects += receiver_objects(message)
            ended = _counted(message, "Protection_Error")
            bodies += receiver_bodies(message, flow, transport, *_handed(system, flow), ended)
    return (*objects, *bodies)


def _counted(message: Message, kind: str) -> tuple[Stmt, ...]:
    """Report a fault of a message."""
    return (fault(kind, message.name, "message"),)


def _handed(system: System, message: Message) -> tuple[tuple[Stmt, ...], tuple[Stmt, ...]]:
    """Hand a frame to the controller; and what is done where that has no room."""
    return (
        #  and not the frame of another message of the same type
        Pragma("Assert", (is_framed(message, ref("Frame")),)),
        do("Controller.Send", ref("Frame"), ref("Status")),
        *note(system, "Sent", message.name, "message"),
    ), _counted(message, "Queue_Overflow")


def _send_bodies(system: System, message: Message) -> tuple[Subprogram, ...]:
    """The procedure that a row calls to send a message; with a mode, one for the row's end too."""
    frame = call(_frame_name(message), ref("Item"))
    handed, lost = _handed(system, message)
    full = OperatorChain("/=", (ref("Status"), ref("Ravenchart.Can.Queued")))
    name, params = f"Send_{ada_case(message.name)}", _send_spec(system, message).params
    statuses = UseType("Ravenchart.Can.Send_Status")
    ends: Stmt = IfStatement(((full, lost),), (recorded(message),) if message.transmission else ())
    if message.transmission is not None:
        body = transmit_body(message, _frame_name(message), (statuses,), (*handed, ends))
        return (Subprogram(name, params, body=keep_value(message)), body)
    own = message.authentication
    sending: tuple[Stmt, ...] = (*handed, ends)
    if own is not None:
        sending = authentication.sealed(
            message, own, sending, _counted(message, "Protection_Error")
        )
    declarations = (
        statuses,
        Object("Frame", ref(ANY, "Any_Frame"), frame, constant=message.check is None),
        Object("Status", "Ravenchart.Can.Send_Status"),
        *(authentication.variables(taken=True) if own is not None else ()),
    )
    body_ = (*protecting(message), *sending)
    return (Subprogram(name, params, declarations=declarations, body=body_),)


def _receiver(system: System, bus: Bus, header: str) -> list[Unit]:
    root = root_package(system)
    name = ref(root, ada_case(bus.name), "Receiver")
    received = _received(system, bus)
    slot = bus_row(system, bus, Work.BUS_RECEIVE)
    spec: tuple[Decl, ...] = (
        Subprogram("Wait"),
        Comment(f"[{bus.name}.receive.release] suspend until a frame has arrived."),
        UseType(ELEMENT_ID),
        run_spec("Receive", slot),
        Comment(f"[{bus.name}.receive] decode a frame and hand its value to the receivers."),
    )
    rows: list[tuple[Expr, tuple[Stmt, ...]]] = []
    declarations: list[Decl] = [
        UseType("Ravenchart.Can.Identifier"),
        UseType("Ravenchart.Can.Frame_Format"),
    ]
    if any(not m.controls for m in received):
        declarations.append(Object("Valid", "Boolean"))
    declarations += reception_declarations(received)
    stamp = STAMP if any(m.transport for m in received) else "Unused_Stamp"
    kept_stamp = Object(stamp, "Ravenchart.Nanoseconds")
    if stamp == STAMP:
        kept_stamp = Object(stamp, "Ravenchart.Nanoseconds", number(0))
    for message in received:
        item = f"{ada_case(message.name)}_Item"
        if message.controls:
            rows.append((_matches(message), noticed(message)))
            continue
        declarations.append(Object(item, type_name(system, message.type)))
        matches = _matches(message)
        puts = tuple(do(_taker(system, message, t), ref(item)) for t in message.targets)
        unpack = do(
            ref("Codecs", codec_name(message), "Unpack"), _data(message), ref(item), ref("Valid")
        )
        if message.transport is not None:
            whole = (*note(system, "Arrived", message.name, "message"), *puts)
            unpacked = (unpack, IfStatement(((ref("Valid"), whole),)))
            refused = _counted(message, "Protection_Error")
            rows.append((matches, segment_taken(message, unpacked, refused)))
            continue
        family = ref(ANY, "Flexible" if message.fd else "Classic")
        carried = call(ref(ANY, "Carries"), ref("Frame"), family, fact(message.element, "Length"))
        good = OperatorChain("and then", (ref("Valid"), carried))
        known = Pragma("Assert", (is_framed(message, ref("Frame")),))
        deliver = (known, *note(system, "Arrived", message.name, "message"), *puts)
        taken: tuple[Stmt, ...] = (unpack, IfStatement(((good, deliver),)))
        refused = _refused(system, message)
        if message.authentication is None:
            rows.append((matches, checked(message, taken, refused)))
        else:
            own = message.authentication
            rows.append((matches, authentication.verified(message, own, taken, refused)))
    if any(m.protection for m in received):
        declarations.append(Object("Status", ref(PROTECTION, "Status")))
    if any(m.authentication for m in received):
        if all(m.fd for m in _sent(system, bus)):  # else the bus itself has it
            declarations.append(UseType("Interfaces.Unsigned_64"))
        declarations.append(UseType(ref(AUTHENTICATION, "Status")))
        declarations += authentication.variables(taken=False)
    body: tuple[Decl, ...] = (
        Object("Frame", ref(ANY, "Any_Frame"), ref(ANY, "Null_Any_Frame")),
        *(state for m in received for state in receiver_of(m)),
        *(state for m in received for state in authentication.receiver_of(m)),
        *((kept_stamp,) if stamp == STAMP else ()),
        Subprogram(
            "Wait",
            declarations=() if stamp == STAMP else (kept_stamp,),
            body=(do("Controller.Wait_Frame", ref("Frame"), ref(stamp)),),
        ),
        Subprogram(
            "Run_Receive",
            (EXECUTED,),
            declarations=tuple(declarations),
            body=(IfStatement(tuple(rows)), executed(slot)),
        ),
    )
    context = {ref(root, "Codecs"), ANY, LAYOUTS}
    valued = [m for m in received if not m.controls]
    context |= {ref(root, _taker(system, m, t).parent) for m in valued for t in m.targets}
    if traced(system):
        context |= {ref(root, "Trace"), ref("Ravenchart.Traces")}
    if not all(is_plain(m) for m in received):
        context |= {ISO_TP}
    if any(m.transport for m in received):
        context |= {RECEIVERS}
        context |= fault_units(root)
    kept = [m.check for m in received if m.check is not None]
    if kept:
        context |= {PROTECTION, AUTHENTICATION, ref("Interfaces")}
        context |= fault_units(root)
    context |= authentication.context(root, received)
    owners = {instance for check in kept for instance, _ in check.on_error}
    context |= {ref(root, ada_case(i)) for i in owners}
    context |= {ref(root, ada_case(system.instance(i).component.name)) for i in owners}
    seen = {ref(root, "Elements")}
    return [
        Unit(header, tuple(seen), Package(name, spec, (SPARK,))),
        Unit(header, tuple(sorted(context - seen)), Package(name, body, (SPARK,), is_body=True)),
    ]


def _matches(message: Message) -> Expr:
    """Has the frame the identifier of a message?"""
    return OperatorChain(
        "and then",
        (
            equal(call(ref(ANY, "Id"), ref("Frame")), fact(message.element, "Id")),
            equal(call(ref(ANY, "Format"), ref("Frame")), _format(message)),
        ),
    )


def _refused(system: System, message: Message) -> tuple[Stmt, ...]:
    """The statements for a frame that is not used: it is counted, and raises its events."""
    if message.check is None:
        return ()
    events = message.check.on_error
    raised = (offer(system, instance, event) for instance, event in events)
    return (*_counted(message, "Protection_Error"), *raised)


def _data(message: Message) -> Expr:
    """The data of a frame, as the codec of a message takes them."""
    if message.transport is not None:
        return received_value()
    if not message.fd:
        return call(ref(ANY, "Payload"), ref("Frame"))
    words = call(ref(ANY, "Words"), ref("Frame"))
    return Indexed(words, plain(0)) if words_of(message) == 1 else words
