# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The protected objects of a program: who calls them, and their ceilings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Set
from dataclasses import dataclass, replace

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.commands import Binding, Remote, RemoteRead
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.nodes import PROBE, SUPERVISOR
from ravenchart.gen.model.recording import OBJECT
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import Processor, SharedObject, System, Task, Work

from .calls import (
    callers,
    callers_of,
    calls_from_afar,
    element_bindings,
    gathers,
    readers_through,
    receivers,
    repliers,
    replies_read,
    rows_of,
)
from .crossing import MAIN_CORE, core_of, crossings, other_cores, reporter, senders_to
from .senders import sending_rows

MAIN = "main"
"""The environment task: priority 0, below all tasks, and not among them."""


@dataclass(frozen=True, slots=True)
class _Sharing:
    """Who calls what, worked out over a system whose priorities are known."""

    system: System
    priorities: dict[str, int]
    cores: dict[str, int]
    """Of each task, and of what runs below all of them."""
    crossing: frozenset[str]
    """The ports whose values come from another core, by ``instance.port``."""

    def made(self, element: str, users: Iterable[str]) -> SharedObject:
        """The object with these users, each once, and the ceiling that they need."""
        once = tuple(dict.fromkeys(users))
        node = self.system.nodes[0]
        ceiling = max((self.priorities[user] for user in once), default=0)
        core = next((self.cores[user] for user in once), MAIN_CORE)
        return SharedObject(element, node.name, once, ceiling, node.critical_section, core=core)

    def made_on_each(self, element: str, users: Iterable[str]) -> SharedObject:
        """An object as `made`, of which other nodes may have one of the same name."""
        return replace(self.made(element, users), on_each_node=True)

    def runs(self, instance: str, name: str) -> str:
        """The processor that runs a row."""
        return self.system.processor_of(f"{instance}.{name}").name

    def of_instance(self, instance: Instance) -> Iterable[SharedObject]:
        """The objects of one instance: mailboxes and boards, data, regions."""
        component = instance.component
        runnables = component.runnables()
        for port in component.inputs():
            handler = self.runs(instance.name, component.handler(port.name))
            element = f"{instance.name}.{port.name}"
            if element not in self.crossing:
                end = End(instance.name, port.name)
                yield self.made(f"{element}.mailbox", [*senders_to(self.system, end), handler])
            readers = [self.runs(instance.name, r.name) for r in runnables if port.name in r.reads]
            if readers:
                yield self.made(element, [handler, *readers])
        for data in component.data:
            users = [self.runs(instance.name, name) for name in component.users(data.name)]
            through = readers_through(self.system, instance.name, data.name)
            users += [self.system.processor_of(row).name for row in through]
            written = any(data.name in item.writes for item in runnables)
            if written and len(users) > 1:  # otherwise it is a constant, or its writer's own
                yield self.made(f"{instance.name}.{data.name}", users)
        yield from self.of_commands(instance)
        for region in component.regions:
            own = self.runs(instance.name, region.name)
            readers = [
                self.runs(instance.name, item.name)
                for item in runnables
                if region.name in item.reads or _works_in(item, region.name)
            ]
            yield self.made(f"{instance.name}.{region.name}", [own, *readers])
            if region.events():
                #  every event goes through one procedure: who raises any is taken to raise all
                raisers = [
                    user for one in component.regions for user in self.raisers(instance, one)
                ]
                looked = self.reporters(instance)
                users = [own, *raisers, *looked]
                yield self.made(f"{instance.name}.{region.name}.queue", users)
            for activity, _ in component.completing(region.name):
                users = [own, self.runs(instance.name, activity.name)]
                yield self.made(f"{instance.name}.{activity.name}.visit", users)
                yield self.made(f"{instance.name}.{activity.name}.done", users)

    def of_commands(self, instance: Instance) -> Iterable[SharedObject]:
        """The queues of requests of an instance, and the boards of replies to its own."""
        for provided in instance.component.provides:
            if provided.server is not None:
                server = self.runs(instance.name, provided.server)
                rows = [
                    row
                    for b in callers_of(self.system, instance.name, provided)
                    for row in rows_of(self.system, b)
                ]
                for message in calls_from_afar(self.system, instance.name, provided):
                    rows += receivers(self.system, message.name)
                users = [self.system.processor_of(row).name for row in rows]
                yield self.made(f"{instance.name}.{provided.name}.queue", [*users, server])
        for binding in self.system.bindings:
            remote = binding.provider
            if binding.instance == instance.name and isinstance(remote, Remote) and remote.reply:
                rows = [*rows_of(self.system, binding), *receivers(self.system, remote.reply)]
                users = [self.system.processor_of(row).name for row in rows]
                yield self.made(f"{instance.name}.{binding.need.name}.call", users)
            if binding.instance == instance.name and gathers(self.system, binding):
                rows = [*rows_of(self.system, binding), *repliers(self.system, binding)]
                users = [self.system.processor_of(row).name for row in rows]
                yield self.made(f"{instance.name}.{binding.need.name}.gathering", users)
            if binding.instance == instance.name and isinstance(remote, RemoteRead):
                rows = [*rows_of(self.system, binding), *receivers(self.system, remote.message)]
                users = [self.system.processor_of(row).name for row in rows]
                yield self.made(f"{instance.name}.{binding.need.name}.read", users)
        for item in replies_read(instance.component):
            binding = next(
                b
                for b in self.system.bindings
                if b.instance == instance.name and b.need.reply_item == item
            )
            users = [self.runs(instance.name, name) for name in instance.component.users(item)]
            writers = (self.system.processor_of(r).name for r in repliers(self.system, binding))
            yield self.made(f"{instance.name}.{item}", [*writers, *users])

    def devices(self) -> Iterable[SharedObject]:
        """The devices that several tasks call: inside one, a driver works its longest.

        The main program starts a device and makes it safe; so does a supervisor in its place.
        """
        supervisors = [f"{n.name}.{SUPERVISOR}" for n in self.system.nodes if n.supervision]
        for device in self.system.devices:
            if device.type is None:
                continue
            users = [self.runs(row.instance, row.name) for row in callers(self.system, device)]
            life = device.type.lifecycle
            if life.given:
                users += [MAIN, *(supervisors if life.make_safe is not None else ())]
            if len(set(users)) > 1:
                made = self.made_on_each(device.name, users)
                longest = max(*(one.wcet for one in device.provides), life.make_safe or Ns(0))
                yield replace(made, section=max(made.section, longest))

    def reporters(self, instance: Instance) -> Iterable[str]:
        """The task that looks at the queues of an instance on another core than the main program.

        That the main program looks at the others is not counted: it does so at its end.
        """
        core = core_of(self.system, instance.name)
        if core != MAIN_CORE:
            yield reporter(self.system.nodes[0], core)

    def raisers(self, instance: Instance, region: Region) -> Iterable[str]:
        """The tasks that may put an event into a region's queue."""
        return self.offering(instance, set(region.events()), region.name)

    def requesting(self, bus: Bus) -> Iterable[str]:
        """The tasks that may request recovery on a bus: all that raise any event of an instance."""
        for name in dict.fromkeys(name for name, _ in bus.recovers_on):
            instance = self.system.instance(name)
            yield from self.offering(instance, {e.name for e in instance.component.events})

    def offering(self, instance: Instance, named: set[str], own: str = "") -> Iterable[str]:
        """The tasks that raise one of these events, for the region ``own`` or for whomever."""
        component = instance.component
        for item in component.runnables():
            overflow = item.on_overflow if isinstance(item, Region) else None
            if named & set(item.raises):
                yield self.runs(instance.name, item.name)
            if overflow in named and isinstance(item, Region):
                # the event is raised by whoever fills that queue, or by the region itself
                yield self.runs(instance.name, item.name)
                if item.name != own:
                    yield from self.raisers_once(instance, item)
        for need in component.needs:
            binding = self.system.bound[instance.name, need.name]
            for one in element_bindings(self.system, binding) or (binding,):
                yield from self.raisers_of_call(one, named)
        for port in component.inputs():
            if named & {port.on_arrival, port.on_stale, port.on_overflow}:
                yield self.runs(instance.name, component.handler(port.name))
        yield from self.raisers_outside(instance, named)

    def raisers_outside(self, instance: Instance, named: Set[str]) -> Iterable[str]:
        """The tasks that raise one of these events themselves: processors, supervisors, main."""

        def raised(events: Iterable[tuple[str, str]]) -> bool:
            return any(one == instance.name and event in named for one, event in events)

        for processor in self.system.processors:
            watched = {slot.owner for slot in processor.slots if slot.work is Work.BUS_WATCH}
            of_buses = (p for bus in self.system.buses if bus.name in watched for p in bus.raises)
            heard = {s.owner for s in processor.slots if s.work is Work.BUS_RECEIVE}
            refused = (
                pair
                for bus in self.system.buses
                if bus.name in heard
                for pair in self.system.refusals(bus)
            )
            if raised((*processor.raises, *of_buses, *refused)):
                yield processor.name
            supervisor = self.supervisor(processor)
            if supervisor is not None and raised(processor.on_silence):
                yield supervisor
        if raised(self.system.shutdown.raises):
            yield MAIN

    def supervisor(self, processor: Processor) -> str | None:
        """The task that supervises a processor, if one does."""
        element = f"{processor.node}.{SUPERVISOR}"
        return element if element in self.priorities else None

    def raisers_of_call(self, binding: Binding, named: Set[str | None]) -> Iterable[str]:
        """The processors that raise an event of a required command.

        Whoever delivers the last reply of an array raises an event also where another is late.
        """
        need, provider = binding.need, binding.provider
        is_remote = isinstance(provider, Remote)
        if need.on_full in named or (is_remote and need.on_timeout in named):
            rows = rows_of(self.system, binding)
            yield from (self.system.processor_of(row).name for row in rows)
        if isinstance(provider, RemoteRead) and need.on_timeout in named:
            yield self.runs(binding.instance, provider.watcher)
        if need.on_reply in named or (need.is_part and need.on_timeout in named):
            rows = repliers(self.system, binding)
            yield from (self.system.processor_of(row).name for row in rows)

    def raisers_once(self, instance: Instance, region: Region) -> Iterable[str]:
        """As `raisers`, without following overflows further."""
        quiet = replace(
            instance,
            component=replace(
                instance.component,
                regions=tuple(replace(r, on_overflow=None) for r in instance.component.regions),
            ),
        )
        yield from self.raisers(quiet, region)


def too_long(system: System) -> Iterator[tuple[SharedObject, Task]]:
    """The objects of a completed system inside which a task might be longer than its whole job."""
    tasks = {task.element: task for task in system.tasks}
    for item in system.objects:
        for user in item.users:
            if user in tasks and tasks[user].wcet < item.section:
                yield item, tasks[user]


def _works_in(item: Region | Activity, region: str) -> bool:
    """Whether an activity works only in a state of that region."""
    return (
        isinstance(item, Activity) and item.while_in is not None and item.while_in.region == region
    )


def on_core(name: str, core: int) -> str:
    """The name of what each core has: ``name``, and on another core than the first ``name_2``."""
    return name if core == MAIN_CORE else f"{name}_{core}"


def objects_on_node(system: System) -> tuple[SharedObject, ...]:
    """The protected objects of one node. The users of `health` and `trace` are all processors."""
    tasks = system.tasks
    away = other_cores(system)
    lowest = {MAIN: MAIN_CORE} | {reporter(system.nodes[0], core): core for core in away}
    sharing = _Sharing(
        system,
        {task.element: task.priority for task in tasks} | dict.fromkeys(lowest, 0),
        {task.element: task.core for task in tasks} | lowest,
        frozenset(one.element for one in crossings(system)),
    )
    objects: list[SharedObject] = []
    for instance in system.instances:
        objects.extend(sharing.of_instance(instance))
    objects.extend(sharing.devices())
    for bus in system.buses:
        senders = [
            system.processor_of(row).name
            for message in system.messages
            if message.bus == bus.name
            for row in sending_rows(system, message)
        ]
        senders += [
            processor.name
            for processor in system.processors
            for slot in processor.slots
            if slot.owner == bus.name and slot.work is Work.BUS_WATCH
        ]
        senders += sharing.requesting(bus)
        receivers = [p.name for p in system.processors if p.released_by == bus.name]
        drivers = [t.element for t in tasks if t.driver_of == bus.name]
        objects.append(sharing.made_on_each(f"{bus.name}.transmit", [*senders, *drivers]))
        objects.append(sharing.made_on_each(f"{bus.name}.receive", [*drivers, *receivers]))
        for message in system.messages:
            if message.bus == bus.name and message.transport is not None:
                rows = sending_rows(system, message) or [system.handler(message.targets[0])]
                ends = [system.processor_of(row).name for row in rows]
                objects.append(sharing.made_on_each(f"{message.element}.flow", [*ends, *receivers]))
    for processor in system.processors:
        watched_by = sharing.supervisor(processor)
        users = [processor.name, *([] if watched_by is None else [watched_by])]
        if processor.core in away:
            users.append(reporter(system.node(processor.node), processor.core))
        objects.append(sharing.made(f"{processor.name}.monitor", users))
        if (line := processor.released_by_interrupt) is not None:
            objects.append(sharing.made(f"{line}.arrivals", [str(line), processor.name]))
    supervisors = {f"{node.name}.{SUPERVISOR}" for node in system.nodes}
    kept = ["health", *(["trace"] if any(node.trace_depth for node in system.nodes) else [])]
    kept += [OBJECT] if system.recorded_values else []
    for core in (MAIN_CORE, *away):
        here = [processor.name for processor in system.processors if processor.core == core]
        if core == MAIN_CORE:
            here += [*(t.element for t in tasks if t.element in supervisors), MAIN]
        else:
            here.append(reporter(system.nodes[0], core))
        for name in kept:
            objects.append(sharing.made_on_each(on_core(name, core), here))
    for node in system.nodes:
        for name, kind in ((SUPERVISOR, node.supervision), (PROBE, node.probe)):
            element = f"{node.name}.{name}"
            if kind is not None:
                objects.append(sharing.made(f"{element}.board", [element, MAIN]))
    return tuple(objects)
