# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What a frame takes to another node: the slcan driver, and the bus server in both kinds of time.

For the driver a frame goes by TCP to an Ada program, which sends it back under the next
identifier: a latency is there and back. On the bus server and on python-can's own virtual bus,
for comparison, two nodes of this process are the ends: a latency is from `send` to `recv`, and
a round trip is a frame and the answer to it. Frames have 8 bytes.
"""

from __future__ import annotations

import os
import socket
import statistics
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass

import can

from ravenchart.hw_can.bench.bus_client import RavenchartBus
from ravenchart.running import server as bus
from tests.support.ada_programs import built

PINGS = 500
"""Frames whose latency is taken, one by one."""
STREAM = 5_000
"""Frames sent as fast as they go."""
IN_FLIGHT = 64
"""Frames of the stream that may be under way: fewer than any node on the way has room for."""
WAIT = 5.0
"""Seconds after which a frame is lost."""
BIT_RATE = 1_000_000
"""Of the bus that is paced by the clock, in bit/s."""
ECHO = "can_echo"
"""The Ada program: it sends each frame back."""

VIRTUAL = "python-can's virtual bus"
SERVER = "bus server, virtual time"

Ends = tuple[can.BusABC, can.BusABC]
"""Where frames are sent, and where they arrive; one and the same for an echo."""


@dataclass(frozen=True, slots=True)
class Figures:
    """Of one bus: frames per second, and latencies in us."""

    rate: float
    median: float
    percentile_99: float
    round_trip: float
    """Median; 0 where a latency is one already."""


def _frame(number: int) -> can.Message:
    data = number.to_bytes(8, "little")
    return can.Message(arbitration_id=0x100, is_extended_id=False, data=data)


def _arrives(far: can.BusABC, number: int) -> None:
    """The next frame is that of the number; TimeoutError where none is or it is another."""
    message = far.recv(WAIT)
    if message is None or int.from_bytes(message.data, "little") != number:
        raise TimeoutError(f"frame {number} did not arrive: {message}")


def measured(ends: Ends, pings: int = PINGS, stream: int = STREAM) -> Figures:
    """One by one, then as many as go; TimeoutError where a frame is lost."""
    near, far = ends
    latencies = []
    for number in range(pings):
        start = time.perf_counter()
        near.send(_frame(number))
        _arrives(far, number)
        latencies.append(1e6 * (time.perf_counter() - start))
    start = time.perf_counter()
    for number in range(stream + IN_FLIGHT):
        if number < stream:
            near.send(_frame(number))
        if number >= IN_FLIGHT:
            _arrives(far, number - IN_FLIGHT)
    rate = stream / (time.perf_counter() - start)
    percentiles = statistics.quantiles(latencies, n=100)
    trip = 0.0 if near is far else statistics.median(_round_trips(ends, pings))
    return Figures(rate, statistics.median(latencies), percentiles[98], trip)


def _round_trips(ends: Ends, pings: int) -> Iterator[float]:
    """How long each frame and its answer take, in us."""
    near, far = ends
    for number in range(pings):
        start = time.perf_counter()
        near.send(_frame(number))
        _arrives(far, number)
        far.send(_frame(number))
        _arrives(near, number)
        yield 1e6 * (time.perf_counter() - start)


@contextmanager
def virtual() -> Iterator[Ends]:
    """Two ends of python-can's own virtual bus, inside this process."""
    with (
        can.Bus(interface="virtual", channel="bench") as near,
        can.Bus(interface="virtual", channel="bench") as far,
    ):
        yield near, far


@contextmanager
def slcan() -> Iterator[Ends]:
    """The Ada echo with the slcan driver, built with -O2 and checks off."""
    program = built("release", "slcan", ECHO) / ECHO
    environment = {**os.environ, "RAVENCHART_CAN_PORT": "0"}
    with subprocess.Popen(
        [program, "0"], env=environment, stdout=subprocess.PIPE, text=True
    ) as ada:
        assert ada.stdout is not None
        try:
            port = ada.stdout.readline().rpartition(":")[2].strip()
            channel = f"socket://127.0.0.1:{port}"
            with can.Bus(interface="slcan", channel=channel, sleep_after_open=0) as one:
                with socket.socket(fileno=os.dup(one.fileno())) as link:
                    link.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                yield one, one
        finally:
            ada.kill()


@contextmanager
def server(*told: str) -> Iterator[Ends]:
    """Two nodes on a bus server that is told this."""
    with (
        bus.running("port=0", *told) as (_, channel),
        RavenchartBus(channel) as near,
        RavenchartBus(channel) as far,
    ):
        yield near, far


BUSES: dict[str, Callable[[], AbstractContextManager[Ends]]] = {
    "slcan driver over TCP, there and back": slcan,
    VIRTUAL: virtual,
    SERVER: lambda: server("time=virtual"),
    "bus server, paced at 1 Mbit/s": lambda: server("time=paced", f"bitrate={BIT_RATE}"),
}


def main() -> None:
    """The figures."""
    print("frames of 8 bytes over a bus, from python-can (latency: median, 99 %):")
    for name, opened in BUSES.items():
        with opened() as ends:
            found = measured(ends)
        print(
            f"  {name}: {found.rate:,.0f} frames/s,"
            f" latency {found.median:.0f} us, {found.percentile_99:.0f} us"
            + (f", round trip {found.round_trip:.0f} us" if found.round_trip else "")
        )


if __name__ == "__main__":
    main()
