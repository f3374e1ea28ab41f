# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The figures of buses: every frame arrives, and none is faster than its bits."""

from __future__ import annotations

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


SLOWEST = 1_000
"""Frames per second that the server carries on any host: with a wait per frame it would not."""


@pytest.mark.alone
def test_the_server_waits_for_no_clock() -> None:
    """The best of three runs: how much slower than inside a process depends on the host's calls."""
    rates = []
    for _ in range(3):
        with bench_buses.BUSES[bench_buses.SERVER]() as ends:
            rates.append(bench_buses.measured(ends, pings=10).rate)
    assert max(rates) > SLOWEST


def test_a_lost_frame_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench_buses, "WAIT", 0.2)
    lost = pytest.raises(TimeoutError, match="frame 2 did not arrive")
    with bench_buses.server("time=virtual", "fault=3:dropped:2") as ends, lost:
        bench_buses.measured(ends, pings=10, stream=0)
