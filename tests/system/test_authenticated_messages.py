# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Authentication against an independent implementation, and attacks on a bus."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

import can
import pytest

from ravenchart.analysis.system.observed import Observation
from ravenchart.hw_can.bench.bus_client import RavenchartBus
from tests.support.ada_programs import ran
from tests.support.on_bus import Play, runner
from tests.support.secoc import PUMP, VALVE, Secured

pytestmark = pytest.mark.alone

FIRST = Secured(VALVE, 0x123, 1, 3)
SECOND = Secured(VALVE, 0x124, 8, 16)
THIRD = Secured(PUMP, 0x123, 4, 8)
SENT = {
    0x200: (Secured(VALVE, 0x223, 1, 3), 0),
    0x201: (Secured(VALVE, 0x224, 8, 16), 0),
    0x202: (Secured(PUMP, 0x225, 4, 8), 0x2_FFFF_FFFA),
}
"""What the controller sends, by identifier: with the last freshness value of an earlier run."""


def test_an_independent_implementation_seals_every_frame_so() -> None:
    done = ran("test_authentication", "print", timeout=60)
    lines = [line.split() for line in done.stdout.splitlines()]
    assert len(lines) == 5 * 200
    for data_id, freshness, mac, value, text in lines:
        frame = bytes.fromhex(text)
        secured = Secured(VALVE, int(data_id), int(freshness), int(mac))
        assert secured.accepts(frame, int(value)), text
        assert not secured.accepts(frame, int(value) ^ 1 << 63), text


def test_of_many_attacks_of_each_kind_none_succeeds() -> None:
    times = "100000" if "RAVENCHART_LONG_TESTS" in os.environ else "1000"
    done = ran("test_authentication", times)
    assert (done.returncode, "not ok" in done.stdout) == (0, False), done.stdout


@pytest.fixture
def gate(tmp_path: Path) -> Callable[[Play], Observation]:
    """Runs the feature model on a bus with a bench that does something; what was seen."""
    return runner("authenticated", tmp_path)


GOOD, WRONG = 5, 900
WORDS = {0x100: FIRST, 0x101: SECOND, 0x102: THIRD}
LENGTHS = {0x100: 6, 0x101: 32, 0x102: 64}
NAMES = {0x100: "first_in", 0x101: "second_in", 0x102: "third_in"}
BEFORE = {0x100: 0, 0x101: 0, 0x102: 0x1_FFFF_FFFD}
"""The freshness value with which each receiver begins."""


def _data(identifier: int, level: int) -> bytes:
    """The data of a message with that level; the other fields are 0."""
    secured = WORDS[identifier]
    made = bytearray(LENGTHS[identifier] - secured.freshness - secured.mac)
    if identifier == 0x102:  # 10 bits from 239 on, the most significant first
        made[29], made[30] = level >> 2, level << 6 & 0xC0
    else:
        made[0:2] = level.to_bytes(2, "little")
    return bytes(made)


def _frame(identifier: int, data: bytes) -> can.Message:
    return can.Message(
        arbitration_id=identifier,
        is_extended_id=identifier == 0x102,
        is_fd=True,
        bitrate_switch=True,
        data=data,
    )


@pytest.mark.slow
def test_attacks_on_the_bus_are_noticed_and_nothing_wrong_is_used(
    gate: Callable[[Play], Observation],
) -> None:
    levels: dict[int, set[int]] = {}
    attacks = 0

    def play(bench: RavenchartBus) -> None:
        nonlocal attacks

        def give(identifier: int, data: bytes) -> None:
            bench.send(_frame(identifier, data), timeout=5)
            end = time.monotonic() + 0.03
            while (rest := end - time.monotonic()) > 0:
                answer = bench.recv(timeout=rest)
                if answer is None or answer.arbitration_id not in SENT:
                    continue
                shown = int.from_bytes(answer.data[0:2], "little") & 0x3FF
                levels.setdefault(answer.arbitration_id, set()).add(shown)

        for identifier, secured in WORDS.items():
            good, wrong = _data(identifier, GOOD), _data(identifier, WRONG)
            last = BEFORE[identifier]

            def sealed(data: bytes, ahead: int, by: Secured = secured, last: int = last) -> bytes:
                return by.seal(data, last + ahead)

            used = [sealed(good, number) for number in (1, 2, 3, 4)]
            for frame in used:
                give(identifier, frame)
            old = sealed(wrong, 2)  # sealed by who has the key and an older freshness value
            flips = [0, 9, 8 * len(good) + 1, 8 * len(used[0]) - 1]
            altered = []
            for bit in flips:
                flipped = bytearray(sealed(wrong, 5))
                flipped[bit // 8] ^= 1 << bit % 8
                altered.append(bytes(flipped))
            other = PUMP if secured.key == VALVE else VALVE
            shorter = {6: 5, 32: 24, 64: 48}[len(used[0])]
            refused = [
                used[-1],  # repetition
                used[0],  # replay
                old,
                *altered,
                wrong + bytes(secured.freshness + secured.mac),  # not sealed at all
                wrong + used[-1][len(good) :],  # the trailer of another frame
                sealed(wrong, 5, Secured(other, secured.data_id, secured.freshness, secured.mac)),
                sealed(wrong, 5, Secured(secured.key, 7, secured.freshness, secured.mac)),
                sealed(wrong, 5)[:shorter],
            ]
            for frame in refused:
                give(identifier, frame)
            attacks += len(refused)
            give(identifier, sealed(_data(identifier, GOOD + 1), 5))
            give(identifier, sealed(_data(identifier, GOOD + 2), 100))  # 94 were lost
            give(identifier, sealed(_data(identifier, GOOD + 2), 101))

    seen = gate(play)
    for identifier, name in NAMES.items():
        assert len(list(seen.of("arrived", name))) == 4 + 3, (identifier, name)
    assert seen.faults["Protection_Error"] == attacks
    assert [r.text for r in seen.of("transition", "gate.Trust")][:1] == ["doubt"]
    for identifier in (0x200, 0x201, 0x202):
        assert WRONG not in levels[identifier]
    assert {GOOD, GOOD + 1, GOOD + 2} <= levels[0x200] & levels[0x201]


@pytest.mark.slow
def test_what_is_sent_is_sealed_with_values_that_only_grow(
    gate: Callable[[Play], Observation],
) -> None:
    answers: list[can.Message] = []

    def play(bench: RavenchartBus) -> None:
        end = time.monotonic() + 1.0
        while time.monotonic() < end:
            frame = bench.recv(timeout=0.05)
            if frame is not None:
                answers.append(frame)

    gate(play)
    for identifier, (secured, before) in SENT.items():
        frames = [bytes(a.data) for a in answers if a.arbitration_id == identifier]
        assert len(frames) > 10
        window = 1 << 8 * secured.freshness
        first = before + (secured.shown(frames[0]) - before) % window
        assert first > before
        for value, frame in enumerate(frames, first):
            assert secured.accepts(frame, value), (identifier, value)
