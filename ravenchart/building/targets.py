# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Targets: what a program is built for, each a folder of the runtime with a ``target.toml``."""

from __future__ import annotations

import os
import re
import shutil
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ravenchart.failures import Refused, ToolFailed, Unusable
from ravenchart.gen.files.schema_base import PositiveSpan, Span
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.model.system import System
from ravenchart.gen.origins import Origin
from ravenchart.paths import work
from ravenchart.tools import children, kept

from . import variants

COMPILERS = variants.RUNTIME / "compilers"
"""Descriptions of the compilers that gprbuild does not find by itself."""
SECOND = 10**9
"""In ns."""


class _Form(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class MemoryRegion(_Form):
    """Memory: its first address, and its bytes."""

    at: int = Field(ge=0)
    size: int = Field(gt=0)


class CanController(_Form):
    """A CAN controller: its registers and its interrupt."""

    name: str
    controller: str
    at: int = Field(ge=0)
    interrupt: int = Field(ge=0)


class TargetOverheads(_Form):
    """The overheads of the run-time library there, in ns; named as the keys of a node are."""

    context_switch: Span
    critical_section: Span
    release: Span


class Gateway(_Form):
    """How the bench reaches the CAN bus of an emulated board; ``driver``: that of the program."""

    driver: str


class Emulator(_Form):
    """The command that runs an image, what its times are, and how to get it."""

    command: tuple[str, ...] = Field(min_length=1)
    time: str
    hint: str
    gateway: Gateway | None = None


class InterruptStack(_Form):
    """Where interrupts are handled: the symbols around it, how many of it there are, the handlers.

    ``frame``: bytes that each level takes for itself.
    """

    first: str
    last: str
    count: int = Field(ge=1)
    root: str
    frame: int = Field(ge=0)


class KnownFrame(_Form):
    """A bound for a frame, or a recursion, that the compiler has none for: see frames.toml."""

    why: str
    bytes: int = Field(default=0, ge=0)
    timer: int = Field(default=0, ge=0)
    depth: int = Field(default=1, ge=1)


class Interrupted(_Form):
    """The stack that an interrupt takes of its task: a frame, and the calls from there."""

    frame: int = Field(ge=0)
    calls: tuple[str, ...]


class Stacks(_Form):
    """Facts about stacks that the program does not show: see docs/memory.md."""

    library: int | None = Field(default=None, gt=0)
    interrupted: Interrupted | None = None
    environment: tuple[str, str] | None = None
    on_end: tuple[str, ...] = ()
    pointers: dict[str, tuple[str, ...]] = {}
    frames: dict[str, KnownFrame] = {}
    interrupts: InterruptStack | None = None


class TargetForm(_Form):
    """``target.toml``."""

    run_time: Literal["full", "light"]
    compilers: tuple[str, ...] = ()
    drivers: tuple[str, ...] = Field(min_length=1)
    tick: PositiveSpan | None = None
    overheads: TargetOverheads | None = None
    memory: dict[str, MemoryRegion] = {}
    stacks: Stacks = Stacks()
    can: tuple[CanController, ...] = ()
    interrupts: Literal["signal", "number"] | None = None
    """The key of an interrupt of the model that says where it comes from here; None: none come."""
    emulator: Emulator | None = None


@dataclass(frozen=True, slots=True)
class Target:
    """A target by name, and what its file says."""

    name: str
    facts: TargetForm


@dataclass(frozen=True, slots=True)
class Board:
    """A target with the user's compiler and run-time library; ``clock_rate`` in Hz."""

    target: Target
    compiler: str
    rts: Path
    clock_rate: int
    place: str = field(init=False)
    """The name of folders for its objects: they differ where its run-time library does.

    gprbuild does not link again where only that has changed.
    """

    def __post_init__(self) -> None:
        archives = sorted((self.rts / "adalib").glob("*.a"))
        library = kept.digest([kept.file_digest(archive) for archive in archives])
        object.__setattr__(self, "place", f"{self.target.name}-{library[:8]}")

    def options(self) -> list[str]:
        """The options of gprbuild."""
        tools = ["--db", str(COMPILERS), f"--target={self.compiler}", f"--RTS={self.rts}"]
        return [*tools, "-bargs", "-static", "-gargs"]

    def scenario(self) -> dict[str, str]:
        """The scenario variables."""
        return {
            "RAVENCHART_TARGET": self.target.name,
            "RAVENCHART_RUN_TIME": self.target.facts.run_time,
            "RAVENCHART_OBJECTS": str(work() / "obj" / self.place),
        }


def file_of(name: str) -> Path:
    """The data file of a target."""
    return variants.RUNTIME / name / "target.toml"


def target(name: str) -> Target:
    """The target of that name. Unusable where its file is wrong, or there is none."""
    if name not in variants.targets():
        raise Unusable(
            f"there is no target {name}; the targets are {', '.join(variants.targets())}"
        )
    path = file_of(name)
    try:
        return Target(name, TargetForm.model_validate(tomllib.loads(path.read_text("utf-8"))))
    except (tomllib.TOMLDecodeError, ValidationError) as fault:
        raise Unusable(f"{path}: {fault}") from None


def board(chosen: Target, rts: Path | None) -> Board:
    """The target with its tools. Unusable, with what is missing, where one is missing."""
    known = " or ".join(chosen.facts.compilers)
    if rts is None and os.environ.get(variants.RTS_VARIABLE):
        rts = Path(os.environ[variants.RTS_VARIABLE])
    if rts is None:
        raise Unusable(
            f"the target {chosen.name} needs an Ada run-time library: give the folder of a "
            f"light-tasking one for it with `--rts DIR` or {variants.RTS_VARIABLE}; it comes with "
            f"your GNAT for {known}"
        )
    if not (rts / "adalib").is_dir():
        raise Unusable(f"{rts} is no Ada run-time library: it has no folder adalib")
    compiler = next((c for c in chosen.facts.compilers if shutil.which(f"{c}-gnatls")), None)
    if compiler is None:
        raise Unusable(f"the target {chosen.name} needs GNAT for {known}, which is not on PATH")
    return Board(chosen, compiler, rts.absolute(), _clock_rate(compiler, rts.absolute()))


_PROBE = """with Ada.Real_Time;
package Clock_Rate is
   Rate : constant Integer := Integer (1.0 / Ada.Real_Time.Time_Unit) with Export;
end Clock_Rate;
"""


def _clock_rate(compiler: str, rts: Path) -> int:
    """How often the real-time clock of a run-time library ticks in a second.

    The compiler is asked, for only that library knows.
    """
    with TemporaryDirectory() as folder:
        (Path(folder) / "clock_rate.ads").write_text(_PROBE, encoding="ascii")
        words = [f"{compiler}-gcc", "-S", "-o", "-", f"--RTS={rts}", "clock_rate.ads"]
        done = children.run(words, cwd=folder)
    match = re.search(r"^\s*\.(?:4byte|word|long)\s+(\d+)$", done.stdout, re.M)
    if done.returncode != 0 or match is None:
        raise ToolFailed(f"{' '.join(words)}\n{done.stdout}{done.stderr}")
    return int(match[1])


def check_system(made: Board, system: System) -> tuple[str, ...]:
    """Warnings on a model that is built for a board.

    Refused where a release is due between two ticks of its clock, or later than its timer
    lets it be, and the analysis does not know.
    """
    wrong = [text for node in system.nodes for text in _late(made, system, node)]
    if wrong:
        raise Refused("\n".join(wrong))
    return tuple(text for node in system.nodes for text in _short(made, node))


def check_interrupts(chosen: Target, system: System) -> None:
    """Refused where an interrupt of the model comes from nowhere on a target."""
    key = chosen.facts.interrupts
    for node in system.nodes:
        for one in node.interrupts:
            if key is None:
                raise Refused(
                    f"{one.origin}: error: programs for {chosen.name} take no interrupts, and "
                    f"{one.name} releases a processor"
                )
            if getattr(one, key) is None:
                raise Refused(
                    f"{one.origin}: error: {one.name} has no `{key}`: it comes from nowhere on "
                    f"{chosen.name}\n{one.origin}: hint: add `{key}` to the interrupt"
                )


def _late(made: Board, system: System, node: Node) -> Iterator[str]:
    """The error that the `tick` of a node causes, with its hint."""
    rate, timer = made.clock_rate, made.target.facts.tick
    has = node.tick.period if node.tick else 0
    if timer is not None and has < timer:
        yield f"{node.origin}: error: the timer of {made.target.name} ticks every {shown(timer)}"
        yield _hint(node, timer)
        return
    unit = -(-SECOND // rate)
    if has >= unit:
        return
    for origin, what, span in _times(system, node):
        if span % SECOND * rate % SECOND:
            yield (
                f"{origin}: error: {what}, {shown(span)}, is no whole number of ticks of the clock "
                f"of {made.target.name}, {rate} Hz: releases are up to a tick late"
            )
            yield _hint(node, unit)
            return


def _hint(node: Node, period: int) -> str:
    tick = f"`tick: {{period: {shown(period)}, wcet: 0 ns}}`"
    return f"{node.origin}: hint: give {node.name} {tick} or more; the analysis adds it"


def _times(system: System, node: Node) -> Iterator[tuple[Origin, str, int]]:
    """Every time that the clock of a node has to keep, and where it stands."""
    for one in system.processors:
        if one.node == node.name and one.released_by is None:
            yield one.origin, f"the period of {one.name}", one.period
            yield one.origin, f"the offset of {one.name}", one.offset
    if node.supervision is not None:
        yield node.origin, f"the period of the supervision of {node.name}", node.supervision.period


def _short(made: Board, node: Node) -> Iterator[str]:
    """Platform figures of a node below those of the target."""
    for key, least in made.target.facts.overheads or ():
        has = getattr(node, key)
        if has < least:
            yield (
                f"{node.origin}: warning: `{key}` of {node.name}, {shown(has)}, is below the "
                f"{shown(least)} that {made.target.name} needs: the bounds do not hold there"
            )
