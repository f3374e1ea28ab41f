# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""`record` resolved: the ports, data items and regions that it names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from ravenchart.gen.files.schema import ModelFile
from ravenchart.gen.language.names import NameScope
from ravenchart.gen.language.terms import RecordType
from ravenchart.gen.model.component import Data, Port
from ravenchart.gen.model.instances import Instance
from ravenchart.gen.model.recording import RecordedItem
from ravenchart.gen.model.statechart import Region
from ravenchart.gen.origins import Origin

from .components import Parts
from .composites import connectable, within
from .paths import DeploymentNames, Placed

SHAPE = "instance.port, instance.data_item or instance.Region"
MISSING = "add the name of what is recorded"


def recorded_of(files: Sequence[ModelFile], site: DeploymentNames) -> tuple[RecordedItem, ...]:
    """The items that the files record, in their order."""
    return tuple(
        found
        for file in files
        for index, text in enumerate(file.record or ())
        for found in _recorded(text, file.item_at("record", index), site)
    )


def _recorded(text: str, origin: Origin, site: DeploymentNames) -> Iterator[RecordedItem]:
    """The items of one entry: an instance's path, an item's name, and perhaps a record's field."""
    findings = site.findings
    first, *names = text.split(".")
    if not names or "" in (first, *names):
        findings.error("RV-0306", origin, f"`{text}` must have the form {SHAPE}", hint=MISSING)
        return
    owner = site.owners.look_up(first, origin, findings)
    while isinstance(owner, Placed) and names:
        name = names.pop(0)
        ports = connectable(owner.composite)
        if not owner.composite.inside.knows(name) and ports.find(name) is not None:
            yield from _led_to(owner, ports.find(name), names, origin, site)
            return
        inside = owner.composite.inside.look_up(name, origin, findings)
        owner = None if inside is None else site.owners.find(f"{owner.name}.{inside.name}")
    if isinstance(owner, Placed) or (isinstance(owner, Instance) and len(names) not in (1, 2)):
        message = f"`{text}` must have the form {SHAPE}"
        findings.error("RV-0306", origin, message, hint=None if names else MISSING)
    parts = site.parts(owner) if isinstance(owner, Instance) else None
    if owner is None or parts is None or len(names) not in (1, 2):
        return
    item = _items(parts).look_up(names[0], origin, findings)
    if item is not None:
        yield from _with_field(owner.name, item, names[1:], origin, site)


def _led_to(
    owner: Placed,
    port: Port | None,
    fields: list[str],
    origin: Origin,
    site: DeploymentNames,
) -> Iterator[RecordedItem]:
    """The ports that the port of a composite leads to."""
    connectable(owner.composite).used(port.name if port else "", origin, site.findings)
    for end, inner in within(owner.name, owner.composite, port) if port else ():
        yield from _with_field(end.instance, inner, fields, origin, site)


def _with_field(
    instance: str,
    item: Port | Data | Region,
    fields: list[str],
    origin: Origin,
    site: DeploymentNames,
) -> Iterator[RecordedItem]:
    """The item, or its field; reported where it has none of that name."""
    if not fields:
        yield RecordedItem(origin, instance, item)
        return
    of_type = None if isinstance(item, Region) else item.type
    if not isinstance(of_type, RecordType) or len(fields) > 1:
        message = f"{instance}.{item.name} is no record, so it has no field `{'.'.join(fields)}`"
        site.findings.error("RV-0305", origin, message, hint=f"write `{instance}.{item.name}`")
        return
    known: NameScope[str] = NameScope(f"field of {of_type.name}")
    for one in of_type.fields:
        known.declare(one.name, of_type.origin, one.name)
    name = known.look_up(fields[0], origin, site.findings)
    if name is not None:
        yield RecordedItem(origin, instance, item, name)


def _items(parts: Parts) -> NameScope[Port | Data | Region]:
    """The items of an instance that can be recorded: no commands."""
    members, component = parts.members, parts.component
    kind = f"port, data item or region of {component.name}"
    scope: NameScope[Port | Data | Region] = NameScope(kind)
    scope.open = members.ports.open or members.data.open or bool(parts.damaged)
    for name, origin, port in members.ports.items.values():
        if port is None or not port.is_command:
            scope.declare(name, origin, port)
    for name, origin, data in members.data.items.values():
        if data is None or not data.is_command:
            scope.declare(name, origin, data)
    for region in component.regions:
        scope.declare(region.name, region.origin, region)
    return scope
