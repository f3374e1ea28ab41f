# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands of tasks on other nodes: the messages that carry calls, replies and published data.

As with connections (`distribution`), neither component knows. The calls of a command by an
instance are one message: the number of the call, and the argument. Where the caller waits for
replies they are another message, with the number of the call. A chain then leads from the
caller's release through the server to the arrival of the reply, within the binding's limit.

A data item that readers on other nodes read is published: one message carries it for all of
them. The row that writes the item sends it, as often as the fastest reader looks. To ask for
the item would add a frame and a wait. A chain leads from the sending to the reader; the binding
limits its age.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravenchart.gen.language.names import path_name, problem_of
from ravenchart.gen.language.terms import (
    BUILT_IN,
    NO_TIME,
    Field,
    IntegerType,
    Ns,
    RecordType,
    Type,
    named,
)
from ravenchart.gen.model.buses import Bus, Message
from ravenchart.gen.model.commands import Binding, Remote, RemoteRead, Server
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.signals import fits_classic, length_of, signals_of
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Carried, Chain, System
from ravenchart.gen.origins import Origin

from .calls import asking, awaited, published_by, readers, serving
from .distribution import bus_named, carriers, which_bus
from .identifiers import OPEN

NUMBER = IntegerType("Call_Number", BUILT_IN, 0, 255)
"""Calls are numbered by these, again and again: one byte of a frame."""

Obstacle = tuple[str, Origin, str, str | None]
"""Code, place, message and hint of what keeps a command on its node."""


def calling(system: System) -> System:
    """The system with the messages of all commands of other nodes.

    Bindings that no message can carry are left as they are; `obstacle` says why.
    """
    across = [b for b in system.bindings if is_across(system, b)]
    found = ((b, _call(system, b)) for b in across)
    made = {(b.instance, b.need.name): call for b, call in found if call is not None}
    calls = (*made.values(), *_reads(system, across))
    providers = {key: one for call in calls for key, one in call.providers.items()}
    return replace(
        system,
        types=(*system.types, *dict.fromkeys(t for call in calls for t in call.types)),
        messages=(*system.messages, *(m for call in calls for m in call.messages)),
        chains=(
            *system.chains,
            *(chain for call in calls for chain in call.chains),
            *_within_node(system),
        ),
        bindings=tuple(_bound(system, b, providers) for b in system.bindings),
    )


def _within_node(system: System) -> Iterator[Chain]:
    """The chains of calls to elements of arrays on the node of their caller, within the limit.

    Of each row that calls there is one: from its release until the element has executed the call.
    """
    for binding in system.bindings:
        need, server, limit = binding.need, binding.provider, binding.time_limit
        component = system.instance(binding.instance).component
        queued = isinstance(server, Server) and published_by(binding) is None
        waits = need.is_part and limit is not None and awaited(component, need)
        if not isinstance(server, Server) or not queued or not waits or is_across(system, binding):
            continue
        rows = asking(system, binding)
        for row in rows:
            name = _called(binding) if len(rows) == 1 else f"{_called(binding)}_{row.name}"
            path = (row, serving(server))
            yield Chain(name, binding.origin, path, reaction=limit, age=None, of_call=True)


def is_across(system: System, binding: Binding) -> bool:
    """Whether a task on another node provides the command."""
    provider = binding.provider
    if not isinstance(provider, Server):
        return False
    home, there = (system.instance(name).node for name in (binding.instance, provider.instance))
    return home != there


def obstacle(system: System, binding: Binding) -> Obstacle | None:
    """Why no message can carry a command to the node of its provider; None where one can."""
    need, server = binding.need, binding.provider
    assert isinstance(server, Server)
    home, there = (system.instance(name).node for name in (binding.instance, server.instance))
    own, at = f"{binding.instance}.{need.name}", binding.origin
    ends = f"{own} is on {home}, and {server.instance}, which provides it, on {there}"
    is_read = published_by(binding) is not None
    if is_read and _writer(system, binding) is None:
        message = f"{ends}; nothing writes {published_by(binding)}, so nothing sends it"
        return "RV-0802", need.origin, message, "let a parameter of the reader say what is constant"
    if not system.buses:
        hint = "declare a bus: between nodes, calls travel as its messages"
        return "RV-0606", at, ends, hint
    if bus_named(system.buses, binding.bus) is None:
        return "RV-0606", at, f"{ends}; {carriers(system.buses)}", which_bus(system.buses)
    if is_read and binding.time_limit is None:
        message = f"{own} is read from {there}: the binding needs the key `time_limit`"
        return "RV-1214", at, message, "say how old it may be: `time_limit: ...`"
    if awaited(system.instance(binding.instance).component, need) and binding.time_limit is None:
        message = f"{own} has its replies from {there}: the binding needs the key `time_limit`"
        hint = "say how long a reply may take: `time_limit: ...`"
        return "RV-1214", at, message, hint
    for name in _names(binding):
        problem = problem_of(name)
        if problem is not None:
            return problem[0], at, f"{own} is carried as `{name}`: {problem[1]}", _RENAME
    taken = {one.name.lower() for one in (*system.messages, *system.types, *system.chains)}
    names = (*_names(binding), NUMBER.name)
    clash = next((name for name in names if name.lower() in taken), None)
    if clash is not None:
        message = f"{own} is carried as `{clash}`, and the model has that name"
        return "RV-0303", at, message, _RENAME
    return None


_RENAME = "give the instance, the command, or what is called so another name"


def _called(binding: Binding) -> str:
    """A command of an instance as one name."""
    return f"{path_name(binding.instance)}_{binding.need.name}"


def _names(binding: Binding) -> Iterator[str]:
    """The names of messages and types that a command between nodes has."""
    if published_by(binding) is not None:
        yield from (_published_as(binding), _called(binding))
        return
    own = _called(binding)
    yield own
    yield from (f"{own}_{what}" for what in ("Reply", "Call", "Answer"))


def _bound(
    system: System, binding: Binding, made: Mapping[tuple[str, str], Remote | RemoteRead]
) -> Binding:
    """A binding with its messages; across nodes without provider where no row uses it."""
    carried = made.get((binding.instance, binding.need.name))
    if carried is not None:
        return replace(binding, provider=carried)
    component, need = system.instance(binding.instance).component, binding.need
    idle = not component.senders(need.command.name) and not readers(component, need)
    return replace(binding, provider=None) if idle and is_across(system, binding) else binding


@dataclass(frozen=True, slots=True)
class _Call:
    """The messages of one command, with their chains and types."""

    providers: Mapping[tuple[str, str], Remote | RemoteRead]
    """By instance and command."""
    messages: tuple[Message, ...]
    chains: tuple[Chain, ...]
    types: tuple[Type, ...]


def _call(system: System, binding: Binding) -> _Call | None:
    """The messages of a binding's command; None where no message can carry it, or no row calls."""
    need, server = binding.need, binding.provider
    component = system.instance(binding.instance).component
    period = component.send_period(need.command.name)
    if not isinstance(server, Server) or period is None or obstacle(system, binding):
        return None
    call, reply, asked, answered = _names(binding)
    limit = (binding.time_limit or NO_TIME) if awaited(component, need) else NO_TIME
    remote = Remote(
        caller=binding.instance,
        need=need,
        server=server,
        request=call,
        reply=reply if limit else None,
        time_limit=limit,
        executions=-(-limit // period),
    )
    bus = _carrier(system, binding)
    here = Message(
        name=call,
        origin=binding.origin,
        bus=bus.name,
        identifier=OPEN,
        extended=False,
        type=_numbered(asked, binding.origin, need.argument),
        signals=(),
        length=0,
        source=End(binding.instance, need.command.name),
        targets=(End(server.instance, server.interface.name),),
        period=period,
        call=remote,
    )
    providers = {(binding.instance, need.name): remote}
    if need.reply is None or not limit:
        return _Call(providers, (_laid_out(here, bus),), (), (NUMBER, here.type))
    server_component = system.instance(server.instance).component
    back = replace(
        here,
        name=reply,
        type=_numbered(answered, binding.origin, need.reply),
        source=End(server.instance, reply),
        targets=(End(binding.instance, f"{need.command.name}_Reply"),),
        period=named(server_component.activities, str(server.interface.server)).timing.period,
    )
    path = (Carried(call), serving(server), Carried(reply))
    chain = Chain(call, binding.origin, path, reaction=limit, age=None)
    messages = tuple(_laid_out(one, bus) for one in (here, back))
    return _Call(providers, messages, (chain,), (NUMBER, here.type, back.type))


def _published_as(binding: Binding) -> str:
    """The message that carries a published data item, on the bus that the binding names."""
    assert isinstance(binding.provider, Server)
    own = f"{path_name(binding.provider.instance)}_{binding.need.command.name}"
    return own if binding.bus is None else f"{own}_{binding.bus}"


def _writer(system: System, binding: Binding) -> Region | Activity | None:
    """The row that writes a published data item and sends it; None where none does."""
    assert isinstance(binding.provider, Server)
    rows = system.instance(binding.provider.instance).component.runnables()
    return next((row for row in rows if published_by(binding) in row.writes), None)


def _reads(system: System, across: Sequence[Binding]) -> Iterator[_Call]:
    """The messages of the read commands between nodes, for all readers of each."""
    of: defaultdict[str, list[Binding]] = defaultdict(list)
    for binding in across:
        read = readers(system.instance(binding.instance).component, binding.need)
        if published_by(binding) is not None and read and obstacle(system, binding) is None:
            of[_published_as(binding)].append(binding)
    for name, bindings in of.items():
        yield _read(system, name, bindings)


def _read(system: System, name: str, bindings: Sequence[Binding]) -> _Call:
    """The message of a read command to its readers, which are on other nodes."""
    first = bindings[0]
    item, writer, reply = published_by(first), _writer(system, first), first.need.reply
    assert isinstance(first.provider, Server)
    assert item is not None and writer is not None and reply is not None
    owner = system.instance(first.provider.instance)
    providers: dict[tuple[str, str], Remote | RemoteRead] = {}
    chains: list[Chain] = []
    periods: list[Ns] = []
    for one in bindings:
        rows = readers(system.instance(one.instance).component, one.need)
        watcher = min(rows, key=lambda row: row.timing.period)
        limit = one.time_limit or NO_TIME
        periods.append(watcher.timing.period)
        providers[one.instance, one.need.name] = RemoteRead(
            need=one.need,
            server=first.provider,
            message=name,
            initial=named(owner.component.data, item).initial,
            time_limit=limit,
            #  the first execution after a message may follow it at once
            executions=-(-limit // watcher.timing.period) + 1,
            watcher=watcher.name,
        )
        path = (Carried(name), End(one.instance, watcher.name))
        chains.append(Chain(_called(one), one.origin, path, reaction=None, age=limit))
    every = max(1, min(periods) // writer.timing.period)
    bus = _carrier(system, first)
    message = Message(
        name=name,
        origin=first.origin,
        bus=bus.name,
        identifier=OPEN,
        extended=False,
        type=reply,
        signals=(),
        length=0,
        source=End(owner.name, item),
        targets=tuple(End(one.instance, one.need.name) for one in bindings),
        period=Ns(writer.timing.period * every),
        every=every,
    )
    return _Call(providers, (_laid_out(message, bus),), tuple(chains), ())


def _carrier(system: System, binding: Binding) -> Bus:
    """The bus of a command that a message can carry."""
    bus = bus_named(system.buses, binding.bus)
    assert bus is not None
    return bus


def _laid_out(message: Message, bus: Bus) -> Message:
    """The message as small as its value is; CAN FD where it must be, and its bus has a rate."""
    signals = signals_of(message.type)
    fd = bus.data_rate is not None and not fits_classic(signals)
    return replace(message, signals=signals, length=length_of(signals, fd=fd), fd=fd)


def _numbered(name: str, origin: Origin, carried: Type | None) -> RecordType:
    """A record of the number of a call, and its argument or reply."""
    fields: tuple[Field, ...] = ()
    if isinstance(carried, RecordType):
        fields = carried.fields
    elif carried is not None:
        fields = (Field("value", origin, carried),)
    number = "number"
    while any(field.name.lower() == number for field in fields):
        number = f"call_{number}"
    return RecordType(name, origin, (Field(number, origin, NUMBER), *fields))
