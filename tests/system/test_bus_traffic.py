# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Much traffic on the bus server, of which nothing is lost and nothing overtakes."""

from __future__ import annotations

import os
import random
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path

import can
import pytest

from ravenchart.hw_can.bench.bus_client import RavenchartBus
from tests.support.can_bus import Start, starter
from tests.support.can_frames import WAIT
from tests.system.test_bus_tools import same, tool_environment

pytestmark = pytest.mark.clock

LONG = "RAVENCHART_LONG_TESTS" in os.environ
PLAYED = 100_000 if LONG else 20_000
"""Frames of the log."""
FULL_LOAD = 60.0 if LONG else 10.0
"""Seconds of bus time for which every node has more to send than the bus carries."""
NODES = 8
PATIENCE = 3_600 if LONG else 600
"""Seconds until a test gives up: a host that does other work besides is slow, not wrong."""
IN_FLIGHT = 64
"""Frames of a node that not all others have received yet."""
BIT_RATE = 1_000_000
LONGEST = 135
"""Bits of the longest standard frame with 8 bytes, intermission included (ISO 11898-1)."""


@pytest.fixture
def start() -> Iterator[Start]:
    with starter() as one:
        yield one


def test_a_long_log_is_played_without_loss(start: Start, tmp_path: Path) -> None:
    channel, log = start("time=virtual"), tmp_path / "long.blf"
    chance = random.Random(8)
    frames = [
        can.Message(
            timestamp=number * 1e-4,
            arbitration_id=chance.getrandbits(11),
            is_extended_id=False,
            data=number.to_bytes(4, "little") + chance.randbytes(number % 5),
        )
        for number in range(PLAYED)
    ]
    with can.Logger(log) as logger:
        for frame in frames:
            logger(frame)
    command = [sys.executable, "-m", "can.player", "-i", "ravenchart", "-c", channel]
    with (
        RavenchartBus(channel) as bus,
        subprocess.Popen(
            [*command, "--ignore-timestamps", str(log)],
            env=tool_environment(tmp_path),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
        ) as player,
    ):
        got: list[can.Message] = []
        while len(got) < PLAYED and (message := bus.recv(60)) is not None:
            got.append(message)
        _, said = player.communicate(timeout=60)
        assert player.returncode == 0, said
        assert bus.recv(0) is None
    assert same(frames, got)


class Node(threading.Thread):
    """Sends numbered frames until the time is over, and takes those of the others."""

    def __init__(self, bus: RavenchartBus, index: int, nodes: list[Node]) -> None:
        super().__init__(daemon=True)
        self.sent = 0
        self.got = [0] * NODES
        """How many frames of each node have come, each the one after the last."""
        self.span = (0.0, 0.0)
        """Bus times of the first and the last frame, in s."""
        self.wrong: str | None = None
        self.over = False
        """It sends nothing more."""
        self._bus, self._index, self._nodes = bus, index, nodes

    def run(self) -> None:
        """Send until the bus time is over, and receive all that the others have sent."""
        others = [node for node in self._nodes if node is not self]
        while self.wrong is None and not self.over:
            if self.sent - min(node.got[self._index] for node in others) < IN_FLIGHT:
                self._send()
                self._receive(0)
            else:
                self._receive(0.001)
            #  of its own frames it hears nothing: the last that sends would never be over
            passed = self.span[1] - self.span[0] >= FULL_LOAD
            self.over = passed or any(node.over for node in others)
        #  the last frame of another node may come before that node says that it was the last
        patient = time.monotonic() + PATIENCE / 2
        while self.wrong is None and not self._has_all(others):
            if not self._receive(0.1) and time.monotonic() > patient:
                self.wrong = f"{self.got} came"

    def _has_all(self, others: Sequence[Node]) -> bool:
        return all(node.over and self.got[node._index] == node.sent for node in others)

    def _send(self) -> None:
        identifier = self.sent % 256 * NODES + self._index
        data = bytes([self._index]) + self.sent.to_bytes(7, "little")
        self._bus.send(can.Message(arbitration_id=identifier, is_extended_id=False, data=data))
        self.sent += 1

    def _receive(self, timeout: float) -> bool:
        some = False
        while (message := self._bus.recv(timeout)) is not None:
            some, timeout = True, 0
            node, number = message.data[0], int.from_bytes(message.data[1:], "little")
            if message.is_error_frame or number != self.got[node]:
                self.wrong = f"{message} in place of frame {self.got[node]} of node {node}"
                break
            self.got[node] += 1
            self.span = self.span[0] or message.timestamp, message.timestamp
        return some


@pytest.mark.slow
def test_eight_nodes_at_full_load_lose_nothing(start: Start) -> None:
    """All frames arrive everywhere in order, on a bus that is never idle.

    Time is virtual: so the load does not depend on this machine.
    """
    channel = start(f"bitrate={BIT_RATE}", "time=virtual")
    with ExitStack() as stack:
        nodes: list[Node] = []
        for index in range(NODES):
            bus = stack.enter_context(RavenchartBus(channel))
            nodes.append(Node(bus, index, nodes))
        for node in nodes:
            node.start()
        for node in nodes:
            node.join(PATIENCE)
            assert not node.is_alive()
    assert [node.wrong for node in nodes] == [None] * NODES
    sent = [node.sent for node in nodes]
    for index, node in enumerate(nodes):
        assert node.got == [0 if other == index else count for other, count in enumerate(sent)]
    assert max(node.span[1] - node.span[0] for node in nodes) >= FULL_LOAD
    busy = sum(sent) * LONGEST / BIT_RATE
    assert busy >= FULL_LOAD, "the bus was idle"


def test_each_bus_object_has_its_own_message(start: Start) -> None:
    """As python-can asks of an interface: no two objects share what they received."""
    channel = start()
    sent = can.Message(arbitration_id=0x123, is_extended_id=False, data=b"abc")
    with (
        RavenchartBus(channel, receive_own_messages=True) as a,
        RavenchartBus(channel) as b,
        RavenchartBus(channel) as c,
    ):
        a.send(sent)
        got = [bus.recv(WAIT) for bus in (a, b, c)]
    messages = [message for message in got if message is not None]
    assert len(messages) == 3
    assert len({id(message) for message in (sent, *messages)}) == 4
    sent.data[0] = 0
    assert all(bytes(message.data) == b"abc" for message in messages)
    assert [message.is_rx for message in messages] == [False, True, True]


def test_many_threads_send_by_one_bus_object(start: Start) -> None:
    """Each thread's frames arrive once and in its order."""
    channel, count = start("time=virtual"), 500
    with can.ThreadSafeBus(channel, "ravenchart") as bus, RavenchartBus(channel) as far:

        def feed(identifier: int) -> None:
            for number in range(count):
                data = number.to_bytes(2, "little")
                bus.send(can.Message(arbitration_id=identifier, is_extended_id=False, data=data))

        threads = [threading.Thread(target=feed, args=(identifier,)) for identifier in range(8)]
        for thread in threads:
            thread.start()
        got = [far.recv(WAIT) for _ in range(8 * count)]
        for thread in threads:
            thread.join()
    for identifier in range(8):
        numbers = [
            int.from_bytes(m.data, "little") for m in got if m and m.arbitration_id == identifier
        ]
        assert numbers == list(range(count))
