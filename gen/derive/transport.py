# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The flow control of values that travel in several frames: a message back to the sender.

The row that handles the receiving port sends it at the end of an execution, one at most.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from ravenchart.gen.language.terms import BOOLEAN
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.system import System


def _flows(system: System) -> Iterator[Message]:
    """The messages of flow control, where both ends of the value are sound."""
    for message in system.messages:
        transport, source = message.transport, message.source
        if transport is None or source is None or len(message.targets) != 1:
            continue
        target = message.targets[0]
        component = system.instance(target.instance).component
        handler = component.handlers().get(component.handler(target.name))
        if handler is None or system.home(target) == system.home(source):
            continue
        yield Message(
            name=transport.flow,
            origin=message.origin,
            bus=message.bus,
            identifier=transport.flow_identifier,
            extended=message.extended,
            type=BOOLEAN,
            signals=(),
            length=8,
            source=target,
            targets=(source,),
            period=handler.period,
            controls=message.name,
        )


def with_flows(system: System) -> System:
    """The system with the messages of flow control, where no message has the name of one."""
    known = {message.name.lower() for message in system.messages}
    made = tuple(flow for flow in _flows(system) if flow.name.lower() not in known)
    return replace(system, messages=(*system.messages, *made)) if made else system
