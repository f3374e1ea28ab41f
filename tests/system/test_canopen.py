# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The CANopen device of the example, and the master of the package `canopen`, on one bus."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial

import canopen
import pytest

from ravenchart.paths import ROOT
from tests.support.examples import PATIENCE, becomes, bus_of, running

pytestmark = [pytest.mark.alone, pytest.mark.slow]

NODE = 5
EDS = ROOT / "examples" / "canopen_device" / "device.eds"
DEFAULT_HEARTBEAT = 200


@dataclass
class Master:
    """The master, its view of the device, and what the device has sent since."""

    network: canopen.Network
    node: canopen.RemoteNode
    states: list[int] = field(default_factory=list)
    """Those of boot-up (0) and heartbeats."""
    reports: list[tuple[int, int]] = field(default_factory=list)
    """Temperature and whether it is at the setpoint, of each PDO."""

    def goes_to(self, state: str, command: str | None = None) -> None:
        """Command it, and see the heartbeats follow."""
        self.node.nmt.state = command or state
        assert becomes(lambda: self.node.nmt.state == state and self.hears_again())

    def hears_again(self) -> bool:
        """Whether another heartbeat comes, with the state of now."""
        count = len(self.states)
        return becomes(lambda: len(self.states) > count)

    def is_silent(self, kind: Callable[[], int], act: Callable[[], object]) -> bool:
        """Whether nothing of a kind comes of an action, until two further heartbeats."""
        before = kind()
        act()
        return self.hears_again() and self.hears_again() and kind() == before


@pytest.fixture(scope="module")
def master(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Master]:
    """A master that saw the device start."""
    trace = tmp_path_factory.mktemp("canopen") / "trace.txt"
    with bus_of(500_000) as channel, canopen.Network() as network:
        network.connect(interface="ravenchart", channel=channel)
        node = network.add_node(NODE, str(EDS))
        node.sdo.RESPONSE_TIMEOUT = PATIENCE
        made = Master(network, node)
        node.nmt.add_heartbeat_callback(made.states.append)
        with running("canopen_device", channel, trace):
            assert becomes(lambda: 127 in made.states)
            node.tpdo.read()
            node.rpdo.read()
            node.tpdo[1].add_callback(
                lambda pdo: made.reports.append((pdo["Temperature"].raw, pdo["At setpoint"].raw))
            )
            yield made


def test_it_starts_pre_operational(master: Master) -> None:
    """The boot-up message of the start is lost where it is sent before the driver has joined."""
    assert set(master.states[:1]) <= {0, 127} and set(master.states[1:]) <= {127}


def test_its_dictionary_is_that_of_the_data_sheet(master: Master) -> None:
    """Every object of the EDS can be read, and has the default value where there is one."""
    read = 0
    for entry in master.node.object_dictionary.values():
        single = isinstance(entry, canopen.objectdictionary.ODVariable)
        for variable in [entry] if single else entry.values():
            item = master.node.sdo[variable.index]
            found = (item if single else item[variable.subindex]).raw
            assert variable.default in (None, found), variable.name
            read += 1
    assert read == 22


def aborted(access: Callable[[], object]) -> int:
    """The code with which the device aborts it."""
    with pytest.raises(canopen.SdoAbortedError) as caught:
        access()
    return caught.value.code


def test_a_transfer_that_cannot_be_is_aborted_with_its_reason(master: Master) -> None:
    sdo = master.node.sdo
    assert aborted(lambda: sdo.upload(0x2100, 0)) == 0x06020000
    assert aborted(lambda: sdo.upload(0x1018, 9)) == 0x06090011
    assert aborted(lambda: sdo.download(0x2001, 0, b"\1\0")) == 0x06010002
    assert aborted(lambda: sdo.download(0x2000, 0, b"\1")) == 0x06070010
    assert aborted(lambda: sdo.download(0x2000, 0, (2501).to_bytes(2, "little"))) == 0x06090031
    low = (-401).to_bytes(2, "little", signed=True)
    assert aborted(lambda: sdo.download(0x2000, 0, low)) == 0x06090032
    assert aborted(partial(sdo.download, 0x2000, 0, b"\1\0", force_segment=True)) == 0x05040001
    assert sdo["Setpoint"].raw == 200


def test_what_is_written_is_read_and_a_new_heartbeat_time_is_kept(master: Master) -> None:
    sdo = master.node.sdo
    for value in (-400, 2500, 200):
        sdo["Setpoint"].raw = value
        assert sdo["Setpoint"].raw == value
    sdo["Producer heartbeat time"].raw = 0
    count = len(master.states)
    for _ in range(2 * DEFAULT_HEARTBEAT // 5):  # each answer takes an execution, 5 ms
        assert sdo["Producer heartbeat time"].raw == 0
    assert len(master.states) <= count + 1
    sdo["Producer heartbeat time"].raw = 50
    assert master.hears_again()
    sdo["Producer heartbeat time"].raw = DEFAULT_HEARTBEAT


def test_pdos_are_exchanged_while_it_is_operational_and_only_then(master: Master) -> None:
    node, network = master.node, master.network
    setpoint = node.rpdo[1]["Setpoint"]
    setpoint.raw = 230

    def send() -> None:
        node.rpdo[1].transmit()
        network.sync.transmit(1)

    assert master.is_silent(lambda: len(master.reports), send)
    assert node.sdo["Setpoint"].raw == 200
    master.goes_to("OPERATIONAL")
    before = len(master.reports)
    node.rpdo[1].transmit()
    assert becomes(lambda: node.sdo["Setpoint"].raw == 230)

    def arrived() -> bool:
        count = len(master.reports)
        network.sync.transmit(count % 240 + 1)
        assert becomes(lambda: len(master.reports) > count)
        return master.reports[-1] == (230, 1)

    assert becomes(arrived)
    temperatures = [temperature for temperature, _ in master.reports[before:]]
    assert temperatures == sorted(temperatures) and 200 <= temperatures[0] < 230
    assert node.sdo["Temperature"].raw == 230


def test_stopped_it_has_only_its_heartbeat(master: Master) -> None:
    master.goes_to("OPERATIONAL")
    master.goes_to("STOPPED")
    assert set(master.states[-1:]) == {4}
    master.node.sdo.RESPONSE_TIMEOUT = 0.5
    try:
        with pytest.raises(canopen.SdoCommunicationError):
            master.node.sdo.upload(0x1000, 0)
    finally:
        master.node.sdo.RESPONSE_TIMEOUT = PATIENCE
    sync = partial(master.network.sync.transmit, 1)
    assert master.is_silent(lambda: len(master.reports), sync)
    master.goes_to("PRE-OPERATIONAL")
    assert master.node.sdo["Device type"].raw == 0


def test_a_command_to_another_node_is_not_its_own_and_one_to_all_is(master: Master) -> None:
    master.goes_to("PRE-OPERATIONAL")
    master.network.send_message(0, bytes([1, NODE + 1]))
    assert master.hears_again() and master.hears_again() and master.states[-1] == 127
    master.network.nmt.state = "OPERATIONAL"
    assert becomes(lambda: master.states[-1] == 5)


@pytest.mark.parametrize(("command", "setpoint"), [("RESET COMMUNICATION", 300), ("RESET", 200)])
def test_a_reset_boots_it_up_again_with_defaults(
    master: Master, command: str, setpoint: int
) -> None:
    """That of the communication leaves the parameters of the application."""
    node = master.node
    master.goes_to("PRE-OPERATIONAL")
    node.sdo["Setpoint"].raw = 300
    node.sdo["Producer heartbeat time"].raw = 100
    count = len(master.states)
    node.nmt.state = command
    assert becomes(lambda: 0 in master.states[count:])
    assert becomes(lambda: master.states[-1] == 127)
    assert node.sdo["Producer heartbeat time"].raw == DEFAULT_HEARTBEAT
    assert node.sdo["Setpoint"].raw == setpoint
