"""What a region's package consists of, and what its guards and behaviours name."""

from __future__ import annotations

from dataclasses import dataclass

from .. import terms as m
from ..model import Component, System
from ..statechart import After, OnEvent, Region, Transition, TransitionKind, When
from .ada import (
    Arg,
    Chain,
    Expr,
    Param,
    Ref,
    call,
    equal,
    member,
)
from .naming import ada_case, region_package, states_package
from .terms import (
    Scope,
    flow_names,
    flow_operators,
    names_in,
    operators_in,
    raise_in_list,
    states_in,
)

START = "Initial_Entry"

_TYPES = "occurrence selection firing transition variables inputs outbox region item chart"
TYPES = frozenset(_TYPES.split())
"""What hides an event of the same name inside a region's package."""


def guard_names(region: Region) -> set[str]:
    """What the guards and conditions of a region read, by name as declared."""
    return {name for guard in _guards(region) for name in names_in(guard)}


def _guards(region: Region) -> list[m.Expression]:
    guards = [t.guard for t in region.transitions if t.guard is not None]
    return guards + [t.trigger.condition for t in region.transitions if isinstance(t.trigger, When)]


def behaviour_names(region: Region) -> set[str]:
    """What its effects, entries and exits read."""
    return {name for flow in _behaviours(region) for name in flow_names(flow)}


def _behaviours(region: Region) -> list[m.Flow]:
    flows = [t.effect for t in region.transitions]
    return flows + [flow for s in region.states for flow in (s.entry, s.exit)]


@dataclass(frozen=True, slots=True)
class RegionShape:
    """What a region's package consists of; asked by its emitter and by the instances'."""

    system: System
    component: Component
    region: Region

    @property
    def package(self) -> str:
        """Full name of the region's package."""
        return region_package(self.system, self.component, self.region)

    @property
    def states(self) -> str:
        """Nested package of the leaf states."""
        return states_package(self.region)

    @property
    def leaf(self) -> str:
        """The leaf type, from inside the component's packages."""
        return f"{self.states}.Leaf"

    @property
    def inputs(self) -> tuple[str, ...]:
        """What it copies in: everything read that it does not itself write."""
        return tuple(n for n in self.region.reads if n not in self.region.writes)

    @property
    def timers(self) -> tuple[Transition, ...]:
        """The transitions with a time-out, in model order."""
        return tuple(t for t in self.region.transitions if isinstance(t.trigger, After))

    @property
    def has_box(self) -> bool:
        """Does a step send or raise anything?"""
        return bool(self.region.sends or self.region.raises)

    def extra(self) -> tuple[Param, ...]:
        """The parameters that guards are evaluated over."""
        named = guard_names(self.region)
        params = []
        if named & set(self.region.writes):
            params.append(Param("Data", "in", "Variables"))
        if named & set(self.inputs):
            params.append(Param("Ins", "in", "Inputs"))
        return tuple(params)

    def target_params(self) -> tuple[Param, ...]:
        """Target looks at the leaf only when a transition can stay where it is."""
        stays = any(t.kind is TransitionKind.INTERNAL for t in self.region.transitions)
        return (Param("Leaf", "in", self.leaf),) if stays else ()

    def target(self, chosen: str, leaf: str) -> Expr:
        """A call of Target."""
        return call("Target", Ref(chosen), *(Ref(leaf) for _ in self.target_params()))

    def scope(self, data: str) -> Scope:
        """Names in guards (``data`` = Data) and in behaviours (``data`` = Self.Data)."""
        writes = {n.lower() for n in self.region.writes}

        def variable(name: str) -> str:
            prefix = data if name.lower() in writes else "Ins"
            return f"{prefix}.{ada_case(name)}"

        raised = f"{ada_case(self.component.name)}"
        return Scope(
            self.system,
            self.component,
            variable,
            lambda name: f"{data}.{ada_case(name)}",
            lambda port: (f"Box.{ada_case(port)}", f"Box.{ada_case(port)}_Sent"),
            lambda event: raise_in_list("Event_Lists", "Box.Raised", f"{raised}.{ada_case(event)}"),
        )

    def in_state(self, leaf: str, state: str) -> Expr:
        """Is the leaf that ``leaf`` holds the state, or inside it?"""
        name = f"{self.states}.{ada_case(state)}"
        if self.region.state(state).is_leaf:
            return equal(Ref(leaf), Ref(name))
        return member(Ref(leaf), name)

    def occurrence(self, transition: Transition) -> str:
        """The occurrence that triggers it."""
        match transition.trigger:
            case OnEvent(event):
                return f"On_{ada_case(event)}"
            case After():
                return f"Expiry_Of_{ada_case(transition.name)}"
            case _:
                return "Conditions"

    def event(self, event: str) -> str:
        """The event as the region's package names it."""
        name = ada_case(event)
        return f"{ada_case(self.component.name)}.{name}" if name.lower() in TYPES else name

    def occurrences(self) -> tuple[str, ...]:
        """All occurrences of the region."""
        events = [f"On_{ada_case(e)}" for e in self.region.events()]
        expiries = [self.occurrence(t) for t in self.timers]
        return ("Start_Of_Region", *events, *expiries, "Conditions")

    def timer_index(self, transition: Transition) -> int:
        """Position of its timer, from 1."""
        return self.timers.index(transition) + 1


def choice_params(shape: RegionShape) -> tuple[Param, ...]:
    """What a selection is made over: leaf, occurrence, data, inputs."""
    return (Param("Leaf", "in", shape.leaf), Param("Now", "in", "Occurrence"), *shape.extra())


def plain_args(params: tuple[Param, ...], **replaced: str) -> tuple[Arg, ...]:
    """Positional arguments that repeat the parameters, some replaced."""
    return tuple(Arg(None, Ref(replaced.get(p.name, p.name))) for p in params)


def flat(parts: list[Expr]) -> list[Expr]:
    """One conjunction instead of nested ones."""
    found: list[Expr] = []
    for part in parts:
        if isinstance(part, Chain) and part.operator == "and then":
            found += flat(list(part.operands))
        else:
            found.append(part)
    return found


def step_params(shape: RegionShape) -> tuple[Param, ...]:
    """The profile of Step, which its callers follow too."""
    params = [Param("Self", "in out", "Region"), Param("Now", "in", "Occurrence")]
    if shape.inputs:
        params.append(Param("Ins", "in", "Inputs"))
    if shape.has_box:
        params.append(Param("Box", "in out", "Outbox"))
    return (*params, Param("Fired", "out", "Selection"))


def guard_operators(region: Region) -> set[str]:
    """The runtime's types whose operators its guards use."""
    return {name for guard in _guards(region) for name in operators_in(guard)}


def behaviour_operators(region: Region) -> set[str]:
    """The runtime's types whose operators its behaviours use."""
    return {name for flow in _behaviours(region) for name in flow_operators(flow)}


def asked_states(region: Region) -> set[tuple[str, str]]:
    """The (region, state) pairs that its guards ask for."""
    return {pair for guard in _guards(region) for pair in states_in(guard)}
