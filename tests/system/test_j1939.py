# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The J1939 node of the example, and the stack of the package `can-j1939`, on one bus."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import pairwise
from pathlib import Path

import can
import j1939
import pytest

from tests.support.examples import becomes, bus_of, running

pytestmark = [pytest.mark.alone, pytest.mark.slow]

ADDRESS, ENGINE, TOOL, GLOBAL = 128, 0, 249, 255
CLAIMED, FAN, UNSUPPORTED = 0xEE00, 0xFEBD, 0xFEE3
CLAIM, CANNOT_CLAIM, NOT_ACKNOWLEDGED, STATE = 0x1CEEFF80, 0x18EEFFFE, 0x18E8FF80, 0x18FEBD80
NAME = 0x10001900FFE00001
FULL = 250
State = j1939.ControllerApplication.State


class Bus:
    """A stack of the other implementation, and who hears all that is on the bus besides."""

    def __init__(self, unit: j1939.ElectronicControlUnit, witness: can.BusABC) -> None:
        self.unit, self.witness = unit, witness
        self.frames: list[can.Message] = []
        self.heard: list[tuple[int, int, bytes]] = []
        """PGN, source and data of what the stack gives to applications."""
        unit.subscribe(self._hear)

    def _hear(self, _priority: int, pgn: int, source: int, _at: float, data: bytearray) -> None:
        self.heard.append((pgn, source, bytes(data)))

    def of(self, identifier: int) -> list[can.Message]:
        """What came with that identifier."""
        return [m for m in list(self.frames) if m.arbitration_id == identifier]

    def after(self, act: Callable[[], object], identifier: int) -> can.Message:
        """The next frame of that identifier after an action."""
        count = len(self.of(identifier))
        act()
        assert becomes(lambda: len(self.of(identifier)) > count), hex(identifier)
        return self.of(identifier)[count]

    def application(self, address: int, name: int) -> j1939.ControllerApplication:
        """An application that has claimed the address, or lost it."""
        made = self.unit.add_ca(name=j1939.Name(value=name), device_address=address)
        made.start()
        assert becomes(lambda: made.state in (State.NORMAL, State.CANNOT_CLAIM))
        return made

    def fan(self, goal: tuple[int, int], act: Callable[[], object] = lambda: None) -> bool:
        """Whether speed and state of the fan become these; before each look there is an action."""

        def reached() -> bool:
            data = self.after(act, STATE).data
            assert data[1] >> 4 == 0xF and data[4:] == b"\xff" * 4
            assert int.from_bytes(data[2:4], "little") == 24 * data[0]
            return (data[0], data[1] & 0xF) == goal

        return becomes(reached)


@pytest.fixture
def bus(tmp_path: Path) -> Iterator[Bus]:
    """The bus with the node, which has claimed its address."""
    trace = tmp_path / "trace.txt"
    with (
        bus_of(250_000) as channel,
        _joined(channel) as made,
        running("j1939_node", channel, trace),
    ):
        assert becomes(lambda: made.of(STATE))
        yield made


@contextmanager
def _joined(channel: str) -> Iterator[Bus]:
    unit = j1939.ElectronicControlUnit()
    with can.Bus(interface="ravenchart", channel=channel) as witness:
        unit.connect(interface="ravenchart", channel=channel)
        made = Bus(unit, witness)
        notifier = can.Notifier(witness, [made.frames.append], timeout=0.1)
        try:
            yield made
        finally:
            notifier.stop()
            unit.stop()
            unit.disconnect()


def test_it_tells_its_name_to_whoever_asks_for_addresses(bus: Bus) -> None:
    nobody = bus.unit.add_ca(name=j1939.Name(value=NAME + 1), device_address=TOOL)
    asked = partial(nobody.send_request, 0, CLAIMED, GLOBAL)
    name = j1939.Name(bytes=bus.after(asked, CLAIM).data)
    assert name.value == NAME
    assert (name.arbitrary_address_capable, name.industry_group, name.function) == (0, 1, 25)
    assert bus.of(0x18EAFFFE)
    tool = bus.application(TOOL, NAME + 1)
    for destination in (GLOBAL, ADDRESS):
        asked = partial(tool.send_request, 0, CLAIMED, destination)
        assert bus.after(asked, CLAIM).data == NAME.to_bytes(8, "little")


def test_the_fan_follows_the_temperature_of_the_engine(bus: Bus) -> None:
    """It is at full speed before there is one, and when it is not available."""
    engine = bus.application(ENGINE, 1)

    def tell(octet: int) -> Callable[[], object]:
        data = [octet, *[0xFF] * 7]
        return partial(engine.send_pgn, 0, 0xFE, 0xEE, 6, data)

    assert bus.fan((FULL, 7))
    assert bus.fan((0, 0), tell(40 + 60))
    assert bus.fan((125, 4), tell(40 + 90))
    assert bus.fan((FULL, 7), tell(0xFF))
    fan = [data for pgn, source, data in bus.heard if (pgn, source) == (FAN, ADDRESS)]
    assert {(data[0], data[1] & 0xF) for data in fan} >= {(0, 0), (125, 4), (FULL, 7)}


def test_a_request_is_answered_and_one_that_is_not_supported_is_refused(bus: Bus) -> None:
    tool = bus.application(TOOL, 2)
    for destination in (GLOBAL, ADDRESS):
        count = len(bus.of(STATE))
        for _ in range(10):
            bus.after(partial(tool.send_request, 0, FAN, destination), STATE)
        times = [message.timestamp for message in bus.of(STATE)[count:]]
        assert min(later - sooner for sooner, later in pairwise(times)) < 0.5  # cyclic: 1 s
    tool.send_request(0, UNSUPPORTED, GLOBAL)
    refused = bus.after(partial(tool.send_request, 0, UNSUPPORTED, ADDRESS), NOT_ACKNOWLEDGED)
    assert refused.data == b"\x01\xff\xff\xff" + bytes([TOOL]) + UNSUPPORTED.to_bytes(3, "little")
    bus.after(lambda: None, STATE)
    assert len(bus.of(NOT_ACKNOWLEDGED)) == 1


def test_a_higher_name_does_not_get_the_address(bus: Bus) -> None:
    count = len(bus.of(CLAIM))
    rival = bus.application(ADDRESS, NAME + 1)
    assert rival.state == State.CANNOT_CLAIM
    assert becomes(lambda: len(bus.of(CLAIM)) > count)
    bus.after(lambda: None, STATE)


def test_a_lower_name_takes_the_address_and_the_node_is_silent(bus: Bus) -> None:
    tool = bus.application(TOOL, 2)
    rival: list[j1939.ControllerApplication] = []
    lost = bus.after(lambda: rival.append(bus.application(ADDRESS, NAME - 1)), CANNOT_CLAIM)
    assert lost.data == NAME.to_bytes(8, "little")
    assert rival[0].state == State.NORMAL
    count = len(bus.of(STATE))
    for _ in range(3):
        tool.send_request(0, FAN, GLOBAL)
        asked = partial(tool.send_request, 0, CLAIMED, GLOBAL)
        assert bus.after(asked, CANNOT_CLAIM).data == NAME.to_bytes(8, "little")
    assert len(bus.of(STATE)) == count
