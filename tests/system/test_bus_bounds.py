# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""On the simulated bus no frame takes longer than the analysis says, with and without errors."""

from __future__ import annotations

import random
import subprocess
from dataclasses import dataclass
from pathlib import Path

import pytest

from ravenchart.analysis.core.bus import Bus, Errors, Frame
from ravenchart.analysis.core.can import analyse, load
from ravenchart.analysis.core.frames import classic_bits, rank
from tests.support.ada_programs import built

BIT = 2_000
SECOND = 10**9
HORIZON = 5 * SECOND
SEPARATION = 20_000_000
NODES = 6


@dataclass(frozen=True)
class Message:
    node: int
    identifier: int
    length: int
    offset: int
    period: int
    jitter: int

    @property
    def transmission_time(self) -> int:
        return classic_bits(self.length).time(SECOND // BIT)


@pytest.fixture(scope="module")
def program() -> Path:
    return built("release", "loopback", "bus_load") / "bus_load"


def messages(seed: int, share: float) -> list[Message]:
    """Random messages that need about ``share`` of the bus."""
    chance = random.Random(seed)
    found: list[Message] = []
    used = 0.0
    for identifier in sorted(chance.sample(range(2**11), 60)):
        length, period = chance.randint(0, 8), chance.choice((5, 8, 10, 20, 25, 40)) * 1_000_000
        cost = classic_bits(length).time(SECOND // BIT)
        if used + cost / period <= share:
            used += cost / period
            offset = chance.choice((0, 0, chance.randrange(period)))
            jitter = chance.randrange(period // 4)
            node = chance.randint(1, NODES)
            found.append(Message(node, identifier, length, offset, period, jitter))
    return found


def observed(
    program: Path, sent: list[Message], *, priority: bool, separation: int
) -> tuple[dict[int, int], int]:
    """The worst response of each identifier in ns, and how many errors there were."""
    told = [f"{int(priority)} {BIT} 7 {separation} {HORIZON}"]
    told += [f"{m.node} {m.identifier} {m.length} {m.offset} {m.period} {m.jitter}" for m in sent]
    done = subprocess.run(
        [program], input="\n".join(told) + "\n", capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    *worst, (_, errors, passive) = (line.split() for line in done.stdout.splitlines())
    assert passive == "0", "the bound is for nodes that are error-active"
    return {int(identifier): int(time) for _, identifier, time in worst}, int(errors)


def bounds(sent: list[Message], *, priority: bool, separation: int) -> dict[int, int | None]:
    frames = [
        Frame(
            name=str(m.identifier),
            rank=rank(m.identifier),
            period=m.period,
            deadline=m.period,
            transmission_time=m.transmission_time,
            jitter=m.jitter,
            queue="" if priority else f"node {m.node}",
        )
        for m in sent
    ]
    errors = Errors(separation) if separation else None
    found = analyse(frames, Bus(bit_time=BIT, errors=errors))
    return {int(response.frame.name): response.bound for response in found}


@pytest.mark.parametrize("separation", [0, SEPARATION])
@pytest.mark.parametrize("priority", [True, False])
@pytest.mark.parametrize("seed", range(3))
def test_no_response_exceeds_its_bound(
    program: Path, seed: int, priority: bool, separation: int
) -> None:
    sent = messages(seed, 0.75 if priority else 0.5)
    allowed = bounds(sent, priority=priority, separation=separation)
    worst, errors = observed(program, sent, priority=priority, separation=separation)
    assert (errors > 50) == (separation > 0)
    assert all(worst[m.identifier] >= m.transmission_time // 2 for m in sent)
    late = {
        identifier: (time, bound)
        for identifier, time in worst.items()
        if (bound := allowed[identifier]) is not None and time > bound
    }
    assert late == {}
    assert sum(bound is not None for bound in allowed.values()) > len(sent) // 2


def test_at_full_load_the_bus_is_never_idle_and_the_bounds_hold(program: Path) -> None:
    """Released together, the urgent ones come within a frame of their bounds."""
    sent = [Message(n % NODES + 1, n, 8, 0, 4_320_000, 0) for n in range(1, 17)]
    frames = [
        Frame(str(m.identifier), rank(m.identifier), m.period, m.period, m.transmission_time)
        for m in sent
    ]
    assert load(frames) == 1
    allowed = bounds(sent, priority=True, separation=0)
    worst, _ = observed(program, sent, priority=True, separation=0)
    for m in sent:
        bound = allowed[m.identifier]
        assert bound is not None
        assert worst[m.identifier] <= bound <= worst[m.identifier] * 1.2 + m.transmission_time
