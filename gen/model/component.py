# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Component types: ports, events, data, regions and activities, resolved and typed.

Parts of a `System`; see `model`.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ravenchart.gen.language.terms import (
    Expression,
    Flow,
    Ns,
    RecordType,
    Scalar,
    ScalarType,
    Type,
    Value,
    always,
    named,
)
from ravenchart.gen.origins import Origin

from .commands import InterfaceEvent, Need, Provided
from .statechart import DONE, Overflow, Region, Timing


class Direction(Enum):
    """Which way a port carries values, seen from its component."""

    IN = "in"
    OUT = "out"


class PortKind(Enum):
    """How an input port keeps what arrives between two runs of its handler."""

    SAMPLED = "sampled"
    QUEUED = "queued"


@dataclass(frozen=True, slots=True)
class Port:
    """A typed port. All but name, direction and type matter to inputs only."""

    name: str
    origin: Origin
    direction: Direction
    type: Type
    kind: PortKind = PortKind.SAMPLED
    depth: int = 1
    overflow: Overflow = Overflow.REJECT_NEWEST
    max_age: Ns | None = None
    """Older than this is Stale; None: never stale."""
    on_arrival: str | None = None
    on_stale: str | None = None
    on_overflow: str | None = None
    """Events of the component, raised by the port's handler."""
    is_command: bool = False
    """An output port that is a required command: what is sent is the argument of a call."""
    is_void: bool = False
    """A command without argument: nothing but that it is called is sent."""


@dataclass(frozen=True, slots=True)
class Event:
    """An event of a component; ``type`` is that of the value it carries, if any."""

    name: str
    origin: Origin
    type: Type | None = None
    overflow: Overflow | None = None
    """The rule of a full queue for this event; None: that of the region."""
    external: bool = False
    """It may come from outside at any time, though the component raises it."""


@dataclass(frozen=True, slots=True)
class Invariant:
    """``never``: a condition over states and data that shall hold in no reachable situation."""

    name: str
    origin: Origin
    condition: Expression


@dataclass(frozen=True, slots=True)
class Data:
    """A data item of a component: one writer, any number of readers."""

    name: str
    origin: Origin
    type: Type
    initial: Value
    is_command: bool = False
    """A read command or the last reply to a call: somebody else writes it."""

    def initial_of(self, field: str | None) -> Scalar:
        """The initial value, or that of a field of a record."""
        if field is None:
            assert not isinstance(self.initial, tuple)
            return self.initial
        assert isinstance(self.initial, tuple)
        return dict(self.initial)[field]


@dataclass(frozen=True, slots=True)
class Parameter:
    """A constant that each instance of the component may set."""

    name: str
    origin: Origin
    type: ScalarType
    default: Scalar | None


@dataclass(frozen=True, slots=True)
class StateRef:
    """A state of a region of the same component."""

    region: str
    state: str


@dataclass(frozen=True, slots=True)
class Clause:
    """One condition of an activity's contract: of what it requires, or of what it ensures."""

    origin: Origin
    condition: Expression


@dataclass(frozen=True, slots=True)
class Activity:
    """A named, bounded piece of work: the user's SPARK procedure, or a flow.

    ``reads`` names data, parameters, input ports and regions (their published state),
    ``writes`` data, ``sends`` output ports and ``raises`` events, all in model order. A flow
    sends by its actions; a user body sends at every execution, except on the ports that it
    ``may_send``. With ``while_in`` it is the do activity of that state, and may raise `DONE`,
    which completes the state.
    """

    name: str
    origin: Origin
    timing: Timing
    reads: tuple[str, ...]
    writes: tuple[str, ...]
    sends: tuple[str, ...]
    raises: tuple[str, ...]
    while_in: StateRef | None
    flow: Flow | None
    """None: the body is the user's, or it forwards requests."""
    requires: tuple[Clause, ...] = ()
    ensures: tuple[Clause, ...] = ()
    may_send: tuple[str, ...] = ()
    """Those of ``sends`` of which a user's body decides in each execution."""
    forwards: bool = False
    """Each request of the interface that it serves is a call of the command of the same name."""

    @property
    def by_user(self) -> bool:
        """Whether its body is written by hand."""
        return self.flow is None and not self.forwards

    @property
    def completes(self) -> StateRef | None:
        """The state that it completes by `DONE`."""
        return self.while_in if DONE in self.raises else None


PORTS = "ports"
"""The row of the port region."""


@dataclass(frozen=True, slots=True)
class PortGroup:
    """Input ports that a row of their own handles, in place of the port region."""

    name: str
    origin: Origin
    timing: Timing
    ports: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Component:
    """A component type. ``port_region`` is None exactly when it has no input port."""

    name: str
    origin: Origin
    parameters: tuple[Parameter, ...]
    ports: tuple[Port, ...]
    events: tuple[Event, ...]
    data: tuple[Data, ...]
    port_region: Timing | None
    regions: tuple[Region, ...]
    activities: tuple[Activity, ...]
    invariants: tuple[Invariant, ...] = ()
    needs: tuple[Need, ...] = ()
    provides: tuple[Provided, ...] = ()
    hears: tuple[InterfaceEvent, ...] = ()
    """The events of its required interfaces."""
    groups: tuple[PortGroup, ...] = ()
    """Those of the port region, which handles every input port that none of them names."""

    def inputs(self) -> tuple[Port, ...]:
        """The input ports, in model order."""
        return tuple(p for p in self.ports if p.direction is Direction.IN)

    def outputs(self) -> tuple[Port, ...]:
        """The output ports, in model order."""
        return tuple(p for p in self.ports if p.direction is Direction.OUT)

    def handlers(self) -> dict[str, Timing]:
        """The rows that handle input ports: the port region, then its groups in model order."""
        if self.port_region is None:
            return {}
        return {PORTS: self.port_region} | {group.name: group.timing for group in self.groups}

    def handler(self, port: str) -> str:
        """The row that handles an input port."""
        return next((group.name for group in self.groups if port in group.ports), PORTS)

    def handled(self, row: str) -> tuple[Port, ...]:
        """The input ports that a row handles, in model order."""
        return tuple(port for port in self.inputs() if self.handler(port.name) == row)

    def port(self, name: str) -> Port:
        """The port called ``name``; KeyError where there is none."""
        return named(self.ports, name)

    def region(self, name: str) -> Region:
        """The region called ``name``; KeyError where there is none."""
        return named(self.regions, name)

    def runnables(self) -> tuple[Region | Activity, ...]:
        """The regions, then the activities, each in model order."""
        return (*self.regions, *self.activities)

    def renews(self, row: Region | Activity, name: str) -> bool:
        """Whether every execution of a row gives a data item or output port a new value.

        A region does in some only, and a do activity while its state is active; a user's
        body is taken to do so, except on the ports that it may send on.
        """
        if isinstance(row, Region) or row.while_in is not None:
            return False
        if row.flow is None:
            called = any(port.name == name and port.is_command for port in self.ports)
            decided = called or name in row.may_send
            return not decided and self.served_by(row.name) is None
        sure = always(row.flow)
        if name in sure:
            return True
        item = next((data.type for data in self.data if data.name == name), None)
        return isinstance(item, RecordType) and all(
            f"{name}.{field.name}" in sure for field in item.fields
        )

    def senders(self, port: str) -> tuple[Region | Activity, ...]:
        """The regions and activities that send on a port."""
        return tuple(item for item in self.runnables() if port in item.sends)

    def send_period(self, port: str) -> Ns | None:
        """The shortest time between two sendings on a port; None where nothing sends on it."""
        return min((one.timing.period for one in self.senders(port)), default=None)

    def completing(self, region: str) -> tuple[tuple[Activity, str], ...]:
        """The do activities that complete a state of a region, each with that state."""
        all_of_them = ((a, a.completes) for a in self.activities)
        return tuple((a, at.state) for a, at in all_of_them if at and at.region == region)

    def served_by(self, activity: str) -> Provided | None:
        """The provided interface whose requests an activity executes."""
        return next((one for one in self.provides if one.server == activity), None)

    def from_outside(self) -> frozenset[str]:
        """The data that may come to be anything in their types: by a user's body, or a command."""
        written = {name for a in self.activities if a.by_user for name in a.writes}
        return frozenset(written | {data.name for data in self.data if data.is_command})

    def users(self, data: str) -> tuple[str, ...]:
        """The regions and activities that read or write ``data``, in model order."""
        return tuple(r.name for r in self.runnables() if data in r.reads or data in r.writes)
