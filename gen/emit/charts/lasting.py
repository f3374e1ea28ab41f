# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""What outlasts a firing: time-outs, the memory of histories, and what is deferred.

The *domain* of a transition is the innermost region that holds all it leaves and
enters (the "transition domain" of SCXML 3.13). Everything active inside it is left,
and what is active inside it afterwards was entered. From the domain and the
configurations before and after follow the time-outs that are cancelled and started,
and the leaves that histories remember; `Timer_After` and `Remembered` declare it,
and the contract of each firing claims it.
"""

from __future__ import annotations

from ravenchart.gen.emit.ada.declarations import Decl, EnumType, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    OTHERS,
    Aggregate,
    Arg,
    Attribute,
    CaseExpr,
    Choices,
    Expr,
    IfExpr,
    Indexed,
    OperatorChain,
    both,
    call,
    chain,
    choice_of,
    equal,
    number,
    old,
    one_of,
    plain,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Comment, Pragma
from ravenchart.gen.emit.ada.walking import rewritten
from ravenchart.gen.emit.language.compound import TOP, Firing, FiringKind
from ravenchart.gen.emit.language.places import flat
from ravenchart.gen.model.chart.tree import Place
from ravenchart.gen.model.statechart import After, Every

from .deferring import freed_after, kept_events
from .shape import START, HistoryMemory, RegionShape

_STOPPED = ref("Ravenchart.Timers.Stopped")


def in_one_word(fact: Subprogram, told: str) -> list[Decl]:
    """A function that provers see as what it stands for."""
    inlined = ref("GNATprove"), ref("Inline_For_Proof"), ref(fact.name)
    return [fact, Comment(told), Pragma("Annotate", inlined)]


def asked(fact: Subprogram, **given: Expr) -> Expr:
    """A call of it where its parameters' names are those of what is given."""
    return call(fact.name, *(given.get(p.name, ref(p.name)) for p in fact.params))


def of_before(fact: Expr) -> Expr:
    """A fact over ``Self.X'Old``, over ``Before.X`` instead."""

    def before(node: object) -> DottedName | None:
        match node:
            case Attribute(DottedName(parts), "Old"):
                return ref("Before", *parts[1:])
        return None

    return rewritten(fact, before)


def has_domains(shape: RegionShape) -> bool:
    """Does anything outlast a firing that depends on what was left and entered?"""
    return bool(shape.timers or shape.memories or shape.deferring)


def _inside(place: Place) -> str:
    return "Everything" if place == TOP else f"Inside_{ada_case(place.region or place.owner or '')}"


def terminates(shape: RegionShape, firing: Firing) -> bool:
    """Does it stop the region?"""
    return firing.goal is not None and shape.is_end(firing.goal)


def _domain(shape: RegionShape, firing: Firing) -> str:
    if terminates(shape, firing):
        return "Ending"
    return "Nothing" if firing.domain is None else _inside(firing.domain)


# --- The chart as declared ---------------------------------------------------


def declared_domains(shape: RegionShape) -> list[Decl]:
    """Domain, Domain_Of, Timer_After and Remembered, as far as the chart needs them."""
    if not has_domains(shape):
        return []
    rows = tuple((f.literal, ref(_domain(shape, f))) for f in shape.firings)
    regions = [Place(s.name, r.name) for s in shape.region.states for r in s.regions]
    found = {_domain(shape, f) for f in shape.firings}
    ends = ("Ending",) if "Ending" in found else ()
    literals = ("Nothing", *map(_inside, regions), "Everything", "Beginning", *ends)
    items: list[Decl] = [
        Comment("The innermost region that holds all that a transition leaves and enters."),
        EnumType("Domain", literals),
        Subprogram(
            "Domain_Of",
            (Param("T", "in", "Firing"),),
            "Domain",
            expression=choice_of(ref("T"), ((START, ref("Beginning")), *rows)),
        ),
        Comment("Everything active inside it is left, and what is active then is entered."),
    ]
    if shape.timers:
        items += _timer_after(shape, bool(ends))
    if shape.memories:
        items += _remembered(shape)
    if shape.deferring:
        items += _freed(shape)
    return items


def _freed(shape: RegionShape) -> list[Decl]:
    rows: list[Arg] = []
    for event in kept_events(shape):
        exits = [
            both(
                *flat([_spans(shape.compounds.places(s.name)), shape.in_state(shape.place, s.name)])
            )
            for s in shape.region.states
            if event in s.defers
        ]
        before = ref("Freed", ada_case(event))
        freed = IfExpr(((chain("or else", exits), ref("Count")),), before)
        rows.append(Arg(ada_case(event), freed))
    return [
        Subprogram(
            "Freed_After",
            (
                Param("D", "in", "Domain"),
                Param(shape.place, "in", shape.place_type),
                Param("Count", "in", "Natural"),
                Param("Freed", "in", "Freed_Events"),
            ),
            "Freed_Events",
            expression=Aggregate(tuple(rows)),
        ),
        Comment("Each exit of a state frees the events that it defers, of those kept till then."),
    ]


def _spans(places: list[Place], *more: str) -> Expr:
    names = [_inside(p) for p in places] + list(more)
    return one_of(ref("D"), names)


def _fresh(shape: RegionShape, index: int) -> Expr:
    """The time-out with this number when its state has just been entered."""
    trigger = shape.timers[index - 1].trigger
    assert isinstance(trigger, After | Every)
    count = number(trigger.executions)
    args = (count, count) if isinstance(trigger, Every) else (count,)
    return call("Ravenchart.Timers.Started", *args)


def _timer_after(shape: RegionShape, ends: bool) -> list[Decl]:
    rows: list[tuple[Choices, Expr]] = []
    for i, timed in enumerate(shape.timers, 1):
        places = shape.compounds.places(timed.source)
        active = both(
            *flat(
                [
                    OperatorChain("/=", (ref("D"), ref("Beginning"))),
                    shape.in_state("Before", timed.source),
                ]
            )
        )
        after = shape.in_state("After", timed.source)
        spanned = _spans(places, "Beginning")
        moved = call(
            "Ravenchart.Timers.Moved", ref("Timer"), spanned, active, after, _fresh(shape, i)
        )
        rows.append((plain(i), moved))
    choice: Expr = CaseExpr(ref("I"), (*rows, (OTHERS, ref("Timer"))))
    if ends:
        choice = IfExpr(((equal(ref("D"), ref("Ending")), _STOPPED),), choice)
    return [
        Subprogram(
            "Timer_After",
            (
                Param("I", "in", "Positive"),
                Param("D", "in", "Domain"),
                Param("Before", "in", shape.place_type),
                Param("After", "in", shape.place_type),
                Param("Timer", "in", "Ravenchart.Timers.Timer"),
            ),
            "Ravenchart.Timers.Timer",
            expression=choice,
        ),
        Comment("Each time-out: cancelled when its state is left, started when it is entered."),
    ]


def _remembered(shape: RegionShape) -> list[Decl]:
    rows: list[Arg] = []
    for memory in shape.memories:
        leaf = shape.at(shape.place, shape.lane_of(memory.place))
        left = flat([_left(shape, memory), _active(shape, memory)])
        children = shape.region.children(memory.place.owner, memory.place.region)
        goes_on = [OperatorChain("/=", (leaf, shape.literal(s.name))) for s in children if s.final]
        last = IfExpr(((both(*left, *goes_on), leaf),), ref("Past", memory.last))
        known = IfExpr(((both(*left), both(*goes_on)),), ref("Past", memory.known))
        rows += [Arg(memory.last, last), Arg(memory.known, known)]
    return [
        Subprogram(
            "Remembered",
            (
                Param("D", "in", "Domain"),
                Param(shape.place, "in", shape.place_type),
                Param("Past", "in", "Memory"),
            ),
            "Memory",
            expression=Aggregate(tuple(rows)),
        ),
        Comment("What histories know then: the leaf that was left, nothing after a final state."),
    ]


def _left(shape: RegionShape, memory: HistoryMemory) -> Expr:
    """Is the leaf of the memory's region left, when there is one?"""
    assert memory.place.owner is not None
    around = [memory.place, *shape.compounds.places(memory.place.owner)]
    lane = shape.lane_of(memory.place)
    inner = [
        p
        for s in shape.region.states
        for r in s.regions
        for p in (Place(s.name, r.name),)
        if p != memory.place
        and shape.lane_of(p) == lane
        and memory.place in shape.compounds.places(s.name)
    ]
    return _spans([*inner, *around])


def _active(shape: RegionShape, memory: HistoryMemory) -> Expr:
    """Is there a leaf in the memory's region? A pseudostate is not remembered."""
    assert memory.place.owner is not None
    passed = {p.name for p in shape.region.pseudostates}
    leaf = shape.at(shape.place, shape.lane_of(memory.place))
    not_left = [
        OperatorChain("/=", (ref(leaf), shape.literal(v)))
        for v in shape.literals_in(memory.place)
        if v in passed
    ]
    return both(*flat([shape.in_state(shape.place, memory.place.owner), *not_left]))


# --- The contract of firings --------------------------------------------------


class Lasting:
    """What outlasts the exits, entries and firings of one region."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region

    def timed(self, state: str) -> list[int]:
        """The numbers of a state's time-outs."""
        return [i for i, t in enumerate(self.shape.timers, 1) if t.source == state]

    def remembered(self, leaf: str) -> list[tuple[HistoryMemory, bool]]:
        """The memories that the exit of a leaf changes; False: there is nothing to remember."""
        if not self.shape.is_literal(leaf):
            return []
        around = self.shape.compounds.places(leaf)
        lane = self.region.lane(leaf)
        final = self.region.state(leaf).final
        return [
            (m, not (final and around[0] == m.place))
            for m in self.shape.memories
            if m.place in around and self.shape.lane_of(m.place) == lane
        ]

    def fired(self, chosen: str) -> list[Expr]:
        """After a firing: what is declared; ``chosen`` names the transition."""
        facts: list[Expr] = []
        held = self.shape.held
        domain = call("Domain_Of", ref(chosen))
        for i in range(1, len(self.shape.timers) + 1):
            before = Indexed(old("Self.Timers"), plain(i))
            after = call("Timer_After", number(i), domain, old(held), held, before)
            facts.append(equal(Indexed("Self.Timers", plain(i)), after))
        ends = any(terminates(self.shape, f) for f in self.shape.firings)
        goes_on = OperatorChain("/=", (domain, ref("Ending")))
        if self.shape.memories:
            recalled = call("Remembered", domain, old(held), old("Self.Past"))
            known = equal(ref("Self.Past"), recalled)
            kept = equal(ref("Self.Past"), old("Self.Past"))
            #  where the region ends, nothing will be remembered
            later: Expr = IfExpr(((goes_on, known),), None) if ends else known
            facts.append(IfExpr(((old("Self.Started"), later),), kept))
        if self.shape.deferring:
            count = call("Deferrals.Count", old("Self.Deferred"))
            freed = freed_after(self.shape, domain, count)
            facts.append(IfExpr(((goes_on, freed),), None) if ends else freed)
        return [*facts, *self._deferred(chosen)]

    def _deferred(self, chosen: str) -> list[Expr]:
        """A deferral keeps its event, or counts it as lost; nothing else touches what is kept."""
        shape = self.shape
        deferrals = [f for f in shape.firings if f.kind is FiringKind.DEFERRAL]
        if not deferrals:
            return []
        kept, before = ref("Self.Deferred"), old("Self.Deferred")
        full = equal(call("Deferrals.Count", before), number(self.region.deferral_depth))
        lost = equal(ref("Self.Lost"), OperatorChain("or", (old("Self.Lost"), full)))
        names: dict[DottedName, list[str]] = {}
        for firing in deferrals:
            names.setdefault(shape.deferred_item(firing), []).append(firing.literal)
        one = len(names) == 1
        added = tuple(
            (
                call("Is_Deferral", ref(chosen)) if one else one_of(ref(chosen), of),
                both(call("Deferrals.Is_Appended", before, item, kept), lost),
            )
            for item, of in names.items()
        )
        same = both(equal(kept, before), equal(ref("Self.Lost"), old("Self.Lost")))
        return [IfExpr(added, same)]
