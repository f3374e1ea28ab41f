"""Commands, interfaces and devices, as the system holds them; vocabulary of the cisst papers.

A *device* has no task: its commands are procedures of a driver, called directly. A *task*
is a component instance: its commands are queued, and executed by one of its activities.
What provides a required command is decided at generation; see docs/devices.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ravenchart.gen.language.terms import Ns, Type, Value, named
from ravenchart.gen.origins import Origin


class CommandKind(Enum):
    """What a command takes and gives."""

    VOID = "void"
    WRITE = "write"
    READ = "read"
    QUALIFIED_READ = "qualified_read"
    EVENT = "event"
    """Comes from whoever provides it: `argument` is what it tells."""

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
class StandIn:
    """What stands in for a command: ``activity`` keeps the data item ``item`` up for it."""

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
    stand_in: StandIn | None = None
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
        return None if self.is_read or self.reply is None else f"{self.name}_Reply"


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


@dataclass(frozen=True, slots=True)
class DeviceType:
    """A type of device: one driver."""

    name: str
    origin: Origin
    axes: int
    simulated: bool
    provides: tuple[DriverCommand, ...]


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

    def leaves(self) -> tuple[Device, ...]:
        """The pieces of equipment in it."""
        if self.type is not None:
            return (self,)
        return tuple(leaf for member in self.members for leaf in member.leaves())

    def command(self, name: str) -> DriverCommand:
        """The command of that name; KeyError where it has none."""
        return named(self.provides, name)


@dataclass(frozen=True, slots=True)
class Server:
    """A provided interface of an instance."""

    instance: str
    interface: Provided


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

    @property
    def served(self) -> str:
        """The row that executes the command."""
        return f"{self.server.instance}.{self.server.interface.server}"


@dataclass(frozen=True, slots=True)
class RemoteRead:
    """A read command of an instance on another node: the message that brings what it publishes.

    When none has come for so many ``executions`` of the row ``watcher``, the ``time_limit``
    of the value is over.
    """

    need: Need
    server: Server
    message: str
    initial: Value
    """What is read before the first message."""
    time_limit: Ns
    executions: int
    watcher: str
    """The row of the reader that notices."""


@dataclass(frozen=True, slots=True)
class Binding:
    """What provides a required command of an instance; None: what stands in for it."""

    instance: str
    origin: Origin
    need: Need
    provider: Device | Server | Remote | RemoteRead | None
    time_limit: Ns | None = None
    """Of a reply from another node, and of the age of what is read there."""
