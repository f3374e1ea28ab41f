"""Commands of tasks on other nodes: the messages that carry their calls and replies.

As with connections (`distribution`), neither component knows. The calls of a command by an
instance are one message: a number that tells them apart, and the argument. Where somebody
waits for replies they are another, with the number of the call, and a chain leads from the
caller's release through the server to the arrival of the reply, limited as the binding says.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from .calls import awaited, published_by
from .commands import Binding, Remote, Server
from .identifiers import OPEN
from .model import NO_TIME, Chain, End, Message, System
from .names import problem_of
from .signals import length_of, signals_of
from .terms import BUILT_IN, Field, IntegerType, Origin, RecordType, Type, named

NUMBER = IntegerType("Call_Number", BUILT_IN, 0, 255)
"""Calls are numbered by these, again and again: one byte of a frame."""

Obstacle = tuple[str, Origin, str, str | None]
"""Code, place, message and hint of what keeps a command on its node."""


def calling(system: System) -> System:
    """The system with a message for each command of another node, and one for its replies.

    Bindings that no message can carry are left as they are; `obstacle` says why.
    """
    found = ((b, _call(system, b)) for b in system.bindings if is_across(system, b))
    made = {(b.instance, b.need.name): call for b, call in found if call is not None}
    calls = made.values()
    return replace(
        system,
        types=(*system.types, *dict.fromkeys(t for call in calls for t in call.types)),
        messages=(*system.messages, *(m for call in calls for m in call.messages)),
        chains=(*system.chains, *(chain for call in calls for chain in call.chains)),
        bindings=tuple(_bound(system, b, made) for b in system.bindings),
    )


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
    if published_by(binding) is not None:
        return "RV-0802", need.origin, ends, "let a port carry what is read"
    if not system.buses:
        hint = "declare a bus: between nodes, calls travel as its messages"
        return "RV-0606", at, ends, hint
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


def _names(binding: Binding) -> Iterator[str]:
    """The names of messages and types that a command between nodes has."""
    own = f"{binding.instance}_{binding.need.name}"
    yield own
    yield from (f"{own}_{what}" for what in ("Reply", "Call", "Answer"))


def _bound(system: System, binding: Binding, made: Mapping[tuple[str, str], _Call]) -> Binding:
    """A binding with what carries it; one across nodes that nothing calls leads nowhere."""
    call = made.get((binding.instance, binding.need.name))
    if call is not None:
        return replace(binding, provider=call.remote)
    component = system.instance(binding.instance).component
    idle = not component.senders(binding.need.name) and published_by(binding) is None
    return replace(binding, provider=None) if idle and is_across(system, binding) else binding


@dataclass(frozen=True, slots=True)
class _Call:
    """What carries one command."""

    remote: Remote
    messages: tuple[Message, ...]
    chains: tuple[Chain, ...]
    types: tuple[Type, ...]


def _call(system: System, binding: Binding) -> _Call | None:
    """What carries the command of a binding; None where nothing can, or nothing calls it."""
    need, server = binding.need, binding.provider
    component = system.instance(binding.instance).component
    period = component.send_period(need.name)
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
    here = Message(
        name=call,
        origin=binding.origin,
        bus=system.buses[0].name,
        identifier=OPEN,
        extended=False,
        type=_numbered(asked, binding.origin, need.argument),
        signals=(),
        length=0,
        source=End(binding.instance, need.name),
        targets=(End(server.instance, server.interface.name),),
        period=period,
        call=remote,
    )
    if need.reply is None or not limit:
        return _Call(remote, (_laid_out(here),), (), (NUMBER, here.type))
    server_component = system.instance(server.instance).component
    back = replace(
        here,
        name=reply,
        type=_numbered(answered, binding.origin, need.reply),
        source=End(server.instance, reply),
        targets=(End(binding.instance, f"{need.name}_Reply"),),
        period=named(server_component.activities, str(server.interface.server)).timing.period,
    )
    chain = Chain(call, binding.origin, (call, remote.served, reply), reaction=limit, age=None)
    messages = (_laid_out(here), _laid_out(back))
    return _Call(remote, messages, (chain,), (NUMBER, here.type, back.type))


def _laid_out(message: Message) -> Message:
    """The message as small as its value is."""
    signals = signals_of(message.type)
    return replace(message, signals=signals, length=length_of(signals))


def _numbered(name: str, origin: Origin, carried: Type | None) -> RecordType:
    """A record of the number of a call, and what is carried with it."""
    fields: tuple[Field, ...] = ()
    if isinstance(carried, RecordType):
        fields = carried.fields
    elif carried is not None:
        fields = (Field("value", origin, carried),)
    number = "number"
    while any(field.name.lower() == number for field in fields):
        number = f"call_{number}"
    return RecordType(name, origin, (Field(number, origin, NUMBER), *fields))
