# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Sampled ports to which several rows send: the last value hides those before it."""

from __future__ import annotations

from .component import PortKind
from .instances import End
from .system import System


def hidden_by(system: System, row: str, target: End) -> str | None:
    """A row whose value may take the place of that of ``row`` at a sampled port; None without.

    Its own value stays where it comes last: the other rows run before it in the same table, and
    only in releases in which it runs as well.
    """
    if system.instance(target.instance).component.port(target.name).kind is not PortKind.SAMPLED:
        return None
    home = system.processor_of(row)
    places = {slot.element: place for place, slot in enumerate(home.slots)}
    own = home.slots[places[row]]
    for connection in system.connections:
        if connection.target != target:
            continue
        source = system.instance(connection.source.instance)
        for sender in source.component.senders(connection.source.name):
            other = f"{source.name}.{sender.name}"
            if other == row:
                continue
            if other not in places or places[other] > places[row]:
                return other
            slot = home.slots[places[other]]
            if slot.divisor % own.divisor or slot.phase % own.divisor != own.phase:
                return other
    return None
