# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""A watched bus as text: a table in 80 columns, or lines for a pipe."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from .bus_watch import WatchedBus, WatchedMessage
from .summary import columns


def tables(bus: WatchedBus) -> RenderableType:
    """Its load and counts, then its messages."""
    head = Text()
    head.append(f"{bus.bus}: ", style="bold")
    head.append(f"{bus.interface}, {_seconds(bus.now)} s\nload at most ")
    head.append(percent(bus.load), style="bold red" if is_above(bus) else "bold")
    head.append(f", by the analysis {_bound(bus)}; frames {bus.frames}")
    for word, number in _faults(bus):
        head.append(f", {word} {number}", style="bold red" if word != "unknown" else "")
    if bus.gone is not None:
        head.append(f"\nGONE: {bus.gone}", style="bold red")
    return Group(head, _messages(bus))


def lines(bus: WatchedBus) -> Iterator[str]:
    """Its load and counts, then each message that has come."""
    where = f"{bus.bus} {_seconds(bus.now)}"
    faults = "".join(f" {word} {number}" for word, number in _faults(bus))
    loads = f"load {percent(bus.load)} bound {_bound(bus)}"
    yield f"{where} {loads} frames {bus.frames}{faults}"
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


def _bound(bus: WatchedBus) -> str:
    return "-" if bus.bound is None else percent(bus.bound)


def percent(share: float) -> str:
    """A share of the bus."""
    return f"{100 * share:.1f} %"


def _faults(bus: WatchedBus) -> list[tuple[str, int]]:
    counts = {"unknown": bus.unknown, "malformed": bus.malformed, "error frames": bus.errors}
    return [(word, number) for word, number in counts.items() if number]


def _messages(bus: WatchedBus) -> Table:
    table = columns("message", "frames>", "s ago>", "shortest ms>", "period ms>", "last values")
    for one in bus.messages:
        table.add_row(
            one.name,
            str(one.frames),
            "-" if one.last is None else f"{(bus.now - one.last) / 1e9:.1f}",
            "-" if one.shortest is None else f"{one.shortest / 1e6:.1f}",
            "-" if one.period is None else f"{one.period / 1e6:g}",
            shown_values(one),
        )
    return table


def _seconds(time: int) -> str:
    return f"{time / 1e9:.3f}"
