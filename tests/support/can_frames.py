# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""CAN frames: random ones of every kind, and those that come next."""

from __future__ import annotations

import random
import time
from collections.abc import Callable

import can

WAIT = 10.0
"""Seconds within which a frame must have come."""

FD_LENGTHS = (*range(9), 12, 16, 20, 24, 32, 48, 64)


def mixed_frames(count: int, *, seed: int = 1, errors: bool = True) -> list[can.Message]:
    """``count`` frames: standard and extended, data, remote, FD, and ``errors``."""
    chance = random.Random(seed)
    kinds = ("data", "data", "remote", "fd", "fd") + (("error",) if errors else ())
    return [_frame(chance, chance.choice(kinds)) for _ in range(count)]


def _frame(chance: random.Random, kind: str) -> can.Message:
    extended = kind == "error" or chance.random() < 0.5
    identifier = chance.getrandbits(29 if extended else 11)
    length = chance.choice(FD_LENGTHS) if kind == "fd" else chance.randint(0, 8)
    return can.Message(
        arbitration_id=identifier,
        is_extended_id=extended,
        is_remote_frame=kind == "remote",
        is_error_frame=kind == "error",
        is_fd=kind == "fd",
        bitrate_switch=kind == "fd" and chance.random() < 0.5,
        error_state_indicator=kind == "fd" and chance.random() < 0.5,
        dlc=length,
        data=None if kind == "remote" else chance.randbytes(length),
        check=True,
    )


def within(look: Callable[[], object]) -> bool:
    """Whether ``look()`` becomes true in time."""
    end = time.monotonic() + WAIT
    while time.monotonic() < end:
        if look():
            return True
        time.sleep(0.01)
    return False


def taken(bus: can.BusABC, count: int) -> list[can.Message]:
    """The next ``count`` frames, or fewer when none came for long."""
    found: list[can.Message] = []
    while len(found) < count and (message := bus.recv(WAIT)) is not None:
        found.append(message)
    return found
