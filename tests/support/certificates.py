# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Timing certificates compiled alone, and systems of random shape to make them of."""

from __future__ import annotations

import random
import re
import subprocess
from dataclasses import replace
from pathlib import Path

from ravenchart.analysis.findings.claims import claims_of
from ravenchart.analysis.system.timing import Analysis
from ravenchart.gen.derive.completion import completed
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.text import print_unit
from ravenchart.gen.emit.certificate.package import emit_certificate
from ravenchart.gen.emit.program import HEADER
from ravenchart.gen.language.terms import Ns
from ravenchart.gen.model.buses import BusErrors, Message, Reception
from ravenchart.gen.model.instances import End
from ravenchart.gen.model.nodes import Tick
from ravenchart.gen.model.signals import FD_SIZES
from ravenchart.gen.model.statechart import Timing
from ravenchart.gen.model.system import (
    Processor,
    Slot,
    System,
    Task,
    Work,
)
from ravenchart.paths import ROOT
from tests.support.systems import HERE, bus, message, system

MS = 1_000_000
RUNTIME = ROOT / "spark_runtime" / "src"


def certificate(analysis: Analysis) -> str:
    """The text of a certificate."""
    header = HEADER.format(system=analysis.system.name)
    return print_unit(emit_certificate(analysis.system, claims_of(analysis), header))


def compiled(text: str, folder: Path, name: str = "Sample") -> str:
    """What the compiler says of a certificate, below a root package of its own; "" is yes."""
    stem = ada_case(name).lower()
    (folder / f"{stem}.ads").write_text(f"package {name} with Pure is\nend {name};\n")
    unit = f"{stem}-timing_certificate.ads"
    (folder / unit).write_text(text)
    done = subprocess.run(
        ["gcc", "-c", "-gnatc", "-gnat2022", "-gnatwa", "-gnatyM79", f"-I{RUNTIME}", unit],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=120,
    )
    return done.stderr if done.returncode or done.stderr else ""


def numbers(text: str, suffix: str) -> list[str]:
    """The named numbers of a certificate that are given as literals and end like that."""
    return re.findall(rf"^   (\w+{suffix}) : constant :=\s+[\d_]+;", text, re.M)


def changed(text: str, name: str, by: int) -> str:
    """The certificate with one literal changed."""

    def change(found: re.Match[str]) -> str:
        return f"{found[1]}{int(found[2].replace('_', '')) + by:_};"

    made, count = re.subn(rf"^(   {name} : constant :=\s+)([\d_]+);", change, text, flags=re.M)
    assert count == 1, name
    return made


def random_system(seed: int, *, by_priority: bool = False) -> System:
    """Processors with rows of different periods, messages in and out, overheads and errors.

    In every third system some frames are CAN FD, with switched rate or without.
    """
    draw = random.Random(seed)
    processors = [_processor(draw, number) for number in range(draw.randint(1, 4))]
    made = system([], (), [bus("bus", draw.choice([50_000, 125_000, 250_000]))])
    messages: list[tuple[Message, str | None]] = []
    for number in range(draw.randint(1, 7)):
        period = draw.choice([4, 5, 10, 20]) * MS
        one = message(
            f"m{number}",
            0x100 * number + draw.randrange(0x100),
            length=draw.randint(0, 8),
            extended=draw.random() < 0.2,
            period=period,
        )
        many = draw.choice([1, 2, 4])
        if draw.random() < 0.5:
            sender = draw.choice(processors)
            slot = draw.choice(sender.slots)
            one = replace(one, period=slot.timing.period, source=End("part", "out"))
            messages.append((replace(one, deadline=Ns(many * one.period)), sender.name))
        else:
            one = replace(one, deadline=Ns(many * one.period))
            messages.append((replace(one, targets=(End("part", "in"),)), None))
    reception = Slot(HERE, "bus", Work.BUS_RECEIVE, "receive", _times(MS, 20_000), 1, 0)
    processors.append(
        Processor("reception", HERE, "cpu", Ns(MS), Ns(0), Ns(MS), 0, 0, "bus", (reception,), ())
    )
    node = replace(made.nodes[0], context_switch=Ns(5_000), critical_section=Ns(4_000))
    if draw.random() < 0.5:
        node = replace(node, release=Ns(3_000), tick=Tick(Ns(MS // 2), Ns(10_000)))
    one_bus = replace(made.buses[0], driver_wcet=Ns(30_000), by_priority=by_priority)
    if draw.random() < 0.5:
        one_bus = replace(one_bus, errors=BusErrors(Ns(20 * MS), draw.randint(1, 2)))
    whole = completed(replace(made, nodes=(node,), buses=(one_bus,), processors=tuple(processors)))
    top = max(task.priority for task in whole.tasks) + 1
    tasks = [*whole.tasks]
    for one, sender_name in messages:
        received = Reception(one, "cpu", several=False).driver
        element = received if sender_name is None else one.sending
        releaser = sender_name or one.element
        times = (one.period, Ns(0), one.limit, one_bus.driver_wcet)
        tasks.append(Task(element, HERE, "cpu", *times, top, released_by=releaser))
    made = replace(whole, tasks=tuple(tasks), messages=tuple(one for one, _ in messages))
    return made if seed % 3 else _with_fd(made, random.Random(-seed))


def _with_fd(made: System, draw: random.Random) -> System:
    """The system with some frames in the other format."""
    data_rate = draw.choice([None, 1_000_000, 8_000_000])
    longest = 16 if data_rate is None else 64
    sizes = [size for size in FD_SIZES if size <= longest]
    messages = (
        replace(one, fd=True, length=draw.choice(sizes)) if draw.random() < 0.6 else one
        for one in made.messages
    )
    buses = (replace(made.buses[0], data_rate=data_rate, takes_fd=True),)
    return replace(made, buses=buses, messages=tuple(messages))


def _processor(draw: random.Random, number: int) -> Processor:
    period = draw.choice([5, 10, 20]) * MS
    slots = []
    for row in range(draw.randint(1, 4)):
        divisor = 1 if row == 0 else draw.choice([1, 2, 3])
        times = _times(divisor * period, draw.randint(1, 8) * period // 200)
        slots.append(Slot(HERE, f"p{number}", Work.ACTIVITY, f"r{row}", times, 1, 0))
    deadline = Ns(draw.choice([period, period * 3 // 4]))
    times_of = (Ns(period), Ns(0), deadline)
    return Processor(f"p{number}", HERE, "cpu", *times_of, 0, 0, None, tuple(slots), ())


def _times(period: int, wcet: int) -> Timing:
    return Timing(Ns(period), Ns(wcet), Ns(period))
