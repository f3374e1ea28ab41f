# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Instances of a deployment: those that the model names, and those inside composite ones.

An instance inside another is called by its path, `arm.shoulder`; its origin is where its
composite names it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from ravenchart.gen.files.schema_deployment import (
    ConnectionForm,
    InnerInstanceForm,
    InstanceForm,
    plain_parameters,
)
from ravenchart.gen.files.schema_devices import BindingForm
from ravenchart.gen.language.names import Findings, NameScope, NameUse
from ravenchart.gen.language.terms import Scalar
from ravenchart.gen.model.component import Direction, Parameter
from ravenchart.gen.model.instances import Connection, Delegation, End, Instance

from .components import Parts
from .composites import Composite, within
from .paths import DeploymentNames, Placed, ends_at, outermost
from .values import constant


@dataclass(frozen=True, slots=True)
class Passing:
    """The parameters of the composite around an instance, and their values by name in lower case.

    A parameter whose declaration is wrong has none.
    """

    declared: NameScope[Parameter]
    values: Mapping[str, tuple[Parameter, Scalar | None]]


TOP = Passing(NameScope("parameter"), {})
"""Around the instances of the model itself there is nothing."""


def place_instance(name: str, form: InstanceForm, site: DeploymentNames) -> None:
    """Declare an instance and those inside it; without an item where it is not sound."""
    findings = site.findings
    of = site.components.look_up(form.component, form.at("component"), findings)
    node = site.nodes.look_up(form.node, form.at("node"), findings)
    if of is None or node is None:
        if isinstance(of, Parts):
            values_of(name, form, of.members.parameters, TOP, findings)
        site.owners.declare(name, form.origin, None, findings)
        site.instances.declare(name, form.origin, None)
        return
    _Placing(site, node.name).declare(name, form, of, TOP, ())


@dataclass(frozen=True, slots=True)
class _Placing:
    """One instance of the model, with all that is inside."""

    site: DeploymentNames
    node: str
    composites: tuple[str, ...] = ()
    """The composite components around, outermost first."""

    def declare(
        self,
        path: str,
        form: InstanceForm | InnerInstanceForm,
        of: Parts | Composite,
        around: Passing,
        delegations: tuple[Delegation, ...],
    ) -> None:
        """Declare the instance at the path, with its parameters, and those inside it."""
        site, origin = self.site, form.origin
        values = values_of(path, form, of.members.parameters, around, site.findings)
        if isinstance(of, Parts):
            own = tuple(
                (p.name, value)
                for p in of.component.parameters
                if (value := values[p.name.lower()][1]) is not None
            )
            theirs = tuple(one for one in delegations if one.end.instance == path)
            made = Instance(path, origin, of.component, self.node, own, theirs, self.composites)
            if site.owners.declare(path, origin, made, site.findings):
                site.instances.declare(path, origin, made)
            return
        if not site.owners.declare(path, origin, Placed(path, origin, of), site.findings):
            return
        known = {(one.end.instance, one.end.name) for one in delegations}
        own_ends = (one for one in _delegations(path, form, of))
        delegations = (
            *delegations,
            *(one for one in own_ends if (one.end.instance, one.end.name) not in known),
        )
        passing = Passing(of.members.parameters, values)
        placing = replace(self, composites=(*self.composites, of.name))
        for inside in of.inside.sound():
            inner = f"{path}.{inside.name}"
            placing.declare(inner, inside.form, inside.of, passing, delegations)


def _delegations(
    path: str, form: InstanceForm | InnerInstanceForm, of: Composite
) -> Iterator[Delegation]:
    """The ends that the ports and interfaces of a composite lead to."""
    for port in of.members.ports.sound():
        for end, _ in within(path, of, port):
            yield Delegation(end, f"{path}.{port.name}", form.origin)
    for one in of.requires.sound():
        for inner, interface in one.requirers:
            yield Delegation(End(f"{path}.{inner}", interface), f"{path}.{one.name}", form.origin)


def values_of(
    name: str,
    form: InstanceForm | InnerInstanceForm,
    declared: NameScope[Parameter],
    around: Passing,
    findings: Findings,
) -> dict[str, tuple[Parameter, Scalar | None]]:
    """The value of each parameter: given, passed by the composite around it, or the default."""
    own = plain_parameters(form)
    given = {key.lower(): key for key in own}
    lost = {key.lower() for key in form.dropped("parameters")}
    for key in given.values():
        declared.look_up(key, form.entry_at("parameters", key), findings)
    values: dict[str, tuple[Parameter, Scalar | None]] = {}
    for parameter in declared.sound():
        entry = given.get(parameter.name.lower())
        value = parameter.default
        if entry is not None:
            text = own[entry]
            if isinstance(text, str) and around.declared.knows(text):
                value = _passed(form, entry, parameter, around.values.get(text.lower()), findings)
            else:
                place = form.place("parameters", entry)
                value = constant(text, place, parameter.name, parameter.type, findings)
        elif value is None and parameter.name.lower() not in lost and not form.lost("parameters"):
            message = f"{name} does not set the parameter `{parameter.name}`, which has no default"
            notes = [(parameter.origin, f"`{parameter.name}` is declared here")]
            hint = f"add `parameters: {{{parameter.name}: ...}}`"
            findings.error("RV-0314", form.origin, message, notes=notes, hint=hint)
        values[parameter.name.lower()] = parameter, value
    return values


def _passed(
    form: InstanceForm | InnerInstanceForm,
    entry: str,
    parameter: Parameter,
    given: tuple[Parameter, Scalar | None] | None,
    findings: Findings,
) -> Scalar | None:
    """The value of a parameter of the composite around an instance, for one of its own type.

    None, without another word, where the declaration of that parameter is wrong.
    """
    if given is None:
        findings.lose()
        return None
    own, value = given
    at = form.place("parameters", entry).origin
    findings.uses.append(NameUse(own.name, at, "parameter", own.origin))
    if own.type != parameter.type:
        message = (
            f"`{parameter.name}` must be of type {parameter.type.name}, but the parameter "
            f"{own.name} is of {own.type.name}"
        )
        notes = [(own.origin, f"`{own.name}` is declared here")]
        findings.error("RV-0312", at, message, notes=notes)
        return None
    if value is None:
        findings.lose()
    return value


def connection_of(form: ConnectionForm, site: DeploymentNames) -> tuple[Connection, ...]:
    """The connections between the ports that both ends lead to; none where one is wrong."""
    sources = ends_at(form.from_, form.at("from"), Direction.OUT, site)
    targets = ends_at(form.to, form.at("to"), Direction.IN, site)
    bus = bus_between(form, site)
    return tuple(
        Connection(form.origin, source, target, bus)
        for source, _ in sources
        for target, _ in targets
    )


def bus_between(form: ConnectionForm | BindingForm, site: DeploymentNames) -> str | None:
    """The bus that a connection or binding names, which must exist; None: the only one."""
    if form.bus is None:
        return None
    found = site.buses.look_up(form.bus, form.at("bus"), site.findings)
    if found is None:
        found = next(iter(site.buses.sound()), None)  # that it has no bus is no second error
    return found.name if found is not None and len(site.buses.names()) > 1 else None


def inner_connections(site: DeploymentNames) -> Iterator[Connection]:
    """The connections inside composite instances."""
    for one in outermost(site.owners):
        for wire in one.composite.connections:
            source = replace(wire.source, instance=f"{one.name}.{wire.source.instance}")
            target = replace(wire.target, instance=f"{one.name}.{wire.target.instance}")
            yield Connection(wire.origin, source, target)
