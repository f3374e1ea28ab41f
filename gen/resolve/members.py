# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The members of a component: parameters, ports, events and data, and their names."""

from __future__ import annotations

from dataclasses import dataclass, field

from ravenchart.gen.files.schema import ComponentForm, InvariantForm
from ravenchart.gen.files.schema_ports import InputForm, OutputForm
from ravenchart.gen.language.names import HIDING, Findings, NameScope
from ravenchart.gen.language.terms import Ns, Reading, Type
from ravenchart.gen.model.component import (
    PORTS,
    Data,
    Direction,
    Event,
    Invariant,
    Parameter,
    Port,
    PortKind,
)
from ravenchart.gen.model.statechart import DONE, Overflow
from ravenchart.gen.origins import Origin

from .chart_names import walk
from .typed import condition
from .values import initial_value, parameter
from .vocabulary import EVENT, Vocabulary

GROUP = "group of ports"
"""The kind of the groups of a port region, in messages."""

TABLE_WORDS = (PORTS, "receive")
"""The names of the port region and of a bus's reception in tables."""

RENAMED = ("state", "transition", "event")
"""Kinds of elements that get another name in Ada where theirs is one of Ada's."""


@dataclass(slots=True)
class Namespace:
    """The one namespace of a component, and the names that nothing in it can have."""

    component: str
    system: str
    findings: Findings
    taken: dict[str, tuple[str, str, Origin]] = field(default_factory=dict)

    def claim(self, kind: str, name: str, origin: Origin) -> None:
        """Report a name that another element of the component, or a unit, has."""
        self.avoid(kind, name, origin)
        known = self.taken.setdefault(name.lower(), (kind, name, origin))
        if known[0] != kind:  # two of one kind are reported by their scope
            message = f"the {kind} `{name}` is named like the {known[0]} `{known[1]}`"
            self.findings.error(
                "RV-0303",
                origin,
                message,
                notes=[(known[2], f"the {known[0]} is here")],
                hint="rename one of them; the names in a component are all different",
            )

    def avoid(self, kind: str, name: str, origin: Origin) -> None:
        """Report a name that would hide a unit of the generated program."""
        what = None
        if name.lower() == self.component.lower():
            what = f"its component {self.component}"
        elif name.lower() == self.system.lower():
            what = f"the system {self.system}"
        elif kind not in RENAMED and name.lower() in HIDING:
            what = "a unit, type or value of Ada that the generated program uses"
        elif kind in ("region", "activity", GROUP) and name.lower() in TABLE_WORDS:
            what = "a row that tables have anyway"
        if what is not None:
            message = f"the {kind} `{name}` is named like {what}"
            self.findings.error("RV-0304", origin, message, hint="choose another name")


@dataclass(frozen=True, slots=True)
class Members:
    """The members of a component by name; those that were wrong keep their names."""

    parameters: NameScope[Parameter]
    ports: NameScope[Port]
    events: NameScope[Event]
    data: NameScope[Data]
    data_types: NameScope[Type]


def members_of(form: ComponentForm, types: NameScope[Type], space: Namespace) -> Members:
    """The members of a component, each checked by itself."""
    for region, at_region in (form.regions or {}).items():
        for state, at_state, _, _ in walk(at_region.states):
            space.avoid("state", state, at_state.origin)
            for nested, inside in (at_state.regions or {}).items():
                space.avoid("nested region", nested, inside.origin)
        for name, transition in (at_region.transitions or {}).items():
            space.avoid("transition", name, transition.origin)
        space.claim("region", region, at_region.origin)
    for name, activity in (form.activities or {}).items():
        space.claim("activity", name, activity.origin)
    events = _events(form, types, space)
    data, data_types = _data(form, types, space)
    parameters, ports = parameters_of(form, types, space), _ports(form, types, events, space)
    carrying = next((event for event in events.sound() if event.type is not None), None)
    for scope in (parameters, ports, data):
        name, origin, _ = scope.items.get(EVENT, ("", None, None))
        if carrying is not None and origin is not None:
            message = f"the {scope.kind} `{name}` hides the value of events"
            notes = [(carrying.origin, f"{carrying.name} carries one, called `{EVENT}` in guards")]
            hint = "choose another name"
            space.findings.error("RV-0304", origin, message, notes=notes, hint=hint)
    return Members(parameters, ports, events, data, data_types)


def _events(form: ComponentForm, types: NameScope[Type], space: Namespace) -> NameScope[Event]:
    scope: NameScope[Event] = NameScope("event")
    scope.open = form.lost("events") or form.list_damaged("events")
    for gone in form.dropped("events"):
        scope.declare(gone, None, None)
    made: list[tuple[str, Origin, Event | None]] = []
    if isinstance(form.events, dict):
        for name, at in form.events.items():
            findings = space.findings
            type_ = None if at.type is None else types.look_up(at.type, at.at("type"), findings)
            overflow = None if at.overflow is None else Overflow(at.overflow)
            sound = type_ is not None or at.type is None
            external = at.external is True
            event = Event(name, at.origin, type_, overflow, external) if sound else None
            made.append((name, at.origin, event))
    else:
        for index, name in enumerate(form.events or ()):
            origin = form.item_at("events", index)
            made.append((name, origin, Event(name, origin)))
    for name, origin, event in made:
        space.claim("event", name, origin)
        if name.lower() == DONE:
            message = f"an event cannot be named `{name}`: do activities raise it"
            hint = "choose another name; `raise: done` completes the state of a do activity"
            space.findings.error("RV-0304", origin, message, hint=hint)
        scope.declare(name, origin, event, space.findings)
    return scope


def parameters_of(
    form: ComponentForm, types: NameScope[Type], space: Namespace
) -> NameScope[Parameter]:
    """The constants that instances of a component set."""
    scope: NameScope[Parameter] = NameScope("parameter", open=form.lost("parameters"))
    for gone in form.dropped("parameters"):
        scope.declare(gone, None, None)
    findings = space.findings
    for name, at in (form.parameters or {}).items():
        space.claim("parameter", name, at.origin)
        given = parameter(name, at, types, findings)
        made = None if given is None else Parameter(name, at.origin, *given)
        scope.declare(name, at.origin, made, findings)
    return scope


def _ports(
    form: ComponentForm, types: NameScope[Type], events: NameScope[Event], space: Namespace
) -> NameScope[Port]:
    scope: NameScope[Port] = NameScope("port", open=form.lost("ports"))
    for gone in form.dropped("ports"):
        scope.declare(gone, None, None)
    findings = space.findings
    for name, at in (form.ports or {}).items():
        space.claim("port", name, at.origin)
        made: Port | None
        if isinstance(at, OutputForm):
            type_ = types.look_up(at.out, at.at("out"), findings)
            made = None if type_ is None else Port(name, at.origin, Direction.OUT, type_)
        else:
            made = _input(name, at, types, events, findings)
        scope.declare(name, at.origin, made, findings)
    return scope


def _input(
    name: str, form: InputForm, types: NameScope[Type], events: NameScope[Event], findings: Findings
) -> Port | None:
    type_ = types.look_up(form.in_, form.at("in"), findings)
    raised: dict[str, str | None] = {}
    for key, event in (
        ("on_arrival", form.on_arrival),
        ("on_stale", form.on_stale),
        ("on_overflow", form.on_overflow),
    ):
        raised[key] = None
        if event is not None:
            found = events.look_up(event, form.at(key), findings)
            raised[key] = None if found is None else found.name
            if found is not None and type_ is not None:
                _check_carried(key, name, type_, found, form.at(key), findings)
    kind_known = not form.lost("kind")
    if form.kind == "sampled" and kind_known:
        for key in ("depth", "overflow", "on_overflow"):
            if form.has(key):
                message = f"`{key}` has no meaning for the sampled port {name}"
                hint = f"add `kind: queued`, or remove `{key}`"
                findings.error("RV-0210", form.at_key(key), message, hint=hint)
    elif form.depth is None and not form.lost("depth") and kind_known:
        message = f"the queued port {name} needs the key `depth`"
        hint = "give the number of values that may wait, such as `depth: 4`"
        findings.error("RV-0202", form.origin, message, hint=hint)
    if form.on_stale is not None and form.max_age is None and not form.lost("max_age"):
        message = "`on_stale` has no meaning without `max_age`"
        hint = f"give the age from which {name} is stale, such as `max_age: 100 ms`"
        findings.error("RV-0210", form.at_key("on_stale"), message, hint=hint)
    if type_ is None:
        return None
    return Port(
        name=name,
        origin=form.origin,
        direction=Direction.IN,
        type=type_,
        kind=PortKind(form.kind),
        depth=form.depth or 1,
        overflow=Overflow(form.overflow or "reject_newest"),
        max_age=None if form.max_age is None else Ns(form.max_age),
        on_arrival=raised["on_arrival"],
        on_stale=raised["on_stale"],
        on_overflow=raised["on_overflow"],
    )


def _check_carried(
    key: str, port: str, type_: Type, event: Event, origin: Origin, findings: Findings
) -> None:
    """A port gives an event its value by `on_arrival` only, and of its own type only."""
    if event.type is None or (key == "on_arrival" and event.type is type_):
        return
    if key == "on_arrival":
        message = f"{event.name} carries {event.type.name}, but {port} takes {type_.name}"
        hint = "name an event of the port's type, or one without"
    else:
        message = f"`{key}` has no value for {event.name}, which carries {event.type.name}"
        hint = "name an event without a type"
    findings.error("RV-0528", origin, message, hint=hint)


def _data(
    form: ComponentForm, types: NameScope[Type], space: Namespace
) -> tuple[NameScope[Data], NameScope[Type]]:
    scope: NameScope[Data] = NameScope("data item", open=form.lost("data"))
    kinds: NameScope[Type] = NameScope("data item", open=form.lost("data"))
    for gone in form.dropped("data"):
        scope.declare(gone, None, None)
        kinds.declare(gone, None, None)
    findings = space.findings
    for name, at in (form.data or {}).items():
        space.claim("data item", name, at.origin)
        type_ = types.look_up(at.type, at.at("type"), findings)
        made = None
        if type_ is not None:
            initial = initial_value(at, at.initial, name, type_, findings)
            made = None if initial is None else Data(name, at.origin, type_, initial)
        scope.declare(name, at.origin, made, findings)
        kinds.declare(name, at.origin, type_)
    return scope, kinds


def invariants_of(
    form: ComponentForm, words: Vocabulary, findings: Findings
) -> tuple[Invariant, ...]:
    """The invariants: conditions that shall never hold."""
    scope: NameScope[Invariant] = NameScope("invariant")
    for name, text in (form.never or {}).items():
        origin = form.entry_at("never", name)
        place = form.place("never", name)
        if isinstance(text, InvariantForm):
            place = text.place("condition")
            text = text.condition
        met = condition(text, place, words, findings, name)
        made = None if met is None else Invariant(name, origin, met)
        scope.declare(name, origin, made, findings)
    return scope.sound()


def vocabulary_of(
    members: Members, regions: NameScope[NameScope[str]], literals: frozenset[str]
) -> Vocabulary:
    """The names that the expressions of the component may use."""
    readable: NameScope[tuple[Reading, str, Type]] = NameScope("data item, parameter or input port")
    inputs: NameScope[str] = NameScope("input port")
    readable.open = members.ports.open or members.data_types.open or members.parameters.open
    inputs.open = members.ports.open
    for name, origin, type_ in members.data_types.items.values():
        readable.declare(name, origin, None if type_ is None else (Reading.DATA, name, type_))
    for name, origin, item in members.data.items.values():  # the required commands among them
        if not members.data_types.knows(name):
            read = None if item is None else (Reading.DATA, name, item.type)
            readable.declare(name, origin, read)
    for name, origin, found in members.parameters.items.values():
        told = None if found is None else (Reading.PARAMETER, name, found.type)
        readable.declare(name, origin, told)
    for name, origin, port in members.ports.items.values():
        if port is None:
            readable.declare(name, origin, None)
            inputs.declare(name, origin, None)
        elif port.direction is Direction.IN:
            readable.declare(name, origin, (Reading.PORT, name, port.type))
            inputs.declare(name, origin, name)
    return Vocabulary(readable, inputs, regions, literals)


def outputs_of(members: Members) -> NameScope[Type]:
    """The types of the output ports by name, required commands apart."""
    scope: NameScope[Type] = NameScope("output port", open=members.ports.open)
    for name, origin, port in members.ports.items.values():
        if port is None or (port.direction is Direction.OUT and not port.is_command):
            scope.declare(name, origin, None if port is None else port.type)
    return scope
