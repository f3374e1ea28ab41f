# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values in several frames: the two ends of a transfer in the code of a bus.

The sender's row makes a segment at the end of an execution, and looks at flow control, which
the reception has put on a board. The reception of the receiver puts segments together in an
object that it shares with the port region of the receiver. At the end of an execution the port
region sends the flow control that is due, and gives up a transfer that has fallen silent.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import (
    Decl,
    GenericInstance,
    Object,
    Param,
    Subprogram,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    Expr,
    OperatorChain,
    all_else,
    arguments,
    call,
    equal,
    member,
    number,
    record,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import ada_case, priority, type_name
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Stmt, do
from ravenchart.gen.emit.certificate.certified import fact
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System
from ravenchart.gen.model.transport import MICROSECOND, Transport, code_of

from .codecs import codec_name
from .layout_tables import ANY, LAYOUTS

ISO_TP = ref("Ravenchart.Can.Iso_Tp")
SENDERS = ref(ISO_TP, "Senders")
RECEIVERS = ref(ISO_TP, "Receivers")
REASSEMBLIES = ref(ISO_TP, "Reassemblies")
EPOCHS = ref("Ravenchart.Epochs")
BOARDS = ref("Ravenchart.Blackboards")
NOTICE = ref(SENDERS, "Flow_Notice")
STAMP = "Stamp"
"""When the frame came that the reception has in hand."""


def _own(prefix: str, name: str) -> str:
    return f"{prefix}_Of_{ada_case(name)}"


def _next(count: Named) -> Expr:
    return call("Ravenchart.Next", ref(count))


def is_plain(message: Message) -> bool:
    """One frame carries its value."""
    return message.transport is None and not message.controls


def transport_units(message: Message) -> set[DottedName]:
    """The units that the spec of a bus needs for a message, which it sends or receives."""
    sends = message.source is not None
    if message.transport is None:
        return {ISO_TP} if message.controls and not sends else set()
    return {SENDERS} if sends else {REASSEMBLIES}


def body_units(root: str, sent: Sequence[Message], received: Sequence[Message]) -> set[DottedName]:
    """The units that the body of a bus needs for segments, and that its spec does not name."""
    found: set[DottedName] = set()
    if any(m.transport for m in received):
        found |= {EPOCHS} if any(m.controls for m in received) else {EPOCHS, ISO_TP}
    if not any(is_plain(m) for m in sent):
        found |= {ANY, LAYOUTS}
    if not any(is_plain(m) for m in (*sent, *received)):
        found |= {ref(root, "Codecs")}
    if any(m.transport for m in sent):
        found |= {BOARDS}
    return found


def _format(message: Message) -> DottedName:
    return ref("Ravenchart.Can", "Extended" if message.extended else "Standard")


def _frame(message: Message, payload: Expr) -> Expr:
    return call(
        ref(ANY, "Whole_Frame"),
        Id=fact(message.element, "Id"),
        Format=_format(message),
        Length=fact(message.element, "Length"),
        Payload=payload,
    )


def _board(system: System, message: str, bus: str) -> GenericInstance:
    ceiling = system.object(f"{bus}.{message}.flow").ceiling
    return GenericInstance(
        f"Flow_Board_{ada_case(message)}",
        BOARDS,
        arguments(
            Element_Type=NOTICE,
            Initial=all_else(BOX),
            Ceiling=priority(ceiling),
        ),
    )


# --- The sender


def sender_spec(system: System, message: Message, transport: Transport) -> list[Decl]:
    """The procedures that rows and reception call, and how values are cut."""
    name = ada_case(message.name)
    columns: dict[str, Expr] = {
        "Length": number(transport.length),
        "Distance": number(transport.distance),
        "Timeout": number(-(-transport.timeout // transport.row)),
        "Waits": number(transport.waits),
        "Row": number(transport.row // MICROSECOND),
    }
    made = record(columns)
    return [
        Comment(f"[{message.name}] the segmentation; times in executions of the sending row"),
        Object(_own("Segmentation", name), ref(SENDERS, "Setting"), made, constant=True),
        Subprogram(f"Send_{name}", (Param("Item", "in", type_name(system, message.type)),)),
        Comment(f"[{message.name}] keep the value until a transfer can begin."),
        Subprogram(f"Transmit_{name}"),
        Comment(f"[{message.name}] called at the end of each execution of the row; never blocks."),
        Subprogram(f"Note_Flow_{name}", (Param("Found", "in", ref(ISO_TP, "Segment")),)),
        Comment(f"[{message.name}] called by the reception when flow control arrives."),
    ]


def sender_objects(system: System, message: Message) -> list[Decl]:
    """The transfer under way, and the flow control that came."""
    return [
        Object(_own("Transfer", message.name), ref(SENDERS, "Sender")),
        Object(_own("Flow", message.name), NOTICE),
        _board(system, message.name, message.bus),
    ]


def sender_bodies(
    system: System,
    message: Message,
    handed: tuple[Stmt, ...],
    lost: tuple[Stmt, ...],
    failed: tuple[Stmt, ...],
) -> tuple[Subprogram, ...]:
    """Keep a value, make a segment, and take notice of flow control.

    ``handed`` gives a frame to the controller; ``lost`` is for one that finds no room,
    ``failed`` for a transfer that ends before its time.
    """
    name, board = ada_case(message.name), f"Flow_Board_{ada_case(message.name)}"
    state, setting = ref(_own("Transfer", name)), ref(_own("Segmentation", name))
    flow = _own("Flow", name)
    bytes_ = call(
        ref(ISO_TP, "Bytes_Of"), call(ref("Codecs", codec_name(message), "Pack"), ref("Item"))
    )
    send = Subprogram(
        f"Send_{name}",
        (Param("Item", "in", type_name(system, message.type)),),
        body=(do(ref(SENDERS, "Give"), state, bytes_),),
    )
    segment = call(ref(SENDERS, "Next_Segment"), state, setting)
    full = OperatorChain("/=", (ref("Status"), ref("Ravenchart.Can.Queued")))
    recorded = do(ref(SENDERS, "Record_Sent"), state, setting)
    ended = OperatorChain("/=", (ref("Fault"), ref(SENDERS, "None")))
    transmit = Subprogram(
        f"Transmit_{name}",
        declarations=(
            UseType("Ravenchart.Can.Send_Status"),
            UseType(ref(SENDERS, "Transfer_Fault")),
            Object("Flow", NOTICE),
            Object("Fault", ref(SENDERS, "Transfer_Fault")),
            Object("Frame", ref(ANY, "Any_Frame")),
            Object("Status", "Ravenchart.Can.Send_Status"),
        ),
        body=(
            do(ref(board, "Read"), ref("Flow")),
            do(ref(SENDERS, "Count"), state, setting, ref("Flow"), ref("Fault")),
            IfStatement(((ended, failed),)),
            IfStatement(
                (
                    (
                        call(ref(SENDERS, "Is_Due"), state, setting),
                        (
                            Assign("Frame", _frame(message, segment)),
                            *handed,
                            IfStatement(((full, lost),), (recorded,)),
                        ),
                    ),
                )
            ),
        ),
    )
    fields = {
        "Count": _next(ref(flow, "Count")),
        "Status": ref("Found.Status"),
        "Block": ref("Found.Block"),
        "Separation": ref("Found.Separation"),
    }
    noted = Subprogram(
        f"Note_Flow_{name}",
        (Param("Found", "in", ref(ISO_TP, "Segment")),),
        body=(
            Assign(flow, record(fields)),
            do(ref(board, "Write"), ref(flow)),
        ),
    )
    return send, transmit, noted


# --- The receiver


def _patience(system: System, message: Message, transport: Transport) -> int:
    """Silence after which no segment that came in time can still wait for the reception.

    So many frames as the queue of the bus holds may be before it, and the reception takes one
    in each of its periods.
    """
    bus = next(b for b in system.buses if b.name == message.bus)
    reception = next(p for p in system.processors if p.released_by == message.bus)
    return transport.timeout + (bus.receive_depth + 1) * reception.period


def receiver_spec(system: System, message: Message, transport: Transport) -> list[Decl]:
    """Where values are put together, and what the port region calls."""
    name = ada_case(message.name)
    columns: dict[str, Expr] = {
        "Length": number(transport.length),
        "Block": number(transport.block),
        "Timeout": number(transport.timeout),
        "Patience": number(_patience(system, message, transport)),
    }
    made = record(columns)
    ceiling = system.object(f"{message.bus}.{message.name}.flow").ceiling
    return [
        GenericInstance(
            _own("Reassembly", name),
            REASSEMBLIES,
            arguments(Segments=made, Ceiling=priority(ceiling)),
        ),
        Comment(f"[{message.name}] the reassembly of the segments"),
        Subprogram(f"Answer_{name}"),
        Comment(f"[{transport.flow}] called at the end of each execution of the port region."),
    ]


def receiver_objects(message: Message) -> list[Decl]:
    """How much of the flow control has gone."""
    return [Object(_own("Answered", message.name), "Ravenchart.Event_Count", number(0))]


def receiver_bodies(
    message: Message,
    flow: Message,
    transport: Transport,
    handed: tuple[Stmt, ...],
    lost: tuple[Stmt, ...],
    failed: tuple[Stmt, ...],
) -> tuple[Subprogram, ...]:
    """Give up a transfer that has fallen silent, and send the flow control that is due.

    ``handed`` gives a frame to the controller; ``lost`` is for one that finds no room,
    ``failed`` for the transfer.
    """
    name = ada_case(message.name)
    store, answered = _own("Reassembly", name), _own("Answered", name)
    payload = call(
        ref(ISO_TP, "Flow_Payload"),
        ref("Wanted.Status"),
        number(transport.block),
        number(code_of(transport.separation) or 0),
    )
    full = OperatorChain("/=", (ref("Status"), ref("Ravenchart.Can.Queued")))
    new = OperatorChain("/=", (ref("Wanted.Count"), ref(answered)))
    answer = Subprogram(
        f"Answer_{name}",
        declarations=(
            UseType("Ravenchart.Can.Send_Status"),
            UseType("Ravenchart.Event_Count"),
            Object("Now", "Ravenchart.Nanoseconds"),
            Object("Wanted", ref(store, "Flow_Request")),
            Object("Expired", "Boolean"),
            Object("Frame", ref(ANY, "Any_Frame")),
            Object("Status", "Ravenchart.Can.Send_Status"),
        ),
        body=(
            do(ref(EPOCHS, "Since_Start"), ref("Now")),
            do(ref(store, "Look"), ref("Now"), ref("Wanted"), ref("Expired")),
            IfStatement(((ref("Expired"), failed),)),
            IfStatement(
                (
                    (
                        new,
                        (
                            Assign("Frame", _frame(flow, payload)),
                            *handed,
                            IfStatement(((full, lost),), (Assign(answered, ref("Wanted.Count")),)),
                        ),
                    ),
                )
            ),
        ),
    )
    return (answer,)


def taken(
    message: Message, unpacked: tuple[Stmt, ...], refused: tuple[Stmt, ...]
) -> tuple[Stmt, ...]:
    """The statements by which the reception takes a segment."""
    store = _own("Reassembly", message.name)
    frame = (call(ref(ANY, "Payload"), ref("Frame")), ref("Frame.Plain.Length"))
    complete = equal(ref("Outcome"), ref(RECEIVERS, "Complete"))
    faulty = member(ref("Outcome"), ref(RECEIVERS, "Fault"))
    plain = OperatorChain(
        "and then",
        (
            equal(ref("Frame.Family"), ref(ANY, "Classic")),
            equal(ref("Frame.Plain.Kind"), ref("Ravenchart.Can.Data")),
        ),
    )
    whole = (do(ref(store, "Read"), ref("Value")), *unpacked)
    return (
        IfStatement(
            (
                (
                    plain,
                    (
                        do(ref(store, "Take"), *frame, ref(STAMP), ref("Outcome")),
                        IfStatement(((complete, whole), (faulty, refused))),
                    ),
                ),
            )
        ),
    )


def received_value() -> Expr:
    """The value that has come, as its codec takes it."""
    return call(ref(ISO_TP, "Words_Of"), ref("Value"))


def noticed(flow: Message) -> tuple[Stmt, ...]:
    """The statements by which the reception takes flow control."""
    name = ada_case(flow.controls)
    found = call(
        ref(ISO_TP, "Decoded"), call(ref(ANY, "Payload"), ref("Frame")), ref("Frame.Plain.Length")
    )
    is_flow = equal(ref("Found.Kind"), ref(ISO_TP, "Flow_Control"))
    classic = equal(ref("Frame.Family"), ref(ANY, "Classic"))
    note = do(f"Note_Flow_{name}", ref("Found"))
    return (
        IfStatement(((classic, (Assign("Found", found), IfStatement(((is_flow, (note,)),)))),)),
    )


def reception_declarations(received: tuple[Message, ...]) -> list[Decl]:
    """The declarations of the reception for segments."""
    found: list[Decl] = []
    if any(not is_plain(m) for m in received):
        found.append(UseType(ref(ANY, "Frame_Family")))
    if any(m.transport for m in received):
        found += [
            UseType(ref(RECEIVERS, "Outcome")),
            UseType("Ravenchart.Can.Frame_Kind"),
            Object("Outcome", ref(RECEIVERS, "Outcome")),
            Object("Value", ref(ISO_TP, "Value_Bytes")),
        ]
    if any(m.controls for m in received):
        found += [
            UseType(ref(ISO_TP, "Segment_Kind")),
            Object("Found", ref(ISO_TP, "Segment")),
        ]
    return found
