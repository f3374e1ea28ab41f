# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The parts of a model besides the messages of a database: figures that no database knows.

They are chosen so that the model passes `check` and a program can be made of it at once. The
text says which of them to set.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ravenchart.analysis.core.frames import classic_bits, fd_bits, rank
from ravenchart.gen.language.quantities import parsed_duration, shown

BIT_RATES = (500_000, 1_000_000)
"""Of a bus whose database does not say it, or says one that its frames do not leave room on."""
LOAD = 0.6
"""The largest load by frames of a bit rate that is chosen for them."""
PORTS_PERIOD = "20 ms"
SENDING_PERIOD = "100 ms"
"""Of a message that the node sends, and that no cycle time is known of."""
DATA_RATE = "5 Mbit/s"
"""Of CAN FD frames after their identifier."""
US, MS = 1000, 1_000_000
TURNS = (1000 * US, 500 * US, 200 * US, 100 * US)
"""Periods of the reception: the first one that leaves it half of its time."""
HALF = 0.5
OVERHEADS = (10 * US, US, 100, 10)
"""Platform figures in ns: the first one with which all drivers at once leave a turn some time."""
DEPTHS = (8, 1024)
"""Frames that a queue of the bus has room for, at least and at most."""


@dataclass(frozen=True, slots=True)
class Frames:
    """The frames of one message on the bus."""

    identifier: int
    extended: bool
    bytes: int
    flexible: bool
    """They are CAN FD."""
    period: str | None

    @property
    def rank(self) -> int:
        """Of two frames the one with the lower rank goes first."""
        return rank(self.identifier, extended=self.extended)

    @property
    def bits(self) -> int:
        """Those of the longest one, at the bit rate of the bus."""
        if self.flexible:
            return fd_bits(self.bytes, extended=self.extended, switched=False).nominal
        return classic_bits(self.bytes, extended=self.extended).nominal

    @property
    def bits_each_second(self) -> float:
        """The bit rate that its frames take."""
        return self.bits / (_nanoseconds(self.period) / 1e9)


@dataclass(frozen=True, slots=True)
class SentMessage:
    """A port that the node sends from."""

    port: str
    period: str | None


def _nanoseconds(period: str | None) -> int:
    found = parsed_duration(period or SENDING_PERIOD)
    assert isinstance(found, int)
    return found


def bit_rate(frames: Sequence[Frames], known: int | None) -> int:
    """That of the database, where frames with these periods fit; else the first that is enough."""
    needed = sum(one.bits_each_second for one in frames)
    if known is not None and needed < known:
        return known
    return next((rate for rate in BIT_RATES if needed <= LOAD * rate), BIT_RATES[-1])


def deadline(own: Frames, frames: Sequence[Frames], rate: int) -> list[str]:
    """The key of a message whose period leaves no room for one frame of each that goes before.

    A database has no deadlines, and that of a message is its period unless it is given.
    """
    before = sum(one.bits for one in frames if one.rank <= own.rank)
    behind = max((one.bits for one in frames if one.rank > own.rank), default=0)
    room = 2 * 1_000_000_000 * (before + behind) // rate
    if own.period is None or _nanoseconds(own.period) > room:
        return []
    return [f"    deadline: {shown(-(-room // MS) * MS)}"]


def _depth(count: int) -> int:
    return min(max(count, DEPTHS[0]), DEPTHS[1])


def _rows(sent: Sequence[SentMessage], *, receives: bool) -> dict[str, list[str]]:
    """The ports that are sent from with each period, the shortest one first.

    A component without a port has a row as well, for it must have something to run.
    """
    if not sent and not receives:
        return {SENDING_PERIOD: []}
    found: dict[str, list[str]] = {}
    for one in sorted(sent, key=lambda one: _nanoseconds(one.period)):
        found.setdefault(one.period or SENDING_PERIOD, []).append(one.port)
    return found


def _named(period: str) -> str:
    return f"every_{period.replace('.', '_').replace(' ', '_')}"


def behaviour(sent: Sequence[SentMessage], *, receives: bool) -> list[str]:
    """The keys of the component for the rows that use its ports."""
    lines = [f"    port_region: {{period: {PORTS_PERIOD}, wcet: 200 us}}"] if receives else []
    rows = _rows(sent, receives=receives)
    if rows:
        lines.append("    activities:")
    for period, ports in rows.items():
        sends = f", sends: [{', '.join(ports)}]" if ports else ""
        wcet = shown(min(200 * US, _nanoseconds(period) // 20))
        lines.append(
            f"      {_named(period)}: {{period: {period}, wcet: {wcet}, body: user{sends}}}"
        )
    return lines


def sections(
    instance: str,
    component: str,
    sent: Sequence[SentMessage],
    *,
    received: Sequence[Frames],
    rate: int,
    flexible: bool,
    database_name: str | None,
) -> list[str]:
    """The sections that make it a model.

    ``received``: the frames that have a port. ``flexible``: some frames are CAN FD.
    ``database_name``: what the database calls the node, where that is something else.
    """
    arrivals = sum(1 / _nanoseconds(one.period) for one in received)
    turn = next((t for t in TURNS if arrivals * t <= HALF), TURNS[-1])
    most = turn // (4 * (len(received) + len(sent) + 1))  # each driver's work, and two switches
    time = shown(next((one for one in OVERHEADS if one <= most), OVERHEADS[-1]))
    named = "" if database_name is None else f", database_name: {database_name}"
    lines = [
        "nodes:",
        f"  {instance}: {{context_switch: {time}, critical_section: {time}, trace: 1024{named}}}",
        "buses:",
        "  bus:",
        f"    bit_rate: {rate // 1000} kbit/s",
        *([f"    data_rate: {DATA_RATE}"] if flexible else []),
        f"    driver_wcet: {time}",
        f"    receive_depth: {_depth(2 * len(received))}",
        f"    transmit_depth: {_depth(len(sent))}",
        "instances:",
        f"  {instance}: {{component: {component}, node: {instance}}}",
        "processors:",
    ]
    if received:
        lines += [
            f"  reception: {{released_by: bus, period: {shown(turn)}, stack: 32 KiB, "
            "activities: [bus.receive]}",
            f"  handling: {{stack: 32 KiB, activities: [{instance}.ports]}}",
        ]
    for period in _rows(sent, receives=bool(received)):
        name = _named(period)
        lines.append(f"  {name}: {{stack: 32 KiB, activities: [{instance}.{name}]}}")
    return lines
