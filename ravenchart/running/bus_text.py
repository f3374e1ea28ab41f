# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A watched bus as text: a table in 80 columns, or lines for a pipe."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from ravenchart import rounded

from .bus_watch import WatchedBus, WatchedMessage
from .summary import columns


def tables(bus: WatchedBus) -> RenderableType:
    """Its load and counts, then its messages."""
    head = Text()
    head.append(f"{bus.bus}: ", style="bold")
    head.append(f"{bus.interface}, {rounded.instant(bus.now)} s\nload at most ")
    load, bound = _loads(bus)
    head.append(load, style="bold red" if is_above(bus) else "bold")
    head.append(f", by the analysis {bound}; frames {bus.frames}")
    for word, number in _faults(bus):
        head.append(f", {word} {number}", style="bold red" if word != "unknown" else "")
    if bus.ended:
        head.append(f"\n{bus.gone}")
    elif bus.gone is not None:
        head.append(f"\nGONE: {bus.gone}", style="bold red")
    return Group(head, _messages(bus))


def lines(bus: WatchedBus) -> Iterator[str]:
    """Its load and counts, then each message that has come."""
    where = f"{bus.bus} {rounded.instant(bus.now)}"
    faults = "".join(f" {word} {number}" for word, number in _faults(bus))
    load, bound = _loads(bus)
    yield f"{where} load {load} bound {bound} frames {bus.frames}{faults}"
    for one in bus.messages:
        if one.frames:
            yield f"{where} {one.name} frames {one.frames} {shown_values(one)}".rstrip()
    if bus.gone is not None:
        yield f"{where} gone: {bus.gone}"


def shown_values(message: WatchedMessage) -> str:
    """The values of the last frame, with their units."""
    return ", ".join(
        f"{name} {value} {message.units.get(name, '')}".rstrip()
        for name, value in message.fields.items()
    )


def is_above(bus: WatchedBus) -> bool:
    """Is the load more than the analysis allows?"""
    return bus.bound is not None and bus.load > bus.bound


def _loads(bus: WatchedBus) -> tuple[str, str]:
    """The load of the bus and its bound by the analysis."""
    if bus.bound is None:
        return rounded.percent(_exact(bus.load)), "-"
    return rounded.shares_beside(_exact(bus.load), _exact(bus.bound))


def _exact(share: float) -> Fraction:
    """A share of a second, which is a whole number of ns."""
    return Fraction(rounded.of_seconds(share), rounded.SECONDS.length)


def _faults(bus: WatchedBus) -> list[tuple[str, int]]:
    counts = {
        "unknown": bus.unknown,
        "malformed": bus.malformed,
        "error frames": bus.errors,
        "missed": bus.missed,
    }
    return [(word, number) for word, number in counts.items() if number]


def _messages(bus: WatchedBus) -> Table:
    table = columns("message", "frames>", "s ago>", "shortest ms>", "period ms>", "last values")
    for one in bus.messages:
        table.add_row(
            one.name,
            str(one.frames),
            "-" if one.last is None else rounded.age(bus.now - one.last),
            rounded.MS.down(one.shortest),
            rounded.MS.down(one.period),
            shown_values(one),
        )
    return table
