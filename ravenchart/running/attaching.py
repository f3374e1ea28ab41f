# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Ends of buses on which controllers run already: any interface of python-can."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ravenchart.failures import Unusable
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.interfaces import BusEnd, check_name, joined_peer
from ravenchart.hw_can.bench.peer import BenchError, OnFrame, Peer

from .vocabulary import BusVocabulary


def require_bus(system: System) -> None:
    """Unusable where a controller has no bus on which it is spoken to."""
    if not system.buses:
        raise Unusable(f"{system.name} has no bus")


def interfaces_of(system: System, name: str, channels: Sequence[str]) -> dict[str, BusEnd]:
    """The interface at each channel, by bus, with the bit rates that the model gives the bus.

    Of a model with several buses a channel is ``BUS=CHANNEL``. Unusable without a bus, and where
    python-can has no such interface.
    """
    require_bus(system)
    try:
        check_name(name)
    except BenchError as fault:
        raise Unusable(str(fault)) from None
    found: dict[str, BusEnd] = {}
    for text in channels:
        bus, channel = _of_bus(system, text)
        if bus.name in found:
            raise Unusable(f"--channel {text}: {bus.name} has a channel already")
        other = next((one for one, end in found.items() if end.channel == channel), None)
        if other is not None or not channel:
            why = "no channel" if other is None else f"the channel of {other}"
            raise Unusable(f"--channel {text}: {bus.name} cannot have {why}")
        data_rate = (bus.data_rate or bus.bit_rate) if bus.takes_fd else None
        found[bus.name] = BusEnd(name, channel, bus.bit_rate, data_rate, fd=bus.takes_fd)
    return found


def _of_bus(system: System, text: str) -> tuple[Bus, str]:
    """The bus that a channel is of, and the channel."""
    if len(system.buses) == 1:
        return system.buses[0], text
    name, equals, channel = text.partition("=")
    for bus in system.buses:
        if equals and bus.name.lower() == name.lower():
            return bus, channel
    known = " or ".join(f"{bus.name}=CHANNEL" for bus in system.buses)
    raise Unusable(f"--channel {text} names no bus of {system.name}: write {known}")


def attached(interfaces: Mapping[str, BusEnd], vocabulary: BusVocabulary, record: OnFrame) -> Peer:
    """A peer there; Unusable where there is no such bus."""
    try:
        return joined_peer(interfaces, vocabulary.codec, record)
    except BenchError as fault:
        raise Unusable(str(fault)) from None


def vocabulary_at(system: System, interfaces: Mapping[str, BusEnd]) -> BusVocabulary:
    """The words of the buses that have an interface."""
    return BusVocabulary.of(system, [bus for bus in system.buses if bus.name in interfaces])
