# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The ghost of the states that are active: when one may be exited or entered.

In each lane the active states are a path, from the outermost to the innermost, so the
innermost one says which they are; it may be a pseudostate that is passed. To exit a
state, it must be the innermost; to enter one, the state around it must be, or nothing
where it stands outermost in its lane. What is active in other lanes below an orthogonal
state is left before it and entered after it. What is exited or entered otherwise brings
disorder, and nothing leads out of that: where a configuration is claimed afterwards,
everything before it was in order.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import (
    Aspect,
    Decl,
    EnumType,
    Object,
    Package,
    Param,
    Subprogram,
)
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    Attribute,
    Call,
    Expr,
    IfExpr,
    OperatorChain,
    both,
    call,
    equal,
    number,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.statements import Assign, Stmt
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.emit.language.own_names import node_literal
from ravenchart.gen.emit.language.places import flat
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.statechart import Lane

from .shape import RegionShape

NODES = ref("Chart.Node")
_GHOST = Aspect("Ghost")
_NOWHERE = "Nowhere"
_DISORDER = "Disorder"
_NONE_ACTIVE = ref("Chart", _NOWHERE)
_NO_ORDER = ref("Chart", _DISORDER)

_MOVED = "Moved"
_IN_ORDER = "In_Order"


def joined(statements: Sequence[Stmt]) -> tuple[Stmt, ...]:
    """Exits and entries that do nothing, one after the other, as one move."""
    found: list[Stmt] = []
    for statement in statements:
        match (found[-1:], statement):
            case (
                [Assign(one, Call(DottedName(("Moved",)), (active, start, via)))],
                Assign(other, Call(DottedName(("Moved",)), (_, then, goal))),
            ) if one == other and via == then:
                found[-1] = Assign(one, Call(_MOVED, (active, start, goal)))
            case _:
                found.append(statement)
    return tuple(found)


def node(state: str) -> DottedName:
    """A state or pseudostate of the ghost."""
    return ref("Chart", node_literal(state))


class Nodes:
    """The innermost active states of one region: a ghost variable for each lane."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region
        self._moves = self._asks = False

    def chart(self, fire: Subprogram) -> Package:
        """The ghost package: the innermost active vertex of a configuration.

        It has all leaves, and the composites and functions that ``fire`` needs: joined
        moves pass by the others.
        """
        shape = self.shape
        literals = [leaf for lane in shape.lanes for leaf in shape.literals(lane)]
        composites = [s.name for s in self.region.states if not shape.is_literal(s.name)]
        named = set(names_in(fire)) if composites else set()
        composites = [name for name in composites if node(name) in named]
        names = tuple(node_literal(v) for v in (*literals, *composites))
        functions: list[Decl] = []
        before = 1
        for lane in shape.lanes:
            functions.append(self._innermost(lane, before))
            before += len(shape.literals(lane))
        nodes = EnumType("Node", (_NOWHERE, *names, _DISORDER))
        return Package("Chart", (nodes, *functions), (_GHOST,))

    def moved(self) -> tuple[Subprogram, ...]:
        """What an exit or entry does, which none does before the region has started.

        As it reads the region, nothing that is set before it counts as unused: an entry may set
        again what an exit has set.
        """
        if not self._moves:
            return ()
        ready: list[Expr] = [ref("Self.Started"), equal(ref("Active_Node"), ref("From_Node"))]
        params = [Param(name, "in", NODES) for name in ("Active_Node", "From_Node", "To_Node")]
        if self._asks:
            ready.append(ref(_IN_ORDER))
            params.append(Param(_IN_ORDER, "in", "Boolean", default=TRUE))
        goal = IfExpr(((both(*ready), ref("To_Node")),), _NO_ORDER)
        return (Subprogram(_MOVED, tuple(params), NODES, (_GHOST,), expression=goal),)

    def _innermost(self, lane: Lane, before: int) -> Subprogram:
        """A leaf, which stands among the nodes in the order of its type; a number for provers."""
        shape = self.shape
        held = shape.held
        of_lane = ref(shape.states, shape.lane_type(lane))
        leaf = call(Attribute(of_lane, "Pos"), shape.at(held, lane))
        found: Expr = call(Attribute("Node", "Val"), OperatorChain("+", (leaf, number(before))))
        active: list[Expr] = [ref("Self.Started")]
        active += [] if lane.owner is None else flat([shape.in_state(held, lane.owner)])
        found = IfExpr(((both(*active), found),), ref(_NOWHERE))
        params = (Param("Self", "in", "Region"),)
        return Subprogram(f"Innermost{self._suffix(lane)}", params, "Node", expression=found)

    def _suffix(self, lane: Lane) -> str:
        return "" if self.shape.single else f"_{self.shape.lane_name(lane)}"

    def _around(self, vertex: str) -> DottedName:
        """The state around a vertex in its lane, if there is one."""
        place = self.shape.compounds.place(vertex)
        if place.owner is None or self.region.state(place.owner).is_orthogonal:
            return _NONE_ACTIVE
        return node(place.owner)

    # --- the variables

    def active(self, lane: Lane) -> DottedName:
        """The innermost active state of a lane."""
        return ref(f"Active{self._suffix(lane)}")

    def variables(self) -> list[Decl]:
        """One for each lane, as the configuration says."""
        return [
            Object(
                self.active(lane),
                NODES,
                self.innermost(lane),
                aspects=(_GHOST,),
            )
            for lane in self.shape.lanes
        ]

    def innermost(self, lane: Lane) -> Expr:
        """The innermost active state of a lane by the region's configuration."""
        return call(ref("Chart", f"Innermost{self._suffix(lane)}"), ref("Self"))

    def agreed(self, lanes: Sequence[Lane] | None = None) -> Expr:
        """What is active is as the configuration says, in these lanes or all."""
        among = self.shape.lanes if lanes is None else lanes
        return both(*(equal(self.active(n), self.innermost(n)) for n in among))

    def exit(self, state: str) -> Assign:
        """The exit of a state."""
        return Assign(self._of(state), self.exited(state))

    def enter(self, vertex: str) -> Assign:
        """The entry of a state."""
        return Assign(self._of(vertex), self.entered(vertex))

    def leave(self, place: Place) -> Assign:
        """The exits of what is active in a region of one lane, all at once."""
        assert place.owner is not None
        self._moves = self._asks = True
        active = self.active(self.shape.lane_of(place))
        within = self.shape.in_state(self.shape.held, place.owner)
        start, goal = self.innermost(self.shape.lane_of(place)), self._inside(place)
        return Assign(active, call(_MOVED, active, start, goal, within))

    def stands(self, vertex: str) -> Expr:
        """A vertex is the innermost active one of its lane."""
        return equal(self._of(vertex), node(vertex))

    def exited(self, state: str) -> Expr:
        """The state around, where it is the innermost and nothing inside it is active."""
        lanes = self._idle(self.shape.lanes_of(state))
        return self._moved(state, (node(state), self._around(state)), lanes)

    def entered(self, vertex: str) -> Expr:
        """The state itself, where its parent is active and nothing in its own region is."""
        place = self.shape.compounds.place(vertex)
        others = self._idle(self.shape.lanes_of(vertex))
        if place.owner is not None and self.region.state(place.owner).is_orthogonal:
            others = [equal(self._of(place.owner), node(place.owner)), *others]
        return self._moved(vertex, (self._around(vertex), node(vertex)), others)

    def _moved(
        self, vertex: str, way: tuple[DottedName, DottedName], others: Sequence[Expr]
    ) -> Expr:
        self._moves = True
        self._asks |= bool(others)
        asked = (both(*others),) if others else ()
        return call(_MOVED, self._of(vertex), *way, *asked)

    def _of(self, vertex: str) -> DottedName:
        """The variable of the lane that a vertex stands in."""
        return self.active(self.shape.lane_of(self.shape.compounds.place(vertex)))

    def stopped(self, end_of_all: str) -> list[Assign]:
        """The region has come to its end, a leaf of the top lane: no other lane is active."""
        found = []
        for lane in self.shape.lanes:
            active = self.active(lane)
            end = node(end_of_all) if lane.owner is None else _NONE_ACTIVE
            found.append(Assign(active, IfExpr(((equal(active, _NO_ORDER), _NO_ORDER),), end)))
        return found

    def empty(self, place: Place) -> list[Expr]:
        """Nothing in a region is active."""
        active = self.active(self.shape.lane_of(place))
        return [equal(active, self._inside(place)), *self._idle(self.lanes_inside(place))]

    def _inside(self, place: Place) -> DottedName:
        """The state around a region, in the lane whose leaves it holds."""
        owner = place.owner if self.shape.lane_of(place).owner != place.owner else None
        return _NONE_ACTIVE if owner is None else node(owner)

    def _idle(self, lanes: Sequence[Lane]) -> list[Expr]:
        return [equal(self.active(n), _NONE_ACTIVE) for n in lanes]

    def lanes_inside(self, place: Place) -> list[Lane]:
        """The lanes of the orthogonal states inside a region."""
        return [
            n
            for n in self.shape.lanes
            if n.owner is not None and place in self.shape.compounds.places(n.owner)
        ]
