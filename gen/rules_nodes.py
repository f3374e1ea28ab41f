"""Rules of systems with several nodes: what may reach from one to another, and what not."""

from __future__ import annotations

from collections.abc import Iterator

from .calls import callers
from .commands import Server
from .diagnostics import Diagnostic, error
from .resolve import Resolved

ABSENT = "RV-0802"
"""What cannot reach from one node to another yet."""


def calls_stay_on_their_node(resolved: Resolved) -> Iterator[Diagnostic]:
    """Who provides a command is on the node of whoever requires it; a device is on one."""
    system = resolved.system
    for binding in system.bindings:
        home = system.instance(binding.instance)
        provider = binding.provider
        if isinstance(provider, Server) and system.instance(provider.instance).node != home.node:
            there = system.instance(provider.instance).node
            text = (
                f"{binding.instance}.{binding.need.name} is on {home.node}, and "
                f"{provider.instance}, which provides it, on {there}"
            )
            hint = "between nodes, values travel over ports"
            yield error(ABSENT, binding.need.origin, text, hint=hint)
    for device in system.devices:
        homes = {
            system.instance(row.partition(".")[0]).node: row for row in callers(system, device)
        }
        if len(homes) > 1:
            ends = " and ".join(f"{row} on {node}" for node, row in homes.items())
            text = f"the device {device.name} is called by {ends}"
            yield error(ABSENT, device.origin, text, hint="let one node call it")


def cores_exist(resolved: Resolved) -> Iterator[Diagnostic]:
    """The node of a processor has its core."""
    cores = {node.name: node.cores for node in resolved.system.nodes}
    for processor in resolved.system.processors:
        last = cores.get(processor.node)
        if last is not None and processor.core > last:
            text = f"{processor.name} is on core {processor.core}, and {processor.node} has {last}"
            hint = f"give the node `cores: {processor.core}`, or the processor another core"
            yield error("RV-0710", processor.origin, text, hint=hint)


def raised_events_are_near(resolved: Resolved) -> Iterator[Diagnostic]:
    """A processor raises events of instances on its node."""
    system = resolved.system
    for processor in system.processors:
        for instance, event in processor.raises:
            home = system.instance(instance).node
            if home != processor.node:
                text = (
                    f"{processor.name} is on {processor.node}, and {instance}, of which it raises "
                    f"{event}, on {home}"
                )
                hint = "raise an event of an instance there; a port can tell others"
                yield error("RV-0707", processor.origin, text, hint=hint)


NODE_RULES = (
    calls_stay_on_their_node,
    cores_exist,
    raised_events_are_near,
)
