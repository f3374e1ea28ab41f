# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands between nodes: how an instance sends and hears calls, and replies to them.

The caller numbers its calls, and gives one up when its limit has passed. The provider queues each
call that it hears like those of its own callers, with the number in it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ravenchart.gen.derive.calls import calls_from_afar, delivered
from ravenchart.gen.derive.remote import NUMBER
from ravenchart.gen.emit.ada.declarations import (
    Decl,
    GenericInstance,
    Object,
    Param,
    Subprogram,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Attribute,
    Expr,
    OperatorChain,
    arguments,
    between,
    call,
    equal,
    member,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case, priority, type_name
from ravenchart.gen.emit.ada.statements import Assign, Comment, IfStatement, Stmt, do
from ravenchart.gen.emit.tables.trace_calls import fault_units
from ravenchart.gen.language.terms import RecordType, Type
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.commands import Need, Provided, Remote, RemoteRead
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System

CALLS = ref("Ravenchart.Calls")
STATUS = ref("Ravenchart.Queueing.Put_Status")


def remotes(system: System, instance: Instance) -> tuple[Remote, ...]:
    """The commands that an instance calls on other nodes."""
    own = (b.provider for b in system.bindings if b.instance == instance.name)
    return tuple(provider for provider in own if isinstance(provider, Remote))


def heard(system: System, instance: Instance) -> tuple[tuple[Provided, Message], ...]:
    """The calls that an instance hears from other nodes, by the interface that serves them."""
    return tuple(
        (provided, message)
        for provided in instance.component.provides
        for message in calls_from_afar(system, instance.name, provided)
    )


def received_as(message: Message) -> str:
    """The procedure by which the receiver of a call or reply takes it."""
    assert message.call is not None
    if message.is_reply:
        return f"Answer_{ada_case(message.call.need.name)}"
    return f"Ask_{ada_case(message.name)}"


def units_of(system: System, instance: Instance) -> Iterator[DottedName]:
    """The units that the body of an instance needs for all of this."""
    root = ada_case(system.name)
    asked = remotes(system, instance)
    answered = [m for _, m in heard(system, instance) if m.call and m.call.reply]
    if asked or heard(system, instance):
        yield CALLS
    if any(one.reply for one in asked):
        yield from (ref("Ravenchart.Remote_Calls"), ref("Ravenchart.Queueing"))
        yield from fault_units(root)
    yield from (ref(root, ada_case(message.bus)) for message in answered)


# --- The caller --------------------------------------------------------------------


def call_objects(system: System, instance: Instance) -> Iterator[Decl]:
    """The calls that wait for replies, and the numbers of those that do not."""
    for remote in remotes(system, instance):
        name = ada_case(remote.need.name)
        yield Comment(f"[{instance.name}.{remote.need.name}] the calls to another node")
        if remote.reply is None:
            last = Attribute(ref(CALLS, "Call_Number"), "Last")
            yield Object(f"{name}_Number", ref(CALLS, "Call_Number"), last)
        else:
            ceiling = priority(system.object(f"{instance.name}.{remote.need.name}.call").ceiling)
            args = arguments(Limit=number(remote.executions), Ceiling=ceiling)
            yield GenericInstance(f"{name}_Call", "Ravenchart.Remote_Calls", args)


def sent_call(
    system: System, remote: Remote, full: tuple[Stmt, ...]
) -> tuple[list[Decl], list[Stmt]]:
    """A call: sent with its number, or ``full`` where one waits already."""
    message = next(m for m in system.messages if m.name == remote.request)
    name, need = ada_case(remote.need.name), remote.need
    send = ref(ada_case(message.bus), f"Send_{ada_case(message.name)}")
    if remote.reply is None:
        kept = ref(f"{name}_Number")
        following = do(send, _framed(message, kept, ref("Item"), need.argument))
        count = Assign(kept, call(ref(CALLS, "Following"), kept))
        return [], [count, following]
    declarations: list[Decl] = [
        Object("Number", ref(CALLS, "Call_Number")),
        Object("Status", STATUS),
        UseType(STATUS),
    ]
    frame = _framed(message, ref("Number"), ref("Item"), need.argument)
    queued = equal(ref("Status"), ref("Ravenchart.Queueing.Queued"))
    body: list[Stmt] = [
        do(ref(f"{name}_Call", "Start"), ref("Number"), ref("Status")),
        IfStatement(((queued, (do(send, frame),)),), full),
    ]
    return declarations, body


def watch_name(need: str) -> str:
    """The procedure that notices when the limit of a call has passed."""
    return f"Watch_{ada_case(need)}"


def watch_body(need: Need, kept: str, passed: tuple[Stmt, ...]) -> Subprogram:
    """One more execution for ``kept``; ``passed`` when that was the last of the limit."""
    status = ref(CALLS, "Wait_Status")
    late = equal(ref("Status"), ref(CALLS, "Timed_Out"))
    return Subprogram(
        watch_name(need.name),
        declarations=(Object("Status", status), UseType(status)),
        body=(
            do(ref(kept, "Tick"), ref("Status")),
            IfStatement(((late, passed),)),
        ),
    )


def watched(system: System, instance: Instance, row: Region | Activity) -> Iterator[Stmt]:
    """The first statements of a row that calls or reads on other nodes: its watches."""
    for binding in system.bindings:
        made, need = binding.provider, binding.need
        called = need.command.name in row.sends
        calls = isinstance(made, Remote) and made.reply is not None and called
        looks = isinstance(made, RemoteRead) and made.watcher == row.name
        if binding.instance == instance.name and (calls or looks):
            yield do(watch_name(need.name))


def answers(system: System, instance: Instance) -> Iterator[tuple[Subprogram, Subprogram]]:
    """For each reply from another node, spec and body of the procedure that takes it."""
    for remote in remotes(system, instance):
        message = next((m for m in system.messages if m.name == remote.reply), None)
        if message is None or remote.need.reply is None:
            continue
        spec = _receiving(system, message)
        name = ada_case(remote.need.name)
        taken = delivered(instance.component, remote.need)
        status = "Status" if taken else "Unused_Status"
        of_type = ref(CALLS, "Reply_Status")
        declarations: list[Decl] = [Object(status, of_type)]
        body: list[Stmt] = [do(ref(f"{name}_Call", "Finish"), _number(message), ref(status))]
        if taken:
            declarations.append(UseType(of_type))
            awaited = equal(ref(status), ref(CALLS, "Awaited"))
            reply = value_of(system, message, remote.need.reply)
            body.append(IfStatement(((awaited, (do(f"Take_{name}", reply),)),)))
        yield (
            spec,
            Subprogram(spec.name, spec.params, declarations=tuple(declarations), body=tuple(body)),
        )


# --- The provider ------------------------------------------------------------------


def heard_objects(system: System, instance: Instance) -> Iterator[Decl]:
    """The last calls that came from other nodes."""
    for _, message in heard(system, instance):
        yield Object(f"{ada_case(message.name)}_Heard", ref(CALLS, "Heard"))


def asked_from_afar(
    system: System, message: Message, request: Expr, put: str
) -> tuple[Subprogram, Subprogram]:
    """Spec and body of the procedure that puts the ``request`` of a call into the queue, once."""
    spec = _receiving(system, message)
    kept = ref(f"{ada_case(message.name)}_Heard")
    first = equal(ref("Hearing"), ref(CALLS, "Heard_First"))
    body = (
        do(ref(CALLS, "Hear"), kept, _number(message), ref("Hearing")),
        IfStatement(((first, (do(put, request, ref("Unused_Status")),)),)),
    )
    declarations = (
        Object("Hearing", ref(CALLS, "Hearing")),
        UseType(ref(CALLS, "Hearing")),
        Object("Unused_Status", STATUS),
    )
    return spec, Subprogram(spec.name, spec.params, declarations=declarations, body=body)


def caller_number(local: int, place: int, message: Message) -> Expr:
    """Who asks, in a request: the numbers of the calls heard, behind the ``local`` callers."""
    called = call("Natural", _number(message))
    first = _first(local, place)
    return called if first == 0 else OperatorChain("+", (number(first), called))


def replies(
    system: System, instance: Instance, provided: Provided, local: int, reply: Callable[[str], str]
) -> Iterator[Stmt]:
    """The replies to other nodes once a request is executed; ``reply`` names what was given."""
    for place, message in enumerate(calls_from_afar(system, instance.name, provided)):
        back = reply_to(system, message)
        if back is None or back.call is None:
            continue
        need, first = back.call.need, _first(local, place)
        caller: Expr = ref("Asked.Caller")
        asks: Expr = OperatorChain("<=", (caller, number(NUMBER.last)))
        if first > 0:
            asks = member(caller, between(first, first + NUMBER.last))
            caller = OperatorChain("-", (caller, number(first)))
        called = call("Ravenchart.Number", caller)
        frame = _framed(back, called, ref(reply(need.command.name)), need.reply)
        send = ref(ada_case(back.bus), f"Send_{ada_case(back.name)}")
        yield IfStatement(((asks, (do(send, frame),)),))


def reply_to(system: System, message: Message) -> Message | None:
    """The message with the replies to the calls of another; None where no caller waits for them."""
    return next((m for m in system.messages if m.call == message.call and m.is_reply), None)


def _first(local: int, place: int) -> int:
    return local + place * (NUMBER.last + 1)


# --- Frames ------------------------------------------------------------------------


def _receiving(system: System, message: Message) -> Subprogram:
    params = (Param("Item", "in", type_name(system, message.type)),)
    return Subprogram(received_as(message), params)


def _number(message: Message) -> DottedName:
    """The number of a call in a received value."""
    assert isinstance(message.type, RecordType)
    return ref("Item", ada_case(message.type.fields[0].name))


def value_of(system: System, message: Message, carried: Type) -> Expr:
    """The argument or reply beside the number in a received value."""
    assert isinstance(message.type, RecordType)
    names = [ada_case(field.name) for field in message.type.fields[1:]]
    if not isinstance(carried, RecordType):
        return ref("Item", names[0])
    rows = tuple(Arg(name, ref("Item", name)) for name in names)
    return Aggregate(rows, type_name(system, carried))


def _framed(message: Message, called: Expr, item: DottedName, carried: Type | None) -> Expr:
    """The number of a call, with its argument or reply."""
    assert isinstance(message.type, RecordType)
    first, *others = (ada_case(field.name) for field in message.type.fields)
    of_record = isinstance(carried, RecordType)
    rows = [Arg(name, ref(item, name) if of_record else item) for name in others]
    return Aggregate((Arg(first, called), *rows))
