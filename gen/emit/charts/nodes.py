"""The ghost set of active states: which there are, and when one may be exited or entered.

A state may be exited only when it is active and nothing inside it is; entered only
when its parent is active and nothing in its own region is.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..ada import (
    FALSE,
    TRUE,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    CaseExpr,
    Chain,
    Decl,
    EnumType,
    Expr,
    ForAll,
    Package,
    Param,
    PlainType,
    Prefix,
    Ref,
    Subprogram,
    both,
    call,
    equal,
)
from ..naming import ada_case
from .compound import TOP, Place
from .shape import RegionShape

NODES = "Chart.Node"
_GHOST = Aspect("Ghost")


class View(NamedTuple):
    """How expressions name states, the set of the active ones, and a variable over it."""

    prefix: str
    set: str
    variable: str


OUTSIDE = View("Chart.", "Active", "N")
_INSIDE = View("", "Among", "M")
"""In the package of the states."""


class Nodes:
    """The states of one region as elements of a set."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region

    def chart(self, more: Sequence[Decl]) -> Package:
        """The ghost package: all states, and which are active in a configuration."""
        shape = self.shape
        states = [s.name for s in self.region.states]
        rows = tuple(Arg(ada_case(s), shape.in_state(shape.place, s)) for s in states)
        exits = {s: both(*self.ready_to_exit(s, _INSIDE)) for s in states}
        entries = {s: both(*self.ready_to_enter(s, _INSIDE)) for s in states}
        return Package(
            "Chart",
            (
                EnumType("Node", tuple(ada_case(s) for s in states)),
                PlainType("Node_Set", "array (Node) of Boolean"),
                Subprogram(
                    "Active_In",
                    (Param(shape.place, "in", shape.place_type),),
                    "Node_Set",
                    expression=Aggregate(rows),
                ),
                self._asked("May_Exit", exits),
                self._asked("May_Enter", entries),
                *more,
            ),
            (_GHOST,),
        )

    def _asked(self, name: str, facts: dict[str, Expr]) -> Subprogram:
        rows = tuple((ada_case(state), fact) for state, fact in facts.items())
        params = (Param("N", "in", "Node"), Param(_INSIDE.set, "in", "Node_Set"))
        return Subprogram(name, params, "Boolean", expression=CaseExpr(Ref("N"), rows))

    def moves(self) -> tuple[Decl, ...]:
        """Exit and entry of a state that does nothing else."""
        node = Param("N", "in", NODES)
        left = both(Chain("/=", (Ref("M"), Ref("N"))), Ref("Active'Old (M)"))
        joined = Chain("or else", (equal(Ref("M"), Ref("N")), Ref("Active'Old (M)")))
        found = []
        for name, ready, fact, value in (
            ("Exited", "May_Exit", left, FALSE),
            ("Entered", "May_Enter", joined, TRUE),
        ):
            pre = call(f"Chart.{ready}", Ref("N"), Ref("Active"))
            post = ForAll("M", NODES, equal(Ref("Active (M)"), fact))
            aspects = (_GHOST, Aspect("Pre", pre), Aspect("Post", post))
            body = (Assign("Active (N)", value),)
            found.append(Subprogram(name, (node,), aspects=aspects, body=body))
        return tuple(found)

    # --- when a state may be exited or entered

    def ready_to_exit(self, state: str, where: View = OUTSIDE) -> list[Expr]:
        """It is active, and nothing inside it is."""
        active = Ref(f"{where.set} ({where.prefix}{ada_case(state)})")
        regions = self.region.state(state).regions
        if not regions:
            return [active]
        first = self.inside(Place(state, regions[0].name), where).split(" .. ")[0]
        last = self.inside(Place(state, regions[-1].name), where).split(" .. ")[1]
        return [active, self.none_in(f"{first} .. {last}", where)]

    def ready_to_enter(self, vertex: str, where: View = OUTSIDE) -> list[Expr]:
        """Its parent is active, and nothing in its own region is."""
        place = self.shape.compounds.place(vertex)
        none = self.none_in(self.inside(place, where), where)
        if place.owner is None:
            return [none]
        return [Ref(f"{where.set} ({where.prefix}{ada_case(place.owner)})"), none]

    def inside(self, place: Place, where: View = OUTSIDE) -> str:
        """The states in a region, as a range."""
        if place == TOP:
            return f"{where.prefix}Node"
        below = [
            f"{where.prefix}{ada_case(s.name)}"
            for s in self.region.states
            if s.name != place.owner and place in self.shape.compounds.places(s.name)
        ]
        return f"{below[0]} .. {below[-1]}"

    def none_in(self, nodes: str, where: View = OUTSIDE) -> Expr:
        """Nothing in that range is active."""
        active = Ref(f"{where.set} ({where.variable})")
        return ForAll(where.variable, nodes, Prefix("not", active))
