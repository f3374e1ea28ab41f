# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Which rows and processors send a message."""

from __future__ import annotations

from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System

from .calls import serving


def sender_of(system: System, message: Message) -> str | None:
    """The processor whose row sends a message; None for one from outside."""
    for row in sending_rows(system, message):
        return system.processor_of(row).name
    return None


def sending_rows(system: System, message: Message) -> tuple[str, ...]:
    """The rows that send a message: one, by the rules."""
    if message.source is None:
        return ()
    source = system.instance(message.source.instance)
    if message.call is not None and message.is_reply:
        return (str(serving(message.call.server)),)
    if message.controls:
        return (source.handler(message.source.name),)
    return tuple(
        f"{source.name}.{item.name}"
        for item in source.component.runnables()
        if message.source.name in (item.writes if message.every else item.sends)
    )
