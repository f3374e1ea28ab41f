# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Authentication in the code of a bus, and the unit of the user that computes the MACs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from ravenchart.gen.emit.ada.declarations import (
    SPARK,
    Aspect,
    Decl,
    EnumType,
    Object,
    Package,
    Param,
    Subprogram,
    SubtypeDeclaration,
    Unit,
)
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    NOTHING,
    Aggregate,
    Arg,
    Expr,
    OperatorChain,
    Prefix,
    all_else,
    both,
    call,
    equal,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import ada_case, root_package
from ravenchart.gen.emit.ada.statements import (
    Assign,
    Comment,
    IfStatement,
    Pragma,
    Return,
    Stmt,
    do,
)
from ravenchart.gen.model.authentication import Authentication
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System

from .ends import checking_state, sending_state, state_before

AUTHENTICATION = ref("Ravenchart.Can.Authentication")

UNIT = "Authentication"
"""The user's unit, below the root package."""

KEYS, MESSAGES = "Keys", "Messages"
"""Its types. Literals have a prefix, so that no name of the model clashes."""

ITEM = ref("Ravenchart.Can.Authentication.Mac_Input")
ANSWER = ref("Ravenchart.Can.Authentication.Mac_Answer")
FRESHNESS = ref("Ravenchart.Can.Authentication.Freshness_Value")

FRAME, VALUE, VERDICT = ref("Frame"), ref("Value"), ref("Verdict")


def authenticated(system: System) -> tuple[tuple[Message, Authentication], ...]:
    """The authenticated messages."""
    pairs = ((m, m.authentication) for m in system.messages)
    return tuple((message, own) for message, own in pairs if own is not None)


# --- The user's unit ---------------------------------------------------------------


def _key(own: Authentication) -> str:
    return f"Key_{ada_case(own.key)}"


def _literal(message: Message) -> str:
    return f"Message_{ada_case(message.name)}"


def _mac_spec() -> Subprogram:
    params = (Param("Key", "in", KEYS), Param("Item", "in", ITEM))
    return Subprogram("Mac", params, ANSWER)


def _last_spec() -> Subprogram:
    return Subprogram("Last_Freshness", (Param("Message", "in", MESSAGES),), FRESHNESS)


def emit_authentication(system: System, header: str) -> list[Unit]:
    """The spec of the unit that the user writes; none where no message is authenticated."""
    found = authenticated(system)
    if not found:
        return []
    keys = {own.key.lower(): _key(own) for _, own in found}
    pure = (Aspect("Global", NOTHING),)
    mac, last = _mac_spec(), _last_spec()
    items: tuple[Decl, ...] = (
        Comment("The keys of the model by name; generated code holds no key."),
        EnumType(KEYS, tuple(keys.values())),
        EnumType(MESSAGES, tuple(_literal(message) for message, _ in found)),
        Subprogram(mac.name, mac.params, mac.result, aspects=pure),
        Comment(
            "The MAC of the first Item.Length bytes under Key, if there is one. All tasks that "
            "send or receive call Mac, which returns within `mac_wcet`. The same arguments give "
            "the same MAC."
        ),
        Subprogram(last.name, last.params, last.result, aspects=pure),
        Comment(
            "The last freshness value of a message; called once for each. Of a message that this "
            "node sends: no less than any value ever sent with the same key and data identifier. "
            "Of one that it receives: no frame with this value or a smaller one is used."
        ),
    )
    return [Unit(header, (AUTHENTICATION,), Package(_unit(system), items, (SPARK,)))]


def first_authentication(system: System, header: str) -> list[Unit]:
    """A first body: no MAC is known, so nothing is sent and nothing is used."""
    if not authenticated(system):
        return []
    mac, last = _mac_spec(), _last_spec()
    nothing = all_else(BOX)
    bodies = tuple(
        Subprogram(
            spec.name,
            spec.params,
            spec.result,
            declarations=(Pragma("Unreferenced", tuple(ref(p.name) for p in spec.params)),),
            body=(Return(value),),
        )
        for spec, value in ((mac, nothing), (last, number(0)))
    )
    return [Unit(header, (), Package(_unit(system), bodies, (SPARK,), is_body=True))]


def _unit(system: System) -> DottedName:
    return ref(root_package(system), UNIT)


# --- The bus -----------------------------------------------------------------------


def context(root: str, messages: Iterable[Message]) -> set[DottedName]:
    """The user's unit, where one of these messages is authenticated."""
    return {ref(root, UNIT)} if any(message.authentication for message in messages) else set()


def _setting(message: Message) -> DottedName:
    return ref(f"Authentication_Of_{ada_case(message.name)}")


SETTING = SubtypeDeclaration("Mac_Setting", ref(AUTHENTICATION, "Setting"))
STATE = SubtypeDeclaration("Mac_State", ref(AUTHENTICATION, "Freshness_State"))
"""Short names: those of messages may be long."""


def settings_of(messages: Iterable[Message]) -> list[Decl]:
    """The parameters of the authenticated messages."""
    found = [m for m in messages if m.authentication is not None]
    shared: list[Decl] = [SETTING, STATE] if found else []
    return [*shared, *(item for message in found for item in _setting_of(message))]


def _setting_of(message: Message) -> list[Decl]:
    own = message.authentication
    assert own is not None
    columns = {
        "Data_Id": own.data_id,
        "Length": message.length,
        "Freshness_Bytes": own.freshness_bits // 8,
        "Mac_Bytes": own.mac_bits // 8,
    }
    made = Aggregate(tuple(Arg(name, number(value)) for name, value in columns.items()))
    return [
        Comment(f"[{message.name}] the authentication of this message"),
        Object(_setting(message), SETTING.name, made, constant=True),
    ]


def states_of_senders(sent: Sequence[Message]) -> tuple[Decl, ...]:
    """The freshness values of the authenticated messages that are sent."""
    return tuple(Object(sending_state(m), STATE.name) for m in sent if m.authentication)


def variables(*, taken: bool) -> tuple[Decl, ...]:
    """The variables that sending or receiving an authenticated message needs."""
    last: Decl = Object("Verdict", ref(AUTHENTICATION, "Status"))
    if taken:
        last = Object("Taken", "Boolean")
    return (Object("Value", FRESHNESS), Object("Answer", ANSWER), last)


def _begun(state: Named, message: Message) -> Stmt:
    """Begin with the user's freshness value, the first time."""
    last = call(ref(UNIT, "Last_Freshness"), ref(UNIT, _literal(message)))
    begin = do(ref(AUTHENTICATION, "Begin_After"), ref(state), last)
    return IfStatement(((Prefix("not", ref(state, "Is_Started")), (begin,)),))


def _mac(message: Message, own: Authentication) -> Expr:
    """The MAC of the frame, by the user's unit."""
    given = call(ref(AUTHENTICATION, "Input_Of"), FRAME, _setting(message), VALUE)
    return call(ref(UNIT, "Mac"), ref(UNIT, _key(own)), given)


def _is_authentic(message: Message, own: Authentication) -> Expr:
    return call(
        ref(AUTHENTICATION, "Is_Authentic"), FRAME, _setting(message), VALUE, _mac(message, own)
    )


def sealed(
    message: Message, own: Authentication, sent: tuple[Stmt, ...], refused: tuple[Stmt, ...]
) -> tuple[Stmt, ...]:
    """Send a frame with the next freshness value and its MAC; where there is none, do not."""
    state, setting = sending_state(message), _setting(message)
    return (
        _begun(state, message),
        do(ref(AUTHENTICATION, "Take"), ref(state), VALUE, ref("Taken")),
        IfStatement(((ref("Taken"), (Assign("Answer", _mac(message, own)),)),)),
        IfStatement(
            (
                (
                    ref("Answer.Is_Known"),
                    (
                        do(ref(AUTHENTICATION, "Seal"), FRAME, setting, VALUE, ref("Answer")),
                        *sent,
                    ),
                ),
            ),
            refused,
        ),
    )


def receiver_of(message: Message) -> tuple[Decl, ...]:
    """The receiver's state of an authenticated message, twice; the second is for its assertion."""
    if message.authentication is None:
        return ()
    return (Object(checking_state(message), STATE.name), Object(state_before(message), STATE.name))


def verified(
    message: Message, own: Authentication, taken: tuple[Stmt, ...], refused: tuple[Stmt, ...]
) -> tuple[Stmt, ...]:
    """Take a frame whose MAC is right; of another do what is to be done then."""
    state, setting = ref(checking_state(message)), _setting(message)
    before = state_before(message)
    newer = OperatorChain(">", (VALUE, ref(before, "Last")))
    known = both(newer, _is_authentic(message, own))
    return (
        _begun(state, message),
        Assign(before, state),
        do(ref(AUTHENTICATION, "Reconstruct"), state, setting, FRAME, VALUE, VERDICT),
        IfStatement(
            (
                (
                    equal(VERDICT, ref(AUTHENTICATION, "Unverified")),
                    (
                        Assign("Answer", _mac(message, own)),
                        do(
                            ref(AUTHENTICATION, "Verify"),
                            state,
                            setting,
                            FRAME,
                            VALUE,
                            ref("Answer"),
                            VERDICT,
                        ),
                    ),
                ),
            )
        ),
        IfStatement(
            (
                (
                    equal(VERDICT, ref(AUTHENTICATION, "Verified")),
                    (Pragma("Assert", (known,)), *taken),
                ),
            ),
            refused,
        ),
    )
