# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Who calls what: the rows behind the bindings of a system."""

from __future__ import annotations

from ravenchart.gen.language.terms import named
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.commands import (
    Binding,
    Device,
    DeviceType,
    DriverCommand,
    Gathered,
    Need,
    Provided,
    Remote,
    Server,
)
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.instances import End, Requests
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System


def readers(component: Component, need: Need) -> tuple[Region | Activity, ...]:
    """The rows of a component that read a command."""
    return tuple(row for row in component.runnables() if need.command.name in row.reads)


def publications(system: System, instance: str, row: Region | Activity) -> tuple[Message, ...]:
    """The messages that bring what a row writes to the readers on other nodes."""
    return tuple(
        message
        for message in system.messages
        if message.every
        and message.source is not None
        and message.source.instance == instance
        and message.source.name in row.writes
    )


def asking(system: System, binding: Binding) -> tuple[End, ...]:
    """The rows of the instance that use the command."""
    need = binding.need
    return tuple(
        End(binding.instance, row.name)
        for row in system.instance(binding.instance).component.runnables()
        if need.command.name in (row.reads if need.is_read else row.sends)
    )


def rows_of(system: System, binding: Binding) -> tuple[str, ...]:
    """The ids of the rows that use the command."""
    return tuple(map(str, asking(system, binding)))


def callers(system: System, device: Device) -> tuple[End, ...]:
    """The rows that call a piece of equipment, each once."""
    rows = (
        row
        for binding in system.bindings
        if isinstance(binding.provider, Device) and device in binding.provider.leaves()
        for row in asking(system, binding)
    )
    polls = ((poll.instance, poll.port) for poll in system.polls if poll.device == device)
    handlers = (End(name, system.instance(name).component.handler(port)) for name, port in polls)
    return tuple(dict.fromkeys((*rows, *handlers)))


def called(system: System, device: Device) -> tuple[DriverCommand, ...]:
    """The commands of a device that something is bound to, by itself or in an array."""
    names = {
        binding.need.command.name
        for binding in system.bindings
        if isinstance(binding.provider, Device)
        and (binding.provider == device or _holds(binding.provider, device))
    }
    names |= {poll.event for poll in system.polls if poll.device == device}
    return tuple(one for one in device.provides if one.name in names)


def _holds(array: Device, device: Device) -> bool:
    return any(member == device or _holds(member, device) for member in array.members)


def device_types(system: System) -> tuple[DeviceType, ...]:
    """The types of the devices that are called, each once."""
    return tuple(dict.fromkeys(device.type for device in system.devices if device.type))


def devices_with_ends(system: System) -> tuple[Device, ...]:
    """The devices with operations at start or end, in model order."""
    return tuple(d for d in system.devices if d.type is not None and d.type.lifecycle.given)


def called_devices(system: System, kind: DeviceType) -> tuple[Device, ...]:
    """The devices of a type that are called, in model order."""
    return tuple(device for device in system.devices if device.type == kind)


def published_by(binding: Binding) -> str | None:
    """The data item of the provider that a read command reads; None where it does not."""
    if not isinstance(binding.provider, Server):
        return None
    published, name = binding.provider.interface.published, binding.need.command.name
    return next((one.item for one in published if one.name == name), None)


def readers_through(system: System, instance: str, item: str) -> tuple[str, ...]:
    """The rows that read a data item through a command: a published item, or a fallback."""
    found: list[str] = []
    for binding in system.bindings:
        provider, fallback = binding.provider, binding.need.fallback
        if isinstance(provider, Server):
            if provider.instance == instance and published_by(binding) == item:
                found += rows_of(system, binding)
        elif provider is None and fallback and binding.instance == instance:
            found += rows_of(system, binding) if fallback.item == item else ()
    return tuple(found)


def callers_of(system: System, instance: str, provided: Provided) -> tuple[Binding, ...]:
    """The bindings whose calls are requests of a provided interface."""
    return tuple(
        b
        for b in system.bindings
        if isinstance(b.provider, Server)
        and (b.provider.instance, b.provider.interface) == (instance, provided)
        and published_by(b) is None
    )


def calls_at_once(system: System, served: Requests) -> int:
    """The calls of an interface that one execution of its caller makes at most."""
    provided = named(system.instance(served.instance).component.provides, served.name)
    found: dict[str, int] = {}
    for binding in callers_of(system, served.instance, provided):
        component = system.instance(binding.instance).component
        for row in component.senders(binding.need.command.name):
            times = getattr(row, "steps_per_execution", 1)
            element = f"{binding.instance}.{row.name}"
            found[element] = found.get(element, 0) + times
    return max(found.values(), default=1)


def serving(server: Server) -> End:
    """The row that executes the commands of an interface."""
    return End(server.instance, str(server.interface.server))


def repliers(system: System, binding: Binding) -> tuple[str, ...]:
    """The rows that deliver the replies to a call: whoever makes it, serves or receives it."""
    if isinstance(binding.provider, Server):
        return (str(serving(binding.provider)),)
    if isinstance(binding.provider, Remote):
        return receivers(system, binding.provider.reply)
    if isinstance(binding.provider, Gathered):
        found = (
            row for part in element_bindings(system, binding) for row in repliers(system, part)
        )
        return tuple(dict.fromkeys(found))
    return rows_of(system, binding) if binding.provider is not None else ()


def element_bindings(system: System, binding: Binding) -> tuple[Binding, ...]:
    """The bindings of the elements where an array provides the command."""
    names = binding.provider.parts if isinstance(binding.provider, Gathered) else ()
    return tuple(system.bound[binding.instance, name] for name in names)


def gathers(system: System, binding: Binding) -> bool:
    """Whether the replies of the elements of an array are put together."""
    called = binding.need.reply is not None and not binding.need.is_read
    component = system.instance(binding.instance).component
    reached = any(part.provider is not None for part in element_bindings(system, binding))
    return reached and called and awaited(component, binding.need)


def answered_at_once(component: Component, activity: Activity) -> tuple[str, ...]:
    """The commands that an activity forwards and whose replies it hands back: those of devices."""
    served = component.served_by(activity.name) if activity.forwards else None
    return () if served is None else tuple(one.name for one in served.requests if one.reply)


def receivers(system: System, name: str | None) -> tuple[str, ...]:
    """The rows that receive the message of that name."""
    return tuple(
        processor.slots[0].element
        for message in system.messages
        if message.name == name
        for one in system.receptions(message)
        for processor in system.processors
        if (processor.released_by, processor.node) == (message.bus, one.node)
    )


def calls_from_afar(system: System, instance: str, provided: Provided) -> tuple[Message, ...]:
    """The messages whose calls are requests of a provided interface."""
    return tuple(
        message
        for message in system.messages
        if message.call is not None
        and message.name == message.call.request
        and (message.call.server.instance, message.call.server.interface) == (instance, provided)
    )


def awaited(component: Component, need: Need) -> bool:
    """Whether anybody waits for the replies to a call, or for the time-out of one."""
    return need.on_timeout is not None or delivered(component, need)


def delivered(component: Component, need: Need) -> bool:
    """Whether anybody takes the replies to a call; those of elements count for a time-out too."""
    if need.is_part and need.on_timeout is not None:
        return True
    return need.on_reply is not None or need.reply_item in replies_read(component)


def replies_read(component: Component) -> tuple[str, ...]:
    """The items of last replies that some row looks at."""
    items = (need.reply_item for need in component.needs)
    return tuple(item for item in items if item is not None and component.users(item))
