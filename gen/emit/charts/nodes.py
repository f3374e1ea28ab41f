"""The ghost set of active states: which there are, and when one may be exited or entered.

A state may be exited only when it is active and nothing inside it is; entered only
when its parent is active and nothing in its own region is.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..ada import (
    Aggregate,
    Arg,
    Aspect,
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
    equal,
)
from ..naming import ada_case
from .compound import TOP, Place
from .shape import RegionShape

NODES = "Chart.Node"
_GHOST = Aspect("Ghost")


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
                *more,
            ),
            (_GHOST,),
        )

    # --- when a state may be exited or entered

    def ready_to_exit(self, state: str) -> list[Expr]:
        """It is active, and nothing inside it is."""
        active = Ref(f"Active (Chart.{ada_case(state)})")
        regions = self.region.state(state).regions
        if not regions:
            return [active]
        first = self.inside(Place(state, regions[0].name)).split(" .. ")[0]
        last = self.inside(Place(state, regions[-1].name)).split(" .. ")[1]
        return [active, self.none_in(f"{first} .. {last}")]

    def ready_to_enter(self, vertex: str) -> list[Expr]:
        """Its parent is active, and nothing in its own region is.

        What is entered last is told more: all states around it are active, nothing else.
        """
        if self.is_last(vertex):
            around: Expr = Ref(f"Chart.Active_In ({self.shape.literal(vertex)}) (N)")
            if self.region.pseudostate(vertex) is None:
                around = both(Chain("/=", (Ref("N"), Ref(f"Chart.{ada_case(vertex)}"))), around)
            return [ForAll("N", NODES, equal(Ref("Active (N)"), around))]
        place = self.shape.compounds.place(vertex)
        none = self.none_in(self.inside(place))
        if place.owner is None:
            return [none]
        return [Ref(f"Active (Chart.{ada_case(place.owner)})"), none]

    def is_last(self, vertex: str) -> bool:
        """Does its entry always end a firing? So does that of a leaf where there is one lane."""
        return self.shape.single and self.shape.is_literal(vertex)

    def inside(self, place: Place) -> str:
        """The states in a region, as a range."""
        if place == TOP:
            return "Chart.Node"
        below = [
            f"Chart.{ada_case(s.name)}"
            for s in self.region.states
            if s.name != place.owner and place in self.shape.compounds.places(s.name)
        ]
        return f"{below[0]} .. {below[-1]}"

    def none_in(self, nodes: str) -> Expr:
        """Nothing in that range is active."""
        active = Ref("Active (N)")
        return ForAll("N", nodes, Prefix("not", active))
