"""Exits, effects and entries of one region, with the ghost set that proves their order.

A state may be exited only when it is active and nothing inside it is; entered
only when its parent is active and nothing inside the parent is; an effect runs
in exactly the common ancestors. The order then follows from the preconditions.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from ..model import Component
from ..statechart import Region, Transition, TransitionKind
from .ada import (
    FALSE,
    NULL,
    TRUE,
    Aggregate,
    Arg,
    Aspect,
    Assign,
    Case,
    Chain,
    Decl,
    Do,
    EnumType,
    Expr,
    ForAll,
    Package,
    Param,
    PlainType,
    Pragma,
    Prefix,
    Ref,
    Stmt,
    Subprogram,
    arguments,
    both,
    call,
    chain,
    equal,
    member,
    number,
)
from .naming import ada_case, states_package
from .terms import Scope, certain_sends, emit_flow

_WHOLE = "Chart.Node"


@dataclass(slots=True)
class Moves:
    """Builds the body of Fire, and remembers which procedures it needs."""

    component: Component
    region: Region
    scope: Scope
    timers: tuple[Transition, ...] = ()
    _used: set[tuple[str, str]] = field(default_factory=set)

    def chart(self) -> Package:
        """The ghost package: all states, and which are active in a leaf."""
        states = self.region.states
        rows = tuple(Arg(ada_case(s.name), self._within("Leaf", s.name)) for s in states)
        leaf = f"{states_package(self.region)}.Leaf"
        return Package(
            "Chart",
            (
                EnumType("Node", tuple(ada_case(s.name) for s in states)),
                PlainType("Node_Set", "array (Node) of Boolean"),
                Subprogram(
                    "Configuration",
                    (Param("Leaf", "in", leaf),),
                    "Node_Set",
                    expression=Aggregate(rows),
                ),
            ),
            (Aspect("Ghost"),),
        )

    def claim(self, fact: Expr) -> Pragma:
        """An assertion for the prover and for builds with checks."""
        return Pragma("Assert", (fact,))

    # --- the statements of Fire

    def start(self) -> tuple[Stmt, ...]:
        """Initial entry of the region."""
        return self._enter_down(self.region.initial.target, None)

    def transition(self, transition: Transition) -> tuple[Stmt, ...]:
        """Exits, effect, entries."""
        effect = emit_flow(self.scope, transition.effect)
        if transition.kind is TransitionKind.INTERNAL:
            return effect or (NULL,)
        domain = self._domain(transition)
        out = self._leave_up(transition.source, domain)
        place = (self._place_claim(domain),) if effect else ()
        return (*out, *place, *effect, *self._enter_down(transition.target, domain))

    def _domain(self, transition: Transition) -> str | None:
        """The innermost state that properly contains both ends; None is the region."""
        above = self.region.ancestors(transition.source)[1:]
        target_above = self.region.ancestors(transition.target)[1:]
        return next((s for s in above if s in target_above), None)

    def _leave_up(self, source: str, domain: str | None) -> tuple[Stmt, ...]:
        inner = () if self.region.state(source).is_leaf else (self._call("Leave", source),)
        return (*inner, *(self._call("Exit", s) for s in self._left(source, domain)))

    def _left(self, source: str, domain: str | None) -> list[str]:
        above = self.region.ancestors(source)
        return list(above if domain is None else above[: above.index(domain)])

    def _enter_down(self, target: str, domain: str | None) -> tuple[Stmt, ...]:
        return tuple(self._call("Enter", state) for state in self._entered(target, domain))

    def _entered(self, target: str, domain: str | None) -> list[str]:
        path = self._left(target, domain)[::-1]
        at = self.region.state(target)
        while at.regions:
            inner = self.region.ancestors(at.regions[0].initial.target)
            path += reversed(inner[: inner.index(at.name)])
            at = self.region.state(inner[0])
        return path

    def fills_outbox(self) -> bool:
        """Does every firing send on every port that any firing sends on, and raise nothing?"""
        region = self.region
        rows = [[region.state(s).entry for s in self._entered(region.initial.target, None)]]
        for t in region.transitions:
            flows = [t.effect]
            if t.kind is not TransitionKind.INTERNAL:
                domain = self._domain(t)
                flows += [region.state(s).exit for s in self._left(t.source, domain)]
                flows += [region.state(s).entry for s in self._entered(t.target, domain)]
            rows.append(flows)
        sends = set(region.sends)
        return not region.raises and all(set().union(*map(certain_sends, r)) == sends for r in rows)

    def _place_claim(self, domain: str | None) -> Pragma:
        if domain is None:
            return self.claim(self._none_in(_WHOLE))
        inside = [f"Chart.{ada_case(s)}" for s in self.region.ancestors(domain)]
        wanted = member(Ref("N"), " | ".join(inside))
        return self.claim(ForAll("N", _WHOLE, equal(Ref("Active (N)"), wanted)))

    def _call(self, verb: str, state: str) -> Do:
        self._used.add((verb, state))
        return Do(f"{verb}_{ada_case(state)}")

    # --- the procedures

    def procedures(self) -> tuple[Decl, ...]:
        """The exits, leavings and entries that Fire calls, callees first."""
        needed = self._closure()
        exits = [self._exit(s.name) for s in self.region.states if ("Exit", s.name) in needed]
        enters = [self._enter(s.name) for s in self.region.states if ("Enter", s.name) in needed]
        leavings = [
            self._leave(s.name) for s in reversed(self.region.states) if ("Leave", s.name) in needed
        ]
        return (*exits, *leavings, *enters)

    def _closure(self) -> set[tuple[str, str]]:
        needed = set(self._used)
        for state in self.region.states:
            if ("Leave", state.name) in needed:
                for child in self.region.children(state.name):
                    needed.add(("Exit", child.name))
                    if not child.is_leaf:
                        needed.add(("Leave", child.name))
        return needed

    def _within(self, leaf: str, state: str) -> Expr:
        name = f"{states_package(self.region)}.{ada_case(state)}"
        if self.region.state(state).is_leaf:
            return equal(Ref(leaf), Ref(name))
        return member(Ref(leaf), name)

    def _inside(self, state: str | None) -> str:
        """The nodes properly inside ``state``, as a range."""
        if state is None:
            return _WHOLE
        below = [s.name for s in self.region.states if state in self.region.ancestors(s.name)[1:]]
        return f"Chart.{ada_case(below[0])} .. Chart.{ada_case(below[-1])}"

    def _none_in(self, nodes: str) -> Expr:
        return ForAll("N", nodes, Prefix("not", Ref("Active (N)")))

    def _leaf_kept(self) -> Expr:
        return equal(Ref("Self.Leaf"), Ref("Self.Leaf'Old"))

    def _exit(self, state: str) -> Subprogram:
        node = f"Chart.{ada_case(state)}"
        ready: list[Expr] = [Ref(f"Active ({node})")]
        if not self.region.state(state).is_leaf:
            ready.append(self._none_in(self._inside(state)))
        after = ForAll(
            "N",
            _WHOLE,
            equal(
                Ref("Active (N)"),
                Chain("and then", (Chain("/=", (Ref("N"), Ref(node))), Ref("Active'Old (N)"))),
            ),
        )
        stops = tuple(
            Do("Ravenchart.Timers.Disarm", arguments(Ref(f"Self.Timers ({i})")))
            for i, t in enumerate(self.timers, 1)
            if t.source == state
        )
        behaviour = emit_flow(self.scope, self.region.state(state).exit)
        return Subprogram(
            f"Exit_{ada_case(state)}",
            aspects=(
                Aspect("Pre", chain("and then", ready)),
                Aspect("Post", both(self._leaf_kept(), after)),
            ),
            body=(*behaviour, *stops, Assign(f"Active ({node})", FALSE)),
        )

    def _enter(self, state: str) -> Subprogram:
        node = f"Chart.{ada_case(state)}"
        parent = self.region.state(state).parent
        ready: list[Expr] = [Ref(f"Active (Chart.{ada_case(parent)})")] if parent else []
        ready.append(self._none_in(self._inside(parent)))
        added = ForAll(
            "N",
            _WHOLE,
            equal(
                Ref("Active (N)"),
                Chain("or else", (equal(Ref("N"), Ref(node)), Ref("Active'Old (N)"))),
            ),
        )
        leaf = f"{states_package(self.region)}.{ada_case(state)}"
        is_leaf = self.region.state(state).is_leaf
        where = equal(Ref("Self.Leaf"), Ref(leaf)) if is_leaf else self._leaf_kept()
        starts = tuple(
            Do(
                "Ravenchart.Timers.Arm",
                arguments(Ref(f"Self.Timers ({i})"), number(t.trigger.executions)),  # type: ignore[union-attr]
            )
            for i, t in enumerate(self.timers, 1)
            if t.source == state
        )
        behaviour = emit_flow(self.scope, self.region.state(state).entry)
        here = (Assign("Self.Leaf", Ref(leaf)),) if is_leaf else ()
        return Subprogram(
            f"Enter_{ada_case(state)}",
            aspects=(Aspect("Pre", both(*ready)), Aspect("Post", both(where, added))),
            body=(*here, *starts, Assign(f"Active ({node})", TRUE), *behaviour),
        )

    def _leave(self, state: str) -> Subprogram:
        rows: list[tuple[str, tuple[Stmt, ...]]] = []
        for child in self.region.children(state):
            name = ada_case(child.name)
            choice = f"{states_package(self.region)}.{name}"
            steps: tuple[Stmt, ...] = (Do(f"Exit_{name}"),)
            if not child.is_leaf:
                steps = (Do(f"Leave_{name}"), *steps)
            rows.append((choice, steps))
        own = f"{states_package(self.region)}.{ada_case(state)}"
        ready = both(
            member(Ref("Self.Leaf"), own),
            equal(Ref("Active"), call("Chart.Configuration", Ref("Self.Leaf"))),
        )
        after = ForAll(
            "N",
            _WHOLE,
            equal(
                Ref("Active (N)"),
                Chain(
                    "and then",
                    (Chain("not in", (Ref("N"), Ref(self._inside(state)))), Ref("Active'Old (N)")),
                ),
            ),
        )
        return Subprogram(
            f"Leave_{ada_case(state)}",
            aspects=(Aspect("Pre", ready), Aspect("Post", both(self._leaf_kept(), after))),
            body=(Case(Ref(f"{own}'(Self.Leaf)"), tuple(rows)),),
        )
