# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""End-to-end protection in the code of a bus: before a frame goes, and before one is unpacked."""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import (
    Aggregate,
    Arg,
    Assign,
    Comment,
    Decl,
    Do,
    Expr,
    IfStatement,
    Object,
    Pragma,
    Ref,
    Stmt,
    arguments,
    both,
    call,
    member,
    number,
)
from ravenchart.gen.model.buses import Message

PROTECTION = "Ravenchart.Can.Protection"


def _setting(message: Message) -> Ref:
    return Ref(f"Protection_Of_{ada_case(message.name)}")


def _sender(message: Message) -> str:
    return f"Sender_Of_{ada_case(message.name)}"


def _receiver(message: Message) -> str:
    return f"Checker_Of_{ada_case(message.name)}"


def _before(message: Message) -> str:
    return f"Checker_Before_{ada_case(message.name)}"


def setting_of(message: Message) -> list[Decl]:
    """The profile of a protected message, and its parameters."""
    protection = message.protection
    if protection is None:
        return []
    ids: Expr = Aggregate((Arg("others", number(0)),))
    if protection.data_ids:
        ids = Aggregate(tuple(Arg(None, number(one)) for one in protection.data_ids))
    columns = {
        "Kind": Ref(f"{PROTECTION}.{protection.profile.kind}"),
        "Mode": Ref(f"{PROTECTION}.{protection.profile.mode}"),
        "Data_Id": number(protection.data_id),
        "Ids": ids,
        "Length": number(message.length),
        "Max_Delta": number(protection.max_delta),
        "Sync": number(protection.sync),
    }
    made = Aggregate(tuple(Arg(name, value) for name, value in columns.items()))
    return [
        Object(_setting(message).text, f"{PROTECTION}.Setting", made, constant=True),
        Comment(f"[{message.name}] its protection from end to end"),
    ]


def states_of_senders(sent: Sequence[Message]) -> tuple[Decl, ...]:
    """The counters of the protected messages."""
    return tuple(Object(_sender(m), f"{PROTECTION}.Sender") for m in sent if m.protection)


def protecting(message: Message) -> tuple[Stmt, ...]:
    """Write the header of a frame that is about to go, and count."""
    if message.protection is None:
        return ()
    given = (Ref(_sender(message)), _setting(message), Ref("Frame"))
    return (
        Do(f"{PROTECTION}.Protect", arguments(*given)),
        Pragma("Assert", (call(f"{PROTECTION}.Is_Intact", Ref("Frame"), _setting(message)),)),
    )


def receiver_of(message: Message) -> tuple[Decl, ...]:
    """What is known of the frames of a protected message; the second one is for its assertion."""
    if message.protection is None:
        return ()
    kind = f"{PROTECTION}.Receiver"
    return (Object(_receiver(message), kind), Object(_before(message), kind))


def checked(
    message: Message, taken: tuple[Stmt, ...], refused: tuple[Stmt, ...]
) -> tuple[Stmt, ...]:
    """Take a frame that is usable; of one that is faulty do what is to be done then."""
    if message.protection is None:
        return taken
    state, setting, frame = Ref(_receiver(message)), _setting(message), Ref("Frame")
    before = Ref(_before(message))
    counter = call(f"{PROTECTION}.Counter", frame, Ref(f"{setting.text}.Kind"))
    proved = both(
        call(f"{PROTECTION}.Is_Intact", frame, setting),
        call(f"{PROTECTION}.Is_In_Sequence", before, setting, counter),
    )
    usable = member(Ref("Status"), f"{PROTECTION}.Usable")
    faulty = member(Ref("Status"), f"{PROTECTION}.Fault")
    return (
        Assign(before.text, state),
        Do(f"{PROTECTION}.Check", arguments(state, setting, frame, Ref("Status"))),
        IfStatement(((usable, (Pragma("Assert", (proved,)), *taken)), (faulty, refused))),
    )
