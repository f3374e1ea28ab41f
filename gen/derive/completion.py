"""What follows from a valid model: tables, priorities, tasks and shared objects.

All times in ns, every figure on the safe side.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass, replace
from functools import lru_cache

from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.commands import Remote, RemoteRead
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import (
    PROBE,
    SUPERVISOR,
    Bus,
    Instance,
    Message,
    Node,
    Processor,
    SharedObject,
    Slot,
    System,
    Task,
    Work,
)

from .calls import (
    callers,
    callers_of,
    calls_from_afar,
    readers_through,
    receivers,
    repliers,
    replies_read,
    rows_of,
)
from .distribution import as_one, part_of, without_idle_buses
from .ways import routed

MAIN = "main"
"""The environment task: priority 0, below all tasks, and not among them."""

FRAME_DISTANCE_BITS = 47
"""Bit times between the beginnings of two frames, at least: a CAN 2.0A data frame with an
11-bit identifier and no data has 44 bits (without stuff bits, the shortest case), followed by
3 bits of interframe space."""


# --- Tables ------------------------------------------------------------------------


def table_period(slots: Iterable[Slot]) -> Ns | None:
    """The shortest period in a table; None for an empty one."""
    return min((slot.timing.period for slot in slots), default=None)


def table_deadline(slots: Iterable[Slot], period: Ns) -> Ns:
    """The shortest deadline in a table, at most the processor's period."""
    return min((slot.timing.deadline for slot in slots), default=period)


def _with_divisors(processor: Processor) -> Processor:
    """Each row's divisor: how many releases lie between two of its runs."""
    slots = tuple(
        replace(slot, divisor=slot.timing.period // processor.period, phase=0)
        for slot in processor.slots
    )
    deadline = min(processor.deadline, processor.period)
    return replace(processor, slots=slots, deadline=deadline)


# --- Priorities --------------------------------------------------------------------


def prioritised(processors: Sequence[Processor]) -> tuple[Processor, ...]:
    """The processors with priorities: given ones kept, the others deadline-monotonic.

    The shorter the deadline the larger the number; of two with one deadline
    the earlier in the model has the larger. Numbers count from 1 and step over
    given ones.
    """
    taken = {processor.priority for processor in processors if processor.priority}
    free = (number for number in range(1, len(processors) + len(taken) + 1) if number not in taken)
    order = sorted(
        (index for index, processor in enumerate(processors) if not processor.priority),
        key=lambda index: (-processors[index].deadline, -index),
    )
    chosen = dict(zip(order, free, strict=False))
    return tuple(
        replace(processor, priority=chosen.get(index, processor.priority))
        for index, processor in enumerate(processors)
    )


# --- Tasks -------------------------------------------------------------------------


def frame_distance(bus: Bus) -> Ns:
    """The least time between two frames on a bus, rounded down."""
    return Ns(FRAME_DISTANCE_BITS * 10**9 // bus.bit_rate)


def tasks_of(system: System) -> tuple[Task, ...]:
    """Processors in model order, then for each message the driver's work on it.

    A driver has two tasks, one that receives and one that transmits, both of
    the priority above all processors. Each serves a frame at a time, so what it
    does is described by one entry for each message, at the message's period: it
    follows the processor that sends the frame, or the frame's arrival.
    """
    tasks = [
        Task(
            element=processor.name,
            origin=processor.origin,
            node=processor.node,
            period=processor.period,
            offset=processor.offset,
            deadline=processor.deadline,
            budget=processor.wcet,
            priority=processor.priority,
            slots=processor.slots,
            sporadic=processor.released_by is not None,
            timed=True,
            core=processor.core,
        )
        for processor in system.processors
    ]
    top = max((processor.priority for processor in system.processors), default=0)
    for message in system.messages:
        bus = system.bus(message.bus)
        ways: list[tuple[str, str, str | None]] = []
        home = system.sender(message)
        if home is not None:
            ways.append((message.sending, home, sender_of(system, message)))
        ways += [(one.driver, one.node, message.element) for one in system.receptions(message)]
        tasks += [
            Task(
                element=driver,
                origin=message.origin,
                node=node,
                period=message.period,
                offset=Ns(0),
                deadline=message.limit,
                budget=bus.driver_wcet,
                priority=top + 1,
                released_by=releaser,
                core=driver_core(system, bus, node),
            )
            for driver, node, releaser in ways
        ]
    above = top + (2 if system.messages else 1)
    for host in system.nodes:
        if host.supervision is not None:
            tasks.append(
                Task(
                    element=f"{host.name}.{SUPERVISOR}",
                    origin=host.origin,
                    node=host.name,
                    period=host.supervision.period,
                    offset=Ns(0),
                    deadline=host.supervision.period,
                    budget=host.supervision.wcet,
                    priority=above,
                    timed=True,
                )
            )
        if host.probe is not None:
            tasks.append(
                Task(
                    element=f"{host.name}.{PROBE}",
                    origin=host.origin,
                    node=host.name,
                    period=host.probe.period,
                    offset=Ns(0),
                    deadline=host.probe.deadline,
                    budget=host.probe.wcet,
                    priority=above + (host.supervision is not None),
                    timed=True,
                )
            )
    return tuple(tasks)


def driver_core(system: System, bus: Bus, node: str) -> int:
    """The core of a bus's driver on a node: that of its reception, or else of what sends first."""
    for processor in system.processors:
        if processor.released_by == bus.name and processor.node == node:
            return processor.core
    for message in system.messages:
        if message.bus == bus.name and system.sender(message) == node:
            for row in sending_rows(system, message):
                return system.processor_of(row).core
    return 1


def sender_of(system: System, message: Message) -> str | None:
    """The processor whose row sends a message; None for one from outside."""
    for row in sending_rows(system, message):
        return system.processor_of(row).name
    return None


def sending_rows(system: System, message: Message) -> tuple[str, ...]:
    """The rows that send a message: one, by the rules."""
    if message.source is None:
        return ()
    source = system.instance(message.source.instance)
    if message.call is not None and message.is_reply:
        return (message.call.served,)
    if message.controls:
        return (f"{source.name}.ports",)
    return tuple(
        f"{source.name}.{item.name}"
        for item in source.component.runnables()
        if message.source.port in (item.writes if message.every else item.sends)
    )


# --- Shared objects ----------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class _Sharing:
    """Who calls what, worked out over a system whose priorities are known."""

    system: System
    priorities: dict[str, int]

    def made(self, element: str, users: Iterable[str]) -> SharedObject:
        """The object with these users, each once, and the ceiling that they need."""
        once = tuple(dict.fromkeys(users))
        node = self.system.nodes[0]
        ceiling = max((self.priorities[user] for user in once), default=0)
        return SharedObject(element, node.name, once, ceiling, node.critical_section)

    def runs(self, instance: str, name: str) -> str:
        """The processor that runs a row."""
        return self.system.processor_of(f"{instance}.{name}").name

    def of_instance(self, instance: Instance) -> Iterable[SharedObject]:
        """The objects of one instance: mailboxes and boards, data, regions."""
        component = instance.component
        runnables = component.runnables()
        for port in component.inputs():
            handler = self.runs(instance.name, "ports")
            element = f"{instance.name}.{port.name}"
            yield self.made(
                f"{element}.mailbox", [*self.writers(instance.name, port.name), handler]
            )
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
                yield self.made(f"{instance.name}.{region.name}.queue", [own, *raisers])
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
            users = [self.system.processor_of(row).name for row in callers(self.system, device)]
            life = device.type.lifecycle
            if life.given:
                users += [MAIN, *(supervisors if life.make_safe is not None else ())]
            if len(set(users)) > 1:
                made = self.made(device.name, users)
                longest = max(*(one.wcet for one in device.provides), life.make_safe or Ns(0))
                yield replace(made, section=max(made.section, longest))

    def writers(self, instance: str, port: str) -> Iterable[str]:
        """The processors that put values into an input port's mailbox."""
        for connection in self.system.connections:
            if (connection.target.instance, connection.target.port) == (instance, port):
                source = self.system.instance(connection.source.instance)
                for sender in source.component.runnables():
                    if connection.source.port in sender.sends:
                        yield self.runs(source.name, sender.name)
        for message in self.system.messages:
            if any((end.instance, end.port) == (instance, port) for end in message.targets):
                yield from (p.name for p in self.system.processors if p.released_by == message.bus)

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
            is_remote = isinstance(binding.provider, Remote)
            if need.on_full in named or (is_remote and need.on_timeout in named):
                rows = rows_of(self.system, binding)
                yield from (self.system.processor_of(row).name for row in rows)
            if isinstance(binding.provider, RemoteRead) and need.on_timeout in named:
                yield self.runs(instance.name, binding.provider.watcher)
            if need.on_reply in named:
                rows = repliers(self.system, binding)
                yield from (self.system.processor_of(row).name for row in rows)
        for port in component.inputs():
            if named & {port.on_arrival, port.on_stale, port.on_overflow}:
                yield self.runs(instance.name, "ports")
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


def _works_in(item: Region | Activity, region: str) -> bool:
    """Whether an activity works only in a state of that region."""
    return (
        isinstance(item, Activity) and item.while_in is not None and item.while_in.region == region
    )


def programs(system: System) -> tuple[System, ...]:
    """What runs on each node, as a system of its own; the system itself where there is one node.

    Nodes without a processor have no program, and a bus that the node only knows has no code.
    """
    return (without_idle_buses(system),) if len(system.nodes) == 1 else _programs(system)


@lru_cache(maxsize=1)
def _programs(system: System) -> tuple[System, ...]:
    busy = {processor.node for processor in system.processors}
    return tuple(_program(system, node) for node in system.nodes if node.name in busy)


def _program(system: System, node: Node) -> System:
    """The part of a system on a node, with its tasks and objects."""
    part = part_of(system, node)
    part = replace(part, tasks=tuple(task for task in system.tasks if task.node == node.name))
    return replace(part, objects=_objects(part))


def on_one_node(system: System) -> System:
    """The same components on one node, with the objects that they share there."""
    one = as_one(system)
    return one if one is system else replace(one, objects=_objects(one))


def objects_of(system: System) -> tuple[SharedObject, ...]:
    """Every protected object of the generated programs, with its users and ceiling.

    ``system`` has its tasks. Where there are several nodes, what each of them has by
    the same name has that of its node in front.
    """
    parts = programs(system)
    if len(parts) == 1:
        return _objects(parts[0])
    own = {instance.name for instance in system.instances} | {node.name for node in system.nodes}
    own |= {processor.name for processor in system.processors}
    return tuple(
        item
        if item.element.partition(".")[0] in own
        else replace(item, element=f"{item.node}.{item.element}")
        for part in parts
        for item in _objects(part)
    )


def _objects(system: System) -> tuple[SharedObject, ...]:
    """The protected objects of one node. The users of `health` and `trace` are all processors."""
    tasks = system.tasks
    sharing = _Sharing(system, {task.element: task.priority for task in tasks} | {MAIN: 0})
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
        drivers = [t.element for t in tasks if t.element.startswith(f"{bus.name}.driver_")]
        objects.append(sharing.made(f"{bus.name}.transmit", [*senders, *drivers]))
        objects.append(sharing.made(f"{bus.name}.receive", [*drivers, *receivers]))
        for message in system.messages:
            if message.bus == bus.name and message.transport is not None:
                rows = sending_rows(system, message) or [f"{message.targets[0].instance}.ports"]
                ends = [system.processor_of(row).name for row in rows]
                objects.append(sharing.made(f"{message.element}.flow", [*ends, *receivers]))
    for processor in system.processors:
        watched_by = sharing.supervisor(processor)
        users = [processor.name, *([] if watched_by is None else [watched_by])]
        objects.append(sharing.made(f"{processor.name}.monitor", users))
    kept = ["health", *(["trace"] if any(node.trace_depth for node in system.nodes) else [])]
    for core in sorted({1, *(processor.core for processor in system.processors)}):
        here = [processor.name for processor in system.processors if processor.core == core]
        if core == 1:
            here += [t.element for t in tasks if t.element.endswith(f".{SUPERVISOR}")]
        for name in kept:
            #  The main program runs on the first core, and looks at the others' at the end.
            own, users = (name, [*here, MAIN]) if core == 1 else (f"{name}_{core}", here)
            objects.append(sharing.made(own, users))
    for node in system.nodes:
        for name, kind in ((SUPERVISOR, node.supervision), (PROBE, node.probe)):
            element = f"{node.name}.{name}"
            if kind is not None:
                objects.append(sharing.made(f"{element}.board", [element, MAIN]))
    return tuple(objects)


def completed(system: System) -> System:
    """A valid system with divisors, priorities, tasks, shared objects and the ways of chains."""
    processors = prioritised([_with_divisors(processor) for processor in system.processors])
    told = replace(system, processors=processors)
    told = replace(told, tasks=tasks_of(told))
    return routed(replace(told, objects=objects_of(told)))
