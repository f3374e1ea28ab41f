"""Exits, effects and entries of one region, with the ghost set that proves their order.

A state may be exited only when it is active and nothing inside it is; entered
only when its parent is active and nothing in its own region is; an effect runs
when everything in the region that holds the transition has been left, and nothing
else. The order then follows from the preconditions.
"""

from __future__ import annotations

from ...statechart import After, Every, PseudoKind
from ...terms import Flow
from ..ada import (
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
    If,
    IfExpr,
    Object,
    Package,
    Param,
    PlainType,
    Pragma,
    Prefix,
    Ref,
    Stmt,
    Subprogram,
    UseType,
    arguments,
    both,
    call,
    chain,
    equal,
    number,
)
from ..naming import ada_case
from ..terms import certain_sends, emit_flow
from .compound import TOP, Effect, Enter, Firing, Kind, Place, Step
from .history import Restoring
from .lasting import Lasting, terminates
from .places import flat
from .shape import START, RegionShape, behaviour_names

_NODES = "Chart.Node"


class Moves:
    """Builds Fire, and remembers which procedures it needs."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region
        self.scope = shape.scope("Self.Data")
        self.held = f"Self.{shape.place}"
        self.lasting = Lasting(shape)
        self._exited: set[str] = set()
        self._entered: set[str] = set()
        self._left: set[Place] = set()

    # --- the ghost package

    def chart(self) -> Package:
        """All states, and which are active in a configuration."""
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
                *self.lasting.ghosts(),
            ),
            (Aspect("Ghost"),),
        )

    def active_in(self, holder: str) -> Expr:
        """The states that a configuration stands for."""
        return call("Chart.Active_In", Ref(holder))

    # --- Fire

    def fire(self) -> Subprogram:
        """Exits, effects and entries of one transition; `Target` says where it leads."""
        shape = self.shape
        rows: list[tuple[str, tuple[Stmt, ...]]] = [
            (START, (*self._steps(shape.start), Assign("Self.Started", TRUE)))
        ]
        rows += [(ada_case(f.name), self._row(f)) for f in shape.firings]
        ready = IfExpr(
            ((equal(Ref("Chosen"), Ref(START)), Prefix("not", Ref("Self.Started"))),),
            both(Ref("Self.Started"), call("In_Source", Ref("Chosen"), Ref(self.held))),
        )
        moved = equal(Ref(self.held), shape.target("Chosen"))
        done = both(Ref("Self.Started"), moved, *self.lasting.fired("Chosen"))
        before = IfExpr(
            ((Ref("Self.Started"), self.active_in(self.held)),),
            Aggregate((Arg("others", FALSE),)),
        )
        ghost = (Aspect("Ghost"),)
        past: tuple[Decl, ...] = ()
        if self.shape.memories:
            past = (Object("Past", "Memory", Ref("Self.Past"), constant=True),)
        return Subprogram(
            "Fire",
            self.fire_params(),
            aspects=(Aspect("Pre", ready), Aspect("Post", done)),
            declarations=(
                UseType(_NODES),
                UseType("Chart.Node_Set"),
                Object("Before", "Chart.Node_Set", before, constant=True, aspects=ghost),
                Object("Active", "Chart.Node_Set", Ref("Before"), aspects=ghost),
                *past,
                *self._procedures(),
            ),
            body=(
                Case(Ref("Chosen"), tuple(rows)),
                Pragma("Assert", (equal(Ref("Active"), self.active_in(self.held)),)),
            ),
        )

    def fire_params(self) -> tuple[Param, ...]:
        """Self, what behaviours read, the outbox, and the transition."""
        reads = behaviour_names(self.region) & set(self.shape.inputs)
        idle = set() if reads else {"Ins"}
        idle |= set() if self.shape.fires_with_item else {"Item"}
        params = [p for p in self.shape.step_params() if p.name not in idle]
        if self._fills_outbox():
            params = [p._replace(mode="out") if p.name == "Box" else p for p in params]
        return (*params, Param("Chosen", "in", "Firing"))

    def _fills_outbox(self) -> bool:
        """Does every firing send on every port that any firing sends on, and raise nothing?"""
        region = self.region
        rows = [self._flows(self.shape.start)]
        for firing in self.shape.firings:
            flows = [e.flow for e in firing.effects] + self._flows(firing.entries)
            if firing.kind is Kind.MOVE and firing.domain is not None:
                path = self._path(firing)
                flows += [region.state(s).exit for s in path if region.pseudostate(s) is None]
            rows.append(flows)
        sends = set(region.sends)
        return not region.raises and all(set().union(*map(certain_sends, r)) == sends for r in rows)

    def _flows(self, steps: tuple[Step, ...]) -> list[Flow]:
        found: list[Flow] = []
        for step in steps:
            if isinstance(step, Effect):
                found.append(step.flow)
            elif self.region.pseudostate(step.vertex) is None:
                found.append(self.region.state(step.vertex).entry)
        return found

    # --- the statements of a firing

    def _row(self, firing: Firing) -> tuple[Stmt, ...]:
        effect = self._effects(firing.effects)
        if firing.kind is Kind.DEFERRAL:
            return self._defer(firing)
        if firing.kind is Kind.INTERNAL:
            return effect or (NULL,)
        assert firing.domain is not None
        out = self._leave(firing)
        claim = (self._claim(firing.domain),) if effect else ()
        if terminates(self.shape, firing):
            entered = self._steps(firing.entries[:-1])
            return (*out, *claim, *effect, *entered, *self._stop(firing))
        if firing.kind is Kind.RESTORE:
            pseudo = self.region.pseudostate(firing.sources[0])
            assert pseudo is not None
            deep = pseudo.kind is PseudoKind.DEEP_HISTORY
            return (*out, *Restoring(self.shape, self._steps).statements(firing.domain, deep))
        return (*out, *claim, *effect, *self._steps(firing.entries))

    def _stop(self, firing: Firing) -> tuple[Stmt, ...]:
        """The region stops: nothing is active any more, and nothing more is left."""
        goal = self.shape.leads_to(firing)
        stops = [
            Assign(self.shape.at(self.held, lane), Ref(self.shape.literal(leaf)))
            for lane, leaf in goal.items()
        ]
        if self.shape.timers:
            stopped = Aggregate((Arg("others", Ref("Ravenchart.Timers.Stopped")),))
            stops.append(Assign("Self.Timers", stopped))
        return (*stops, Assign("Active", Aggregate((Arg("others", FALSE),))))

    def _effects(self, effects: tuple[Effect, ...]) -> tuple[Stmt, ...]:
        return tuple(
            s
            for e in effects
            for s in (*self.shape.note(f"{e.name}.effect"), *emit_flow(self.scope, e.flow))
        )

    def _defer(self, firing: Firing) -> tuple[Stmt, ...]:
        (event,) = firing.triggers
        assert isinstance(event, str)
        item = Ref("Item" if self.shape.takes_item else self.shape.event(event))
        full = equal(
            call("Deferrals.Count", Ref("Self.Deferred")), number(self.region.deferral_depth)
        )
        return (
            If(
                ((full, (Assign("Self.Lost", TRUE),)),),
                (Do("Deferrals.Append", arguments(Ref("Self.Deferred"), item)),),
            ),
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
            return (self._leave_place(firing.domain),)
        states = [v for v in path if self.region.pseudostate(v) is None]
        split = next((i for i, v in enumerate(states) if self._splits(v, firing)), len(states) - 1)
        outer = states[: split + 1]
        found: list[Stmt] = []
        if outer and (outer[-1] == firing.sources[0] or self._splits(outer[-1], firing)):
            nested = self.region.state(outer[-1]).regions
            found += [self._leave_place(Place(outer[-1], r.name)) for r in nested]
        found += [self._exit_of(v) for v in reversed(outer)]
        return tuple(found)

    def _splits(self, vertex: str, firing: Firing) -> bool:
        """Is it an orthogonal state around the source? Then all its lanes are left."""
        return vertex != firing.sources[0] and self.region.state(vertex).is_orthogonal

    def _claim(self, domain: Place) -> Pragma:
        """Everything in the region that holds the transition has been left, nothing else."""
        nodes = self._inside(domain)
        if domain == TOP:
            return Pragma("Assert", (self._none_in(nodes),))
        kept = both(Chain("not in", (Ref("N"), Ref(nodes))), Ref("Before (N)"))
        return Pragma("Assert", (ForAll("N", _NODES, equal(Ref("Active (N)"), kept)),))

    def _steps(self, steps: tuple[Step, ...]) -> tuple[Stmt, ...]:
        found: list[Stmt] = []
        for step in steps:
            if isinstance(step, Effect):
                found += self._effects((step,))
            else:
                self._entered.add(step.vertex)
                found.append(Do(f"Enter_{ada_case(step.vertex)}"))
        return tuple(found)

    def _exit_of(self, state: str) -> Stmt:
        self._exited.add(state)
        return Do(f"Exit_{ada_case(state)}")

    def _leave_place(self, place: Place) -> Stmt:
        if place not in self._left:
            self._left.add(place)
            for child in self.region.children(place.owner, place.region):
                self._exited.add(child.name)
                for nested in child.regions:
                    self._leave_place(Place(child.name, nested.name))
        return Do(self._leave_name(place))

    def _leave_name(self, place: Place) -> str:
        return f"Leave_{ada_case(place.region or place.owner or '')}"

    # --- the procedures, callees first

    def _procedures(self) -> tuple[Decl, ...]:
        states = self.region.states
        exits = [self._exit(s.name) for s in states if s.name in self._exited]
        places = [Place(s.name, r.name) for s in reversed(states) for r in s.regions]
        leavings = [self._leaving(p) for p in places if p in self._left]
        vertices = [s.name for s in states] + [p.name for p in self.region.pseudostates]
        entries = [self._entry(v) for v in vertices if v in self._entered]
        return (*exits, *leavings, *entries)

    def _inside(self, place: Place) -> str:
        """The states in a region, as a range."""
        if place == TOP:
            return _NODES
        below = [
            s.name
            for s in self.region.states
            if s.name != place.owner and place in self.shape.compounds.places(s.name)
        ]
        return f"Chart.{ada_case(below[0])} .. Chart.{ada_case(below[-1])}"

    def _inside_state(self, state: str) -> str:
        regions = self.region.state(state).regions
        first = self._inside(Place(state, regions[0].name)).split(" .. ")[0]
        return f"{first} .. {self._inside(Place(state, regions[-1].name)).split(' .. ')[1]}"

    def _none_in(self, nodes: str) -> Expr:
        return ForAll("N", nodes, Prefix("not", Ref("Active (N)")))

    def _kept(self) -> Expr:
        return equal(Ref(self.held), Ref(f"{self.held}'Old"))

    def _exit(self, state: str) -> Subprogram:
        node = f"Chart.{ada_case(state)}"
        at = self.region.state(state)
        ready: list[Expr] = [Ref(f"Active ({node})")]
        if not at.is_leaf:
            ready.append(self._none_in(self._inside_state(state)))
        left = both(Chain("/=", (Ref("N"), Ref(node))), Ref("Active'Old (N)"))
        after = ForAll("N", _NODES, equal(Ref("Active (N)"), left))
        stops = tuple(
            Do("Ravenchart.Timers.Disarm", arguments(Ref(f"Self.Timers ({i})")))
            for i in self.lasting.timed(state)
        )
        undone = (
            (Assign(f"Self.{self.shape.completed(state)}", FALSE),)
            if state in self.shape.completing
            else ()
        )
        note = () if at.final else self.shape.note(f"{state}.exit")
        return Subprogram(
            f"Exit_{ada_case(state)}",
            aspects=(
                Aspect("Pre", chain("and then", ready)),
                Aspect("Post", both(self._kept(), after, *self.lasting.exited(state))),
            ),
            body=(
                *note,
                *emit_flow(self.scope, at.exit),
                *stops,
                *undone,
                *self._remember(state),
                Assign(f"Active ({node})", FALSE),
            ),
        )

    def _remember(self, leaf: str) -> tuple[Stmt, ...]:
        found: list[Stmt] = []
        for memory, goes_on in self.lasting.remembered(leaf):
            if goes_on:
                found.append(Assign(f"Self.Past.{memory.last}", Ref(self.shape.literal(leaf))))
            found.append(Assign(f"Self.Past.{memory.known}", TRUE if goes_on else FALSE))
        return tuple(found)

    def _entry(self, vertex: str) -> Subprogram:
        place = self.shape.compounds.place(vertex)
        ready: list[Expr] = []
        if place.owner is not None:
            ready.append(Ref(f"Active (Chart.{ada_case(place.owner)})"))
        ready.append(self._none_in(self._inside(place)))
        leaves = self.shape.after((Enter(vertex),))
        moved = self._kept()
        here: tuple[Stmt, ...] = ()
        if leaves:
            goal = self.shape.configuration(leaves, f"{self.held}'Old")
            moved = equal(Ref(self.held), goal)
            here = tuple(
                Assign(self.shape.at(self.held, lane), Ref(self.shape.literal(leaf)))
                for lane, leaf in leaves.items()
            )
        if self.region.pseudostate(vertex) is not None:
            same = equal(Ref("Active"), Ref("Active'Old"))
            return Subprogram(
                f"Enter_{ada_case(vertex)}",
                aspects=(
                    Aspect("Pre", both(*flat(ready))),
                    Aspect("Post", both(moved, same, *self.lasting.entered(vertex))),
                ),
                body=here,
            )
        node = f"Chart.{ada_case(vertex)}"
        state = self.region.state(vertex)
        added = Chain("or else", (equal(Ref("N"), Ref(node)), Ref("Active'Old (N)")))
        grown = ForAll("N", _NODES, equal(Ref("Active (N)"), added))
        note = () if state.final else self.shape.note(f"{vertex}.entry")
        return Subprogram(
            f"Enter_{ada_case(vertex)}",
            aspects=(
                Aspect("Pre", both(*flat(ready))),
                Aspect("Post", both(moved, grown, *self.lasting.entered(vertex))),
            ),
            body=(
                *here,
                *self._arm(vertex),
                *self._begin_work(vertex),
                Assign(f"Active ({node})", TRUE),
                *note,
                *emit_flow(self.scope, state.entry),
                *self._complete(vertex),
            ),
        )

    def _arm(self, state: str) -> tuple[Stmt, ...]:
        found: list[Stmt] = []
        for i in self.lasting.timed(state):
            trigger = self.shape.timers[i - 1].trigger
            assert isinstance(trigger, After | Every)
            args = [Ref(f"Self.Timers ({i})"), number(trigger.executions)]
            if isinstance(trigger, Every):
                args.append(number(trigger.executions))
            found.append(Do("Ravenchart.Timers.Arm", arguments(*args)))
        return tuple(found)

    def _begin_work(self, state: str) -> tuple[Stmt, ...]:
        """Another visit, in which the do activity is not done yet."""
        if state not in self.shape.working:
            return ()
        visits = f"Self.{self.shape.visits(state)}"
        return (
            Assign(visits, call("Ravenchart.Next", Ref(visits))),
            Assign(f"Self.{self.shape.done(state)}", FALSE),
        )

    def _complete(self, vertex: str) -> tuple[Stmt, ...]:
        """What has completed by an entry: the leaf itself, or the state around a final one."""
        state = self.region.state(vertex)
        shape = self.shape
        if vertex in shape.completing and state.is_leaf and vertex not in shape.working:
            return (Assign(f"Self.{shape.completed(vertex)}", TRUE),)
        owner = state.parent
        if not state.final or owner is None or owner not in shape.completing:
            return ()
        done = Assign(f"Self.{shape.completed(owner)}", TRUE)
        others = [r for r in self.region.state(owner).regions if r.name != state.region]
        parts: list[Expr] = [Ref(f"Self.{shape.done(owner)}")] if owner in shape.working else []
        for nested in others:
            leaf = Ref(shape.at(self.held, shape.lane_of(Place(owner, nested.name))))
            finals = [
                equal(leaf, Ref(shape.literal(s.name)))
                for s in self.region.children(owner, nested.name)
                if s.final
            ]
            parts.append(chain("or else", finals, FALSE))
        return (If(((both(*parts), (done,)),)),) if parts else (done,)

    def _leaving(self, place: Place) -> Subprogram:
        assert place.owner is not None
        shape = self.shape
        rows: list[tuple[str, tuple[Stmt, ...]]] = []
        for child in self.region.children(place.owner, place.region):
            inner = [Do(self._leave_name(Place(child.name, r.name))) for r in child.regions]
            rows.append((shape.literal(child.name), (*inner, Do(f"Exit_{ada_case(child.name)}"))))
        rows += [(shape.literal(p), (NULL,)) for p in shape.compounds.passed(place)]
        lane = shape.lane_of(place)
        leaf = shape.at(self.held, lane)
        if not self.region.state(place.owner).is_orthogonal:
            leaf = f"{shape.literal(place.owner)}'({leaf})"
        nodes = self._inside(place)
        agrees = ForAll(
            "N", nodes, equal(Ref("Active (N)"), Ref(f"Chart.Active_In ({self.held}) (N)"))
        )
        gone = both(Chain("not in", (Ref("N"), Ref(nodes))), Ref("Active'Old (N)"))
        after = ForAll("N", _NODES, equal(Ref("Active (N)"), gone))
        return Subprogram(
            self._leave_name(place),
            aspects=(
                Aspect("Pre", both(*flat([shape.in_state(self.held, place.owner), agrees]))),
                Aspect("Post", both(self._kept(), after, *self.lasting.left(place, nodes))),
            ),
            body=(Case(Ref(leaf), tuple(rows)),),
        )
