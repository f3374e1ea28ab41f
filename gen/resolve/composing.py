# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The forms of composite components resolved: their insides, and the ends of their ports."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import product

from ravenchart.gen.diagnostics import warning
from ravenchart.gen.files.schema import ComponentForm
from ravenchart.gen.files.schema_base import Element
from ravenchart.gen.files.schema_deployment import InnerConnectionForm, plain_parameters
from ravenchart.gen.files.schema_devices import InnerBindingForm, ProvidedForm, RequiredForm
from ravenchart.gen.files.schema_ports import InputForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.language.terms import Type
from ravenchart.gen.model.commands import Command
from ravenchart.gen.model.component import Data, Direction, Port
from ravenchart.gen.model.instances import Connection, End

from .components import Parts
from .composites import (
    MOST_INSTANCES,
    Composite,
    Ends,
    InnerBinding,
    Inside,
    Interface,
    connectable,
    provided_by,
    required_by,
    within,
)
from .interfaces import named_commands
from .members import Members, Namespace, parameters_of

OWN_BEHAVIOUR = ("port_region", "events", "data", "regions", "activities", "never")
"""Keys of a component that runs by itself, which no composite has."""

OF_COMPOSITES = ("instances", "connections", "bindings")
"""Keys of a composite."""

OF_DELEGATED = ("in", "out", "req")
"""Keys of a port that leads to another."""

OF_SERVERS = ("queue", "served_by", "published", "events", "protocol")
"""Keys of an interface that belong to who requires or provides it in the end."""


def is_composite(form: ComponentForm) -> bool:
    """Whether a component is made of instances of others."""
    return form.instances is not None or form.lost("instances")


def refuse_inner_keys(name: str, form: ComponentForm, findings: Findings) -> None:
    """Report what only a composite has, in a component that is none."""
    for key in OF_COMPOSITES[1:]:
        if form.has(key):
            message = f"`{key}` has no meaning in {name}, which has no instances inside"
            hint = "add `instances:`, or remove the key"
            findings.error("RV-0806", form.at_key(key), message, hint=hint)


@dataclass(slots=True)
class Components:
    """The components of a model, each resolved when it is asked for first."""

    forms: NameScope[ComponentForm]
    plain: Callable[[str, ComponentForm], Parts]
    """Resolves a component without others inside it."""
    types: NameScope[Type]
    dictionary: NameScope[Command]
    system: str
    findings: Findings
    made: dict[str, Parts | Composite | None] = field(default_factory=dict)
    under_way: list[str] = field(default_factory=list)

    def of(self, name: str, form: ComponentForm) -> Parts | Composite | None:
        """A component; None where an instance inside it cannot be resolved."""
        key = name.lower()
        if key in self.made and self.forms.find(name) is form:
            return self.made[key]
        if not is_composite(form):
            refuse_inner_keys(name, form, self.findings)
            made: Parts | Composite | None = self.plain(name, form)
        else:
            self.under_way.append(name)
            made = _Composing(name, form, self).made()
            self.under_way.pop()
        return self.made.setdefault(key, made)

    def inside(self, name: str, form: Element) -> Parts | Composite | None:
        """The component of an instance inside another; reported where there is none."""
        at = form.at("component")
        found = self.forms.look_up(name, at, self.findings)
        if found is None:
            return None
        declared = self.forms.items[name.lower()][0]
        if declared in self.under_way:
            ring = [*self.under_way[self.under_way.index(declared) :], declared]
            message = f"the component {declared} contains itself: {' -> '.join(ring)}"
            hint = "take the instance out of one of them"
            self.findings.error("RV-0805", at, message, hint=hint)
            return None
        return self.of(declared, found)


class _Composing:
    """One composite as it is resolved."""

    def __init__(self, name: str, form: ComponentForm, known: Components) -> None:
        self.name, self.form, self.known = name, form, known
        self.findings = known.findings
        self.before = known.findings.count()
        #  no unit is called like the composite, so nothing in it hides one of that name
        self.space = Namespace("", "", known.findings)
        self.inside: NameScope[Inside] = NameScope(f"instance of {name}")
        self.inside.open = form.lost("instances")
        self.leads: dict[str, Ends] = {}
        self.connections: list[Connection] = []
        self.bindings: list[InnerBinding] = []
        self.given: set[str] = set()
        """The ports and interfaces of its own that something is joined to, in lower case."""

    def made(self) -> Composite | None:
        """The composite; None where it would be too large."""
        name, form = self.name, self.form
        for key in OWN_BEHAVIOUR:
            if form.has(key):
                message = f"`{key}` has no meaning in {name}, which has instances inside"
                hint = "put it into a component of its own, with an instance here"
                self.findings.error("RV-0806", form.at_key(key), message, hint=hint)
        members = self._members()
        for own, at in (form.instances or {}).items():
            self.space.claim("instance", own, at.origin)
            of = self.known.inside(at.component, at)
            inside = None if of is None else Inside(own, at, of)
            self.inside.declare(own, at.origin, inside, self.findings)
        for gone in form.dropped("instances"):
            self.inside.declare(gone, None, None)
        size = sum(_size(one.of) for one in self.inside.sound())
        if size > MOST_INSTANCES:
            message = f"{name} has {size:,} instances inside; the limit is {MOST_INSTANCES:,}"
            self.findings.error("RV-0209", form.at_key("instances"), message)
            return None
        requires = self._interfaces("required interface", "requires", form.requires or {})
        provides = self._interfaces("provided interface", "provides", form.provides or {})
        self._join_ports(members)
        self._join_interfaces(requires, provides)
        self._nothing_is_left(members, requires, provides)
        for one in self.inside.sound():
            if isinstance(one.of, Composite):
                self.connections += (_under(one.name, wire) for wire in one.of.connections)
                self.bindings += (binding.under(one.name) for binding in one.of.bindings)
        return Composite(
            name,
            form.origin,
            members,
            self.inside,
            self.leads,
            requires,
            provides,
            tuple(self.connections),
            tuple(self.bindings),
            size,
            self.findings.count() > self.before or form.damaged,
        )

    def _members(self) -> Members:
        """Its parameters and ports. A port that leads to another has direction and type only."""
        form, findings = self.form, self.findings
        parameters = parameters_of(form, self.known.types, self.space)
        ports: NameScope[Port] = NameScope("port", open=form.lost("ports"))
        for gone in form.dropped("ports"):
            ports.declare(gone, None, None)
        for name, at in (form.ports or {}).items():
            self.space.claim("port", name, at.origin)
            for key in (key for key in at.tree if key not in OF_DELEGATED):
                message = f"`{key}` has no meaning for {name}, which leads to another port"
                hint = "give it to the port that it leads to"
                findings.error("RV-0806", at.at_key(key), message, hint=hint)
            key, text = ("in", at.in_) if isinstance(at, InputForm) else ("out", at.out)
            type_ = self.known.types.look_up(text, at.at(key), findings)
            port = None if type_ is None else Port(name, at.origin, Direction(key), type_)
            ports.declare(name, at.origin, port, findings)
        data: NameScope[Data] = NameScope("data item")
        return Members(parameters, ports, NameScope("event"), data, NameScope("data item"))

    # --- ports

    def _join_ports(self, members: Members) -> None:
        """Connections between instances, and those that delegate a port."""
        for form in self.form.connections or ():
            source = self._ends(form, "from", form.from_, members)
            target = self._ends(form, "to", form.to, members)
            if source is None or target is None:
                continue
            (own_source, sent), (own_target, taken) = source, target
            if own_source is not None and own_target is not None:
                message = f"{own_source.name} and {own_target.name} are both ports of {self.name}"
                hint = "a port of a composite leads to that of an instance inside it"
                self.findings.error("RV-0601", form.origin, message, hint=hint)
            elif own_source is not None:
                self._delegate(form, own_source, taken)
            elif own_target is not None:
                self._delegate(form, own_target, sent)
            else:
                self.connections += (
                    Connection(form.origin, start, end)
                    for (start, _), (end, _) in product(sent, taken)
                )

    def _ends(
        self, form: InnerConnectionForm, key: str, text: str, members: Members
    ) -> tuple[Port | None, Ends] | None:
        """The own port, or what that of an instance leads to; None where there is none."""
        at, (owner, dot, name) = form.at(key), text.rpartition(".")
        wanted, other = Direction.OUT, Direction.IN
        if (key == "from") != bool(dot):
            wanted, other = other, wanted
        inside = self._inside(owner, text, "port", form, key) if dot else None
        if dot and inside is None:
            return None
        ports = members.ports if inside is None else connectable(inside.of)
        port = ports.look_up(name, at, self.findings)
        if port is None:
            return None
        if port.direction is not wanted:
            whose = "an instance" if dot else f"{self.name} itself"
            message = (
                f"{text} is an {other.value}put port; `{key}` takes an {wanted.value}put port of "
                f"{whose}"
            )
            notes = [(port.origin, f"`{port.name}` is declared here")]
            self.findings.error("RV-0601", at, message, notes=notes)
            return None
        if inside is None:
            return port, ()
        return None, within(inside.name, inside.of, port)

    def _delegate(self, form: InnerConnectionForm, own: Port, ends: Ends) -> None:
        """An own port leads to these ports: an input to any number, an output from one."""
        key = own.name.lower()
        if own.direction is Direction.OUT and key in self.given:
            message = f"the output port {own.name} of {self.name} has two sources"
            hint = "give the second an output port of its own"
            self.findings.error("RV-0807", form.origin, message, hint=hint)
            return
        self.given.add(key)
        for end, port in ends:
            if port.type != own.type:
                message = f"{own.name} is of type {own.type.name}, but {end} is of {port.type.name}"
                notes = [(own.origin, f"`{own.name}` is declared here")]
                self.findings.error("RV-0605", form.origin, message, notes=notes)
        self.leads[key] = (*self.leads.get(key, ()), *ends)

    def _inside(self, owner: str, text: str, kind: str, form: Element, key: str) -> Inside | None:
        """The instance that an end of a connection or binding names."""
        if "." in owner or not owner:
            message = f"`{text}` must have the form instance.{kind}"
            around = owner.partition(".")[0]
            hint = f"what is inside {around} is reached by its own {kind}s" if around else None
            self.findings.error("RV-0306", form.at(key), message, hint=hint)
            return None
        return self.inside.look_up(owner, form.at(key), self.findings)

    # --- interfaces

    def _interfaces(
        self, kind: str, section: str, forms: dict[str, RequiredForm] | dict[str, ProvidedForm]
    ) -> NameScope[Interface]:
        """Its own interfaces, before it is known what they lead to."""
        scope: NameScope[Interface] = NameScope(f"{kind} of {self.name}")
        scope.open = self.form.lost(section)
        for gone in self.form.dropped(section):
            scope.declare(gone, None, None)
        for name, form in forms.items():
            self.space.claim(kind, name, form.origin)
            for key in OF_SERVERS:
                if form.has(key):
                    message = f"`{key}` has no meaning for {name}, which leads to another interface"
                    hint = "list the names of all its commands and events under `commands`"
                    if key == "protocol":
                        hint = f"move it to the component that provides {name} in the end"
                    self.findings.error("RV-0806", form.at_key(key), message, hint=hint)
            commands: set[str] = set()
            damaged = form.damaged
            for text, at, said in named_commands(form):
                command = self.known.dictionary.look_up(text, at, self.findings)
                commands |= set() if command is None else {command.name}
                damaged = damaged or command is None
                if said is not None and said.tree:
                    message = f"{text} has no properties here: {name} leads to another interface"
                    hint = "give them to the interface that requires it in the end"
                    self.findings.error("RV-0806", at, message, hint=hint)
            interface = Interface(name, form.axes, frozenset(commands), is_damaged=damaged)
            scope.declare(name, form.origin, interface, self.findings)
        return scope

    def _join_interfaces(
        self, requires: NameScope[Interface], provides: NameScope[Interface]
    ) -> None:
        """Bindings between instances, and those that delegate an interface."""
        for form in self.form.bindings or ():
            caller = self._interface(form, "from", form.from_, provides)
            server = self._interface(form, "to", form.to, requires)
            if caller is None or server is None:
                continue
            calls_itself, serves_itself = "." not in form.from_, "." not in form.to
            if calls_itself and serves_itself:
                message = f"{caller.name} and {server.name} are both interfaces of {self.name}"
                hint = "an interface of a composite leads to that of an instance inside it"
                self.findings.error("RV-0807", form.origin, message, hint=hint)
            elif calls_itself:
                self._lead(form, provides, caller, server)
            elif serves_itself:
                self._lead(form, requires, server, caller)
            elif server.server is not None:
                self.bindings += (
                    InnerBinding(form, path, own, server.server) for path, own in caller.requirers
                )

    def _interface(
        self,
        form: InnerBindingForm,
        key: str,
        text: str,
        own: NameScope[Interface],
    ) -> Interface | None:
        """An own interface, or that of an instance as it is seen from here."""
        owner, dot, name = text.rpartition(".")
        if not dot:
            return own.look_up(text, form.at(key), self.findings)
        inside = self._inside(owner, text, "interface", form, key)
        if inside is None:
            return None
        of = inside.of
        if isinstance(of, Composite):
            known = of.requires if key == "from" else of.provides
        else:
            known = (required_by if key == "from" else provided_by)(
                of.component, damaged=of.is_damaged
            )
        found = known.look_up(name, form.at(key), self.findings)
        return None if found is None else found.under(inside.name)

    def _lead(
        self, form: InnerBindingForm, scope: NameScope[Interface], own: Interface, to: Interface
    ) -> None:
        """An own interface leads to another of the same commands: a required one to several."""
        key = own.name.lower()
        declared = scope.items[key][1] or form.origin
        if to.server is not None and key in self.given:
            message = f"the interface {own.name} of {self.name} leads to two providers"
            hint = "give the second an interface of its own"
            self.findings.error("RV-0807", form.origin, message, hint=hint)
            return
        self.given.add(key)
        end = form.to if to.server is not None else form.from_
        for names, has, lacks in (
            (own.commands - to.commands, own.name, end),
            (to.commands - own.commands, end, own.name),
        ):
            if names and not (own.is_damaged or to.is_damaged):
                message = f"{has} has {', '.join(sorted(names))}, which {lacks} lacks"
                notes = [(declared, f"`{own.name}` is declared here")]
                hint = f"list under `commands` of {own.name} what {end} has"
                self.findings.error("RV-0807", form.origin, message, notes=notes, hint=hint)
        if to.axes not in (0, own.axes):
            message = f"{own.name} works on {own.axes} axes, but {end} on {to.axes}"
            self.findings.error("RV-1205", form.origin, message, hint="change `axes` of one")
        known = scope.find(own.name) or own
        joined = replace(
            known, requirers=(*known.requirers, *to.requirers), server=to.server or known.server
        )
        scope.items[key] = own.name, declared, joined

    # --- the whole

    def _parameters_are_passed(self, members: Members) -> None:
        """A warning for each parameter that no instance inside is given."""
        given = (plain_parameters(one.form) for one in self.inside.sound())
        passed = {str(text).lower() for values in given for text in values.values()}
        for one in members.parameters.sound():
            if one.name.lower() not in passed:
                message = f"{self.name} passes the parameter {one.name} to no instance"
                self.findings.items.append(warning("RV-0534", one.origin, message))

    def _nothing_is_left(
        self, members: Members, requires: NameScope[Interface], provides: NameScope[Interface]
    ) -> None:
        """Every own port and interface leads somewhere, and every parameter is passed on."""
        form, findings = self.form, self.findings
        lost = any(form.list_damaged(key) or form.lost(key) for key in OF_COMPOSITES)
        if lost or self.inside.has_lost() or findings.count() > self.before:
            return
        self._parameters_are_passed(members)
        for port in members.ports.sound():
            if port.name.lower() not in self.given:
                way = "from" if port.direction is Direction.OUT else "to"
                message = f"the {port.direction.value}put port {port.name} of {self.name} leads "
                message += "to no port inside" if way == "to" else "from no port inside"
                entry = (
                    f"from: {port.name}, to: ..." if way == "to" else f"from: ..., to: {port.name}"
                )
                hint = f"add `- {{{entry}}}` under `connections:` of {self.name}"
                findings.error("RV-0807", port.origin, message, hint=hint)
        for scope, entry in ((requires, "from: ..., to: {}"), (provides, "from: {}, to: ...")):
            for name, origin, _ in scope.items.values():
                if name.lower() not in self.given:
                    message = f"the interface {name} of {self.name} leads to none inside"
                    hint = f"add `- {{{entry.format(name)}}}` under `bindings:` of {self.name}"
                    findings.error("RV-0807", origin or form.origin, message, hint=hint)


def _size(of: Parts | Composite) -> int:
    return of.size if isinstance(of, Composite) else 1


def _under(path: str, wire: Connection) -> Connection:
    """A connection in the instance at the path."""
    source = End(f"{path}.{wire.source.instance}", wire.source.name)
    target = End(f"{path}.{wire.target.instance}", wire.target.name)
    return Connection(wire.origin, source, target)
