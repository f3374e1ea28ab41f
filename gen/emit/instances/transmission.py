# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The last statements of a row that sends messages with a transmission mode, or segments."""

from __future__ import annotations

from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Do, do
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import System


def transmits(system: System, instance: Instance, row: Region | Activity) -> tuple[Do, ...]:
    """Send the newest value of each message of which a frame is due."""
    sources = [End(instance.name, port) for port in row.sends]
    return tuple(
        do(ref(ada_case(message.bus), f"Transmit_{ada_case(message.name)}"))
        for message in system.messages
        if (message.transmission is not None or message.transport is not None)
        and message.source in sources
    )


def flow_control(system: System, instance: Instance, handler: str) -> tuple[Do, ...]:
    """Send the flow control that the segments for the ports of a row ask for."""
    return tuple(
        do(ref(ada_case(message.bus), f"Answer_{ada_case(message.controls)}"))
        for message in system.messages
        if message.controls
        and message.source is not None
        and system.handler(message.source) == f"{instance.name}.{handler}"
    )


def answering(system: System, instance: Instance) -> set[DottedName]:
    """The units that the body of the instance needs for that."""
    handlers = instance.component.handlers()
    calls = (one for handler in handlers for one in flow_control(system, instance, handler))
    return {ref(ada_case(system.name), one.name.first) for one in calls}
