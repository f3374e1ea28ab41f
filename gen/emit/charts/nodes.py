"""The ghost of the states that are active: when one may be exited or entered.

In each lane the active states are a path, from the outermost to the innermost, so the
innermost one says which they are; it may be a pseudostate that is passed. To exit a
state, it must be the innermost; to enter one, the state around it must be, or nothing
where it stands outermost in its lane. What is active in other lanes below an orthogonal
state is left before it and entered after it.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...statechart import Lane
from ..ada import (
    Aspect,
    Assign,
    Call,
    Chain,
    Decl,
    EnumType,
    Expr,
    IfExpr,
    Object,
    Package,
    Param,
    Ref,
    Stmt,
    Subprogram,
    both,
    call,
    equal,
    number,
)
from ..naming import ada_case
from .compound import Place
from .shape import RegionShape

NODES = "Chart.Node"
_GHOST = Aspect("Ghost")
_NOWHERE = "Nowhere"


_MOVED = Subprogram(
    "Moved",
    tuple(Param(name, "in", "Node") for name in ("Active_Node", "From_Node", "To_Node")),
    "Node",
    aspects=(Aspect("Pre", equal(Ref("Active_Node"), Ref("From_Node"))),),
    expression=Ref("To_Node"),
)
"""Exits and entries that do nothing but this: their order is the precondition."""


def joined(statements: Sequence[Stmt]) -> tuple[Stmt, ...]:
    """Exits and entries that do nothing, one after the other, as one move."""
    found: list[Stmt] = []
    for statement in statements:
        match (found[-1:], statement):
            case (
                [Assign(one, Call("Chart.Moved", (active, start, via)))],
                Assign(other, Call("Chart.Moved", (_, then, goal))),
            ) if one == other and via == then:
                found[-1] = Assign(one, Call("Chart.Moved", (active, start, goal)))
            case _:
                found.append(statement)
    return tuple(found)


def node(state: str) -> Ref:
    """A state or pseudostate of the ghost."""
    return Ref(f"Chart.{ada_case(state)}")


class Nodes:
    """The innermost active states of one region: a ghost variable for each lane."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region
        self._moves = False

    def chart(self) -> Package:
        """The ghost package: all vertices, and the innermost active one of a configuration.

        With what the exits and entries given so far need.
        """
        shape = self.shape
        literals = [leaf for lane in shape.lanes for leaf in shape.literals(lane)]
        composites = [s.name for s in self.region.states if not shape.is_literal(s.name)]
        names = tuple(ada_case(v) for v in (*literals, *composites))
        functions: list[Decl] = []
        before = 1
        for lane in shape.lanes:
            functions.append(self._innermost(lane, before))
            before += len(shape.literals(lane))
        nodes = EnumType("Node", (_NOWHERE, *names))
        moved = (_MOVED,) if self._moves else ()
        return Package("Chart", (nodes, *functions, *moved), (_GHOST,))

    def _innermost(self, lane: Lane, before: int) -> Subprogram:
        """A leaf, which stands among the nodes in the order of its type; a number for provers."""
        shape = self.shape
        leaf = call(f"{shape.states}.{shape.lane_type(lane)}'Pos", Ref(shape.at(shape.place, lane)))
        found: Expr = call("Node'Val", Chain("+", (leaf, number(before))))
        if lane.owner is not None:
            found = IfExpr(((shape.in_state(shape.place, lane.owner), found),), Ref(_NOWHERE))
        params = (Param(shape.place, "in", shape.place_type),)
        return Subprogram(f"Innermost{self._suffix(lane)}", params, "Node", expression=found)

    def _suffix(self, lane: Lane) -> str:
        return "" if self.shape.single else f"_{self.shape.lane_name(lane)}"

    def _around(self, vertex: str) -> str:
        """The state around a vertex in its lane, if there is one."""
        place = self.shape.compounds.place(vertex)
        if place.owner is None or self.region.state(place.owner).is_orthogonal:
            return _NOWHERE
        return ada_case(place.owner)

    # --- the variables

    def active(self, lane: Lane) -> Ref:
        """The innermost active state of a lane."""
        return Ref(f"Active{self._suffix(lane)}")

    def variables(self, started: Expr, held: str) -> list[Decl]:
        """One for each lane, as the configuration says."""
        nowhere = Ref(f"Chart.{_NOWHERE}")
        return [
            Object(
                self.active(lane).text,
                NODES,
                IfExpr(((started, self.innermost(lane, held)),), nowhere),
                aspects=(_GHOST,),
            )
            for lane in self.shape.lanes
        ]

    def innermost(self, lane: Lane, held: str) -> Expr:
        """The innermost active state of a lane in a configuration."""
        return call(f"Chart.Innermost{self._suffix(lane)}", Ref(held))

    def agreed(self, held: str, lanes: Sequence[Lane] | None = None) -> Expr:
        """What is active is as the configuration says, in these lanes or all."""
        among = self.shape.lanes if lanes is None else lanes
        return both(*(equal(self.active(n), self.innermost(n, held)) for n in among))

    def exit(self, state: str) -> Assign:
        """The exit of a state that does nothing else."""
        active, gone = self.exited(state)
        return self._move(active, node(state), gone)

    def enter(self, state: str) -> Assign:
        """The entry of a state that does nothing else."""
        active, come = self.entered(state)
        _, around = self.exited(state)
        return self._move(active, around, come)

    def _move(self, active: Ref, start: Ref, goal: Ref) -> Assign:
        self._moves = True
        return Assign(active.text, call("Chart.Moved", active, start, goal))

    def exited(self, state: str) -> tuple[Ref, Ref]:
        """The variable that the exit of a state changes, and its value then."""
        return self.active(self.region.lane(state)), Ref(f"Chart.{self._around(state)}")

    def entered(self, state: str) -> tuple[Ref, Ref]:
        """The variable that the entry of a state changes, and its value then."""
        return self.active(self.region.lane(state)), node(state)

    def stopped(self, goal: dict[Lane, str]) -> list[Assign]:
        """The region has come to its end."""
        return [
            Assign(self.active(n).text, node(goal[n]) if n in goal else Ref(f"Chart.{_NOWHERE}"))
            for n in self.shape.lanes
        ]

    # --- when a state may be exited or entered

    def ready_to_exit(self, state: str) -> list[Expr]:
        """It is active, and nothing inside it is."""
        return [equal(*self.entered(state)), *self._idle(self.shape.lanes_of(state))]

    def ready_to_enter(self, vertex: str) -> list[Expr]:
        """Its parent is active, and nothing in its own region or inside it is."""
        place = self.shape.compounds.place(vertex)
        ready = [
            equal(self.active(self.shape.lane_of(place)), Ref(f"Chart.{self._around(vertex)}"))
        ]
        if place.owner is not None and self.region.state(place.owner).is_orthogonal:
            ready.append(equal(*self.entered(place.owner)))
        return [*ready, *self._idle(self.shape.lanes_of(vertex))]

    def empty(self, place: Place) -> list[Expr]:
        """Nothing in a region is active."""
        lane = self.shape.lane_of(place)
        inside = place.owner if lane.owner != place.owner else None
        here = Ref(f"Chart.{_NOWHERE}") if inside is None else node(inside)
        return [equal(self.active(lane), here), *self._idle(self.lanes_inside(place))]

    def _idle(self, lanes: Sequence[Lane]) -> list[Expr]:
        return [equal(self.active(n), Ref(f"Chart.{_NOWHERE}")) for n in lanes]

    def lanes_inside(self, place: Place) -> list[Lane]:
        """The lanes of the orthogonal states inside a region."""
        return [
            n
            for n in self.shape.lanes
            if n.owner is not None and place in self.shape.compounds.places(n.owner)
        ]
