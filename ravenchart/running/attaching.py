# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The end of a bus on which a controller runs already: any interface of python-can."""

from __future__ import annotations

from ravenchart.failures import Unusable
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.interfaces import BusEnd, check_name, joined_peer
from ravenchart.hw_can.bench.peer import BenchError, OnFrame, Peer

from .vocabulary import BusVocabulary


def spoken_bus(system: System) -> Bus:
    """The bus on which a controller is spoken to; Unusable without one."""
    if not system.buses:
        raise Unusable(f"{system.name} has no bus")
    return system.buses[0]


def interface_of(system: System, name: str, channel: str) -> BusEnd:
    """The interface with the bit rates that the model gives its bus.

    Unusable without a bus, and where python-can has no such interface.
    """
    bus = spoken_bus(system)
    try:
        check_name(name)
    except BenchError as fault:
        raise Unusable(str(fault)) from None
    data_rate = (bus.data_rate or bus.bit_rate) if bus.takes_fd else None
    return BusEnd(name, channel, bus.bit_rate, data_rate, fd=bus.takes_fd)


def attached(interface: BusEnd, vocabulary: BusVocabulary, record: OnFrame) -> Peer:
    """A peer there; Unusable where there is no such bus."""
    try:
        return joined_peer(interface, vocabulary.codec, record)
    except BenchError as fault:
        raise Unusable(str(fault)) from None
