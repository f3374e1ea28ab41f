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
    assert found.round_trip == 0 or found.round_trip > found.median / 2
    if "paced" in name:
        assert found.rate <= bench_buses.BIT_RATE / BITS
        assert found.median >= 1e6 * (BITS - 3) / bench_buses.BIT_RATE


FACTOR = 4
"""By which the server may be slower than a bus without one; on an idle machine they are equal."""


@pytest.mark.alone
def test_the_server_keeps_up_with_a_bus_inside_the_process() -> None:
    """The best runs of each, one beside the other: a host may withhold a core for a second."""
    best = dict.fromkeys((bench_buses.VIRTUAL, bench_buses.SERVER), 0.0)
    for number in range(20):
        if number >= 3 and best[bench_buses.SERVER] > best[bench_buses.VIRTUAL] / FACTOR:
            break
        for name in best:
            with bench_buses.BUSES[name]() as ends:
                best[name] = max(best[name], bench_buses.measured(ends, pings=10).rate)
    assert best[bench_buses.SERVER] > best[bench_buses.VIRTUAL] / FACTOR


def test_a_lost_frame_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench_buses, "WAIT", 0.2)
    lost = pytest.raises(TimeoutError, match="frame 2 did not arrive")
    with bench_buses.server("time=virtual", "fault=3:dropped:2") as ends, lost:
        bench_buses.measured(ends, pings=10, stream=0)
