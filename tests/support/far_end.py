# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The other end of a bus, where a controller would be: says what it is told, and answers."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path

import can

from ravenchart.building import checking
from ravenchart.gen.model.system import System
from ravenchart.hw_can.bench.peer import FrameValues, Value
from ravenchart.paths import ROOT
from ravenchart.running.vocabulary import BusVocabulary

ROBOT = ROOT / "examples" / "cartesian_robot"

LIMIT = 10.0
"""Seconds within which something must have come."""

Answer = tuple[str, Mapping[str, Value]]


@cache
def system_of(model: Path) -> System:
    """The model in that file, checked."""
    return checking.check(model).system


def robot() -> BusVocabulary:
    """What is said on the bus of the Cartesian robot."""
    return BusVocabulary.of(system_of(ROBOT / "model.yaml"))


def status(condition: str, x: int = 0) -> Answer:
    """What the robot says of itself."""
    return "robot_status", {"condition": condition, "x": x, "y": 0}


class FarEnd:
    """A thread that hears every message and sends what ``answer`` makes of it."""

    def __init__(
        self,
        bus: can.BusABC,
        words: BusVocabulary,
        answer: Callable[[str, FrameValues], list[Answer]] = lambda name, values: [],
    ) -> None:
        self.bus, self.words = bus, words
        self.heard: list[tuple[str, FrameValues]] = []
        self._answer = answer
        self._ends = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def say(self, name: str, values: Mapping[str, Value]) -> None:
        """Send a message."""
        self.bus.send(self.words.codec.encode(name, values))

    def hears(self, name: str, **wanted: Value) -> FrameValues:
        """The values of the last message of that name, once it has those that are ``wanted``."""
        end = time.monotonic() + LIMIT
        while time.monotonic() < end:
            last = next((values for one, values in reversed(self.heard) if one == name), None)
            if last is not None and last.items() >= wanted.items():
                return last
            time.sleep(0.005)
        raise AssertionError(f"no {name} with {wanted} came")

    def close(self) -> None:
        """Leave the bus."""
        self._ends = True
        self._thread.join()
        self.bus.shutdown()

    def _run(self) -> None:
        with suppress(can.CanError):  # the bus is gone
            while not self._ends:
                frame = self.bus.recv(0.02)
                named = None if frame is None else self.words.codec.decode(frame)
                if named is not None:
                    self.heard.append(named)
                    for one in self._answer(*named):
                        self.say(*one)


def obedient(name: str, values: FrameValues) -> list[Answer]:
    """A robot that is at once where a command wants it."""
    if name != "robot_command":
        return []
    position = int(values["x"])
    return [status("Moving", position), status("Ready", position)]
