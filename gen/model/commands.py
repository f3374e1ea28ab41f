# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Commands, interfaces and devices, as the system holds them; vocabulary of the cisst papers.

A *device* has no task: its commands are procedures of a driver, called directly. A *task*
is a component instance: its commands are queued, and executed by one of its activities.
The provider of a required command is decided at generation; see docs/devices.md.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from ravenchart.gen.language.terms import Ns, Scalar, ScalarType, Type, Value, named
from ravenchart.gen.origins import Origin

from .protocols import Protocol


class CommandKind(Enum):
    """The kind of a command: whether it has an argument and a reply."""

    VOID = "void"
    WRITE = "write"
    READ = "read"
    QUALIFIED_READ = "qualified_read"
    EVENT = "event"
    """Comes from the provider: `argument` is its value."""

    @property
    def takes(self) -> bool:
        """Whether it has an argument."""
        return self in (CommandKind.WRITE, CommandKind.QUALIFIED_READ, CommandKind.EVENT)

    @property
    def gives(self) -> bool:
        """Whether it must have a reply; `VOID` and `WRITE` may."""
        return self in (CommandKind.READ, CommandKind.QUALIFIED_READ)


@dataclass(frozen=True, slots=True)
class Command:
    """An entry of the command dictionary; of one ``per_axis``, the types of one axis."""

    name: str
    origin: Origin
    kind: CommandKind
    argument: Type | None
    reply: Type | None
    per_axis: bool = False


@dataclass(frozen=True, slots=True)
class Fallback:
    """The fallback of a command: ``activity`` keeps the data item ``item`` up to date for it."""

    activity: str
    item: str


@dataclass(frozen=True, slots=True)
class Need:
    """A required command, with the types that it has at the interface's number of axes."""

    name: str
    origin: Origin
    interface: str
    axes: int
    command: Command
    argument: Type | None
    reply: Type | None
    optional: bool = False
    fallback: Fallback | None = None
    on_reply: str | None = None
    on_full: str | None = None
    on_timeout: str | None = None

    @property
    def is_read(self) -> bool:
        """Read as data are; all others are called."""
        return self.command.kind is CommandKind.READ

    @property
    def reply_item(self) -> str | None:
        """The data item that holds the last reply to a call."""
        return None if self.is_read or self.reply is None else f"{self.command.name}_Reply"

    @property
    def is_part(self) -> bool:
        """Whether it is for one element of an array; rows and providers use the command's name."""
        return self.name != self.command.name


@dataclass(frozen=True, slots=True)
class Request:
    """A queued command of a provided interface, with its types there."""

    command: Command
    argument: Type | None
    reply: Type | None

    @property
    def name(self) -> str:
        """The command's."""
        return self.command.name


@dataclass(frozen=True, slots=True)
class Published:
    """A read command of a provided interface: its reply is that data item."""

    command: Command
    item: str

    @property
    def name(self) -> str:
        """The command's."""
        return self.command.name


@dataclass(frozen=True, slots=True)
class InterfaceEvent:
    """An event of an interface: it leaves its provider, or comes to who requires it, by a port."""

    name: str
    origin: Origin
    interface: str
    port: str


@dataclass(frozen=True, slots=True)
class Provided:
    """A provided interface of a component."""

    name: str
    origin: Origin
    axes: int
    depth: int
    """Requests that wait at most; 0: there are none to wait."""
    server: str | None
    """The activity that executes them."""
    requests: tuple[Request, ...]
    published: tuple[Published, ...]
    events: tuple[InterfaceEvent, ...] = ()
    protocol: Protocol | None = None


@dataclass(frozen=True, slots=True)
class DriverCommand:
    """A command of a device type, with its types there and its worst-case execution time."""

    command: Command
    argument: Type | None
    reply: Type | None
    wcet: Ns

    @property
    def name(self) -> str:
        """The command's."""
        return self.command.name

    @property
    def is_event(self) -> bool:
        """Whether the device raises it, and nobody calls it."""
        return self.command.kind is CommandKind.EVENT


@dataclass(frozen=True, slots=True)
class DeviceParameter:
    """A constant of each device of a type."""

    name: str
    origin: Origin
    type: ScalarType
    default: Scalar | None


class Access(Enum):
    """The access of a driver to a register."""

    READ = "read"
    WRITE = "write"
    READ_WRITE = "read_write"

    @property
    def reads(self) -> bool:
        """Whether it may be read."""
        return self is not Access.WRITE

    @property
    def writes(self) -> bool:
        """Whether it may be written."""
        return self is not Access.READ


@dataclass(frozen=True, slots=True)
class Register:
    """A register of a device: ``width`` bits, ``offset`` bytes behind the device's address."""

    name: str
    origin: Origin
    offset: int
    width: int
    access: Access

    @property
    def end(self) -> int:
        """The first byte behind it."""
        return self.offset + self.width // 8


@dataclass(frozen=True, slots=True)
class Lifecycle:
    """Worst-case execution times of a driver's operations at start and end; None: it has none."""

    initialise: Ns | None = None
    self_test: Ns | None = None
    make_safe: Ns | None = None

    @property
    def start(self) -> Ns:
        """The time that a device takes before the first release."""
        return Ns((self.initialise or 0) + (self.self_test or 0))

    @property
    def given(self) -> bool:
        """Whether there is any."""
        return any(one is not None for one in (self.initialise, self.self_test, self.make_safe))


@dataclass(frozen=True, slots=True)
class DeviceType:
    """A type of device: one driver."""

    name: str
    origin: Origin
    axes: int
    simulated: bool
    provides: tuple[DriverCommand, ...]
    parameters: tuple[DeviceParameter, ...] = ()
    registers: tuple[Register, ...] = ()
    """Those that the driver uses: a simulated one uses none."""
    lifecycle: Lifecycle = Lifecycle()
    protocol: Protocol | None = None

    @property
    def span(self) -> int:
        """The bytes from the address of a device to the end of its last register."""
        return max((one.end for one in self.registers), default=0)

    @property
    def tells_apart(self) -> bool:
        """Whether its driver gets the device that it works for; a simulated one does not."""
        return not self.simulated and bool(self.parameters or self.registers)


@dataclass(frozen=True, slots=True)
class Device:
    """One piece of equipment of a type, or an array of devices as one."""

    name: str
    origin: Origin
    type: DeviceType | None
    """None: an array."""
    members: tuple[Device, ...]
    provides: tuple[DriverCommand, ...]
    axes: int
    address: int | None = None
    """Of its registers, in bytes; None: they are simulated and nothing else."""
    values: tuple[tuple[DeviceParameter, Scalar], ...] = ()

    def leaves(self) -> tuple[Device, ...]:
        """The pieces of equipment in it."""
        if self.type is not None:
            return (self,)
        return tuple(leaf for member in self.members for leaf in member.leaves())

    def command(self, name: str) -> DriverCommand:
        """The command of that name; KeyError where it has none."""
        return named(self.provides, name)


@dataclass(frozen=True, slots=True)
class Poll:
    """An event of a device, which the port handler of an instance asks for in each execution."""

    origin: Origin
    device: Device
    event: str
    instance: str
    port: str
    """The input port that it comes to."""

    @property
    def wcet(self) -> Ns:
        """The time that it adds to the execution of the port handler."""
        return self.device.command(self.event).wcet


@dataclass(frozen=True, slots=True)
class Server:
    """A provided interface of an instance; ``outside`` is that of the composite around it."""

    instance: str
    interface: Provided
    outside: str | None = field(default=None, compare=False)


@dataclass(frozen=True, slots=True)
class Remote:
    """A queued command of an instance on another node: the messages that carry its calls.

    At most one call waits for its reply. ``executions`` of its caller after the call that
    is given up; both are numbered, so that no frame is taken for another.
    """

    caller: str
    """The instance that calls."""
    need: Need
    server: Server
    request: str
    """The message of the calls."""
    reply: str | None
    """The message of the replies; None: nobody waits for any."""
    time_limit: Ns
    """From the release of the caller until the reply has arrived; 0 without replies."""
    executions: int


@dataclass(frozen=True, slots=True)
class RemoteRead:
    """A read command of an instance on another node: the message that brings the published value.

    When none has come for so many ``executions`` of the row ``watcher``, the ``time_limit``
    of the value is over.
    """

    need: Need
    server: Server
    message: str
    initial: Value
    """The value before the first message."""
    time_limit: Ns
    executions: int
    watcher: str
    """The row of the reader that notices."""


@dataclass(frozen=True, slots=True)
class Gathered:
    """An array whose elements are called one by one: each has a binding of its own."""

    name: str
    parts: tuple[str, ...]
    """The needs of the elements, in the order of the array."""


@dataclass(frozen=True, slots=True)
class Binding:
    """The provider of a required command of an instance; None: the fallback."""

    instance: str
    origin: Origin
    need: Need
    provider: Device | Server | Remote | RemoteRead | Gathered | None
    time_limit: Ns | None = None
    """Of a reply from another node, and of the age of what is read there."""
    bus: str | None = None
    """The bus between nodes that the model names for it, of several."""


def wcet_of(binding: Binding) -> Ns:
    """The time that a call adds to its caller's WCET; only a driver's work is counted apart."""
    provider, name = binding.provider, binding.need.command.name
    return provider.command(name).wcet if isinstance(provider, Device) else Ns(0)
