# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Any interface of python-can, opened: the one module that loads drivers of others."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import can
from can.interfaces import BACKENDS

from .peer import BenchError, Codec, OnFrame, Peer, link_of, unrecorded
from .several import joined_bus

BACKENDS.setdefault("ravenchart", ("ravenchart.hw_can.bench.bus_client", "RavenchartBus"))
"""So that the interface also exists in a checkout that is on the path and not installed."""


@dataclass(frozen=True, slots=True)
class BusEnd:
    """One end of a bus, by its names in python-can."""

    name: str
    channel: str
    bitrate: int | None = None
    """In bit/s; None: that of the interface."""
    data_bitrate: int | None = None
    """The same for the data of CAN FD frames."""
    fd: bool = False
    """Whether it also carries CAN FD frames."""

    def __str__(self) -> str:
        return f"{self.name} {self.channel!r}"

    def options(self) -> dict[str, Any]:
        """The options of `can.Bus` besides interface and channel."""
        told: dict[str, Any] = {"bitrate": self.bitrate, "data_bitrate": self.data_bitrate}
        told = {name: rate for name, rate in told.items() if rate is not None}
        if self.fd:
            told["fd"] = True
        if self.name == "slcan" and "://" in self.channel:
            told["sleep_after_open"] = 0  # no adapter that starts when its line is opened
        return told


def check_name(interface: str) -> None:
    """BenchError where python-can has no such interface."""
    if interface not in BACKENDS:
        known = ", ".join(sorted(BACKENDS))
        raise BenchError(f"python-can has no interface {interface!r}; it has {known}")


def opened_bus(interface: BusEnd, *, echo: bool = False) -> can.BusABC:
    """One bus object, which receives its own frames with ``echo``; BenchError when there is none.

    Drivers may raise any exception.
    """
    check_name(interface.name)
    options = interface.options() | ({"receive_own_messages": True} if echo else {})
    try:
        return can.Bus(interface.channel, interface.name, ignore_config=True, **options)
    except PermissionError as fault:
        raise BenchError(f"no permission for {interface}: {fault}") from None
    except Exception as fault:
        raise BenchError(f"{interface} cannot be opened: {fault_text(fault)}") from None


def fault_text(fault: BaseException) -> str:
    """The text of a driver's exception, on one printable line."""
    said = " ".join(str(fault).split()) or type(fault).__name__
    if not isinstance(fault, can.CanError | OSError | BenchError):
        said = f"{type(fault).__name__}: {said}"
    return "".join(c if c.isprintable() else "?" for c in said)


def joined_peer(
    interfaces: Mapping[str, BusEnd], codec: Codec, record: OnFrame = unrecorded
) -> Peer:
    """A peer at an end of each bus, by the name of the bus; BenchError when there is none."""
    with ExitStack() as stack:
        ends: dict[str, can.BusABC] = {}
        for bus, interface in interfaces.items():
            ends[bus] = opened_bus(interface)
            stack.callback(ends[bus].shutdown)
        made = joined_bus(ends)
        only = next(iter(interfaces.values())) if len(interfaces) == 1 else None
        by_tcp = only is not None and only.name == "slcan" and "socket://" in only.channel
        link = link_of(made) if by_tcp else None
        peer = Peer(made, codec, link, record, gone=shown_ends(interfaces))
        stack.pop_all()
        return peer


def shown_ends(interfaces: Mapping[str, BusEnd]) -> str:
    """Ends of buses in words."""
    return " and ".join(map(str, interfaces.values()))
