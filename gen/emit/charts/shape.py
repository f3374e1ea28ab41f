# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The types of a region's package: its occurrences, its memory, and the names that it reads."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

from ravenchart.gen.emit.ada.declarations import Param
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    Arg,
    Expr,
    OperatorChain,
    StringLiteral,
    both,
    call,
    chain,
    old,
    one_of,
)
from ravenchart.gen.emit.ada.named import DottedName, Named, ref
from ravenchart.gen.emit.ada.naming import ada_case, component_name, region_package
from ravenchart.gen.emit.ada.statements import Stmt, do
from ravenchart.gen.emit.language.compound import PASSED, EntryStep, Firing, FiringKind
from ravenchart.gen.emit.language.configurations import Configurations, conjuncts
from ravenchart.gen.emit.language.events import carries, event_value
from ravenchart.gen.emit.language.own_names import event_literal, region_label
from ravenchart.gen.emit.language.terms import (
    Scope,
    asks_event,
    compared_states,
    emit_expression,
    expressions_in,
    names_read,
    raise_in_list,
)
from ravenchart.gen.language import terms as m
from ravenchart.gen.model.component import Component
from ravenchart.gen.model.safety import SafeRegion
from ravenchart.gen.model.statechart import (
    TOP,
    After,
    Completion,
    Every,
    OnEvent,
    PseudoKind,
    Region,
    RegionId,
    Segment,
    Transition,
    When,
)
from ravenchart.gen.model.system import System

from .guards import flows_of, guards_of

START = "Initial_Entry"
PASSING = "Passing"
"""The occurrence that takes an execution on from a choice or history."""

TYPES = frozenset(
    (
        *("safe_region", "initial_data"),
        *("occurrence", "selection", "firing", "transition", "choice", "domain", "memory", "chart"),
        *("variables", "inputs", "outbox", "region", "item"),
        *("firings", "deferrals", "done_states", "time_outs"),
        *("configuration", "leaf", "name", "d"),
    )
)
"""Names that hide an event of the same name inside a region's package."""

SELF = Param("Self", "in", "Region")
"""The region's own state, read."""

ITEM = Param("Item", "in", "Event")
"""The event that a step is made for."""


@dataclass(frozen=True, slots=True)
class HistoryMemory:
    """The memory of a history: the last leaf left in a region."""

    region: RegionId
    label: str

    @property
    def last(self) -> str:
        """The component with the leaf."""
        return f"Last_In_{self.label}"

    @property
    def known(self) -> str:
        """The component that says whether there is one."""
        return f"Known_In_{self.label}"


class RegionShape(Configurations):
    """The types of one region's package; asked by its emitters and by the instances'."""

    def __init__(
        self, system: System, component: Component, region: Region, *, noted: bool = False
    ) -> None:
        super().__init__(region)
        self.noted = noted
        self.system = system
        self.component = component

    @cached_property
    def firings(self) -> tuple[Firing, ...]:
        """The lines of the declared chart, in order of precedence."""
        return self.compounds.firings

    @cached_property
    def start(self) -> tuple[EntryStep, ...]:
        """The entries of the region's start."""
        return self.compounds.default(TOP)

    def in_sources(self, firing: Firing) -> Expr:
        """Are all its sources active?"""
        return both(*conjuncts([self.in_state(self.configuration_name, s) for s in firing.sources]))

    def leads_to(self, firing: Firing) -> dict[RegionId, str]:
        """The leaves that a move leads to."""
        if firing.goal is not None and self.is_end(firing.goal):
            return self.after(firing.entries[:-1]) | {TOP: firing.goal}
        return self.after(firing.entries)

    # --- concurrent regions

    @cached_property
    def busy_regions(self) -> tuple[RegionId, ...]:
        """The regions with transitions, in the order of a step; the top-level one if none has."""
        busy = tuple(n for n in self.concurrent if any(f.region == n for f in self.firings))
        return busy or (TOP,)

    def label(self, region: RegionId) -> str:
        """Its name among the concurrent regions: a component of choices and nodes."""
        return "Top" if region.owner is None else region_label(region.name)

    def transitions_of(self, region: RegionId) -> str:
        """The subtype of a region's transitions, where there are orthogonal regions."""
        return f"{self.label(region)}_Transition"

    def concurrent_around(self, region: RegionId) -> RegionId:
        """The region itself if it is concurrent, or else the innermost one around it that is."""
        if region.owner is None or self.region.state(region.owner).is_orthogonal:
            return region
        return self.region.concurrent_region(region.owner)

    def inner_regions(self, region: RegionId) -> tuple[RegionId, ...]:
        """The busy regions inside a concurrent region."""
        return tuple(n for n in self.busy_regions if n != region and region in self.enclosing(n))

    def enclosing(self, region: RegionId) -> list[RegionId]:
        """A concurrent region and those around it, innermost first."""
        found = [region]
        while found[-1].owner is not None:
            found.append(self.region.concurrent_region(found[-1].owner))
        return found

    @cached_property
    def left_states(self) -> tuple[str, ...]:
        """The orthogonal states that some transition leaves from inside."""
        found = {s for f in self.firings for s in self.compounds.left(f)}
        return tuple(s.name for s in self.region.states if s.name in found)

    @cached_property
    def watched(self) -> tuple[str, ...]:
        """The orthogonal states in which transitions of one step can conflict."""
        return tuple(s for s in self.left_states if len(self.busy_inside(s)) > 1)

    def busy_inside(self, state: str) -> tuple[RegionId, ...]:
        """The busy regions inside an orthogonal state, in the order of a step."""
        inside = self.region.ancestors
        return tuple(n for n in self.busy_regions if n.owner and state in inside(n.owner))

    # --- steps

    @cached_property
    def held(self) -> DottedName:
        """The configuration in the region's own state."""
        return ref("Self", self.configuration_name)

    @cached_property
    def configuration_param(self) -> Param:
        """The parameter with a configuration, read."""
        return Param(self.configuration_name, "in", self.configuration_type)

    @cached_property
    def deferring(self) -> bool:
        """Does a state defer events?"""
        return any(s.defers for s in self.region.states)

    @cached_property
    def listed(self) -> bool:
        """Can one step take more than one transition?"""
        return self.passes or not self.single

    @cached_property
    def most_firings(self) -> int:
        """The most transitions and segments that one step takes."""
        return max(1, len(self.busy_regions)) * (1 + self.most_segments)

    @cached_property
    def most_segments(self) -> int:
        """The most segments that one transition goes on by."""
        ranks = (self.rank(p.name) for p in self.region.pseudostates if p.kind in PASSED)
        return max(ranks, default=0)

    def rank(self, pseudo: str) -> int:
        """The most segments that follow when an execution is in a choice or history."""
        goals = {f.goal for f in self.firings if f.sources[0] == pseudo} - {pseudo}
        passed = {p.name for p in self.region.pseudostates if p.kind in PASSED}
        return 1 + max((self.rank(g) for g in goals if g in passed), default=0)

    def completed(self, state: str) -> str:
        """The component that says that a state has completed and nothing took it yet."""
        return f"Completed_{ada_case(state)}"

    @cached_property
    def working(self) -> tuple[str, ...]:
        """The states that do activities complete, in tree order."""
        found = {state for _, state in self.component.completing(self.region.name)}
        return tuple(s.name for s in self.region.states if s.name in found)

    def done(self, state: str) -> DottedName:
        """The component that says that a do activity of an active state is done."""
        return ref("Done_In", ada_case(state))

    def visits(self, state: str) -> str:
        """The component that counts the entries of a state with a do activity."""
        return f"Visits_{ada_case(state)}"

    def is_complete(self, state: str) -> Expr | None:
        """Has an active state completed? None: always."""
        parts = self.finals(state, self.held)
        parts += [ref("Self", self.done(state))] if state in self.working else []
        return both(*conjuncts(parts)) if parts else None

    def finals(self, state: str, holder: Named) -> list[Expr]:
        """For each region of a state: is it in a final state?"""
        parts: list[Expr] = []
        for nested in self.region.state(state).regions:
            finals = [s for s in self.region.children(state, nested.name) if s.final]
            inside = [self.in_state(holder, s.name) for s in finals]
            parts.append(chain("or else", inside, FALSE))
        return parts

    @property
    def polls_more(self) -> bool:
        """Are there occurrences of its own besides time-outs?"""
        return bool(self.completing) or self.deferring

    @property
    def polls_out(self) -> bool:
        """Does asking for the next occurrence change the region's state?"""
        return bool(self.timers) or self.polls_more

    def poll_params(self) -> tuple[Param, ...]:
        """The profile of Poll; a deferred event comes with its value."""
        mode = "in out" if self.polls_out else "in"
        params = [Param("Self", mode, "Region"), Param("Now", "out", "Occurrence")]
        if self.deferring:
            params.append(replace(ITEM, mode="out"))
        return tuple(params)

    def compared_in(self, expressions: Iterable[m.Expression]) -> set[DottedName]:
        """The types of other regions' states that expressions compare."""
        compared = compared_states(self.component, expressions)
        return {name for name in compared if name.first != self.states}

    @cached_property
    def safe(self) -> SafeRegion | None:
        """The invariants that its code keeps by contract."""
        own = self.component.name, self.region.name
        found = (s for s in self.system.safe_regions if (s.component, s.region) == own)
        return next(found, None)

    @property
    def kept_as(self) -> str:
        """The type of the region's state between steps."""
        return "Region" if self.safe is None else "Safe_Region"

    # --- notes

    def note(self, text: str) -> tuple[Stmt, ...]:
        """In a program for simulation: say that a behaviour is executed."""
        if not self.noted:
            return ()
        return (do("Ravenchart.Steps.Note", StringLiteral(text)),)

    # --- packages and types

    @property
    def package(self) -> DottedName:
        """Full name of the region's package."""
        return region_package(self.system, self.component, self.region)

    # --- memory

    @cached_property
    def memories(self) -> tuple[HistoryMemory, ...]:
        """The regions whose last leaf some history asks for."""
        found: dict[RegionId, HistoryMemory] = {}
        for pseudo in self.region.pseudostates:
            if pseudo.kind in PASSED and pseudo.kind is not PseudoKind.CHOICE:
                own = self.region.region_of(pseudo.name)
                wanted = [own]
                if pseudo.kind is PseudoKind.DEEP_HISTORY:
                    around = self.region.regions_around
                    wanted += [r for r in self.concurrent if r.owner and own in around(r.owner)]
                for region in wanted:
                    found[region] = HistoryMemory(region, ada_case(region.label))
        return tuple(found.values())

    def memory(self, region: RegionId) -> HistoryMemory:
        """The memory of a region that has one."""
        return next(one for one in self.memories if one.region == region)

    def memory_type(self, memory: HistoryMemory) -> DottedName:
        """The type of its last leaf."""
        owner = self.region.state(memory.region.owner or "")
        if owner.is_orthogonal:
            return ref(self.states, self.leaves_type(memory.region))
        return ref(self.states, ada_case(owner.name))

    # --- occurrences

    @cached_property
    def timers(self) -> tuple[Transition, ...]:
        """The transitions with a time-out, in model order."""
        timed = (After, Every)
        return tuple(t for t in self.region.transitions if isinstance(t.trigger, timed))

    @cached_property
    def completing(self) -> tuple[str, ...]:
        """The states whose completion triggers something, in tree order."""
        wanted = {t.source for t in self.region.transitions if isinstance(t.trigger, Completion)}
        return tuple(s.name for s in self.region.states if s.name in wanted)

    @cached_property
    def passes(self) -> bool:
        """Are there choices or histories?"""
        return any(p.kind in PASSED for p in self.region.pseudostates)

    @property
    def begins(self) -> tuple[Expr, ...]:
        """That a step begins, where one may also go on from a choice or history."""
        return (OperatorChain("/=", (ref("Now"), ref(PASSING))),) if self.passes else ()

    def occurrences(self) -> tuple[str, ...]:
        """All occurrences of the region."""
        found = ["Start_Of_Region"]
        found += [f"Completion_Of_{ada_case(s)}" for s in self.completing]
        found += [f"On_{ada_case(e)}" for e in self.region.events()]
        found += [f"Expiry_Of_{ada_case(t.name)}" for t in self.timers]
        found += [PASSING] if self.passes else []
        return (*found, "Conditions")

    def triggers(self, firing: Firing) -> tuple[str, ...]:
        """The occurrences that a line is for."""
        found: list[str] = []
        for trigger in firing.triggers:
            match trigger:
                case OnEvent(event) | str(event):
                    found.append(f"On_{ada_case(event)}")
                case After() | Every():
                    timed = next(t for t in self.timers if t.trigger is trigger)
                    found.append(f"Expiry_Of_{ada_case(timed.name)}")
                case Completion():
                    found += [f"Completion_Of_{ada_case(s)}" for s in firing.sources]
                case Segment():
                    found.append(PASSING)
                case When():
                    found.append("Conditions")
        return tuple(found)

    @cached_property
    def enabled_when(self) -> dict[str, Expr]:
        """For each line its trigger and guard; where it has several sources, that all are
        complete."""
        return {firing.literal: self._enabled_when(firing) for firing in self.firings}

    def _enabled_when(self, firing: Firing) -> Expr:
        scope = self.scope("Self.Data")
        triggers = self.triggers(firing)
        parts: list[Expr] = [one_of(ref("Now"), triggers)]
        whens = (t for t in firing.triggers if isinstance(t, When))
        parts += [emit_expression(scope, when.condition) for when in whens]
        if firing.kind is FiringKind.RESTORE:
            memory = self.memory(self.region.region_of(firing.sources[0]))
            parts.append(ref("Self.Past", memory.known))
        parts += [emit_expression(scope, guard) for guard in firing.guards]
        if len(firing.sources) > 1:
            parts += [p for s in firing.sources if (p := self.is_complete(s)) is not None]
        return both(*conjuncts(parts))

    def event(self, event: str) -> DottedName:
        """The event as the region's package names it."""
        name = event_literal(event)
        types = {self.transitions_of(region).lower() for region in self.busy_regions}
        hidden = name.lower() in TYPES or name.lower() in types
        return ref(component_name(self.component), name) if hidden else ref(name)

    # --- what it reads

    @property
    def inputs(self) -> tuple[str, ...]:
        """The names that it copies in: everything read that it does not itself write."""
        return tuple(n for n in self.region.reads if n not in self.region.writes)

    @property
    def has_box(self) -> bool:
        """Does a step send or raise anything?"""
        return bool(self.region.sends or self.region.raises)

    @cached_property
    def takes_item(self) -> bool:
        """Does a step need the event itself, for its value?"""
        asked = any(asks_event(guard) for guard in guards_of(self.region))
        return self.fires_with_item or asked

    @cached_property
    def fires_with_item(self) -> bool:
        """Does a behaviour ask for the event's value, or is the event kept?"""
        flows = (e for flow in flows_of(self.region) for e in expressions_in(flow))
        asks = carries(self.component) and any(map(asks_event, flows))
        return asks or self.deferring

    @cached_property
    def situation(self) -> tuple[Param, ...]:
        """The parameters that decide whether a transition is enabled: the region, the occurrence,
        and the inputs and event of guards."""
        named = {name for guard in guards_of(self.region) for name in names_read(guard)}
        params = [SELF, Param("Now", "in", "Occurrence")]
        if named & set(self.inputs):
            params.append(Param("Ins", "in", "Inputs"))
        if any(asks_event(g) for g in guards_of(self.region)):
            params.append(ITEM)
        return tuple(params)

    def situation_args(self, **replaced: Expr) -> tuple[Arg, ...]:
        """The same as arguments, some replaced."""
        return plain_args(self.situation, **replaced)

    def target_params(self) -> tuple[Param, ...]:
        """The configuration and the past, where Target needs them."""
        params = []
        stays = (FiringKind.INTERNAL, FiringKind.DEFERRAL)
        if not self.single or any(f.kind in stays for f in self.firings):
            params.append(self.configuration_param)
        if self.memories:
            params.append(Param("Past", "in", "Memory"))
        return tuple(params)

    def target(self, chosen: str) -> Expr:
        """A call of Target over the region's state before a call."""
        own = (old(ref("Self", p.name)) for p in self.target_params())
        return call("Target", ref(chosen), *own)

    def step_params(self) -> tuple[Param, ...]:
        """The profile of Step and Fire, without what was chosen."""
        params = [Param("Self", "in out", "Region")]
        if self.inputs:
            params.append(Param("Ins", "in", "Inputs"))
        if self.takes_item:
            params.append(ITEM)
        if self.has_box:
            params.append(Param("Box", "in out", "Outbox"))
        return tuple(params)

    def scope(self, data: str) -> Scope:
        """Names in guards (``data`` = Data) and in behaviours (``data`` = Self.Data)."""
        writes = {n.lower() for n in self.region.writes}

        def variable(name: str) -> DottedName:
            if name == self.region.name:
                return self.held
            return ref(data if name.lower() in writes else "Ins", ada_case(name))

        def raised(event: str, given: Expr | None) -> tuple[Stmt, ...]:
            item = event_value(self.component, event, given)
            return (raise_in_list("Event_Lists", "Box.Raised", item),)

        return Scope(
            self.system,
            self.component,
            variable,
            lambda name: ref(data, ada_case(name)),
            lambda port: (ref("Box", ada_case(port)), ref("Box", f"{ada_case(port)}_Sent")),
            raised,
        )


def plain_args(params: tuple[Param, ...], **replaced: Expr) -> tuple[Arg, ...]:
    """Positional arguments that repeat the parameters, some replaced."""
    return tuple(Arg(None, replaced.get(p.name, ref(p.name))) for p in params)
