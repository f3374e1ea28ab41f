# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end protection in the code of a bus: before a frame goes, and before one is unpacked."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import Decl, Object
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Expr,
    all_else,
    both,
    call,
    member,
    number,
    record,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Pragma, Stmt, do
from ravenchart.gen.model.buses import Message

from .ends import checking_state, sending_state, state_before

PROTECTION = ref("Ravenchart.Can.Protection")


def _setting(message: Message) -> DottedName:
    return ref(f"Protection_Of_{ada_case(message.name)}")


def setting_of(message: Message) -> list[Decl]:
    """The profile of a protected message, and its parameters."""
    protection = message.protection
    if protection is None:
        return []
    ids: Expr = all_else(number(0))
    if protection.data_ids:
        ids = Aggregate(tuple(Arg(None, number(one)) for one in protection.data_ids))
    columns = {
        "Kind": ref(PROTECTION, protection.profile.kind),
        "Mode": ref(PROTECTION, protection.profile.mode),
        "Data_Id": number(protection.data_id),
        "Ids": ids,
        "Length": number(message.length),
        "Max_Delta": number(protection.max_delta),
        "Sync": number(protection.sync),
    }
    made = record(columns)
    return [
        Object(_setting(message), ref(PROTECTION, "Setting"), made, constant=True),
        Comment(f"[{message.name}] the end-to-end protection of this message"),
    ]


def states_of_senders(sent: Sequence[Message]) -> tuple[Decl, ...]:
    """The counters of the protected messages."""
    return tuple(Object(sending_state(m), ref(PROTECTION, "Sender")) for m in sent if m.protection)


def protecting(message: Message) -> tuple[Stmt, ...]:
    """Write the header of a frame that is about to go, and count."""
    if message.protection is None:
        return ()
    given = (ref(sending_state(message)), _setting(message), ref("Frame"))
    return (
        do(ref(PROTECTION, "Protect"), *given),
        Pragma("Assert", (call(ref(PROTECTION, "Is_Intact"), ref("Frame"), _setting(message)),)),
    )


def receiver_of(message: Message) -> tuple[Decl, ...]:
    """The receiver's state of a protected message, twice; the second is for its assertion."""
    if message.protection is None:
        return ()
    kind = ref(PROTECTION, "Receiver")
    return (Object(checking_state(message), kind), Object(state_before(message), kind))


def checked(
    message: Message, taken: tuple[Stmt, ...], refused: tuple[Stmt, ...]
) -> tuple[Stmt, ...]:
    """Take a frame that is usable; of one that is faulty do what is to be done then."""
    if message.protection is None:
        return taken
    state, setting, frame = ref(checking_state(message)), _setting(message), ref("Frame")
    before = ref(state_before(message))
    counter = call(ref(PROTECTION, "Counter"), frame, ref(setting, "Kind"))
    proved = both(
        call(ref(PROTECTION, "Is_Intact"), frame, setting),
        call(ref(PROTECTION, "Is_In_Sequence"), before, setting, counter),
    )
    usable = member(ref("Status"), ref(PROTECTION, "Usable"))
    faulty = member(ref("Status"), ref(PROTECTION, "Fault"))
    return (
        Assign(before, state),
        do(ref(PROTECTION, "Check"), state, setting, frame, ref("Status")),
        IfStatement(((usable, (Pragma("Assert", (proved,)), *taken)), (faulty, refused))),
    )
