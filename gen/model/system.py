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

from ravenchart.gen.language.terms import IntegerType, Ns, Scalar, Type, named
from ravenchart.gen.origins import Origin

from .authentication import Authentication
from .commands import Binding, Device, Poll, Remote
from .component import Component
from .protection import Protection
from .safety import SafeRegion
from .signals import Signal
from .statechart import Timing
from .transmission import Transmission
from .transport import Transport

NO_TIME = Ns(0)

PROBE = "probe"
"""A node's host probe, as a task."""

SUPERVISOR = "supervisor"
"""The liveness supervision of a node, as a task."""

UNREADY = "RV-0804"
"""The model is checked and analysed, but not generated yet."""

# --- Deployment --------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Tick:
    """A timer that interrupts a node every ``period`` for up to ``wcet``."""

    period: Ns
    wcet: Ns


@dataclass(frozen=True, slots=True)
class Supervision:
    """The liveness supervision of a node: a task that looks at all processors every ``period``.

    A processor is silent when a release has not completed by its deadline and ``margin``.
    """

    period: Ns
    wcet: Ns
    margin: Ns


@dataclass(frozen=True, slots=True)
class Node:
    """One processor core or several alike, with platform figures, all worst cases in ns."""

    name: str
    origin: Origin
    context_switch: Ns
    critical_section: Ns
    """Longest time inside any protected operation of the runtime on this node."""
    trace_depth: int
    """Records that the trace holds between two looks at it; 0: no trace."""
    probe: Timing | None = None
    """The host probe: a task above all others that measures how late it wakes."""
    release: Ns = NO_TIME
    """Work above all tasks that makes one job ready."""
    tick: Tick | None = None
    """What makes timed releases late by up to its period; None: a timer that is exact."""
    cores: int = 1
    supervision: Supervision | None = None
    database_name: str | None = None
    """What databases call it; None: as the model does."""

    @property
    def in_database(self) -> str:
        """Its name in the databases of its buses."""
        return self.database_name or self.name

    @property
    def core_names(self) -> tuple[str, ...]:
        """The cores by name: that of the node where there is one, ``node.1`` and on otherwise."""
        if self.cores == 1:
            return (self.name,)
        return tuple(f"{self.name}.{number}" for number in range(1, self.cores + 1))

    def core_name(self, number: int) -> str:
        """The name of the core with that number, from 1."""
        return self.core_names[number - 1]


@dataclass(frozen=True, slots=True)
class BusErrors:
    """At most ``burst`` errors at once, and one more every ``period``."""

    period: Ns
    burst: int


@dataclass(frozen=True, slots=True)
class Bus:
    """A CAN bus and what its driver costs on a node: one frame in, one frame out."""

    name: str
    origin: Origin
    bit_rate: int
    """Nominal, in bit/s."""
    receive_depth: int
    transmit_depth: int
    driver_wcet: Ns
    errors: BusErrors | None = None
    data_rate: int | None = None
    """In bit/s, of the data of CAN FD frames; None: that of the rest."""
    takes_fd: bool = False
    """There are CAN FD frames on it, or a rate for them."""
    by_priority: bool = False
    """A controller offers the most urgent of its frames, not the oldest."""
    audsley: bool = False
    """Identifiers that the model does not give are found by the analysis; else by deadline."""
    watch: Timing | None = None
    """When each node looks at its controller."""
    on_error_passive: tuple[tuple[str, str], ...] = ()
    """(instance, event) raised on the node of the instance; so the two below."""
    on_bus_off: tuple[tuple[str, str], ...] = ()
    on_recovered: tuple[tuple[str, str], ...] = ()
    recovers_after: Ns | None = None
    """Bus-off lasts so long before recovery is requested."""
    recovers_on: tuple[tuple[str, str], ...] = ()
    """(instance, event) that requests recovery; with neither, the driver does so at once."""

    @property
    def raises(self) -> tuple[tuple[str, str], ...]:
        """(instance, event) that faults of a controller raise."""
        return (*self.on_error_passive, *self.on_bus_off, *self.on_recovered)

    @property
    def recovers_by_request(self) -> bool:
        """The driver leaves bus-off when it is asked to, not by itself."""
        return self.recovers_after is not None or bool(self.recovers_on)

    @property
    def recovery_looks(self) -> int:
        """Looks from the one that finds bus-off to the one that requests recovery; 0: none does."""
        if self.recovers_after is None or self.watch is None:
            return 0
        return -(-self.recovers_after // self.watch.period)


@dataclass(frozen=True, slots=True)
class End:
    """One end of a connection: a port of an instance."""

    instance: str
    port: str

    def __str__(self) -> str:
        """``instance.port``."""
        return f"{self.instance}.{self.port}"


@dataclass(frozen=True, slots=True)
class Instance:
    """One component instance on a node, its parameters all set."""

    name: str
    origin: Origin
    component: Component
    node: str
    parameters: tuple[tuple[str, Scalar], ...]


@dataclass(frozen=True, slots=True)
class Connection:
    """An output port wired to an input port.

    In a resolved system both are on one node: between nodes there are messages, see
    `distribution`.
    """

    origin: Origin
    source: End
    target: End


@dataclass(frozen=True, slots=True)
class Message:
    """A CAN message: a port's value on a bus.

    ``source`` None: sent by a party outside the system; ``targets`` empty:
    received outside. ``period`` is the time between two instances, the least one of what is
    ``sporadic``. A frame that others send to others has neither, and no signals.
    """

    name: str
    origin: Origin
    bus: str
    identifier: int
    extended: bool
    type: Type
    signals: tuple[Signal, ...]
    length: int
    """Data length in bytes, 0 .. 8; of a CAN FD frame one of its sizes, up to 64."""
    source: End | None
    targets: tuple[End, ...]
    period: Ns
    deadline: Ns | None = None
    """From the event that leads to it; None: the period."""
    fd: bool = False
    """A CAN FD frame, which switches to the bus's data rate where there is one."""
    given: bool = True
    """The model gives the identifier."""
    call: Remote | None = None
    """Of a command between nodes: it carries the calls or the replies. None: a port's value."""
    sporadic: bool = False
    """From outside, and nothing says how long after a frame the next one comes."""
    every: int = 0
    """Of a read command between nodes: sent in each so-many-eth execution of the row that writes
    the data item which is its source. 0: of a port or a call."""

    protection: Protection | None = None
    """From end to end; None: none."""
    authentication: Authentication | None = None
    """By a MAC; None: none."""
    transmission: Transmission | None = None
    """Its transmission mode; None: periodic. ``period`` is then the least time between two."""
    transport: Transport | None = None
    """Its value travels in several frames, of which it describes each; None: in one."""
    controls: str = ""
    """The message with transport whose flow control it is; "" for all others."""
    database_name: str | None = None
    """What databases call it, an identifier of C; None: as the model does."""

    @property
    def in_database(self) -> str:
        """Its name in the database of the bus."""
        return self.database_name or self.name

    @property
    def element(self) -> str:
        """Stable id of the frame: ``bus.message``."""
        return f"{self.bus}.{self.name}"

    @property
    def check(self) -> Protection | Authentication | None:
        """What decides whether a frame that is received is used."""
        return self.protection or self.authentication

    @property
    def longest(self) -> Ns | None:
        """The time from one frame to the next in its transmission mode; None: without bound."""
        return self.period if self.transmission is None else self.transmission.longest

    @property
    def is_reply(self) -> bool:
        """It carries the replies to a command between nodes."""
        return self.call is not None and self.name == self.call.reply

    @property
    def is_foreign(self) -> bool:
        """Others send it to others: it takes its time on the bus, and nothing else."""
        return self.source is None and not self.targets

    @property
    def limit(self) -> Ns:
        """The deadline that holds."""
        return self.period if self.deadline is None else self.deadline

    @property
    def sending(self) -> str:
        """The driver's work on sending it, as a task."""
        return f"{self.bus}.driver_tx.{self.name}"


@dataclass(frozen=True, slots=True)
class Reception:
    """A message as one node receives it; ``several`` do."""

    message: Message
    node: str
    several: bool

    @property
    def element(self) -> str:
        """Stable id: the message's, with the node behind it where several receive it."""
        return f"{self.message.element}.{self.node}" if self.several else self.message.element

    @property
    def driver(self) -> str:
        """The driver's work on it, as a task."""
        name = f"{self.message.name}.{self.node}" if self.several else self.message.name
        return f"{self.message.bus}.driver_rx.{name}"


class Work(Enum):
    """What an entry of a processor's table runs."""

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
    """``ports``, ``receive``, ``watch``, or the name of the region or activity."""
    timing: Timing
    divisor: int
    phase: int

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
    """A command processor: one task. Sporadic when ``released_by`` names a bus.

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
    released_by: str | None
    slots: tuple[Slot, ...]
    on_deadline_miss: tuple[tuple[str, str], ...]
    """(instance, event) raised when a release completes after its deadline."""
    on_overrun: tuple[tuple[str, str], ...] = ()
    """(instance, event) raised when a row used more than its budget; empty: nobody looks."""
    core: int = 1
    """The core of the node that it runs on."""
    on_silence: tuple[tuple[str, str], ...] = ()
    """(instance, event) that the supervisor of its node raises when the processor is silent."""

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
        """Sum of the table's budgets: no release needs more."""
        return Ns(sum(slot.timing.wcet for slot in self.slots))


@dataclass(frozen=True, slots=True)
class Task:
    """One schedulable task as the analysis sees it: a processor, or a driver's work.

    ``budget`` is the longest execution of a job, overheads apart: of one that runs
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
    budget: Ns
    priority: int
    jitter: Ns = NO_TIME
    slots: tuple[Slot, ...] = ()
    released_by: str | None = None
    sporadic: bool = False
    timed: bool = False
    core: int = 1

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


@dataclass(frozen=True, slots=True)
class Chain:
    """A way that values take, and how long it may take them; None: no limit.

    ``path`` names messages and rows (``owner.name``), in order; between two of
    them the shortest way is meant. `ways` fills in ``way``, all its places, or the
    ``gap`` between two of the path that no values cross.
    """

    name: str
    origin: Origin
    path: tuple[str, ...]
    reaction: Ns | None
    """From an input until the first output that knows it."""
    age: Ns | None
    """From the sampling of an input until the output made of it."""
    way: tuple[str, ...] = ()
    gap: tuple[str, str] | None = None
    gap_event: tuple[str, str, str] | None = None
    """An event that leads over the gap: itself, what raises it, and the region it is for."""


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
        """What provides each required command, by instance and command."""
        return {(b.instance, b.need.name): b for b in self.bindings}

    def sender(self, message: Message) -> str | None:
        """The node that sends a message; None for one from outside."""
        return None if message.source is None else self.home(message.source)

    def receptions(self, message: Message) -> tuple[Reception, ...]:
        """A message on each node that receives it, in the order of its targets."""
        homes = tuple(dict.fromkeys(self.home(end) for end in message.targets))
        return tuple(Reception(message, home, len(homes) > 1) for home in homes)

    def received(self, bus: str | None, node: str) -> tuple[Reception, ...]:
        """What a node receives from a bus, in model order."""
        found = (one for m in self.messages if m.bus == bus for one in self.receptions(m))
        return tuple(one for one in found if one.node == node)

    def reception(self, message: Message, place: str) -> Reception | None:
        """That of the node of a target port, ``instance.port``; of any other place, the first."""
        found = self.receptions(message)
        homes = (self.home(end) for end in message.targets if str(end) == place)
        at = next(homes, found[0].node if found else None)
        return next((one for one in found if one.node == at), None)

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

    def object(self, element: str) -> SharedObject:
        """The protected object with that id; KeyError where there is none."""
        return self._objects[element]

    def has_object(self, element: str) -> bool:
        """Is there a protected object with that id?"""
        return element in self._objects

    @cached_property
    def _objects(self) -> dict[str, SharedObject]:
        return {item.element: item for item in self.objects}

    def slots_of(self, owner: str) -> tuple[Slot, ...]:
        """The rows of an instance or bus, in order of processor and table."""
        return self._slots.get(owner, ())

    @cached_property
    def _slots(self) -> dict[str, tuple[Slot, ...]]:
        found: defaultdict[str, list[Slot]] = defaultdict(list)
        for processor in self.processors:
            for slot in processor.slots:
                found[slot.owner].append(slot)
        return {owner: tuple(slots) for owner, slots in found.items()}
