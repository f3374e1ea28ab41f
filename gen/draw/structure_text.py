# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The component structure of a system as PlantUML and as Mermaid text."""

from __future__ import annotations

from collections.abc import Iterator

from ravenchart.gen.language.names import path_name
from ravenchart.gen.model.buses import Message
from ravenchart.gen.model.component import Direction
from ravenchart.gen.model.instances import End, Instance
from ravenchart.gen.model.system import Processor, System

from .boxes import Box, boxes
from .devices import device_links, devices_of, kind_of


def plantuml(system: System) -> str:
    """A component diagram: nodes with instances and ports, buses, processors as notes."""
    lines = ["@startuml", f"title {system.name}", "left to right direction"]
    for node in system.nodes:
        lines.append(f"node {node.name} {{")
        for box in boxes(system, node):
            lines += [f"  {line}" for line in _boxed(box)]
        for device in devices_of(system, node.name):
            title = f"{device.name} : {kind_of(device)}"
            lines.append(f'  component "{title}" <<device>> as device_{device.name}')
        lines.append("}")
    lines += [f"queue {bus.name}" for bus in system.buses]
    for wire in system.connections:
        source, target = wire.source, wire.target
        lines.append(f"{_port(source)} --> {_port(target)}")
    for link in device_links(system):
        provider = path_name(link.provider) if link.interface else f"device_{link.provider}"
        lines.append(f"{path_name(link.instance)} ..> {provider} : {link.required}")
    for device in system.devices:
        lines += [f"device_{device.name} o-- device_{one.name}" for one in device.members]
    for message in system.messages:
        if message.source is not None:
            lines.append(f"{_end(system, message.source)} --> {message.bus} : {_carried(message)}")
        for target in message.targets:
            lines.append(f"{message.bus} --> {_end(system, target)} : {_carried(message)}")
    for processor in system.processors:
        lines += [f"note as {processor.name}_table", f"  {_named(system, processor)}"]
        lines += [*(f"  {slot.element}" for slot in processor.slots), "end note"]
    return "".join(f"{line}\n" for line in (*lines, "@enduml"))


def _end(system: System, end: End) -> str:
    """A port, or the instance where a call or reply ends at none."""
    component = system.instance(end.instance).component
    ports = {port.name for port in component.ports if not port.is_command}
    return _port(end) if end.name in ports else path_name(end.instance)


def _port(end: End) -> str:
    return f"{path_name(end.instance)}_{end.name}"


def _boxed(box: Instance | Box) -> Iterator[str]:
    """An instance, or a composite with what is inside."""
    if isinstance(box, Instance):
        yield from _component(box)
        return
    yield f'component "{box.name} : {box.component}" as {path_name(box.name)} {{'
    for one in box.inside:
        yield from (f"  {line}" for line in _boxed(one))
    yield "}"


def _component(instance: Instance) -> Iterator[str]:
    own = path_name(instance.name)
    yield f'component "{instance.name} : {instance.component.name}" as {own} {{'
    for port in instance.component.ports:
        if port.is_command:
            continue
        kind = "portin" if port.direction is Direction.IN else "portout"
        yield f'  {kind} "{port.name}" as {own}_{port.name}'
    yield "}"


def mermaid(system: System) -> str:
    """A flow chart: nodes with instances, and with processors and their tables; buses."""
    lines = ["---", f"title: {system.name}", "---", "flowchart LR"]
    lines.append("  %% Mermaid has no ports: the ends of an arrow are in its label.")
    for node in system.nodes:
        lines.append(f'  subgraph node_{node.name}["node {node.name}"]')
        for box in boxes(system, node):
            lines += [f"    {line}" for line in _subgraph(box)]
        for device in devices_of(system, node.name):
            title = f"{device.name} : {kind_of(device)}"
            lines.append(f'    device_{device.name}(["{title}"])')
        for processor in system.processors:
            if processor.node == node.name:
                rows = "<br/>".join(slot.element for slot in processor.slots)
                label = f"{_named(system, processor)}<br/>{rows}"
                lines.append(f'    processor_{processor.name}["{label}"]')
        lines.append("  end")
    lines += [f'  bus_{bus.name}[("bus {bus.name}")]' for bus in system.buses]
    for wire in system.connections:
        source, target = wire.source, wire.target
        label = f"{source.name} to {target.name}"
        lines.append(f'  {_shape(source.instance)} -->|"{label}"| {_shape(target.instance)}')
    for link in device_links(system):
        provider = _shape(link.provider) if link.interface else f"device_{link.provider}"
        lines.append(f'  {_shape(link.instance)} -.->|"{link.required}"| {provider}')
    for device in system.devices:
        lines += [f"  device_{device.name} o--o device_{one.name}" for one in device.members]
    for message in system.messages:
        label = _carried(message)
        if message.source is not None:
            lines.append(f'  {_shape(message.source.instance)} -->|"{label}"| bus_{message.bus}')
        for target in message.targets:
            lines.append(f'  bus_{message.bus} -->|"{label}"| {_shape(target.instance)}')
    return "".join(f"{line}\n" for line in lines)


def _named(system: System, processor: Processor) -> str:
    """A processor by its name, and by its core where its node has several."""
    several = system.node(processor.node).cores > 1
    return f"processor {processor.name}{f', core {processor.core}' if several else ''}"


def _shape(instance: str) -> str:
    """An instance as the chart knows it."""
    return f"instance_{path_name(instance)}"


def _subgraph(box: Instance | Box) -> Iterator[str]:
    """An instance, or a composite with what is inside."""
    if isinstance(box, Instance):
        yield f'{_shape(box.name)}["{box.name} : {box.component.name}"]'
        return
    yield f'subgraph {_shape(box.name)}["{box.name} : {box.component}"]'
    for one in box.inside:
        yield from (f"  {line}" for line in _subgraph(one))
    yield "end"


def _carried(message: Message) -> str:
    return f"{message.name} {message.shown_identifier}"
