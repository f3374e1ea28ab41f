# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""States and pseudostates resolved, with their regions and where these begin."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from ravenchart.gen.files.schema import InitialForm, NestedRegionForm, RegionForm, StateForm
from ravenchart.gen.language.names import Findings, NameScope
from ravenchart.gen.language.terms import Flow, Ns
from ravenchart.gen.model.component import Event
from ravenchart.gen.model.statechart import Initial, NestedRegion, PseudoKind, Pseudostate, State

from .chart_names import FINAL_STATE, States, WrittenVertex, vertex_of, walk
from .flows import Targets, flow_of
from .vocabulary import Vocabulary


@dataclass(frozen=True, slots=True)
class Setting:
    """The surroundings in which the parts of one region are resolved."""

    region: str
    period: Ns
    states: States
    words: Vocabulary
    targets: Targets
    findings: Findings

    def flow(self, form: StateForm | InitialForm, key: str) -> Flow:
        """The actions under a key."""
        return flow_of(getattr(form, key), self.words, self.targets, self.findings)


ONLY_STATES = ("entry", "exit", "defer", "initial", "states", "regions")
"""Keys that mean nothing for a final state or pseudostate."""

INSTEAD = {
    "entry": "write these actions as the effect of its transitions",
    "exit": "write these actions as the effect of its transitions",
    "defer": "let a state defer: nothing rests here",
    "initial": "put it beside the `states` that it chooses from",
    "states": "nothing is inside it: write them beside it",
    "regions": "nothing is inside it: write them beside it",
}
INSTEAD_FINAL = INSTEAD | {
    "entry": "write these actions as the effect of the transitions to it, or use a plain state",
    "exit": "a final state is left only together with the state around it: use its `exit`",
    "defer": "let the state around it defer",
}


def vertices_of(form: RegionForm, setting: Setting) -> tuple[list[State], list[Pseudostate]]:
    """The states and the pseudostates, each in tree order."""
    states: list[State] = []
    pseudostates: list[Pseudostate] = []
    for row in walk(form.states):
        name, at, parent, region = row
        if at.kind is None:
            states.append(_state(row, setting))
            continue
        _refuse_keys(row, setting)
        if at.kind == "final":
            states.append(State(name, at.origin, parent, region, (), (), (), final=True))
        else:
            kind = PseudoKind(at.kind)
            pseudostates.append(Pseudostate(name, at.origin, kind, parent, region))
    return states, pseudostates


def _refuse_keys(row: WrittenVertex, setting: Setting) -> None:
    """A final state or pseudostate has nothing but its kind."""
    vertex = vertex_of(row.name, row.form)
    hints = INSTEAD_FINAL if vertex.what == FINAL_STATE else INSTEAD
    for key in ONLY_STATES:
        if row.form.has(key):
            message = f"`{key}` has no meaning for the {vertex.shown}"
            setting.findings.error("RV-0210", row.form.at_key(key), message, hint=hints[key])


def _state(row: WrittenVertex, setting: Setting) -> State:
    name, form, parent, region = row
    if form.states and form.regions:
        message = f"{name} has both `states` and `regions`"
        hint = "move the `states` into one of the regions"
        setting.findings.error("RV-0210", form.at_key("regions"), message, hint=hint)
    if form.regions:
        if form.initial is not None:
            message = f"`initial` has no meaning for {name}: each of its regions has its own"
            setting.findings.error("RV-0210", form.at_key("initial"), message, hint="remove it")
        regions = tuple(
            NestedRegion(nested, at.origin, initial_of(at, nested, setting))
            for nested, at in form.regions.items()
        )
    else:
        regions = _only_region(row, setting)
    entry, exit_flow = setting.flow(form, "entry"), setting.flow(form, "exit")
    return State(
        name, form.origin, parent, region, regions, entry, exit_flow, _defers(row, setting)
    )


def _only_region(row: WrittenVertex, setting: Setting) -> tuple[NestedRegion, ...]:
    """The region of a state that has `states`; none for a leaf."""
    name, form = row.name, row.form
    if not form.states:
        if form.initial is not None and not (form.lost("states") or form.lost("regions")):
            message = "`initial` has no meaning without `states`"
            setting.findings.error("RV-0210", form.at_key("initial"), message)
        return ()
    if form.initial is None:
        if not form.lost("initial"):
            message = f"{name} has substates and needs the key `initial`"
            first = _first(form.states)
            hint = f"`initial: {first}`?" if form.states[first].kind is None else None
            setting.findings.error("RV-0202", form.origin, message, hint=hint)
        return (NestedRegion("", form.origin, Initial(_first(form.states))),)
    return (NestedRegion("", form.origin, initial_of(form, name, setting)),)


def _first(states: Mapping[str, StateForm]) -> str:
    """The first vertex that a region can begin in, or else the first one."""
    plain = (name for name, form in states.items() if form.kind is None)
    return next(plain, next(iter(states)))


def initial_of(
    form: RegionForm | StateForm | NestedRegionForm, around: str, setting: Setting
) -> Initial:
    """Where a region begins; where that is wrong, in its first state."""
    assert form.states is not None
    given = form.initial
    effect: Flow = ()
    target: str | None = None
    if isinstance(given, InitialForm):
        effect = setting.flow(given, "effect")
        origin = given.at("to")
        target = setting.states.look_up(given.to, origin, setting.findings)
    elif given is not None:
        origin = form.at("initial")
        target = setting.states.look_up(given, origin, setting.findings)
    if target is not None:
        inside = {inner.name.lower() for inner in walk(form.states)}
        if target.lower() not in inside:
            message = (
                f"`{target}` cannot be the initial state of {around}: it is not inside {around}"
            )
            setting.findings.error("RV-0501", origin, message)
            target = None
    return Initial(target or _first(form.states), effect)


def _defers(row: WrittenVertex, setting: Setting) -> tuple[str, ...]:
    """The events that a state defers, each once."""
    names: NameScope[Event] = NameScope("entry of `defer`")
    for index, text in enumerate(row.form.defer or ()):
        origin = row.form.item_at("defer", index)
        event = setting.targets.events.look_up(text, origin, setting.findings)
        if event is not None and not names.declare(event.name, origin, event):
            message = f"`{event.name}` appears twice in `defer`"
            setting.findings.error("RV-0303", origin, message, hint="remove one of them")
    return tuple(event.name for event in names.sound())
