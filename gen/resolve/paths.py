# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Paths of a deployment: the instance that `arm.shoulder.move` names, and the element of it.

An instance of a composite component is no instance of the `System`: those inside it are. Its
ports and interfaces are theirs, and from outside they are reached through it alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.model.buses import Bus
from ravenchart.gen.model.component import Direction
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.nodes import Node
from ravenchart.gen.origins import Origin

from .components import Parts
from .composites import Composite, Ends, connectable, within


@dataclass(frozen=True, slots=True)
class Placed:
    """An instance of a composite component, by its path."""

    name: str
    origin: Origin
    composite: Composite


class Owners(NameScope[Instance | Placed]):
    """All instances by their paths, composite ones among them."""

    def names(self) -> list[str]:
        """Those with which a path can begin."""
        return [name for name, _, _ in self.items.values() if "." not in name]


@dataclass(frozen=True, slots=True)
class DeploymentNames:
    """The names that the elements of a deployment may refer to."""

    nodes: NameScope[Node]
    buses: NameScope[Bus]
    components: NameScope[Parts | Composite]
    instances: NameScope[Instance]
    owners: Owners
    findings: Findings

    def composites(self) -> list[Composite]:
        """The composite components."""
        return [one for one in self.components.sound() if isinstance(one, Composite)]

    def parts(self, instance: Instance) -> Parts | None:
        """The parts of an instance's component; None where it is lost."""
        found = self.components.find(instance.component.name)
        return found if isinstance(found, Parts) else None


def split(
    text: str, shape: str, origin: Origin, owners: Owners, findings: Findings
) -> tuple[str, str] | None:
    """The path of an instance and the name behind it; reported where there are not both."""
    path, _, name = text.rpartition(".")
    first, dot, _ = path.partition(".")
    found = owners.find(first)
    well_formed = name != "" and "" not in path.split(".")
    if well_formed and dot and found is None and owners.knows(first):
        owners.used(first, origin, findings)
        findings.lose()
        return None
    if not well_formed or (dot and not isinstance(found, Placed)):
        findings.error("RV-0306", origin, f"`{text}` must have the form {shape}")
        return None
    return path, name


def owner_at(
    path: str, origin: Origin, owners: Owners, findings: Findings
) -> Instance | Placed | None:
    """The instance at a path, each name of which is looked up; reported where there is none."""
    first, *inner = path.split(".")
    found = owners.look_up(first, origin, findings)
    for name in inner:
        if not isinstance(found, Placed):
            if found is not None:
                message = f"{found.name} has no instances, so there is no `{path}`"
                findings.error("RV-0305", origin, message, hint=f"name {found.name} itself")
            return None
        inside = found.composite.inside.look_up(name, origin, findings)
        found = None if inside is None else owners.find(f"{found.name}.{inside.name}")
    return found


def member_of(
    text: str, shape: str, origin: Origin, site: DeploymentNames
) -> tuple[Instance, Parts, str] | None:
    """The instance of ``instance.name``, what its component has, and the name."""
    pair = split(text, shape, origin, site.owners, site.findings)
    if pair is None:
        return None
    instance = owner_at(pair[0], origin, site.owners, site.findings)
    if isinstance(instance, Placed):
        _refuse_composite(instance, pair[1], origin, site.findings)
        return None
    parts = None if instance is None else site.parts(instance)
    return None if instance is None or parts is None else (instance, parts, pair[1])


def _refuse_composite(at: Placed, name: str, origin: Origin, findings: Findings) -> None:
    """Report a row or event of a composite, which has none of its own."""
    known = at.composite.inside
    if known.look_up(name, origin, findings) is not None:
        message = f"expected a row or event, found the instance {at.name}.{name}"
        hint = "add the name of what is meant inside it"
        findings.error("RV-0808", origin, message, hint=hint)


def ends_at(text: str, origin: Origin, wanted: Direction, site: DeploymentNames) -> Ends:
    """The ports of the wanted direction that ``instance.port`` names; none where it is wrong.

    That of a composite are those that it leads to.
    """
    findings = site.findings
    pair = split(text, "instance.port", origin, site.owners, findings)
    owner = None if pair is None else owner_at(pair[0], origin, site.owners, findings)
    if pair is None or owner is None or not reached(owner, origin, "port", findings):
        return ()
    of: Parts | Composite | None
    of = owner.composite if isinstance(owner, Placed) else site.parts(owner)
    port = None if of is None else connectable(of).look_up(pair[1], origin, findings)
    if of is None or port is None:
        return ()
    if port.direction is not wanted:
        other = Direction.IN if wanted is Direction.OUT else Direction.OUT
        key = "from" if wanted is Direction.OUT else "to"
        message = (
            f"{owner.name}.{port.name} is an {other.value}put port; `{key}` takes an "
            f"{wanted.value}put port"
        )
        notes = [(port.origin, f"`{port.name}` is declared here")]
        findings.error("RV-0601", origin, message, notes=notes)
        return ()
    found = within(owner.name, of, port)
    if not found:
        findings.lose()
    return found


def reached(owner: Instance | Placed, origin: Origin, kind: str, findings: Findings) -> bool:
    """Whether a port or interface of an instance can be used: not that of one inside another."""
    around, dot, name = owner.name.rpartition(".")
    if dot:
        message = f"{name} is inside {around}: nothing outside is joined to its {kind}s"
        hint = f"give {around} {kind}s of its own that lead to it"
        findings.error("RV-0808", origin, message, hint=hint)
    return not dot


def event_at(text: str, origin: Origin, site: DeploymentNames) -> tuple[str, str] | None:
    """The (instance, event) that ``instance.Event`` names."""
    found = member_of(text, "instance.Event", origin, site)
    if found is None:
        return None
    instance, parts, own = found
    named = NameScope(f"event of {instance.component.name}", parts.members.events.items)
    named.open = parts.members.events.open
    event = named.look_up(own, origin, site.findings)
    if event is not None and event.type is not None:
        message = f"the event {event.name} needs a value of type {event.type.name}"
        site.findings.error("RV-0528", origin, message, hint="name an event without a type")
    return None if event is None else (instance.name, event.name)


def outermost(owners: Owners) -> Iterator[Placed]:
    """The composites of the system itself: none inside another."""
    for one in owners.sound():
        if isinstance(one, Placed) and "." not in one.name:
            yield one
