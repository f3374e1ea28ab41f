"""What a row does last for the messages with a transmission mode that it sends."""

from __future__ import annotations

from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.syntax import Do, Stmt
from ravenchart.gen.model.component import Activity
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.model.system import End, Instance, System


def transmits(system: System, instance: Instance, row: Region | Activity) -> tuple[Stmt, ...]:
    """Send the newest value of each message of which a frame is due."""
    sources = [End(instance.name, port) for port in row.sends]
    return tuple(
        Do(f"{ada_case(message.bus)}.Transmit_{ada_case(message.name)}")
        for message in system.messages
        if message.transmission is not None and message.source in sources
    )
