# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Exits, effects and entries of one region, with the ghost that proves their order.

A state may be exited only when it is active and nothing inside it is. It may be entered only when
its parent is active and nothing in its own region is. An effect runs when everything in the
region that holds the transition has been left, and nothing else. The order follows from the
ghost.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cached_property

from ravenchart.gen.emit.ada.declarations import (
    Aspect,
    Decl,
    Object,
    Package,
    Param,
    Subprogram,
    SubtypeDeclaration,
    UseType,
)
from ravenchart.gen.emit.ada.expressions import (
    TRUE,
    Choice,
    Expr,
    IfExpr,
    Prefix,
    Range,
    RangeConstrained,
    both,
    call,
    equal,
    old,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.statements import (
    NULL,
    Assign,
    Comment,
    Pragma,
    Stmt,
    case_of,
    do,
)
from ravenchart.gen.emit.ada.walking import names_in
from ravenchart.gen.emit.language.compound import Effect, EntryStep, Firing, FiringKind
from ravenchart.gen.emit.language.terms import certain_sends, emit_flow, flow_names
from ravenchart.gen.language.terms import Flow
from ravenchart.gen.model.statechart import TOP, PseudoKind

from .deferring import STORE
from .history import Restoring
from .lasting import Lasting, called_with, in_one_word, of_before, terminates
from .moving import BEFORE, Moving
from .nodes import NODE, NODES, Nodes, as_one_move
from .safety import Safety, used
from .shape import START, RegionShape

MANY = 100
"""Charts with more transitions, counted once for each region, take them by procedures of `BATCH`
transitions each."""
BATCH = 12
"""The transitions of such a procedure: the prover has few to see at a time."""
ALONE = 20
"""In charts with orthogonal regions and more transitions than this, each transition ends in an
assertion of its own. The provers of the younger age give up on all of them at once."""

_BEFORE, _CHOSEN = Param("Before", "in", "Region"), Param("Chosen", "in", "Firing")
_WAS = "Was"
"""The region before a transition, for the procedures that take a few transitions each."""
_BEGUN = "Is_Begun"
_STILL = "Is_Still"
_LASTING = "Whether Chosen has changed time-outs, memory and deferred events as declared."
_READY = (
    "Whether Chosen may be taken: Initial_Entry before the start, any other transition while its "
    "source is active."
)
_TAKEN = "Whether the region is as declared after Chosen has been taken."
_GHOST = (Aspect("Ghost"),)

_Row = tuple[str, tuple[Stmt, ...]]
"""A transition by its literal, and what it does."""


def _between(claim: Stmt, effect: tuple[Stmt, ...]) -> tuple[Stmt, ...]:
    """An effect between the claim and the claim again, which fixes its position in the order."""
    return (claim, *effect, claim) if effect else ()


def _range(rows: Sequence[_Row]) -> Range:
    return Range(ref(rows[0][0]), ref(rows[-1][0]))


def _procedure(rows: Sequence[_Row], claims: tuple[Aspect, ...]) -> tuple[Decl, Decl]:
    """A procedure for some transitions, and their type."""
    own = SubtypeDeclaration(f"From_{rows[0][0]}", RangeConstrained("Selection", _range(rows)))
    body = (case_of(ref("Chosen"), rows),)
    chosen = Param("Chosen", "in", own.name)
    return own, Subprogram(f"Fire_{own.name}", (chosen,), aspects=claims, body=body)


def _call(rows: Sequence[_Row]) -> tuple[Range, tuple[Stmt, ...]]:
    return _range(rows), (do(f"Fire_From_{rows[0][0]}", ref("Chosen")),)


class Moves:
    """Builds Fire, and remembers which procedures it needs."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region
        self.scope = shape.scope("Self.Data")
        self.held = shape.held
        self.lasting = Lasting(shape)
        self.nodes = Nodes(shape)
        self.safety = Safety(shape)
        self.moving = Moving(shape, self.nodes)
        self._effects_given: list[Flow] = []

    def chart(self, fire: Subprogram) -> Package:
        """The ghost package of the states that ``fire`` moves between."""
        return self.nodes.chart(fire)

    # --- Fire

    def fire(self) -> Subprogram:
        """Fire: the declared changes, then exits, effects and entries of one transition."""
        start = as_one_move(self._steps(self.shape.start)) or (NULL,)
        each = [(f.literal, self._row(f)) for f in self.shape.firings] or [("None", (NULL,))]
        rows: list[tuple[Choice | str, tuple[Stmt, ...]]] = [*each]
        moving = self.moving.procedures()
        declared = self._declared()
        constants = self._constants((*moving, *each, *declared))
        batches: list[Decl] = []
        if len(each) * len(self.shape.concurrent) > MANY:
            was = Object(_WAS, "Region", ref("Self"), constant=True, aspects=_GHOST)
            by_batch = [each[at : at + BATCH] for at in range(0, len(each), BATCH)]
            claims = self._claims_inside()
            kept = [UseType(STORE)] if self.shape.deferring else []
            batches = [*kept, was, self._begun(constants), self._still()]
            batches += [d for batch in by_batch for d in _procedure(batch, claims)]
            rows = [_call(batch) for batch in by_batch]
        elif len(each) > ALONE and not self.shape.single:
            rows = [(choice, (*made, self._agreed())) for choice, made in each]
        return Subprogram(
            "Fire",
            self.fire_params(),
            aspects=self._claims(),
            declarations=(
                *map(UseType, (NODE,) if self.shape.single else (NODES, NODE)),
                *self.nodes.variables(),
                *constants,
                *self.nodes.moved(),
                *moving,
                *batches,
            ),
            body=(
                *declared,
                case_of(ref("Chosen"), [(START, start), *rows]),
                self._agreed(),
            ),
        )

    def _agreed(self) -> Pragma:
        """An assertion that the active vertices are those of the configuration."""
        return Pragma("Assert", (self.nodes.agreed(),))

    def _declared(self) -> tuple[Stmt, ...]:
        """The configuration that the transition leads to, and what outlasts it."""
        given = {self.shape.configuration_name: ref(BEFORE), "Past": ref("Past")}
        return (
            Assign("Self.Started", TRUE),
            Assign(self.held, self._goal(given)),
            *self.lasting.moved("Chosen", BEFORE),
        )

    def _goal(self, before: Mapping[str, Expr]) -> Expr:
        """Where the transition leads, with what the region held before."""
        own = (before[p.name] for p in self.shape.target_params())
        return call("Target", ref("Chosen"), *own)

    def _constants(self, named_in: object) -> list[Object]:
        """Constants of the region before the transition, as far as the statements name them."""
        named = {name.first for name in names_in(named_in)}
        configuration = self.shape.configuration_param
        parts = ((BEFORE, configuration.type, configuration.name), ("Past", "Memory", "Past"))
        return [
            Object(name, of_type, ref("Self", part), constant=True)
            for name, of_type, part in parts
            if name in named
        ]

    def claims(self) -> list[Decl]:
        """The precondition and the postcondition of Fire, each as a function of one name."""
        lasting: list[Decl] = []
        if self._lasts is not None:
            lasting = [self._lasts, Comment(_LASTING)]
        return [
            *in_one_word(self._ready("Chosen"), _READY),
            *lasting,
            *in_one_word(self._fired, _TAKEN),
        ]

    def _claims(self) -> tuple[Aspect, ...]:
        """Both of Fire.

        `Is_Safe` stands beside `Is_Fired`: gnatprove then names it where an invariant breaks.
        """
        fired = called_with(self._fired, Before=old("Self"))
        return (
            Aspect("Pre", self.ready("Chosen")),
            Aspect("Post", both(fired, *self.safety.holds())),
        )

    def _claims_inside(self) -> tuple[Aspect, ...]:
        """Both of a procedure that takes a few transitions, and changes nothing declared."""
        kept = call(_STILL, old("Self"))
        return (
            Aspect("Pre", call(_BEGUN, ref("Chosen"))),
            Aspect("Post", both(kept, *self.safety.holds(), self.nodes.agreed())),
        )

    def _begun(self, constants: Sequence[Object]) -> Subprogram:
        """The precondition of such a procedure: no exit, effect or entry has run yet."""
        shape = self.shape
        goal = self._goal({p.name: ref(_WAS, p.name) for p in shape.target_params()})
        ready = called_with(self._ready("Chosen"), Self=ref(_WAS))
        facts = [ready, ref("Self.Started"), equal(self.held, goal)]
        facts += [equal(ref("Self.Data"), ref(_WAS, "Data"))] if self.safety else []
        for one in constants:
            assert isinstance(one.value, DottedName)
            facts.append(equal(ref(one.name), ref(_WAS, one.value.last)))
        facts += self.nodes.begun(_WAS)
        return Subprogram(_BEGUN, (_CHOSEN,), "Boolean", _GHOST, expression=both(*facts))

    def _still(self) -> Subprogram:
        """The components of the region that such a procedure leaves as they were."""
        shape = self.shape
        parts = ["Started", shape.configuration_name]
        parts += ["Past"] if shape.memories else []
        parts += ["Timers"] if shape.timers else []
        parts += ["Deferred"] if shape.deferring else []
        same = both(*(equal(ref("Self", p), ref("Before", p)) for p in parts))
        return Subprogram(_STILL, (_BEFORE,), "Boolean", _GHOST, expression=same)

    def ready(self, chosen: str) -> Expr:
        """That a transition may be taken."""
        return called_with(self._ready(chosen))

    def _ready(self, chosen: str) -> Subprogram:
        first, later = self.safety.ready(chosen)
        sources = call("In_Source", ref(chosen), self.held)
        ready = IfExpr(
            ((equal(ref(chosen), ref(START)), both(Prefix("not", ref("Self.Started")), *first)),),
            both(ref("Self.Started"), sources, *later),
        )
        return self._claim_of("Is_Ready", ready, Param(chosen, "in", "Firing"))

    @cached_property
    def _fired(self) -> Subprogram:
        done = both(
            ref("Self.Started"),
            of_before(equal(self.held, self.shape.target("Chosen"))),
            *([] if self._lasts is None else [called_with(self._lasts)]),
        )
        return self._claim_of("Is_Fired", done, _CHOSEN, _BEFORE)

    @cached_property
    def _lasts(self) -> Subprogram | None:
        """Apart from the rest, for no caller but the step of a plain region needs it."""
        facts = self.lasting.fired("Chosen")
        if not facts:
            return None
        return self._claim_of("Is_Lasting", of_before(both(*facts)), _CHOSEN, _BEFORE)

    def _claim_of(self, name: str, claim: Expr, chosen: Param, *before: Param) -> Subprogram:
        values = (p for p in self.shape.step_params()[1:] if p.name in ("Ins", "Item"))
        of_region = Param("Self", "in", "Region")
        params = used([*before, of_region, *values, chosen], claim)
        return Subprogram(name, params, "Boolean", _GHOST, expression=claim)

    def flows(self) -> list[Flow]:
        """The behaviours given so far: the exit of a state that is never left is not among them."""
        return [*self._effects_given, *self.moving.flows()]

    def fire_params(self) -> tuple[Param, ...]:
        """Self, what behaviours read, the outbox, and the transition."""
        named = {name for flow in self.flows() for name in flow_names(flow)}
        reads = named & set(self.shape.inputs)
        idle = set() if reads else {"Ins"}
        idle |= set() if self.shape.fires_with_item else {"Item"}
        idle -= self.safety.reads()
        params = [p for p in self.shape.step_params() if p.name not in idle]
        if self._fills_outbox():
            params = [replace(p, mode="out") if p.name == "Box" else p for p in params]
        return (*params, Param("Chosen", "in", "Firing"))

    def _fills_outbox(self) -> bool:
        """Does every transition send on every port that any of them sends on, and raise nothing?"""
        region = self.region
        rows = [self._flows(self.shape.start)]
        for firing in self.shape.firings:
            flows = [e.flow for e in firing.effects] + self._flows(firing.entries)
            if firing.kind is FiringKind.MOVE and firing.domain is not None:
                path = self._path(firing)
                flows += [region.state(s).exit for s in path if region.pseudostate(s) is None]
            rows.append(flows)
        sends = set(region.sends)
        return not region.raises and all(set().union(*map(certain_sends, r)) == sends for r in rows)

    def _flows(self, steps: tuple[EntryStep, ...]) -> list[Flow]:
        found: list[Flow] = []
        for step in steps:
            if isinstance(step, Effect):
                found.append(step.flow)
            elif self.region.pseudostate(step.vertex) is None:
                found.append(self.region.state(step.vertex).entry)
        return found

    # --- the statements of a transition

    def _row(self, firing: Firing) -> tuple[Stmt, ...]:
        effect = self._effects(firing.effects)
        if firing.kind in (FiringKind.INTERNAL, FiringKind.DEFERRAL):
            return effect or (NULL,)
        assert firing.domain is not None
        out = self._leave(firing)
        effect = _between(self.nodes.empty(firing.domain), effect)
        if terminates(self.shape, firing):
            entered = self._steps(firing.entries[:-1])
            return as_one_move((*out, *effect, *entered, *self._stop(firing)))
        if firing.kind is FiringKind.RESTORE:
            pseudo = self.region.pseudostate(firing.sources[0])
            assert pseudo is not None
            deep = pseudo.kind is PseudoKind.DEEP_HISTORY
            restored = Restoring(self.shape, self._steps).statements(firing.domain, deep)
            return as_one_move((*out, *restored))
        return as_one_move((*out, *effect, *self._steps(firing.entries)))

    def _stop(self, firing: Firing) -> tuple[Stmt, ...]:
        """The region stops: nothing is active any more, and nothing more is left."""
        goal = self.shape.leads_to(firing)
        return tuple(self.nodes.stopped(goal[TOP]))

    def _effects(self, effects: tuple[Effect, ...]) -> tuple[Stmt, ...]:
        self._effects_given += [e.flow for e in effects]
        return tuple(
            s
            for e in effects
            for s in (*self.shape.note(f"{e.name}.effect"), *emit_flow(self.scope, e.flow))
        )

    def _path(self, firing: Firing) -> list[str]:
        """The states around the source that are certainly left, outermost first."""
        assert firing.domain is not None
        source = firing.sources[0]
        if firing.domain.owner == source:
            return []
        return self.shape.compounds.below(firing.domain, source)

    def _leave(self, firing: Firing) -> tuple[Stmt, ...]:
        assert firing.domain is not None
        path = self._path(firing)
        if not path:
            return (self.moving.leave(firing.domain),)
        states = [v for v in path if self.region.pseudostate(v) is None]
        split = next((i for i, v in enumerate(states, 1) if self._splits(v, firing)), None)
        outer = states[:split]
        found: list[Stmt] = []
        if split is None and len(states) < len(path):
            found += self.moving.exit(firing.sources[0])
        if outer and (outer[-1] == firing.sources[0] or self._splits(outer[-1], firing)):
            found += [self.moving.leave(r) for r in self.region.state(outer[-1]).region_ids]
        return (*found, *(s for v in reversed(outer) for s in self.moving.exit(v)))

    def _splits(self, vertex: str, firing: Firing) -> bool:
        """Is it an orthogonal state around the source? Then all its regions are left."""
        return vertex != firing.sources[0] and self.region.state(vertex).is_orthogonal

    def _steps(self, steps: tuple[EntryStep, ...]) -> tuple[Stmt, ...]:
        found: list[Stmt] = []
        entered: str | None = None
        for step in steps:
            if isinstance(step, Effect):
                effect = self._effects((step,))
                found += effect if entered is None else _between(self.nodes.stands(entered), effect)
            else:
                found += self.moving.enter(step.vertex)
                entered = step.vertex
        return tuple(found)
