# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Buses, the messages on them, and the receptions of a node."""

from __future__ import annotations

from dataclasses import dataclass

from ravenchart.gen.language.terms import Ns, Type
from ravenchart.gen.origins import Origin

from .authentication import Authentication
from .commands import Remote
from .instances import End
from .protection import Protection
from .signals import Signal
from .statechart import Timing
from .transmission import Transmission
from .transport import Transport


@dataclass(frozen=True, slots=True)
class BusErrors:
    """At most ``burst`` errors at once, and one more every ``period``."""

    period: Ns
    burst: int


@dataclass(frozen=True, slots=True)
class Bus:
    """A CAN bus and the WCETs of its driver on a node: one frame in, one frame out."""

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
    """Of a read command between nodes: n, where the row that writes the source sends in every n-th
    execution. 0: of a port or a call."""

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
    """Its name in databases, an identifier of C; None: that in the model."""

    @property
    def in_database(self) -> str:
        """Its name in the database of the bus."""
        return self.database_name or self.name

    @property
    def element(self) -> str:
        """Stable id of the frame: ``bus.message``."""
        return f"{self.bus}.{self.name}"

    @property
    def shown_identifier(self) -> str:
        """The identifier as people read it: ``0x1A0``, ``0x000001A0`` of an extended one."""
        return f"0x{self.identifier:0{8 if self.extended else 3}X}"

    @property
    def check(self) -> Protection | Authentication | None:
        """The check that decides whether a received frame is used."""
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
