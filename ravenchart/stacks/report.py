# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The stacks and the memory of a program, as `--json` and the record of a build have them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ravenchart.described import Described


@dataclass(slots=True)
class PathStep(Described):
    """A frame on the longest path of a stack."""

    function: str
    """The function, or `the run-time library`."""
    bytes: int
    """Its frame."""
    called: str
    """Where its caller calls it, `file:line:column`; empty at the root and in a library."""


@dataclass(slots=True)
class Stack(Described):
    """The stack of a task, of the environment task or of interrupts."""

    task: str
    """The processor, `NODE.supervisor`, `NODE.probe`, `BUS.TASK` of a driver, or the task."""
    bound: int
    """The most bytes that it takes: the path or the ending, and interrupts."""
    interrupts: int
    """Bytes of the bound that interrupts take."""
    ending: int
    """Bytes that the handler of the end of a task takes: it runs when the body has been left."""
    size: int | None
    """The bytes that it has; null where the operating system gives them."""
    path: list[PathStep]
    """The longest path, the root first."""

    @property
    def margin(self) -> int | None:
        """The bytes that are never used."""
        return None if self.size is None else self.size - self.bound


@dataclass(slots=True)
class MemoryPart(Described):
    """A part of the program and what it takes of the memory."""

    part: str
    """Name of the part."""
    flash: int
    """Bytes of code, constants and initial values."""
    ram: int
    """Bytes of variables. On a board the stacks of tasks are in the objects of their tasks."""


@dataclass(slots=True)
class Memory(Described):
    """The stacks and the memory of the program of a node."""

    node: str
    """The name of the node."""
    target: str
    """The target of the program."""
    mode: str
    """`checks` or `release`."""
    library: int | None
    """Bytes on each stack for the run-time library; null where it is in the image and read there.
    """
    stacks: list[Stack]
    """One for each task, then the environment task, then interrupts."""
    parts: list[MemoryPart]
    """The memory by parts."""
    flash: int
    """Bytes of code, constants and initial values in all."""
    ram: int
    """Bytes of variables and stacks in all, the stack of the main program left out on a host."""
    sources: dict[str, str]
    """SHA-256 of each Ada source of the program."""

    @property
    def tightest(self) -> Stack | None:
        """The stack with the least margin."""
        known = [one for one in self.stacks if one.size is not None]
        return min(known, key=lambda one: one.margin or 0, default=None)

    def shown(self) -> str:
        """One line for people."""
        least = self.tightest
        text = f"flash {self.flash:,} bytes, RAM {self.ram:,} bytes"
        if least is None:
            return text
        return f"tightest stack: {least.task}, {least.bound:,} of {least.size:,} bytes; {text}"


def memory_of(entry: Any) -> Memory:
    """The `Memory` that `asdict` has made such an entry of; KeyError or TypeError where none has.

    `building.stacks` reads entries that may come from elsewhere, and validates every value.
    """
    stacks = [
        Stack(**one | {"path": [PathStep(**step) for step in one["path"]]})
        for one in entry["stacks"]
    ]
    return Memory(**entry | {"stacks": stacks, "parts": [MemoryPart(**p) for p in entry["parts"]]})
