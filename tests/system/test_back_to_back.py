# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Two bus objects back to back: the cases that python-can tries its own interfaces with.

They are written anew here, as python-can is installed without its tests.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor

import can
import pytest

from tests.support.can_bus import started
from tests.support.can_frames import WAIT

pytestmark = pytest.mark.clock

Pair = tuple[can.BusABC, can.BusABC]
THREADS, FRAMES = 100, 1_000


@pytest.fixture(params=["Bus", "ThreadSafeBus"])
def pair(request: pytest.FixtureRequest) -> Iterator[Pair]:
    """Two objects on one bus, by the names of interface and channel."""
    opened: Callable[..., can.BusABC] = getattr(can, request.param)
    with started("bitrate=500000") as channel:
        words = {"interface": "ravenchart", "channel": channel, "bitrate": 500_000, "fd": True}
        with opened(**words) as near, opened(**words) as far:
            yield near, far


def received(bus: can.BusABC) -> can.Message:
    message = bus.recv(WAIT)
    assert message is not None
    return message


MESSAGES = {
    "standard": can.Message(arbitration_id=0x123, is_extended_id=False, data=bytes(range(8))),
    "extended": can.Message(arbitration_id=0x1ABCDEF, data=bytes(range(8, 16))),
    "remote": can.Message(arbitration_id=0x321, is_extended_id=False, is_remote_frame=True, dlc=5),
    "short": can.Message(arbitration_id=0x222, is_extended_id=False, data=b"abc"),
    "empty": can.Message(arbitration_id=0x333, is_extended_id=False),
    "CAN FD": can.Message(arbitration_id=0x12345, is_fd=True, data=bytes(64)),
    "bit rate switch": can.Message(
        arbitration_id=0x54321, is_fd=True, bitrate_switch=True, data=b"\xa5" * 48
    ),
}


@pytest.mark.parametrize("kind", MESSAGES)
def test_a_frame_is_the_same_both_ways(pair: Pair, kind: str) -> None:
    for sender, receiver in (pair, pair[::-1]):
        sender.send(MESSAGES[kind])
        got = received(receiver)
        assert got.equals(MESSAGES[kind], timestamp_delta=None, check_channel=False)
        assert got.is_rx and str(got.channel).startswith("127.0.0.1:")
        assert sender.recv(0) is None


def test_a_shutdown_may_be_repeated_and_nothing_comes_of_nothing(pair: Pair) -> None:
    assert pair[0].recv(0.05) is None
    assert pair[0].fileno() > 0
    for _ in range(2):
        pair[0].shutdown()


def test_times_are_absolute_and_go_on_with_the_clock(pair: Pair) -> None:
    """The lower bounds hold on any host: a frame is not received before it was sent."""
    near, far = pair
    times = []
    for _ in range(2):
        before = time.time()
        near.send(can.Message())
        got = received(far)
        assert before - 0.05 <= got.timestamp <= time.time() + 0.05
        times.append(got.timestamp)
        time.sleep(0.2)
    assert times[1] - times[0] >= 0.15
    assert any(at % 1 for at in times)


def test_periodic_sending_ends_after_its_duration(pair: Pair) -> None:
    near, far = pair
    task = near.send_periodic(can.Message(arbitration_id=5), 0.01, duration=0.1)
    got = [received(far)]
    while (message := far.recv(1.0)) is not None:
        got.append(message)
    assert 1 <= len(got) <= 11
    task.stop()


@pytest.mark.parametrize("filtered", [False, True])
def test_a_hundred_threads_send_and_a_hundred_receive(filtered: bool) -> None:
    """Each frame goes to one of those who receive, whole; what a filter excludes to nobody."""
    wanted = can.Message(arbitration_id=0x123, data=[254, 255, 1, 2])
    other = can.Message(arbitration_id=2, data=[1, 2, 3])
    given = FRAMES * ([wanted, other] if filtered else [wanted])
    with (
        started("time=virtual") as channel,
        can.ThreadSafeBus(channel, "ravenchart") as near,
        can.ThreadSafeBus(channel, "ravenchart") as far,
        ThreadPoolExecutor(THREADS) as sending,
        ThreadPoolExecutor(THREADS) as receiving,
    ):
        if filtered:
            far.set_filters([{"can_id": 0x123, "can_mask": 0x7FF, "extended": True}])
        sent = sending.map(near.send, given)
        got = list(receiving.map(lambda _: far.recv(WAIT), range(FRAMES)))
        assert len(list(sent)) == len(given)
        assert far.recv(0.1) is None
    assert all(
        one is not None and one.equals(wanted, timestamp_delta=None, check_channel=False)
        for one in got
    )
