# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The ghost of the states that are active: when one may be exited or entered.

In each top-level or orthogonal region the active states are a path, so the innermost one tells
which they are; it may be a pseudostate that is passed. To exit a state, it must be the innermost.
To enter one, the state around it must be the innermost, or nothing where it stands outermost in
such a region. States of the regions of an orthogonal state are left before it and entered after
it. Any other exit or entry brings disorder, and nothing leads out of that. So where a
configuration is claimed afterwards, everything before it was in order.
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
    RecordComponent,
    RecordDeclaration,
    Subprogram,
)
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    Aggregate,
    Arg,
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
from ravenchart.gen.emit.language.configurations import conjuncts
from ravenchart.gen.emit.language.own_names import node_literal
from ravenchart.gen.model.statechart import RegionId

from .shape import RegionShape

CHART = "Chart"
NODE = ref(CHART, "Node")
NODES = ref(CHART, "Nodes")
"""Of charts with orthogonal regions: a node for each, and one for the top."""
_GHOST = Aspect("Ghost")
_NOWHERE = "Nowhere"
_DISORDER = "Disorder"
_NONE_ACTIVE = ref(CHART, _NOWHERE)
_NO_ORDER = ref(CHART, _DISORDER)

_ACTIVE = ref("Active")
_AT_FIRST = ref("Active_At_First")
_MOVED = "Moved"
_IN_ORDER = "In_Order"


def as_one_move(statements: Sequence[Stmt]) -> tuple[Stmt, ...]:
    """Exits, entries and claims that do nothing, one after the other, as one move.

    The precondition of each is about other regions, which the rest of them do not change.
    """
    found: list[Stmt] = []
    for statement in statements:
        match (found[-1:], statement):
            case (
                [Assign(one, Call(DottedName(("Moved",)), (active, start, via, *first)))],
                Assign(other, Call(DottedName(("Moved",)), (_, then, goal, *more))),
            ) if one == other and via == then:
                asked = dict.fromkeys(arg.value for arg in (*first, *more))
                all_asked = (Arg(None, both(*conjuncts([*asked]))),) if asked else ()
                found[-1] = Assign(one, Call(_MOVED, (active, start, goal, *all_asked)))
            case _:
                found.append(statement)
    return tuple(found)


def node(state: str) -> DottedName:
    """A state or pseudostate of the ghost."""
    return ref(CHART, node_literal(state))


class Nodes:
    """The innermost active states of a chart: a ghost variable with a part for each region."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region
        self._moves = self._asks = self._leaves = False

    def chart(self, fire: Subprogram) -> Package:
        """The ghost package: the innermost active vertex in each region of a configuration.

        It has all leaves, and the composites that ``fire`` needs: joined moves pass by the
        others.
        """
        shape = self.shape
        literals = [leaf for region in shape.concurrent for leaf in shape.literals(region)]
        composites = [s.name for s in self.region.states if not shape.is_literal(s.name)]
        named = set(names_in(fire)) if composites else set()
        composites = [name for name in composites if node(name) in named]
        names = tuple(node_literal(v) for v in (*literals, *composites))
        items: list[Decl] = [EnumType("Node", (_NOWHERE, *names, _DISORDER))]
        if not shape.single:
            rows = tuple(RecordComponent(shape.label(r), "Node") for r in shape.concurrent)
            items.append(RecordDeclaration("Nodes", rows))
        return Package(CHART, (*items, self._innermost()), (_GHOST,))

    def moved(self) -> tuple[Subprogram, ...]:
        """The effect of an exit or entry; none runs before the region has started.

        As it reads the region, nothing that is set before it counts as unused: an entry may set
        again what an exit has set.
        """
        if not self._moves:
            return ()
        ready: list[Expr] = [ref("Self.Started"), equal(ref("Active_Node"), ref("From_Node"))]
        params = [Param(name, "in", NODE) for name in ("Active_Node", "From_Node", "To_Node")]
        if self._asks:
            ready.append(ref(_IN_ORDER))
            params.append(Param(_IN_ORDER, "in", "Boolean", default=TRUE))
        goal = IfExpr(((both(*ready), ref("To_Node")),), _NO_ORDER)
        return (Subprogram(_MOVED, tuple(params), NODE, (_GHOST,), expression=goal),)

    def _innermost(self) -> Subprogram:
        """Leaves, which stand among the nodes in the order of their types; numbers for provers."""
        shape = self.shape
        held = shape.held
        rows: list[Arg] = []
        before = 1
        for region in shape.concurrent:
            of_region = ref(shape.states, shape.leaves_type(region))
            leaf = call(Attribute(of_region, "Pos"), shape.at(held, region))
            found: Expr = call(Attribute("Node", "Val"), OperatorChain("+", (leaf, number(before))))
            active: list[Expr] = [ref("Self.Started")]
            if region.owner is not None:
                active += conjuncts([shape.in_state(held, region.owner)])
            found = IfExpr(((both(*active), found),), ref(_NOWHERE))
            rows.append(Arg(shape.label(region), found))
            before += len(shape.literals(region))
        params = (Param("Self", "in", "Region"),)
        if shape.single:
            return Subprogram("Innermost", params, "Node", expression=rows[0].value)
        return Subprogram("Innermost", params, "Nodes", expression=Aggregate(tuple(rows)))

    def _around(self, vertex: str) -> DottedName:
        """The state around a vertex, unless an orthogonal region begins between them."""
        region = self.shape.region.region_of(vertex)
        if region.owner is None or self.region.state(region.owner).is_orthogonal:
            return _NONE_ACTIVE
        return node(region.owner)

    # --- the variables

    def _part(self, nodes: DottedName, region: RegionId) -> DottedName:
        return nodes if self.shape.single else ref(nodes, self.shape.label(region))

    def active(self, region: RegionId) -> DottedName:
        """The innermost active state of a concurrent region."""
        return self._part(_ACTIVE, region)

    def variables(self) -> list[Decl]:
        """The active vertices; where a region is left at once, also those at first."""
        of_type = NODE if self.shape.single else NODES
        ghost = (_GHOST,)
        found: list[Decl] = [Object(_ACTIVE, of_type, self.innermost("Self"), aspects=ghost)]
        if self._leaves:
            found.append(Object(_AT_FIRST, of_type, _ACTIVE, constant=True, aspects=ghost))
        return found

    def innermost(self, region: str) -> Expr:
        """The innermost active states by the configuration of a region."""
        return call(ref(CHART, "Innermost"), ref(region))

    def agreed(self, region: str = "Self") -> Expr:
        """That the active vertices are those of a chart's configuration."""
        return equal(_ACTIVE, self.innermost(region))

    def begun(self, region: str) -> list[Expr]:
        """The same before anything has moved."""
        at_first = [equal(_AT_FIRST, _ACTIVE)] if self._leaves else []
        return [self.agreed(region), *at_first]

    def exit(self, state: str) -> Assign:
        """The exit of a state."""
        others = self._idle(self.shape.orthogonal_regions(state))
        return self._moved(state, (node(state), self._around(state)), others)

    def enter(self, vertex: str) -> Assign:
        """The entry of a vertex, where its parent is active and nothing in its own region is."""
        region = self.shape.region.region_of(vertex)
        others = self._idle(self.shape.orthogonal_regions(vertex))
        if region.owner is not None and self.region.state(region.owner).is_orthogonal:
            others = [equal(self._of(region.owner), node(region.owner)), *others]
        return self._moved(vertex, (self._around(vertex), node(vertex)), others)

    def leave(self, region: RegionId, before: str) -> Assign:
        """The exits of all that was active ``before`` in a region, all at once."""
        assert region.owner is not None
        self._moves = self._asks = self._leaves = True
        active = self.active(self.shape.concurrent_around(region))
        within = self.shape.in_state(before, region.owner)
        start = self._part(_AT_FIRST, self.shape.concurrent_around(region))
        return Assign(active, call(_MOVED, active, start, self._inside(region), within))

    def stands(self, vertex: str) -> Assign:
        """The claim that a vertex is the innermost active one of its region."""
        return self._moved(vertex, (node(vertex), node(vertex)), ())

    def empty(self, region: RegionId) -> Assign:
        """The claim that nothing in a region is active."""
        self._moves = True
        idle = self._idle(self.orthogonal_inside(region))
        self._asks |= bool(idle)
        active, inside = self.active(self.shape.concurrent_around(region)), self._inside(region)
        asked = (both(*idle),) if idle else ()
        return Assign(active, call(_MOVED, active, inside, inside, *asked))

    def _moved(
        self, vertex: str, way: tuple[DottedName, DottedName], others: Sequence[Expr]
    ) -> Assign:
        self._moves = True
        self._asks |= bool(others)
        asked = (both(*others),) if others else ()
        active = self._of(vertex)
        return Assign(active, call(_MOVED, active, *way, *asked))

    def _of(self, vertex: str) -> DottedName:
        """The variable of the concurrent region that a vertex stands in."""
        region = self.shape.region.region_of(vertex)
        return self.active(self.shape.concurrent_around(region))

    def stopped(self, end_of_all: str) -> list[Assign]:
        """The end of the chart, a leaf of the top-level region: no orthogonal region is active."""
        found = []
        for region in self.shape.concurrent:
            active = self.active(region)
            end = node(end_of_all) if region.owner is None else _NONE_ACTIVE
            found.append(Assign(active, IfExpr(((equal(active, _NO_ORDER), _NO_ORDER),), end)))
        return found

    def _inside(self, region: RegionId) -> DottedName:
        """The state around a region; none where the region is orthogonal or the top."""
        if region.owner is None or self.shape.concurrent_around(region) == region:
            return _NONE_ACTIVE
        return node(region.owner)

    def _idle(self, regions: Sequence[RegionId]) -> list[Expr]:
        return [equal(self.active(region), _NONE_ACTIVE) for region in regions]

    def orthogonal_inside(self, region: RegionId) -> list[RegionId]:
        """The regions of the orthogonal states inside a region."""
        around = self.shape.region.regions_around
        return [r for r in self.shape.concurrent if r.owner and region in around(r.owner)]
