# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Several buses as one for the bench: what is sent where, and whose a frame is."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import can
import pytest
from can.interfaces.virtual import VirtualBus

from ravenchart.building import checking
from ravenchart.hw_can.bench.interfaces import BusEnd, joined_peer
from ravenchart.hw_can.bench.peer import BenchError, FrameValues, Peer
from ravenchart.hw_can.bench.replay import SUFFIXES, from_outside, log_for
from ravenchart.hw_can.bench.several import JoinedCodec
from ravenchart.paths import ROOT
from ravenchart.running.vocabulary import BusVocabulary

WORDS = BusVocabulary.of(
    checking.check(ROOT / "examples" / "two_buses" / "model.yaml", deadlines=False).system
)


@pytest.fixture
def ends(request: pytest.FixtureRequest) -> Iterator[dict[str, can.BusABC]]:
    """The other end of each bus."""
    made = {bus: can.Bus(f"{request.node.name}-{bus}", "virtual") for bus in ("chassis", "cabin")}
    yield made
    for end in made.values():
        end.shutdown()


@pytest.fixture
def peer(ends: dict[str, can.BusABC], request: pytest.FixtureRequest) -> Iterator[Peer]:
    interfaces = {bus: BusEnd("virtual", f"{request.node.name}-{bus}") for bus in ends}
    one = joined_peer(interfaces, WORDS.codec)
    yield one
    one.close()


def heard(peer: Peer) -> list[tuple[str, FrameValues]]:
    found: list[tuple[str, FrameValues]] = []
    peer.receive_until(time.monotonic() + 0.2, lambda name, values: found.append((name, values)))
    return found


def test_each_message_goes_on_its_bus(peer: Peer, ends: dict[str, can.BusABC]) -> None:
    peer.send("pedal", {"pressed": True})
    frame = ends["chassis"].recv(1.0)
    assert frame is not None and frame.arbitration_id == 0x100
    assert ends["cabin"].recv(0.1) is None


def test_one_identifier_means_another_message_on_each_bus(
    peer: Peer, ends: dict[str, can.BusABC]
) -> None:
    codec = WORDS.codec
    ends["cabin"].send(codec.encode("advice", {"value": "Slow_Down"}))  # 0x100 on both
    ends["chassis"].send(codec.encode("pedal", {"pressed": 1}))
    assert dict(heard(peer)) == {
        "advice": {"value": "Slow_Down"}, "pedal": {"pressed": "True"},
    }  # fmt: skip
    assert peer.unknown == 0 and peer.received == {"advice": 1, "pedal": 1}


def test_frames_of_all_buses_come_though_one_never_rests(
    peer: Peer, ends: dict[str, can.BusABC]
) -> None:
    busy = WORDS.codec.encode("wheel_speed", {"value": 7})
    for _ in range(500):
        ends["chassis"].send(busy)
    ends["cabin"].send(WORDS.codec.encode("needle", {"value": 5}))
    found = heard(peer)
    assert ("needle", {"value": 5}) in found and len(found) == 501


def test_a_message_of_no_bus_is_refused(peer: Peer) -> None:
    with pytest.raises(BenchError, match="no bus has a message nothing"):
        peer.send("nothing", {})
    with pytest.raises(BenchError, match="no bus has a message nothing"):
        WORDS.codec.fields("nothing")


def test_an_interface_that_is_not_there_leaves_the_others_closed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    closed: list[str] = []
    monkeypatch.setattr(VirtualBus, "shutdown", lambda bus: closed.append(bus.channel_info))
    ends = {"chassis": BusEnd("virtual", "a"), "cabin": BusEnd("socketcan", "nowhere0")}
    with pytest.raises(BenchError, match="nowhere0"):
        joined_peer(ends, WORDS.codec)
    assert closed


def frame(identifier: int, channel: str | None = None) -> can.Message:
    return can.Message(arbitration_id=identifier, is_extended_id=False, data=b"\1", channel=channel)


def test_a_frame_whose_identifier_two_buses_have_is_of_none_without_a_name() -> None:
    """The gate's own `advice` of the cabin must not come back as `pedal` on the chassis."""
    codec = WORDS.codec
    assert isinstance(codec, JoinedCodec)
    assert codec.from_outside(frame(0x100)) is None
    assert codec.from_outside(frame(0x100, "cabin")) is None
    assert codec.from_outside(frame(0x100, "chassis")) == "pedal"


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize(("bus", "sent"), [("chassis", ["pedal"]), ("cabin", [])])
def test_a_log_is_of_the_bus_that_ends_its_name(
    suffix: str, bus: str, sent: list[str], tmp_path: Path
) -> None:
    path = tmp_path / f"run-{bus}{suffix}"
    with can.Logger(path) as log:
        log.on_message_received(frame(0x100, bus))
    frames = from_outside(log_for(path, WORDS.codec), WORDS.codec, frozenset())
    assert [WORDS.codec.from_outside(one) for _, one in frames] == sent
