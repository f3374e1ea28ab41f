# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""How an instance calls what its required commands are bound to, and how calls are served."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.calls import (
    asking,
    callers_of,
    calls_from_afar,
    delivered,
    published_by,
    repliers,
    replies_read,
)
from ravenchart.gen.emit.ada.declarations import (
    Decl,
    EnumType,
    GenericInstance,
    Object,
    Package,
    Param,
    RecordComponent,
    RecordDeclaration,
    Subprogram,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    BOX,
    OTHERS,
    Aggregate,
    Arg,
    Choice,
    Expr,
    OperatorChain,
    all_else,
    arguments,
    equal,
    number,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import (
    ada_case,
    component_name,
    default_value,
    priority,
    type_name,
)
from ravenchart.gen.emit.ada.statements import (
    Assign,
    Case,
    Comment,
    Do,
    ExitStatement,
    IfStatement,
    Pragma,
    Stmt,
    do,
)
from ravenchart.gen.emit.language.events import event_value
from ravenchart.gen.language.terms import Type, named
from ravenchart.gen.model.commands import Binding, Device, Need, Provided, Remote, Server
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.instances import Instance, Requests
from ravenchart.gen.model.system import System

from .gathered_answers import concluding
from .remote_calls import (
    answers,
    asked_from_afar,
    caller_number,
    heard,
    replies,
    reply_to,
    sent_call,
    value_of,
)
from .remote_reads import kept

STATUS = ref("Ravenchart.Queueing.Put_Status")


# --- Who is called -----------------------------------------------------------------


def providers(system: System, instance: Instance) -> tuple[str, ...]:
    """The packages, below the root, of what an instance calls and of whom it replies to."""
    found: dict[str, None] = {}
    for binding in system.bindings:
        provider = binding.provider
        if isinstance(provider, Server):
            owner = system.instance(provider.instance)
            if binding.instance == instance.name:
                found[ada_case(owner.name)] = found[component_name(owner.component)] = None
            elif owner.name == instance.name and delivers(system, binding):
                found[ada_case(binding.instance)] = None
        elif isinstance(provider, Device) and binding.instance == instance.name:
            found[ada_case(provider.name)] = None
    for poll in system.polls:
        if poll.instance == instance.name:
            found[ada_case(poll.device.name)] = None
    found.pop(ada_case(instance.name), None)
    return tuple(found)


def delivers(system: System, binding: Binding) -> bool:
    """Whether anybody takes the replies to a call."""
    return delivered(system.instance(binding.instance).component, binding.need)


def call_body(
    system: System,
    binding: Binding,
    full: tuple[Stmt, ...],
    lost: tuple[Stmt, ...],
    more: tuple[Param, ...] = (),
) -> Subprogram:
    """A required command as the instance calls it, whatever provides it.

    ``full`` follows where the call is refused. ``lost`` counts a call to another node that is
    refused, since one is under way.
    """
    need = binding.need
    params = item_params(system, need)
    if isinstance(binding.provider, Server):
        declarations, body = _queued(system, binding, binding.provider, full)
    elif isinstance(binding.provider, Remote):
        declarations, body = sent_call(system, binding.provider, (*lost, *full))
    else:
        assert isinstance(binding.provider, Device)
        declarations, body = _direct(system, binding, binding.provider)
    name = f"Call_{ada_case(need.name)}"
    return Subprogram(name, (*params, *more), declarations=tuple(declarations), body=tuple(body))


def item_params(system: System, need: Need) -> tuple[Param, ...]:
    """The parameter of a call that takes something."""
    of_type = need.argument
    return () if of_type is None else (Param("Item", "in", type_name(system, of_type)),)


def told_full(instance: Instance, need: Need) -> tuple[Stmt, ...]:
    """Raise the event of a call that is refused, where there is one."""
    if need.on_full is None:
        return ()
    return (do("Offer", event_value(instance.component, need.on_full)),)


def _direct(system: System, binding: Binding, device: Device) -> tuple[list[Decl], list[Stmt]]:
    need = binding.need
    given = list(arguments(ref("Item")) if need.argument is not None else ())
    called = ref(ada_case(device.name), ada_case(need.command.name))
    if need.reply is None:
        return [], [Do(called, tuple(given))]
    taken = delivers(system, binding)
    reply = "Reply" if taken else "Unused_Reply"
    given.append(Arg(None, ref(reply)))
    call = Do(called, tuple(given))
    after = (do(ref(f"Take_{ada_case(need.name)}"), ref(reply)),) if taken else ()
    return [Object(reply, type_name(system, need.reply))], [call, *after]


def _queued(
    system: System, binding: Binding, server: Server, full: tuple[Stmt, ...]
) -> tuple[list[Decl], list[Stmt]]:
    need = binding.need
    asking = callers_of(system, server.instance, server.interface)
    caller = number(asking.index(binding))
    request = _request(system, server, need, caller, ref("Item"))
    status = "Status" if full else "Unused_Status"
    put = ref(f"Put_{ada_case(server.interface.name)}")
    if server.instance != binding.instance:
        put = ref(ada_case(server.instance), put)
    body: list[Stmt] = [do(put, request, ref(status))]
    declarations: list[Decl] = [Object(status, STATUS)]
    if full:
        declarations.append(UseType(STATUS))
        refused = OperatorChain("/=", (ref(status), ref("Ravenchart.Queueing.Queued")))
        body.append(IfStatement(((refused, full),)))
    return declarations, body


def _request(
    system: System, server: Server, need: Need, caller: Expr, item: Expr | None
) -> Aggregate:
    """An item in the queue of an interface: the command, its caller, and the argument."""
    owner = ada_case(system.instance(server.instance).component.name)
    package = ref(owner, requests_package(server.interface))
    rows = [Arg("Name", ref(package, f"{ada_case(need.command.name)}_Asked"))]
    if numbered(server.interface):
        rows.append(Arg("Caller", caller))
    if need.argument is not None and item is not None:
        rows.append(Arg(ada_case(need.command.name), item))
    if len(rows) < len(_fields(system, server.interface)):
        rows.append(Arg(OTHERS, BOX))
    return Aggregate(tuple(rows), ref(package, "Request"))


def from_afar(system: System, instance: Instance) -> Iterator[tuple[Subprogram, Subprogram]]:
    """For each call, reply and value from another node, spec and body of what takes it."""
    for provided, message in heard(system, instance):
        assert message.call is not None
        need = message.call.need
        local = len(callers_of(system, instance.name, provided))
        place = calls_from_afar(system, instance.name, provided).index(message)
        caller = caller_number(local, place, message)
        item = None if need.argument is None else value_of(system, message, need.argument)
        request = _request(system, message.call.server, need, caller, item)
        put = f"Put_{ada_case(provided.name)}"
        yield asked_from_afar(system, message, request, put)
    yield from answers(system, instance)
    yield from kept(system, instance)


# --- Replies -----------------------------------------------------------------------


def taken_replies(system: System, instance: Instance) -> Iterator[Binding]:
    """The calls of an instance whose replies it takes."""
    for binding in system.bindings:
        called = binding.need.reply is not None and not binding.need.is_read
        own = binding.instance == instance.name and called
        if own and repliers(system, binding) and delivers(system, binding):
            yield binding


def take_spec(system: System, need: Need) -> Subprogram:
    """Takes a reply: for whoever executed the command."""
    assert need.reply is not None
    params = (Param("Reply", "in", type_name(system, need.reply)),)
    return Subprogram(f"Take_{ada_case(need.name)}", params)


def take_body(system: System, instance: Instance, need: Need) -> Subprogram:
    """Keeps a reply for those who look at it, and raises its event.

    A reply of an element of an array is one of several to the same call.
    """
    if need.is_part:
        return concluding(system, need)
    body: list[Stmt] = []
    spec = take_spec(system, need)
    is_looked_at = False
    if need.reply_item in replies_read(instance.component):
        is_looked_at = True
        body.append(do(ref(f"{ada_case(str(need.reply_item))}_Board", "Write"), ref("Reply")))
    if need.on_reply is not None:
        is_looked_at |= named(instance.component.events, need.on_reply).type is not None
        event = event_value(instance.component, need.on_reply, ref("Reply"))
        body.append(do("Offer", event))
    unused = () if is_looked_at else (Pragma("Unreferenced", (ref("Reply"),)),)
    return Subprogram(spec.name, spec.params, declarations=unused, body=tuple(body))


def reply_boards(system: System, instance: Instance) -> Iterator[Decl]:
    """The last replies that somebody looks at."""
    read = replies_read(instance.component)
    for need in instance.component.needs:
        if need.reply_item in read and need.reply is not None:
            ceiling = priority(system.object(f"{instance.name}.{need.reply_item}").ceiling)
            args = arguments(
                Element_Type=type_name(system, need.reply),
                Initial=default_value(system, need.reply),
                Ceiling=ceiling,
            )
            board = f"{ada_case(need.reply_item)}_Board"
            yield GenericInstance(board, "Ravenchart.Blackboards", args)


# --- Requests ----------------------------------------------------------------------


def requests_package(provided: Provided) -> str:
    """Nested in the component's package: what can be asked of an interface."""
    return f"{ada_case(provided.name)}_Requests"


def request_param(provided: Provided) -> str:
    """The parameter by which the activity that serves an interface gets a request."""
    return f"{ada_case(provided.name)}_Request"


def reply_param(command: str) -> str:
    """The parameter by which the activity that serves an interface gives a reply."""
    return f"{ada_case(command)}_Reply"


def numbered(provided: Provided) -> bool:
    """Whether a request says who asks: somebody may get a reply."""
    return any(one.reply is not None for one in provided.requests)


def _fields(system: System, provided: Provided) -> tuple[RecordComponent, ...]:
    first = ref(f"{ada_case(provided.requests[0].name)}_Asked")
    fields = [RecordComponent("Name", "Command", first)]
    if numbered(provided):
        fields.append(RecordComponent("Caller", "Natural", number(0)))
    given: list[tuple[str, Type]] = [
        (one.name, one.argument) for one in provided.requests if one.argument is not None
    ]
    fields += [
        RecordComponent(ada_case(n), type_name(system, t), default_value(system, t))
        for n, t in given
    ]
    return tuple(fields)


def request_types(system: System, component: Component) -> Iterator[Decl]:
    """For each interface that is served, what can be asked of it."""
    for provided in component.provides:
        if provided.requests:
            yield Comment(
                f"[{component.name}.{provided.name}] the requests of callers, with arguments"
            )
            items: tuple[Decl, ...] = (
                EnumType("Command", tuple(f"{ada_case(r.name)}_Asked" for r in provided.requests)),
                RecordDeclaration("Request", _fields(system, provided)),
                Object("No_Request", "Request", all_else(BOX), constant=True),
            )
            yield Package(requests_package(provided), items)


def serving_params(system: System, component: Component, activity: str) -> Iterator[Param]:
    """More parameters of the activity that serves an interface: a request, and room for replies."""
    provided = component.served_by(activity)
    if provided is not None:
        package = ref(component_name(component), requests_package(provided))
        yield Param(request_param(provided), "in", ref(package, "Request"))
        for one in provided.requests:
            if one.reply is not None:
                yield Param(reply_param(one.name), "out", type_name(system, one.reply))


def put_spec(instance: Instance, provided: Provided) -> Subprogram:
    """Queues a request."""
    package = ref(component_name(instance.component), requests_package(provided))
    params = (Param("Item", "in", ref(package, "Request")), Param("Status", "out", STATUS))
    return Subprogram(f"Put_{ada_case(provided.name)}", params)


def put_body(instance: Instance, provided: Provided, lost: tuple[Stmt, ...]) -> Subprogram:
    """Queues a request; a full queue rejects it, which ``lost`` counts."""
    spec = put_spec(instance, provided)
    queue = f"{ada_case(provided.name)}_Queue"
    full = OperatorChain("/=", (ref("Status"), ref("Ravenchart.Queueing.Queued")))
    body = (
        do(ref(queue, "Put"), ref("Item"), ref("Status")),
        IfStatement(((full, lost),)),
    )
    return Subprogram(spec.name, spec.params, declarations=(UseType(STATUS),), body=body)


def request_objects(system: System, instance: Instance, provided: Provided) -> list[Decl]:
    """The variables of the row that serves an interface: a request, and room for replies."""
    package = ref(component_name(instance.component), requests_package(provided))
    found: list[Decl] = [
        Object("Asked", ref(package, "Request")),
        Object("Taken", "Ravenchart.Queueing.Take_Status"),
        UseType("Ravenchart.Queueing.Take_Status"),
    ]
    rooms = _rooms(system, instance, provided)
    found += [Object(room, type_name(system, of_type)) for _, room, of_type in rooms]
    return found


def asked_args(system: System, instance: Instance, provided: Provided) -> list[Arg]:
    """The arguments for the parameters that `serving_params` adds."""
    rooms = _rooms(system, instance, provided)
    given = (Arg(parameter, ref(room)) for parameter, room, _ in rooms)
    return [Arg(request_param(provided), ref("Asked")), *given]


def _rooms(
    system: System, instance: Instance, provided: Provided
) -> Iterator[tuple[str, str, Type]]:
    """For each reply its parameter, the room for it, and its type; some are sent to nobody."""
    local = callers_of(system, instance.name, provided)
    afar = calls_from_afar(system, instance.name, provided)
    wanted = {binding.need.command.name for binding in local if delivers(system, binding)}
    backs = (reply_to(system, message) for message in afar)
    heard_from = (back.call for back in backs if back is not None)
    wanted |= {call.need.command.name for call in heard_from if call is not None}
    for one in provided.requests:
        if one.reply is not None:
            name = reply_param(one.name)
            yield name, name if one.name in wanted else f"Unused_{name}", one.reply


def served(
    system: System, instance: Instance, provided: Provided, work: tuple[Stmt, ...]
) -> tuple[Stmt, ...]:
    """One request: taken, executed by ``work``, and its reply delivered."""
    replied: list[Stmt] = []
    asking = callers_of(system, instance.name, provided)
    for index, binding in enumerate(asking):
        if delivers(system, binding):
            is_own = binding.instance == instance.name
            take = ref(f"Take_{ada_case(binding.need.name)}")
            take = take if is_own else ref(ada_case(binding.instance), take)
            asks = OperatorChain("=", (ref("Asked.Caller"), number(index)))
            reply = ref(reply_param(binding.need.command.name))
            replied.append(IfStatement(((asks, (do(take, reply),)),)))
    replied += replies(system, instance, provided, len(asking), reply_param)
    return (
        do(ref(f"{ada_case(provided.name)}_Queue", "Take"), ref("Asked"), ref("Taken")),
        ExitStatement(equal(ref("Taken"), ref("Ravenchart.Queueing.Empty"))),
        *work,
        *replied,
    )


def forwarded(system: System, instance: Instance, provided: Provided) -> tuple[Stmt, ...]:
    """A request as a call of the required command of its name; a device replies at once."""
    rooms = {name: (room, of_type) for name, room, of_type in _rooms(system, instance, provided)}
    package = ref(component_name(instance.component), requests_package(provided))
    branches: list[tuple[Choice, tuple[Stmt, ...]]] = []
    for one in provided.requests:
        name = ada_case(one.name)
        given = [] if one.argument is None else [ref("Asked", name)]
        called = ref(f"Call_{name}")
        if one.reply is not None:
            provider = system.bound[instance.name, one.name].provider
            assert isinstance(provider, Device)
            called = ref(ada_case(provider.name), name)
            given.append(ref(rooms[reply_param(one.name)][0]))
        branches.append((ref(package, f"{name}_Asked"), (do(called, *given),)))
    starts = (Assign(room, default_value(system, of_type)) for room, of_type in rooms.values())
    return (*starts, Case(ref("Asked.Name"), branches))


def request_queue(system: System, instance: Instance, provided: Provided) -> GenericInstance:
    """The queue of an interface that is served."""
    package = ref(component_name(instance.component), requests_package(provided))
    element = f"{instance.name}.{provided.name}.queue"
    args = arguments(
        Element_Type=ref(package, "Request"),
        Null_Element=ref(package, "No_Request"),
        Capacity=number(provided.depth),
        Ceiling=priority(system.object(element).ceiling),
        Policy=ref("Ravenchart.Queueing.Reject_Newest"),
    )
    woken = system.called(Requests(instance.name, provided.name)) is not None
    generic = "Ravenchart.Releasing_Queues" if woken else "Ravenchart.Queues"
    return GenericInstance(f"{ada_case(provided.name)}_Queue", generic, args)


def published(system: System, instance: Instance) -> Iterator[tuple[Subprogram, str]]:
    """The read commands of an instance that somebody reads, each with its data item."""
    seen: set[str] = set()
    for binding in system.bindings:
        provider, item = binding.provider, published_by(binding)
        if isinstance(provider, Server) and provider.instance == instance.name:
            need, name = binding.need, binding.need.command.name
            if item is None or need.reply is None or name in seen:
                continue
            if asking(system, binding):
                seen.add(name)
                params = (Param("Reply", "out", type_name(system, need.reply)),)
                yield Subprogram(ada_case(name), params), item
