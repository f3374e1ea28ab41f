# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Elements that are checked and analysed but have no code yet: `generate` refuses them."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.derive.completion import programs
from ravenchart.gen.diagnostics import UNREADY, Diagnostic, error
from ravenchart.gen.model.system import System


def unready(system: System) -> Iterator[Diagnostic]:
    """An error for each element that has no code yet."""
    for bus in (bus for part in programs(system) for bus in part.buses):
        if not any(message.bus == bus.name for message in system.messages):
            text = f"the model sends and receives nothing on {bus.name}"
            hint = "give a component a port, and a message `from` or `to` it, or remove the bus"
            yield error(UNREADY, bus.origin, text, hint=hint)
