# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Components resolved: the meaning of their names, then their regions and activities."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from ravenchart.gen.files.schema import (
    ActivityForm,
    ComponentForm,
    RegionForm,
)
from ravenchart.gen.files.schema_deployment import ProbeForm
from ravenchart.gen.files.schema_frames import WatchForm
from ravenchart.gen.files.schema_ports import PortGroupForm, PortRegionForm
from ravenchart.gen.language.names import Findings, NameScope, Unknown, meant
from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import Flow, Ns, Type
from ravenchart.gen.model.commands import Command, Need
from ravenchart.gen.model.component import (
    PORTS,
    Activity,
    Clause,
    Component,
    Direction,
    PortGroup,
    StateRef,
)
from ravenchart.gen.model.statechart import DONE, Region, Timing
from ravenchart.gen.origins import Origin

from .chart_names import States, concurrent_states, names_of
from .chart_structure import structure_errors
from .charts import region_of
from .contracts import contract_of, sent
from .flows import Targets, Use, called_command, flow_of
from .forwarding import forwarding, only_forwards
from .interfaces import fallbacks_agree, heard_of, needs_of, provided_of, servers_serve_once
from .members import Members, Namespace, invariants_of, members_of, outputs_of, vocabulary_of
from .port_groups import groups_of
from .vocabulary import Vocabulary


@dataclass(frozen=True, slots=True)
class Parts:
    """A component as deployment sees it; what was wrong keeps its name.

    ``rows`` are the names that a processor's table may hold, ``damaged`` the
    regions and activities that had errors.
    """

    component: Component
    members: Members
    rows: NameScope[str]
    damaged: frozenset[str]
    is_damaged: bool


def timing_of(
    name: str,
    form: PortRegionForm | PortGroupForm | RegionForm | ActivityForm | ProbeForm | WatchForm,
    findings: Findings,
) -> Timing:
    """Period, WCET and deadline, checked against each other."""
    given = None if isinstance(form, ProbeForm) else form.deadline
    deadline = form.period if given is None else given
    if deadline > form.period:
        message = (
            f"the deadline of {name}, {shown(deadline)}, is longer than its period, "
            f"{shown(form.period)}"
        )
        findings.error("RV-0703", form.at("deadline"), message)
    elif form.wcet > deadline:
        limit = "period" if deadline == form.period else "deadline"
        message = f"{name} may take {shown(form.wcet)}, longer than its {limit}, {shown(deadline)}"
        findings.error("RV-0703", form.at("wcet"), message)
    return Timing(Ns(form.period), Ns(form.wcet), Ns(deadline))


def parts_of(
    name: str,
    form: ComponentForm,
    types: NameScope[Type],
    literals: frozenset[str],
    dictionary: NameScope[Command],
    system: str,
    findings: Findings,
) -> Parts:
    """A component with all its parts that are sound."""
    before = findings.count()
    space = Namespace(name, system, findings)
    members = members_of(form, types, space)
    needs = needs_of(form, dictionary, types, members, space)
    hears = heard_of(form, dictionary, types, members, findings)
    states: NameScope[NameScope[str]] = NameScope("region", open=form.lost("regions"))
    for gone in form.dropped("regions"):
        states.declare(gone, None, None)
    damaged: set[str] = set()
    names: dict[str, States] = {}
    for region, at in (form.regions or {}).items():
        count = findings.count()
        names[region] = names_of(region, at, findings)
        states.declare(region, at.origin, names[region], findings)
        if findings.count() > count or at.damaged:
            damaged.add(region)
    words = vocabulary_of(members, states, literals)
    outputs, calls = outputs_of(members), _calls(form, members, needs)
    targets = Targets(members.data_types, outputs, members.events, calls)
    regions: list[Region] = []
    activities: NameScope[Activity] = NameScope("activity", open=form.lost("activities"))
    for gone in form.dropped("activities"):
        activities.declare(gone, None, None)
    for region, at in (form.regions or {}).items():
        count = findings.count()
        timing = timing_of(region, at, findings)
        own = replace(words, own_region=region, concurrent=concurrent_states(at.states))
        made = region_of(region, at, timing, names[region], own, targets, findings)
        regions.append(made)
        if findings.count() == count and region not in damaged:
            findings.items.extend(structure_errors(made))
        if findings.count() > count:
            damaged.add(region)
    for activity, on in (form.activities or {}).items():
        count = findings.count()
        doing = _activity(activity, on, words, targets, findings)
        activities.declare(activity, on.origin, doing, findings)
        if findings.count() > count or on.damaged:
            damaged.add(activity)
    provides = (
        provided_of(given, at, dictionary, types, members, activities, findings)
        for given, at in (form.provides or {}).items()
    )
    port_region = _port_region(name, form, members, findings)
    groups: tuple[PortGroup, ...] = ()
    if form.port_region is not None:
        groups = groups_of(form.port_region, members.ports, space, timing_of)
    component = Component(
        name=name,
        origin=form.origin,
        parameters=members.parameters.sound(),
        ports=members.ports.sound(),
        events=members.events.sound(),
        data=members.data.sound(),
        port_region=port_region,
        regions=tuple(regions),
        activities=activities.sound(),
        invariants=invariants_of(form, words, findings),
        needs=needs,
        provides=tuple(one for one in provides if one is not None),
        hears=hears,
        groups=groups,
    )
    if findings.count() == before:
        fallbacks_agree(form, component, findings)
        servers_serve_once(component, findings)
        component = forwarding(form, component, findings)
    if not (component.regions or component.activities or form.damaged or component.port_region):
        message = f"the component {name} has nothing to run: no region, no activity, no input"
        findings.error("RV-0513", form.origin, message)
    hurt = findings.count() > before or form.damaged
    return Parts(component, members, _rows(name, form, component), frozenset(damaged), hurt)


def _calls(form: ComponentForm, members: Members, needs: tuple[Need, ...]) -> NameScope[Need]:
    """The required commands that can be called."""
    scope: NameScope[Need] = NameScope("required command")
    required = (form.requires or {}).values()
    scope.open = form.lost("requires") or bool(form.dropped("requires"))
    scope.open |= any(one.lost("commands") for one in required)
    called = {need.name.lower(): need for need in needs if not need.is_read}
    for name, origin, port in members.ports.items.values():
        if port is None or port.is_command:
            scope.declare(name, origin, called.get(name.lower()))
    return scope


def _rows(name: str, form: ComponentForm, component: Component) -> NameScope[str]:
    """The rows that tables may hold of an instance of the component."""
    scope: NameScope[str] = NameScope(f"region or activity of {name}")
    region = form.port_region
    scope.open = form.lost("regions") or form.lost("activities") or form.lost("port_region")
    scope.open |= region is not None and region.lost("groups")
    if component.port_region is not None:
        scope.declare(PORTS, None, PORTS)
    elif (
        form.lost("port_region")
        or form.lost("ports")
        or form.dropped("ports")
        or component.inputs()
    ):
        scope.declare(PORTS, None, None)
    sound: tuple[PortGroup | Region | Activity, ...]
    sound = (*component.groups, *component.regions, *component.activities)
    for item in sound:
        scope.declare(item.name, item.origin, item.name)
    for lost in (
        *(() if region is None else region.dropped("groups")),
        *(form.regions or {}),
        *form.dropped("regions"),
        *form.dropped("activities"),
    ):
        scope.declare(lost, None, None)
    return scope


def _port_region(
    name: str, form: ComponentForm, members: Members, findings: Findings
) -> Timing | None:
    """When the port handlers run: exactly when there are input ports."""
    inputs = [p for p in members.ports.sound() if p.direction is Direction.IN]
    if form.port_region is not None:
        timing = timing_of("the port region", form.port_region, findings)
        if not inputs and not members.ports.has_lost():
            message = f"{name} has a port region and no input port"
            findings.error("RV-0511", form.at_key("port_region"), message, hint="remove it")
        return timing
    if inputs and not form.lost("port_region"):
        message = f"{name} has input ports and needs a port region"
        findings.error(
            "RV-0511",
            form.origin,
            message,
            notes=[(inputs[0].origin, f"`{inputs[0].name}` is an input port")],
            hint="`port_region: {period: ..., wcet: ...}` says when arrivals are handled",
        )
    return None


# --- Activities ------------------------------------------------------------------


def _activity(
    name: str, form: ActivityForm, words: Vocabulary, targets: Targets, findings: Findings
) -> Activity:
    timing = timing_of(name, form, findings)
    while_in = None
    if form.while_ is not None:
        while_in = _state_ref(form.while_, form.at("while"), words, findings)
    targets = replace(targets, do_activity=form.while_ is not None)
    before = findings.count()
    lists = _lists(form, words, targets, findings)
    flow: Flow | None = None
    forwards = form.body == "forward"
    if forwards:
        only_forwards(name, form, findings)
    elif not isinstance(form.body, str):
        if form.has("may_send"):
            message = "only a body of the user has `may_send`: actions send where they say so"
            hint = "remove it; `if` makes a `send` depend on a condition"
            findings.error("RV-0210", form.at_key("may_send"), message, hint=hint)
        count = findings.count()
        flow = flow_of(form.body, words, targets, findings)
        use = Use()
        use.flow(flow)
        if findings.count() == count and not form.damaged:
            lists |= _agreed(name, form, lists, use, targets, findings)
    requires: tuple[Clause, ...] = ()
    ensures: tuple[Clause, ...] = ()
    if findings.count() == before and not form.damaged:
        requires, ensures = contract_of(name, form, lists, words, targets, findings)
    return Activity(
        name=name,
        origin=form.origin,
        timing=timing,
        reads=lists["reads"],
        writes=lists["writes"],
        sends=sent(lists),
        raises=lists["raises"],
        while_in=while_in,
        flow=flow,
        requires=requires,
        ensures=ensures,
        may_send=lists["may_send"],
        forwards=forwards,
    )


def _state_ref(text: str, origin: Origin, words: Vocabulary, findings: Findings) -> StateRef | None:
    region, dot, state = text.partition(".")
    if not dot or not region or not state or "." in state:
        message = f"`{text}` must have the form Region.State"
        findings.error("RV-0306", origin, message)
        return None
    states = words.regions.look_up(region, origin, findings)
    found = None if states is None else states.look_up(state, origin, findings)
    vertex = states.vertices.find(state) if isinstance(states, States) else None
    if found is not None and vertex is not None and vertex.is_final:
        message = f"expected a plain state, found the final state `{found}`"
        findings.error("RV-0514", origin, message, hint="nothing is done in a final state")
    return None if found is None else StateRef(words.regions.items[region.lower()][0], found)


def _lists(
    form: ActivityForm, words: Vocabulary, targets: Targets, findings: Findings
) -> dict[str, tuple[str, ...]]:
    """The declared reads, writes, sends and raises, as the names were declared."""
    known: Mapping[str, tuple[str, tuple[NameScope[object], ...]]] = {
        "reads": (
            "data item, parameter, input port or region",
            (words.readable, words.regions),  # type: ignore[dict-item]
        ),
        "writes": ("data item", (targets.data,)),  # type: ignore[dict-item]
        "sends": ("output port", (targets.outputs,)),  # type: ignore[dict-item]
        "may_send": ("output port", (targets.outputs,)),  # type: ignore[dict-item]
        "calls": ("required command", ()),
        "raises": ("event", (targets.events,)),  # type: ignore[dict-item]
    }
    lists: dict[str, tuple[str, ...]] = {}
    for key, given in (
        ("reads", form.reads),
        ("writes", form.writes),
        ("sends", form.sends),
        ("may_send", form.may_send),
        ("calls", form.calls),
        ("raises", form.raises),
    ):
        kind, scopes = known[key]
        names: NameScope[str] = NameScope(f"entry of `{key}`")
        for index, name in enumerate(given or ()):
            origin = form.item_at(key, index)
            if key == "raises" and name.lower() == DONE:
                declared = _done(targets, origin, findings)
            elif key == "calls":
                need = called_command(name, origin, words, targets, findings)
                declared = None if need is None else need.name
            elif key in ("reads", "sends", "may_send") and targets.calls.find(name) is not None:
                message = f"`{name}` is a command to call, so it cannot stand in `{key}`"
                findings.error("RV-1206", origin, message, hint="name it under `calls`")
                declared = None
            else:
                declared = _declared(name, kind, scopes, origin, findings)
            if declared is not None and not names.declare(declared, origin, declared):
                message = f"`{declared}` appears twice in `{key}`"
                findings.error("RV-0303", origin, message, hint="remove one of them")
            elif key == "may_send" and declared in lists["sends"]:
                message = f"`{declared}` appears in `sends` and in `may_send`"
                hint = "remove it from `sends` if the body decides, else from `may_send`"
                findings.error("RV-0303", origin, message, hint=hint)
        lists[key] = names.sound()
    return lists


def _done(targets: Targets, origin: Origin, findings: Findings) -> str | None:
    """`DONE`, which only a do activity raises."""
    if not targets.do_activity:
        message = f"only a do activity raises `{DONE}`"
        hint = "a do activity has `while: Region.State`, and completes that state"
        findings.error("RV-0527", origin, message, hint=hint)
        return None
    return DONE


def _declared(
    name: str, kind: str, scopes: Iterable[NameScope[object]], origin: Origin, findings: Findings
) -> str | None:
    """The name as declared in one of these scopes; None when unknown or unsound."""
    for scope in scopes:
        if name.lower() in scope.items:
            scope.used(name, origin, findings)
            declared, _, item = scope.items[name.lower()]
            if item is None:
                findings.lose()
            return None if item is None else declared
    names = tuple(known for scope in scopes for known in scope.names())
    findings.unknown.append(Unknown(name, kind, names))
    if not any(scope.open for scope in scopes):
        near = meant(name, names)
        findings.error("RV-0305", origin, f"there is no {kind} named `{name}`", hint=near)
    findings.lose()
    return None


def _agreed(
    name: str,
    form: ActivityForm,
    lists: dict[str, tuple[str, ...]],
    use: Use,
    targets: Targets,
    findings: Findings,
) -> dict[str, tuple[str, ...]]:
    """The names that the flow uses, by key; where the key is declared too, both must agree."""
    agreed: dict[str, tuple[str, ...]] = {}
    for key, verb, done in (
        ("reads", "read", use.reads),
        ("writes", "write", use.writes),
        ("sends", "send on", [one for one in use.sends if targets.calls.find(one) is None]),
        ("calls", "call", [one for one in use.sends if targets.calls.find(one) is not None]),
        ("raises", "raise", use.raises),
    ):
        agreed[key] = lists[key] if form.has(key) else tuple(done)
        if not form.has(key):
            continue
        for item in (one for one in done if one not in lists[key]):
            message = f"the flow of {name} can {verb} `{item}`, but `{key}` does not name it"
            findings.error("RV-0414", form.at(key), message, hint=f"add it, or leave `{key}` out")
        for item in (one for one in lists[key] if one not in done):
            message = f"the flow of {name} does not {verb} `{item}`, but `{key}` names it"
            findings.error("RV-0414", form.at(key), message, hint=f"remove it from `{key}`")
    return agreed
