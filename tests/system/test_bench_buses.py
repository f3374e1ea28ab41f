# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The figures of buses: every frame arrives, and none is faster than its bits."""

from __future__ import annotations

import resource

import pytest

from tests.bench import buses as bench_buses

BITS = 111
"""The least that a frame of 8 bytes takes, with the space behind it (ISO 11898-1)."""


@pytest.mark.parametrize("name", bench_buses.BUSES)
def test_every_frame_arrives(name: str) -> None:
    with bench_buses.BUSES[name]() as ends:
        found = bench_buses.measured(ends, pings=100, stream=500)
    assert found.rate > 0
    assert 0 < found.median <= found.percentile_99
    if "paced" in name:
        assert found.rate <= bench_buses.BIT_RATE / BITS
        shortest = 1e6 * (BITS - 3) / bench_buses.BIT_RATE
        assert found.median >= shortest
        assert found.round_trip >= 2 * shortest


STREAM = 20_000
"""Frames of a comparison: with fewer the start of the server counts."""
FACTOR = 4
"""By which a frame may cost more through the server: there are two processes in place of one."""
SLOWEST = 1_000
"""Frames per second that the server carries on any host: with a wait per frame it would not."""


def used() -> float:
    """Seconds of processor time of this process and of its children that ended."""
    kinds = (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    return sum(kind.ru_utime + kind.ru_stime for kind in map(resource.getrusage, kinds))


@pytest.mark.alone
def test_the_server_keeps_up_with_a_bus_inside_the_process() -> None:
    """Processor time and no rates: a host may withhold a core for seconds.

    Beside other tests the server is woken for each frame, and takes five times as long.
    """
    costs: dict[str, list[float]] = {bench_buses.VIRTUAL: [], bench_buses.SERVER: []}
    rates = []
    for name, cost in 5 * list(costs.items()):
        start = used()
        with bench_buses.BUSES[name]() as ends:
            rates.append(bench_buses.measured(ends, pings=10, stream=STREAM).rate)
        cost.append(used() - start)
    assert min(costs[bench_buses.SERVER]) < FACTOR * min(costs[bench_buses.VIRTUAL])
    assert max(rates[1::2]) > SLOWEST


def test_a_lost_frame_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench_buses, "WAIT", 0.2)
    lost = pytest.raises(TimeoutError, match="frame 2 did not arrive")
    with bench_buses.server("time=virtual", "fault=3:dropped:2") as ends, lost:
        bench_buses.measured(ends, pings=10, stream=0)
