# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Groups of a port region resolved: each names input ports, and no port is in two of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ravenchart.gen.files.schema_ports import PortGroupForm, PortRegionForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.model.component import Direction, Port, PortGroup
from ravenchart.gen.model.statechart import Timing
from ravenchart.gen.origins import Origin

from .members import GROUP, Namespace

UNDIVIDED = "RV-0535"

Timed = Callable[[str, PortGroupForm, Findings], Timing]
Placed = dict[str, tuple[str, Origin]]
"""The group of each port so far, and where it names the port."""


def groups_of(
    region: PortRegionForm, ports: NameScope[Port], space: Namespace, timed: Timed
) -> tuple[PortGroup, ...]:
    """The groups of a port region, which handles the ports that none of them names."""
    given, placed = region.groups or {}, Placed()
    groups: NameScope[PortGroup] = NameScope(GROUP)
    for name, at in given.items():
        space.claim(GROUP, name, at.origin)
        timing = timed(f"the group {name}", at, space.findings)
        own = tuple(_ports(name, at, ports, placed, space.findings))
        groups.declare(name, at.origin, PortGroup(name, at.origin, timing, own), space.findings)
    damaged = ports.has_lost() or any(one.damaged for one in (region, *given.values()))
    inputs = {port.name for port in ports.sound() if port.direction is Direction.IN}
    if inputs and placed.keys() >= inputs and not damaged:
        message = f"the groups of {space.component} name all of its input ports: its row `ports` "
        message += "handles none"
        hint = f"remove the group `{groups.names()[-1]}`: the port region handles its ports"
        space.findings.error(UNDIVIDED, region.at_key("groups"), message, hint=hint)
    return groups.sound()


def _ports(
    group: str, form: PortGroupForm, ports: NameScope[Port], placed: Placed, findings: Findings
) -> Iterator[str]:
    """The input ports of a group that no group before it names."""
    for index, text in enumerate(form.ports):
        at = form.item_at("ports", index)
        port = ports.look_up(text, at, findings)
        if port is None:
            continue
        if port.direction is not Direction.IN:
            message = f"{group} is a group of input ports, but {port.name} is an output port"
            notes = [(port.origin, f"`{port.name}` is declared here")]
            findings.error(UNDIVIDED, at, message, notes=notes, hint="remove it from the group")
        elif port.name in placed:
            other, where = placed[port.name]
            message = f"the port {port.name} is in the groups {other} and {group}"
            if other == group:
                message = f"the group {group} names the port {port.name} twice"
            notes = [(where, "the first is here")]
            findings.error(UNDIVIDED, at, message, notes=notes, hint="remove one of them")
        else:
            placed[port.name] = group, at
            yield port.name
