# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The one intermediate representation: a `System`, frozen, typed and located.

The loader builds it, `rules` checks it, `derive` completes it (priorities,
ceilings, shared objects), and every back end reads it: the Ada emitters, the
analysis, the diagrams. All times are integers in nanoseconds. Names are Ada
identifiers, unique without regard to case within their scope.
"""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass
from enum import Enum
from functools import cached_property

from ravenchart.gen.language.terms import NO_TIME, IntegerType, Ns, Type, named
from ravenchart.gen.origins import Origin

from .buses import Bus, Message, Reception
from .commands import Binding, Device, Poll
from .component import Component
from .instances import Connection, End, Events, Instance, Queue, Requests
from .nodes import InterruptLine, Node
from .recording import RecordedItem, RecordedValue
from .safety import SafeRegion
from .statechart import Timing


class Work(Enum):
    """The kind of work of an entry of a processor's table."""

    PORT_REGION = "ports"
    REGION = "region"
    ACTIVITY = "activity"
    BUS_RECEIVE = "receive"
    BUS_WATCH = "watch"


@dataclass(frozen=True, slots=True)
class Slot:
    """One row of a processor's table: runs when release mod ``divisor`` = ``phase``."""

    origin: Origin
    owner: str
    """Instance; for BUS_RECEIVE and BUS_WATCH the bus."""
    work: Work
    name: str
    """``receive``, ``watch``, or the name of the port region, group, region or activity."""
    timing: Timing
    divisor: int
    phase: int
    after: Ns = NO_TIME
    """The time of its first execution, after the first release of the processor."""
    placed_at: Origin | None = None
    """Where the model gives that time; None where it does not."""

    @property
    def element(self) -> str:
        """Stable id of the row: ``owner.name``."""
        return f"{self.owner}.{self.name}"

    @property
    def of_bus(self) -> bool:
        """The owner is a bus."""
        return self.work in (Work.BUS_RECEIVE, Work.BUS_WATCH)


@dataclass(frozen=True, slots=True)
class Processor:
    """A command processor: one task. Sporadic when ``released_by`` names what releases it.

    That is a bus whose frames it receives, a queue of a port, interface or region, or an interrupt.
    ``period`` is the minimum separation of a sporadic one. ``priority`` counts
    upwards from 1, larger is more urgent, unique in the node unless given.
    """

    name: str
    origin: Origin
    node: str
    period: Ns
    offset: Ns
    deadline: Ns
    priority: int
    stack_bytes: int
    released_by: str | Queue | InterruptLine | None
    slots: tuple[Slot, ...]
    on_deadline_miss: tuple[tuple[str, str], ...]
    """(instance, event) raised when a release completes after its deadline."""
    on_overrun: tuple[tuple[str, str], ...] = ()
    """(instance, event) raised when a row ran for longer than its WCET; empty: nobody looks."""
    core: int = 1
    """The core of the node that it runs on."""
    on_silence: tuple[tuple[str, str], ...] = ()
    """(instance, event) that the supervisor of its node raises when the processor is silent."""
    released_at: Origin | None = None
    """Where ``released_by`` is given."""
    logical: Ns | None = None
    """The logical execution time: how long after its release what it sends becomes visible."""
    cyclic: bool = False
    """Whether it is a cyclic executive: phases that the model leaves open are chosen."""

    @property
    def released_by_port(self) -> End | None:
        """The queued port whose values release it; None where time or a bus does."""
        return self.released_by if isinstance(self.released_by, End) else None

    @property
    def released_by_value(self) -> Queue | InterruptLine | None:
        """The queue whose values, calls or events release it, or the interrupt that does."""
        return None if isinstance(self.released_by, str) else self.released_by

    @property
    def released_by_interrupt(self) -> InterruptLine | None:
        """The interrupt that releases it; None where time, a bus or a queue does."""
        return self.released_by if isinstance(self.released_by, InterruptLine) else None

    @property
    def raises(self) -> tuple[tuple[str, str], ...]:
        """(instance, event) that the processor itself may raise."""
        return (*self.on_deadline_miss, *self.on_overrun)

    @property
    def raised_for_it(self) -> tuple[tuple[str, str], ...]:
        """(instance, event) that it or its supervisor may raise."""
        return (*self.raises, *self.on_silence)

    @property
    def cycle(self) -> int:
        """Releases after which the table repeats."""
        return math.lcm(*(slot.divisor for slot in self.slots))

    @property
    def wcet(self) -> Ns:
        """The WCETs of the rows of a release that has the most to do: of all, without phases."""
        if not any(slot.phase for slot in self.slots):
            return Ns(sum(slot.timing.wcet for slot in self.slots))
        return Ns(max(sum(row.timing.wcet for row in self.rows_of(k)) for k in range(self.cycle)))

    def rows_of(self, release: int) -> tuple[Slot, ...]:
        """The rows that a release executes, by its number from 0."""
        return tuple(slot for slot in self.slots if release % slot.divisor == slot.phase)


@dataclass(frozen=True, slots=True)
class Task:
    """One schedulable task as the analysis sees it: a processor, or a driver's work.

    ``wcet`` is the longest execution of a job, overheads apart: of one that runs
    all of ``slots`` where there are some. ``released_by`` names the task or message
    whose completion releases it; ``jitter`` and ``deadline`` count from the event
    that begins that chain. ``timed``: the node's timer releases it. A job suspends
    itself ``suspensions`` times: one of a sporadic processor waits for a frame, and
    then until its least separation is over.
    """

    element: str
    origin: Origin
    node: str
    period: Ns
    offset: Ns
    deadline: Ns
    wcet: Ns
    priority: int
    jitter: Ns = NO_TIME
    slots: tuple[Slot, ...] = ()
    released_by: str | None = None
    sporadic: bool = False
    timed: bool = False
    core: int = 1
    driver_of: str | None = None
    """The bus whose driver this is the work of."""

    @property
    def suspensions(self) -> int:
        """See above: each costs two context switches, and the work of making it ready."""
        return 2 if self.sporadic else 1


@dataclass(frozen=True, slots=True)
class SharedObject:
    """A protected object: its ceiling is the highest priority among its users."""

    element: str
    node: str
    users: tuple[str, ...]
    """Elements of the tasks that call it."""
    ceiling: int
    section: Ns
    """Longest time inside it."""
    on_each_node: bool = False
    """Whether other nodes may have an object of the same name."""
    core: int = 1
    """The core of its users."""


@dataclass(frozen=True, slots=True)
class Carried:
    """A place on a way: the message that carries the value from node to node."""

    message: str

    def __str__(self) -> str:
        """The message by its name."""
        return self.message


Stop = Carried | End
"""A place on a way: a message, or a row, port or data item of an instance."""


@dataclass(frozen=True, slots=True)
class Gap:
    """Two places of a chain, as its path names them, between which no values go."""

    before: str
    after: str
    event: tuple[str, str, str] | None
    """An event that leads over the gap: itself, what raises it, and the region it is for."""
    turned: bool
    """Values go the other way."""
    reached: tuple[str, ...]
    """Where values from the first place end."""
    sources: tuple[str, ...]
    """Where values of the second place begin."""


@dataclass(frozen=True, slots=True)
class Chain:
    """A way that values take, and how long it may take them; None: no limit.

    ``path`` has messages and rows, in order; between two of them the shortest way is
    meant. `ways` fills in ``way``, all its places, or the ``gap`` between two of the
    path that no values cross.
    """

    name: str
    origin: Origin
    path: tuple[Stop, ...]
    reaction: Ns | None
    """From an input until the first output that knows it."""
    age: Ns | None
    """From the sampling of an input until the output made of it."""
    way: tuple[Stop, ...] = ()
    gap: Gap | None = None
    of_call: bool = False
    """It counts from the release of its first row, which makes a call, whatever that waits for."""
    logical: bool = False
    """Its values become visible at the ends of the periods of their senders."""


@dataclass(frozen=True, slots=True)
class Shutdown:
    """On a request to stop: raise these (instance, event), wait, end."""

    raises: tuple[tuple[str, str], ...]
    grace: Ns


@dataclass(frozen=True)
class System:
    """A whole system, resolved. ``tasks``, ``objects`` and ways are filled in by `derive`."""

    name: str
    origin: Origin
    digest: str
    """SHA-256 of the model files, in the order read."""
    types: tuple[Type, ...]
    components: tuple[Component, ...]
    nodes: tuple[Node, ...]
    buses: tuple[Bus, ...]
    instances: tuple[Instance, ...]
    connections: tuple[Connection, ...]
    messages: tuple[Message, ...]
    processors: tuple[Processor, ...]
    shutdown: Shutdown
    chains: tuple[Chain, ...] = ()
    traffic: tuple[Message, ...] = ()
    """Frames of the buses that are none of the system's ``messages``."""
    devices: tuple[Device, ...] = ()
    """Those that some command or event is bound to, pieces of an array before it."""
    bindings: tuple[Binding, ...] = ()
    polls: tuple[Poll, ...] = ()
    tasks: tuple[Task, ...] = ()
    objects: tuple[SharedObject, ...] = ()
    safe_regions: tuple[SafeRegion, ...] = ()
    """The invariants that are contracts of the code, filled in when behaviour was checked."""
    recorded: tuple[RecordedItem, ...] = ()
    """The items that `record` names."""
    deployment: str | None = None
    """The deployment that was chosen, in lower case, where the model has several."""
    version: str | None = None
    """Of a library: types and components for other systems. None: this is a system."""
    files: tuple[str, ...] = ()
    """The files of a library, main file first."""
    libraries: tuple[System, ...] = ()
    """Those that it uses, directly or by another, each behind those that it uses itself."""

    @property
    def is_library(self) -> bool:
        """Whether it is a library: it has no instances, and no program of its own."""
        return self.version is not None

    def library_of(self, element: Type | Component) -> System | None:
        """The library that declares a type or component; None: this system itself."""
        return self._in_libraries.get(element.name.lower())

    @cached_property
    def _in_libraries(self) -> dict[str, System]:
        found: dict[str, System] = {}
        for one in self.libraries:
            for item in (*one.types, *one.components):
                found.setdefault(item.name.lower(), one)
        return found

    def home_of(self, element: Type | Component) -> System:
        """The library that declares a type or component, or this system itself."""
        return self.library_of(element) or self

    @property
    def own_components(self) -> tuple[Component, ...]:
        """The components that no library declares."""
        return tuple(c for c in self.components if self.library_of(c) is None)

    @property
    def frames(self) -> tuple[Message, ...]:
        """All that is sent on the buses: the system's messages, then those of others."""
        return (*self.messages, *self.traffic)

    def instance(self, name: str) -> Instance:
        """The instance called ``name``; KeyError where there is none."""
        return self._instances[name.lower()]

    @cached_property
    def _instances(self) -> dict[str, Instance]:
        return {i.name.lower(): i for i in self.instances}

    @cached_property
    def units(self) -> tuple[str, ...]:
        """The units that its types count in, in the order of the types."""
        counted = (t.unit for t in self.types if isinstance(t, IntegerType) and t.unit is not None)
        return tuple(dict.fromkeys(counted))

    def values_of(self, instance: str, item: str) -> tuple[RecordedValue, ...]:
        """The recorded values of a port or data item of an instance."""
        return self._recorded.get((instance, item), ())

    @cached_property
    def _recorded(self) -> dict[tuple[str, str], tuple[RecordedValue, ...]]:
        found: defaultdict[tuple[str, str], list[RecordedValue]] = defaultdict(list)
        for one in self.recorded:
            found[one.instance, one.item.name] += one.values
        return {key: tuple(values) for key, values in found.items()}

    @cached_property
    def recorded_values(self) -> tuple[RecordedValue, ...]:
        """All of them, in the order of `record`."""
        return tuple(value for one in self.recorded for value in one.values)

    @property
    def most_cores(self) -> int:
        """The number of cores of the node that has the most of them."""
        return max((node.cores for node in self.nodes), default=1)

    def instances_of(self, component: str) -> frozenset[str]:
        """The names of the instances of a component."""
        return self._by_component.get(component, frozenset())

    @cached_property
    def _by_component(self) -> dict[str, frozenset[str]]:
        found: dict[str, list[str]] = {}
        for instance in self.instances:
            found.setdefault(instance.component.name, []).append(instance.name)
        return {component: frozenset(names) for component, names in found.items()}

    @cached_property
    def bound(self) -> dict[tuple[str, str], Binding]:
        """The binding of each required command, by instance and command."""
        return {(b.instance, b.need.name): b for b in self.bindings}

    def sender(self, message: Message) -> str | None:
        """The node that sends a message; None for one from outside."""
        return None if message.source is None else self.home(message.source)

    def receptions(self, message: Message) -> tuple[Reception, ...]:
        """A message on each node that receives it, in the order of its targets."""
        homes = tuple(dict.fromkeys(self.home(end) for end in message.targets))
        return tuple(Reception(message, home, len(homes) > 1) for home in homes)

    def received(self, bus: str | Queue | InterruptLine | None, node: str) -> tuple[Reception, ...]:
        """The receptions of a node from a bus, in model order."""
        found = (one for m in self.messages if m.bus == bus for one in self.receptions(m))
        return tuple(one for one in found if one.node == node)

    def reception(self, message: Message, place: Stop | None) -> Reception | None:
        """That of the node of a target port; of any other place, the first."""
        found = self.receptions(message)
        homes = (self.home(end) for end in message.targets if end == place)
        at = next(homes, found[0].node if found else None)
        return next((one for one in found if one.node == at), None)

    def joining(self, bus: str) -> list[str]:
        """The nodes that send or receive on a bus, in model order."""
        return [node.name for node in self.nodes if self.joins(bus, node.name)]

    def joins(self, bus: str, node: str) -> bool:
        """Whether a node sends or receives on a bus."""
        return any(
            message.bus == bus
            and (
                self.sender(message) == node
                or any(self.home(end) == node for end in message.targets)
            )
            for message in self.messages
        )

    def refusals(self, bus: Bus) -> tuple[tuple[str, str], ...]:
        """(instance, event) raised where a checked message of a bus is not used."""
        kept = (m.check for m in self.messages if m.bus == bus.name and m.check)
        return tuple(pair for check in kept for pair in check.on_error)

    @property
    def raised_outside(self) -> tuple[tuple[str, str], ...]:
        """(instance, event) raised by processors, supervisors, buses and a request to stop."""
        of_processors = (p for processor in self.processors for p in processor.raised_for_it)
        of_buses = (pair for bus in self.buses for pair in (*bus.raises, *self.refusals(bus)))
        return (*of_processors, *of_buses, *self.shutdown.raises)

    def home(self, end: End) -> str:
        """The node of an end's instance."""
        return self.nodes[0].name if len(self.nodes) == 1 else self.instance(end.instance).node

    def handler(self, port: End) -> str:
        """The element of the row that handles an input port."""
        return self.instance(port.instance).handler(port.name)

    def queue(self, message: Message) -> str:
        """The first-in first-out queue of the controller that sends a message; "" for none."""
        if message.source is None or self.bus(message.bus).by_priority:
            return ""
        return f"{self.sender(message)}.{message.bus}"

    def node(self, name: str) -> Node:
        """The node called ``name``; KeyError where there is none."""
        return named(self.nodes, name)

    def bus(self, name: str) -> Bus:
        """The bus called ``name``; KeyError where there is none."""
        return named(self.buses, name)

    def processor_of(self, element: str) -> Processor:
        """The processor whose table holds the row ``owner.name``; KeyError where none does."""
        return self._processors[element]

    @cached_property
    def _processors(self) -> dict[str, Processor]:
        return {slot.element: p for p in reversed(self.processors) for slot in reversed(p.slots)}

    def woken_by(self, port: End) -> Processor | None:
        """The processor that an input port releases; None where none is."""
        return self._woken.get(port)

    @cached_property
    def _woken(self) -> dict[End, Processor]:
        return {p.released_by_port: p for p in self.processors if p.released_by_port}

    def called(self, served: Requests | Events) -> Processor | None:
        """The processor that calls of an interface, or events of a region, release; else None."""
        return next((one for one in self.processors if one.released_by == served), None)

    def object(self, element: str) -> SharedObject:
        """The protected object with that id; KeyError where there is none."""
        return self._objects[element]

    def has_object(self, element: str) -> bool:
        """Is there a protected object with that id?"""
        return element in self._objects

    @cached_property
    def _objects(self) -> dict[str, SharedObject]:
        return {item.element: item for item in self.objects}

    @cached_property
    def slots(self) -> tuple[Slot, ...]:
        """The rows of all tables, in order of processor and table."""
        return tuple(slot for processor in self.processors for slot in processor.slots)

    def slots_of(self, owner: str) -> tuple[Slot, ...]:
        """The rows of an instance or bus, in order of processor and table."""
        return self._owned.get(owner, ())

    @cached_property
    def _owned(self) -> dict[str, tuple[Slot, ...]]:
        found: defaultdict[str, list[Slot]] = defaultdict(list)
        for slot in self.slots:
            found[slot.owner].append(slot)
        return {owner: tuple(slots) for owner, slots in found.items()}
