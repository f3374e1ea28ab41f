# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Exits and entries of one region: a procedure for each state where one does something.

A state without actions and completion is exited and entered in the ghost of the active
states alone, for which there is no code. The procedures have neither parameters nor contracts:
gnatprove inlines them where they are called, and proves the caller with their work.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Decl, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    FALSE,
    TRUE,
    Choice,
    Expr,
    Qualified,
    both,
    call,
    chain,
    equal,
)
from ravenchart.gen.emit.ada.named import ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, IfStatement, Stmt, case_of, do
from ravenchart.gen.emit.language.terms import emit_flow
from ravenchart.gen.language.terms import Flow
from ravenchart.gen.model.statechart import RegionId

from .nodes import Nodes, as_one_move
from .shape import RegionShape

BEFORE = "Before"
"""The configuration before a transition."""


def _leave_name(region: RegionId) -> str:
    return f"Leave_{ada_case(region.label)}"


class Moving:
    """Gives the statements of exits and entries, and remembers which procedures they need."""

    def __init__(self, shape: RegionShape, nodes: Nodes) -> None:
        self.shape = shape
        self.region = shape.region
        self.nodes = nodes
        self.scope = shape.scope("Self.Data")
        self.held = shape.held
        self._exited: set[str] = set()
        self._entered: set[str] = set()
        self._left: set[RegionId] = set()

    def exit(self, state: str) -> tuple[Stmt, ...]:
        """The exit of one state, or of a pseudostate that is passed."""
        if self.region.pseudostate(state) is not None:
            return (self.nodes.exit(state),)
        if state in self._exited or self._work_of_exit(state):
            self._exited.add(state)
            return (do(f"Exit_{ada_case(state)}"),)
        return (*self._noted(state, "exit"), self.nodes.exit(state))

    def enter(self, vertex: str) -> tuple[Stmt, ...]:
        """The entry of one state, or of a pseudostate that is passed."""
        if self.region.pseudostate(vertex) is not None:
            return (self.nodes.enter(vertex),)
        if vertex in self._entered or any(self._work_of_entry(vertex)):
            self._entered.add(vertex)
            return (do(f"Enter_{ada_case(vertex)}"),)
        return (self.nodes.enter(vertex), *self._noted(vertex, "entry"))

    def leave(self, region: RegionId) -> Stmt:
        """The exits of all that is active in a region."""
        if region.owner is not None and self._is_silent(region):
            return self.nodes.leave(region, BEFORE)
        if region not in self._left:
            self._left.add(region)
            for child in self.region.children(*region):
                self.exit(child.name)
                for nested in child.region_ids:
                    self.leave(nested)
        return do(_leave_name(region))

    def _is_silent(self, region: RegionId) -> bool:
        """Whether nothing is done there however it is left, and no orthogonal region ends there."""
        states = self.region.children(*region)
        return (
            region.owner is not None
            and not self.shape.compounds.passed(region)
            and not any(
                s.is_orthogonal or self._work_of_exit(s.name) or self._noted(s.name, "exit")
                for s in states
            )
            and all(self._is_silent(nested) for s in states for nested in s.region_ids)
        )

    def flows(self) -> list[Flow]:
        """The actions of the exits and entries given so far."""
        exits = [self.region.state(name).exit for name in self._exited]
        return [*exits, *(self.region.state(name).entry for name in self._entered)]

    # --- the procedures, callees first

    def procedures(self) -> tuple[Decl, ...]:
        """Those that the statements given so far call."""
        states = self.region.states
        exits = [self._exit(s.name) for s in states if s.name in self._exited]
        regions = [nested for s in reversed(states) for nested in s.region_ids]
        left = [region for region in regions if region in self._left]
        leavings = [self._leaving(region) for region in left]
        entries = [self._entry(s.name) for s in states if s.name in self._entered]
        return (*exits, *leavings, *entries)

    def _exit(self, state: str) -> Subprogram:
        return Subprogram(
            f"Exit_{ada_case(state)}",
            body=(
                *self._noted(state, "exit"),
                *self._work_of_exit(state),
                self.nodes.exit(state),
            ),
        )

    def _noted(self, state: str, what: str) -> tuple[Stmt, ...]:
        return () if self.region.state(state).final else self.shape.note(f"{state}.{what}")

    def _work_of_exit(self, state: str) -> tuple[Stmt, ...]:
        """The work of a state's exit: its actions, and the end of its completion."""
        completed = Assign(ref("Self", self.shape.completed(state)), FALSE)
        undone = (completed,) if state in self.shape.completing else ()
        return (*emit_flow(self.scope, self.region.state(state).exit), *undone)

    def _entry(self, vertex: str) -> Subprogram:
        first, then = self._work_of_entry(vertex)
        noted = self._noted(vertex, "entry")
        return Subprogram(
            f"Enter_{ada_case(vertex)}",
            body=(*first, self.nodes.enter(vertex), *noted, *then),
        )

    def _work_of_entry(self, state: str) -> tuple[tuple[Stmt, ...], tuple[Stmt, ...]]:
        """The work of a state's entry: another visit; its action and completion."""
        action = emit_flow(self.scope, self.region.state(state).entry)
        return self._begin_work(state), (*action, *self._complete(state))

    def _begin_work(self, state: str) -> tuple[Stmt, ...]:
        """Another visit, in which the do activity is not done yet."""
        if state not in self.shape.working:
            return ()
        visits = ref("Self", self.shape.visits(state))
        return (
            Assign(visits, call("Ravenchart.Next", ref(visits))),
            Assign(ref("Self", self.shape.done(state)), FALSE),
        )

    def _complete(self, vertex: str) -> tuple[Stmt, ...]:
        """The completion by an entry: of the leaf itself, or of the state around a final one."""
        state = self.region.state(vertex)
        shape = self.shape
        if vertex in shape.completing and state.is_leaf and vertex not in shape.working:
            return (Assign(ref("Self", shape.completed(vertex)), TRUE),)
        owner = state.parent
        if not state.final or owner is None or owner not in shape.completing:
            return ()
        done = Assign(ref("Self", shape.completed(owner)), TRUE)
        others = [r for r in self.region.state(owner).region_ids if r.name != state.region]
        parts: list[Expr] = [ref("Self", shape.done(owner))] if owner in shape.working else []
        for nested in others:
            leaf = shape.at(self.held, shape.concurrent_around(nested))
            finals = [
                equal(leaf, shape.literal(s.name)) for s in self.region.children(*nested) if s.final
            ]
            parts.append(chain("or else", finals, FALSE))
        return (IfStatement(((both(*parts), (done,)),)),) if parts else (done,)

    def _leaving(self, region: RegionId) -> Subprogram:
        assert region.owner is not None
        shape = self.shape
        rows: list[tuple[Choice, tuple[Stmt, ...]]] = []
        for child in self.region.children(*region):
            inner = [self.leave(nested) for nested in child.region_ids]
            rows.append((shape.literal(child.name), as_one_move((*inner, *self.exit(child.name)))))
        rows += [(shape.literal(p), self.exit(p)) for p in shape.compounds.passed(region)]
        leaf: Expr = shape.at(BEFORE, shape.concurrent_around(region))
        if not self.region.state(region.owner).is_orthogonal:
            leaf = Qualified(shape.literal(region.owner), leaf)
        return Subprogram(_leave_name(region), body=(case_of(leaf, rows),))
