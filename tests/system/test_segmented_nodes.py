# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Values in several frames between two programs on a bus, and between one and `can-isotp`."""

from __future__ import annotations

import shutil
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import can
import isotp
import pytest

from ravenchart.analysis.system.observed import Observation, read_map, read_trace
from ravenchart.building import checking, generation, programs
from ravenchart.gen.model.buses import Message
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.paths import ROOT
from ravenchart.running import server as bus
from ravenchart.running.controllers import Controller, controller
from ravenchart.running.process import ControllerProcess
from ravenchart.running.runs import run_nodes

pytestmark = [pytest.mark.alone, pytest.mark.slow]

STALE_INPUT, PROTECTION_ERROR = "3", "7"
"""Their numbers among the kinds of faults."""

PATIENCE = 20.0
"""Seconds that something may take on a busy host."""


@dataclass(frozen=True)
class Built:
    """The two programs, and what the model says of their messages."""

    folder: Path
    checked: checking.Checked
    controllers: dict[str, Controller]
    messages: dict[str, Message]


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Built:
    """Both programs."""
    folder = tmp_path_factory.mktemp("segmented")
    shutil.copy(ROOT / "tests" / "nodes" / "segmented" / "model.yaml", folder)
    checked = checking.check(folder / "model.yaml")
    assert not checked.warnings
    generation.write_program(checked)
    made = {str(p.node): controller(p) for p in programs.programs_of(checked)}
    return Built(folder, checked, made, {m.name: m for m in checked.system.messages})


def _value(message: Message, data: bytes) -> dict[str, int | str]:
    """The fields of a value, by the layout that the model gives it."""
    whole = int.from_bytes(data, "little")
    raw = {
        s.name: sum(((whole >> bit) & 1) << place for place, bit in enumerate(s.bits()))
        for s in message.signals
    }
    return {s.name: s.value(raw[s.name]) for s in message.signals}


def _coded(message: Message, fields: dict[str, int]) -> bytes:
    whole = 0
    for signal in message.signals:
        raw = signal.raw(fields[signal.name])
        whole |= sum(((raw >> place) & 1) << bit for place, bit in enumerate(signal.bits()))
    assert message.transport is not None
    return whole.to_bytes(message.transport.length, "little")


def test_the_two_nodes_exchange_values(built: Built) -> None:
    outcome = run_nodes(
        tuple(built.controllers.values()),
        built.checked.analysis,
        built.folder / "generated",
        None,
        2.0,
        built.folder / "report",
    )
    assert (outcome.ended.exit_code, outcome.ended.killed) == (0, False)
    seen = outcome.observation
    assert seen is not None
    assert len(list(seen.of("arrived", "report"))) > 3
    assert len(list(seen.of("arrived", "table"))) > 3
    #  three segments make a value, or more where one is lost
    assert len(list(seen.of("sent", "report"))) >= 3 * len(list(seen.of("arrived", "report")))


@dataclass
class Peer:
    """The other end of both transfers, by the package; it answers when it is told to."""

    bench: RavenchartBus
    speaks: bool = True
    faults: list[Exception] = field(default_factory=list)
    frames: dict[int, deque[can.Message]] = field(default_factory=dict)
    flows: int = 0
    """Frames of flow control for what the package sends."""

    def layer(self, transmits: int, receives: int) -> isotp.TransportLayerLogic:
        """An end of one of them."""
        waiting: deque[can.Message] = self.frames.setdefault(receives, deque())

        def taken(timeout: float) -> isotp.CanMessage | None:
            if not waiting:
                return None
            frame = waiting.popleft()
            return isotp.CanMessage(
                arbitration_id=frame.arbitration_id, dlc=frame.dlc, data=bytes(frame.data)
            )

        def sent(frame: isotp.CanMessage) -> None:
            if self.speaks:
                self.bench.send(
                    can.Message(
                        arbitration_id=transmits, is_extended_id=False, data=bytes(frame.data)
                    ),
                    timeout=5,
                )

        address = isotp.Address(isotp.AddressingMode.Normal_11bits, txid=transmits, rxid=receives)
        params = {
            "blocking_send": False,
            "blocksize": 1,
            "stmin": 5,
            "rx_flowcontrol_timeout": 9000,
        }
        return isotp.TransportLayerLogic(
            rxfn=taken,
            txfn=sent,
            address=address,
            error_handler=self.faults.append,
            params=params,
        )

    def serve(self, *layers: isotp.TransportLayerLogic) -> None:
        """Take a frame, and let the ends work."""
        frame = self.bench.recv(timeout=0.002)
        if frame is not None and frame.arbitration_id in self.frames:
            self.flows += frame.arbitration_id == 0x131
            self.frames[frame.arbitration_id].append(frame)
        for one in layers:
            one.process()


Played = Callable[[Callable[[RavenchartBus], None]], Observation]


@pytest.fixture
def gauge(built: Built, tmp_path: Path) -> Played:
    """Runs the node with the gauge on a bus with something else; what was seen."""
    program = built.controllers["sensor"]

    def run(play: Callable[[RavenchartBus], None]) -> Observation:
        trace = tmp_path / "trace.txt"
        with bus.running("port=0", "bitrate=500000") as (_, channel):
            process = ControllerProcess(
                program.executable,
                trace,
                0,
                RAVENCHART_BUS_PORT=channel.rpartition(":")[2],
                RAVENCHART_BUS_NAME="sensor",
            )
            try:
                process.wait_until_joined()
                with RavenchartBus(channel) as bench:
                    play(bench)
                    time.sleep(0.2)
            finally:
                ended = process.stop(0.0)
        assert ended.exit_code == 0
        names = read_map(program.trace_json.read_text())
        return read_trace(trace.read_text().splitlines(), names)

    return run


def test_the_package_receives_and_sends_values(gauge: Played, built: Built) -> None:
    report, table = built.messages["report"], built.messages["table"]
    received: list[dict[str, int | str]] = []
    fields = {s.name: 2000 * number + 7 for number, s in enumerate(table.signals)}
    sent = _coded(table, fields)
    assert len(sent) == 64
    flows: list[int] = []

    def play(bench: RavenchartBus) -> None:
        peer = Peer(bench)
        hears, speaks = peer.layer(0x121, 0x120), peer.layer(0x130, 0x131)
        speaks.send(sent)
        until = time.monotonic() + PATIENCE
        while time.monotonic() < until and (len(received) < 3 or speaks.transmitting()):
            peer.serve(hears, speaks)
            if hears.available():
                data = hears.recv()
                assert data is not None
                received.append(_value(report, bytes(data)))
        flows.append(peer.flows)
        assert not speaks.transmitting(), peer.faults
        #  twice the age at which the port is stale, for a busy host
        time.sleep(2.0)

    seen = gauge(play)
    assert [(one["w5"], one["w8"], one["level"]) for one in received] == [(55555, 65535, 171)] * 3
    counts = [int(one["count"]) for one in received]
    assert counts == sorted(set(counts))
    #  nine consecutive frames, in blocks of four
    assert flows == [3]
    assert len(list(seen.of("arrived", "table"))) == 1
    assert [record.text for record in seen.of("transition", "gauge.Link")] == ["lost"]


def test_a_silent_receiver_ends_each_transfer_and_is_counted(gauge: Played) -> None:
    def play(bench: RavenchartBus) -> None:
        until = time.monotonic() + PATIENCE
        firsts = 0
        while firsts < 2 and time.monotonic() < until:
            frame = bench.recv(timeout=0.1)
            firsts += frame is not None and frame.arbitration_id == 0x120
        #  the second transfer begins after the time-out of the first one
        assert firsts == 2
        time.sleep(0.3)

    seen = gauge(play)
    faults = [record.text for record in seen.of("fault", "report")]
    assert faults
    assert set(faults) == {STALE_INPUT}
    #  no consecutive frame without flow control: each frame began a value
    assert len(list(seen.of("sent", "report"))) <= len(faults) + 2
    assert list(seen.of("arrived", "table")) == []


def test_a_sender_that_falls_silent_is_counted_once_and_may_begin_again(
    gauge: Played, built: Built
) -> None:
    table = built.messages["table"]
    assert table.transport is not None
    sent = _coded(table, {s.name: number for number, s in enumerate(table.signals)})
    first = bytes([0x10, len(sent), *sent[:6]])
    asked: list[int] = []

    def play(bench: RavenchartBus) -> None:
        def answered() -> bool:
            frame = bench.recv(timeout=0.1)
            return frame is not None and frame.arbitration_id == 0x131

        for _ in range(2):
            bench.send(can.Message(arbitration_id=0x130, is_extended_id=False, data=first))
            until = time.monotonic() + PATIENCE
            while not answered():
                assert time.monotonic() < until
            asked.append(1)
            #  no frame tells the receiver that the time is over
            time.sleep(2.0)

    seen = gauge(play)
    assert len(asked) == 2
    #  each silence by itself: the second transfer did not have to end the first
    assert [record.text for record in seen.of("fault", "table")] == [PROTECTION_ERROR] * 2
    apart = [record.time for record in seen.of("fault", "table")]
    assert apart[1] - apart[0] > table.transport.timeout
    assert list(seen.of("arrived", "table")) == []
