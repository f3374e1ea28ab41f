# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Time-outs, the memory of histories, and deferred events: they outlast a transition.

The *domain* of a transition is the innermost region that holds all it leaves and
enters (the "transition domain" of SCXML 3.13). Everything active inside it is left,
and everything active inside it afterwards was entered. The domain and the configurations
before and after decide the time-outs that are cancelled and started, and the leaves that
histories remember. `Timers_After` and `Remembered` declare this, and each transition calls them.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravenchart.gen.emit.ada.declarations import Decl, EnumType, Param, Subprogram
from ravenchart.gen.emit.ada.expressions import (
    Aggregate,
    Arg,
    Attribute,
    Expr,
    IfExpr,
    Indexed,
    OperatorChain,
    all_else,
    both,
    call,
    choice_of,
    equal,
    number,
    old,
    one_of,
    plain,
)
from ravenchart.gen.emit.ada.named import DottedName, ref
from ravenchart.gen.emit.ada.naming import ada_case
from ravenchart.gen.emit.ada.statements import Assign, Comment, Pragma, Stmt
from ravenchart.gen.emit.ada.walking import rewritten
from ravenchart.gen.emit.language.compound import Firing
from ravenchart.gen.emit.language.configurations import conjuncts
from ravenchart.gen.model.statechart import TOP, After, Every, RegionId

from .deferring import change, is_changed
from .shape import START, HistoryMemory, RegionShape

_STOPPED = ref("Ravenchart.Timers.Stopped")
TIME_OUTS = "Time_Outs"
"""The type of a region's timers."""
_TIMERS, _PAST = ref("Self.Timers"), ref("Self.Past")
_TIMES_AFTER = (
    "The time-outs afterwards: cancelled where their state is left, started where it is entered."
)
_REMEMBERED = (
    "The memory of histories afterwards: the leaf that was left, or none after a final state."
)


def in_one_word(fact: Subprogram, told: str) -> list[Decl]:
    """A function that provers see as its expression."""
    inlined = ref("GNATprove"), ref("Inline_For_Proof"), ref(fact.name)
    return [fact, Comment(told), Pragma("Annotate", inlined)]


def called_with(fact: Subprogram, **given: Expr) -> Expr:
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
    """Does anything outlast a transition that depends on the states left and entered?"""
    return bool(shape.timers or shape.memories or shape.deferring)


def _inside(region: RegionId) -> str:
    return "Everything" if region == TOP else f"Inside_{ada_case(region.label)}"


def terminates(shape: RegionShape, firing: Firing) -> bool:
    """Does it stop the region?"""
    return firing.goal is not None and shape.is_end(firing.goal)


def _domain(shape: RegionShape, firing: Firing) -> str:
    if terminates(shape, firing):
        return "Ending"
    return "Nothing" if firing.domain is None else _inside(firing.domain)


# --- The chart as declared ---------------------------------------------------


def domain_types(shape: RegionShape) -> list[Decl]:
    """Domain and Domain_Of, where something outlasts a transition."""
    if not has_domains(shape):
        return []
    rows = tuple((f.literal, ref(_domain(shape, f))) for f in shape.firings)
    regions = [r for s in shape.region.states for r in s.region_ids]
    ends = ("Ending",) if _ends(shape) else ()
    literals = ("Nothing", *map(_inside, regions), "Everything", "Beginning", *ends)
    return [
        Comment("The innermost region that holds all that a transition leaves and enters."),
        EnumType("Domain", literals),
        Subprogram(
            "Domain_Of",
            (Param("T", "in", "Firing"),),
            "Domain",
            expression=choice_of(ref("T"), ((START, ref("Beginning")), *rows)),
        ),
        Comment(
            "T leaves all states in its domain and enters those that are active there afterwards."
        ),
    ]


def declared_lasting(shape: RegionShape) -> list[Decl]:
    """Timers_After and Remembered, as far as the chart needs them."""
    timers = _timers_after(shape, _ends(shape)) if shape.timers else []
    return timers + (_remembered(shape) if shape.memories else [])


def spans_of_states(shape: RegionShape) -> dict[str, Expr]:
    """For each state the test whether a domain holds a region around it."""
    return {s.name: _spans(shape.region.regions_around(s.name)) for s in shape.region.states}


def _ends(shape: RegionShape) -> bool:
    """Does a transition stop the region?"""
    return any(terminates(shape, f) for f in shape.firings)


def _spans(regions: Sequence[RegionId], *more: str) -> Expr:
    names = [_inside(r) for r in regions] + list(more)
    return one_of(ref("D"), names)


def _fresh(shape: RegionShape, index: int) -> Expr:
    """The time-out with this number when its state has just been entered."""
    trigger = shape.timers[index - 1].trigger
    assert isinstance(trigger, After | Every)
    count = number(trigger.executions)
    args = (count, count) if isinstance(trigger, Every) else (count,)
    return call("Ravenchart.Timers.Started", *args)


def _timers_after(shape: RegionShape, ends: bool) -> list[Decl]:
    rows: list[Arg] = []
    for i, timed in enumerate(shape.timers, 1):
        around = shape.region.regions_around(timed.source)
        active = both(
            *conjuncts(
                [
                    OperatorChain("/=", (ref("D"), ref("Beginning"))),
                    shape.in_state("Before", timed.source),
                ]
            )
        )
        after = shape.in_state("After", timed.source)
        spanned, timer = _spans(around, "Beginning"), Indexed("Timers", plain(i))
        moved = call("Ravenchart.Timers.Moved", timer, spanned, active, after, _fresh(shape, i))
        rows.append(Arg(plain(i), moved))
    moves: Expr = Aggregate(tuple(rows))
    if ends:
        moves = IfExpr(((equal(ref("D"), ref("Ending")), all_else(_STOPPED)),), moves)
    return [
        Subprogram(
            "Timers_After",
            (
                Param("Timers", "in", TIME_OUTS),
                Param("D", "in", "Domain"),
                Param("Before", "in", shape.configuration_type),
                Param("After", "in", shape.configuration_type),
            ),
            TIME_OUTS,
            expression=moves,
        ),
        Comment(_TIMES_AFTER),
    ]


def _remembered(shape: RegionShape) -> list[Decl]:
    rows: list[Arg] = []
    for memory in shape.memories:
        leaf = shape.at(shape.configuration_name, shape.concurrent_around(memory.region))
        left = conjuncts([_left(shape, memory), _active(shape, memory)])
        children = shape.region.children(*memory.region)
        goes_on = [OperatorChain("/=", (leaf, shape.literal(s.name))) for s in children if s.final]
        last = IfExpr(((both(*left, *goes_on), leaf),), ref("Past", memory.last))
        known = IfExpr(((both(*left), both(*goes_on)),), ref("Past", memory.known))
        rows += [Arg(memory.last, last), Arg(memory.known, known)]
    return [
        Subprogram(
            "Remembered",
            (
                Param("D", "in", "Domain"),
                Param(shape.configuration_name, "in", shape.configuration_type),
                Param("Past", "in", "Memory"),
            ),
            "Memory",
            expression=Aggregate(tuple(rows)),
        ),
        Comment(_REMEMBERED),
    ]


def _left(shape: RegionShape, memory: HistoryMemory) -> Expr:
    """Is the leaf of the memory's region left, when there is one?"""
    assert memory.region.owner is not None
    around = [memory.region, *shape.region.regions_around(memory.region.owner)]
    concurrent = shape.concurrent_around(memory.region)
    inner = [
        r
        for s in shape.region.states
        for r in s.region_ids
        if r != memory.region
        and shape.concurrent_around(r) == concurrent
        and memory.region in shape.region.regions_around(s.name)
    ]
    return _spans([*inner, *around])


def _active(shape: RegionShape, memory: HistoryMemory) -> Expr:
    """Is there a leaf in the memory's region? A pseudostate is not remembered."""
    assert memory.region.owner is not None
    passed = {p.name for p in shape.region.pseudostates}
    leaf = shape.at(shape.configuration_name, shape.concurrent_around(memory.region))
    not_left = [
        OperatorChain("/=", (leaf, shape.literal(v)))
        for v in shape.literals(memory.region)
        if v in passed
    ]
    active = shape.in_state(shape.configuration_name, memory.region.owner)
    return both(*conjuncts([active, *not_left]))


# --- The contract of transitions ----------------------------------------------


class Lasting:
    """The time-outs, memory and deferred events of one region."""

    def __init__(self, shape: RegionShape) -> None:
        self.shape = shape
        self.region = shape.region

    def moved(self, chosen: str, before: str) -> list[Stmt]:
        """The effect of a transition on them; ``before`` holds the configuration that it leaves."""
        shape = self.shape
        domain, left = call("Domain_Of", ref(chosen)), ref(before)
        done: list[Stmt] = []
        if shape.timers:
            after = call("Timers_After", _TIMERS, domain, left, shape.held)
            done.append(Assign(_TIMERS, after))
        if shape.memories:
            done.append(Assign(_PAST, call("Remembered", domain, left, _PAST)))
        if shape.deferring:
            done.append(change(chosen, domain, before))
        return done

    def fired(self, chosen: str) -> list[Expr]:
        """The declared effect, after a transition that ``chosen`` names."""
        facts: list[Expr] = []
        held = self.shape.held
        domain = call("Domain_Of", ref(chosen))
        if self.shape.timers:
            after = call("Timers_After", old(_TIMERS), domain, old(held), held)
            facts.append(equal(_TIMERS, after))
        if self.shape.memories:
            recalled = call("Remembered", domain, old(held), old(_PAST))
            facts.append(equal(_PAST, recalled))
        if self.shape.deferring:
            facts.append(is_changed(self.shape, chosen, domain))
        return facts
