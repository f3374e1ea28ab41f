# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Transmission modes in the code of a bus: a value waits until the end of its row's execution."""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Decl, Object, Subprogram
from ravenchart.gen.emit.ada.expressions import Attribute, Expr, call, number, record
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, default_value, type_name
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Pragma, Stmt, do
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System
from ravenchart.gen.model.transmission import Mode

TRANSMISSIONS = ref("Ravenchart.Can.Transmissions")

_MODES = {Mode.ON_CHANGE: "On_Change", Mode.ON_EVENT: "On_Event", Mode.MIXED: "Mixed"}


def transmit_name(message: Message) -> str:
    """The procedure that a row calls last."""
    return f"Transmit_{ada_case(message.name)}"


def _setting(message: Message) -> DottedName:
    return ref(f"Mode_Of_{ada_case(message.name)}")


def _state(message: Message) -> DottedName:
    return ref(f"Pending_Of_{ada_case(message.name)}")


def _value(message: Message) -> DottedName:
    return ref(f"Value_Of_{ada_case(message.name)}")


def mode_of(message: Message) -> list[Decl]:
    """The mode of a message that has one besides the periodic one."""
    transmission = message.transmission
    if transmission is None:
        return []
    columns: dict[str, Expr] = {
        "Mode": ref(TRANSMISSIONS, _MODES[transmission.mode]),
        "Minimum": number(transmission.minimum),
        "Period": Attribute(ref(TRANSMISSIONS, "Distance"), "Last"),
    }
    if transmission.renewal:
        columns["Period"] = number(transmission.renewal)
    made = record(columns)
    return [
        Object(_setting(message), ref(TRANSMISSIONS, "Setting"), made, constant=True),
        Comment(f"[{message.name}] the transmission mode; times in executions of the sending row"),
    ]


def transmit_spec(message: Message) -> list[Decl]:
    """The procedure that a row calls last; none for a message that is periodic."""
    if message.transmission is None:
        return []
    return [
        Subprogram(transmit_name(message)),
        Comment(f"[{message.name}] called at the end of each execution of the row; never blocks."),
    ]


def values_of(system: System, message: Message) -> tuple[Decl, ...]:
    """The newest value of a message with a mode, and when its frames went."""
    if message.transmission is None:
        return ()
    first = default_value(system, message.type)
    return (
        Object(_state(message), ref(TRANSMISSIONS, "Sender")),
        Object(_value(message), type_name(system, message.type), first),
    )


def keep_value(message: Message) -> tuple[Stmt, ...]:
    """Keep a value until the end of the execution."""
    return (
        Assign(_value(message), ref("Item")),
        do(ref(TRANSMISSIONS, "Give"), _state(message)),
    )


def transmit_body(
    message: Message, frame: str, declarations: tuple[Decl, ...], handed: tuple[Stmt, ...]
) -> Subprogram:
    """Count the execution, and send if a frame is due; ``handed`` gives it to the controller."""
    state, setting = _state(message), _setting(message)
    kept = call(ref(TRANSMISSIONS, "Keeps_Distance"), state, setting)
    due = call(ref(TRANSMISSIONS, "Is_Due"), state, setting, ref("Frame"))
    return Subprogram(
        transmit_name(message),
        declarations=(
            *declarations,
            Object("Frame", "Ravenchart.Can.Any_Frames.Any_Frame",
                   call(frame, _value(message)), constant=True),
            Object("Status", "Ravenchart.Can.Send_Status"),
        ),
        body=(
            do(ref(TRANSMISSIONS, "Count"), state),
            IfStatement(((due, (Pragma("Assert", (kept,)), *handed)),)),
        ),
    )  # fmt: skip


def recorded(message: Message) -> Stmt:
    """The controller has taken the frame."""
    return do(ref(TRANSMISSIONS, "Record_Sent"), _state(message), ref("Frame"))
