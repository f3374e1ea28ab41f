# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The structure of charts: rules on pseudostates, on which everything else relies.

They are checked as soon as a region is resolved. A region that breaks a rule counts as damaged,
and nothing else is reported about it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from graphlib import CycleError, TopologicalSorter

from ravenchart.gen.diagnostics import Diagnostic, error
from ravenchart.gen.language.terms import BOOLEAN, Expression, Literal
from ravenchart.gen.model.chart.tree import Tree
from ravenchart.gen.model.statechart import (
    OnEvent,
    PseudoKind,
    Pseudostate,
    Region,
    Transition,
    TransitionKind,
)

from .chart_names import PSEUDO_WORDS

BRANCHING = (PseudoKind.CHOICE, PseudoKind.JUNCTION)
MOST_PATHS = 64
"""Ways through junctions that one transition can have."""


def structure_errors(region: Region) -> Iterator[Diagnostic]:
    """Everything that breaks a rule of structure."""
    tree = Tree(region)
    for pseudo in region.pseudostates:
        if pseudo.kind in CHECKS:
            yield from CHECKS[pseudo.kind](tree, pseudo)
    endless = list(_circles(tree)) or list(_paths(tree))
    yield from endless
    if not endless:
        yield from _deferrals(tree)


def shown(pseudo: Pseudostate) -> str:
    """Kind and name."""
    return f"{PSEUDO_WORDS[pseudo.kind]} {pseudo.name}"


def is_literal(expression: Expression | None, value: str) -> bool:
    """Whether a condition is ``true``, or ``false``, as it stands."""
    return expression == Literal(value, BOOLEAN)


def always_enabled(tree: Tree, transition: Transition) -> bool:
    """Whether no guard, its own or a junction's, can disable a transition."""
    if transition.guard is not None and not is_literal(transition.guard, "True"):
        return False
    if tree.kind(transition.target) is not PseudoKind.JUNCTION:
        return True
    return any(always_enabled(tree, t) for t in tree.outgoing.get(transition.target, ()))


# --- Choices and junctions ---------------------------------------------------------


def _branching(tree: Tree, pseudo: Pseudostate) -> Iterator[Diagnostic]:
    """A way out, and one `else` at most."""
    leaving = tree.outgoing.get(pseudo.name, ())
    if not leaving:
        message = f"no transition leaves the {shown(pseudo)}"
        hint = "a step cannot end there: add transitions from it, the last with `guard: else`"
        yield error("RV-0517", pseudo.origin, message, hint=hint)
    otherwise = [t for t in leaving if t.otherwise]
    for second in otherwise[1:]:
        message = f"the {shown(pseudo)} has two transitions with `else`"
        notes = [(otherwise[0].origin, f"{otherwise[0].name} is the first")]
        hint = "give one of them a condition, or remove it"
        yield error("RV-0516", second.origin, message, notes=notes, hint=hint)


def _circles(tree: Tree) -> Iterator[Diagnostic]:
    """Segments never lead from a choice or junction back to it: such a step would not end."""
    inner = [p.name for p in tree.region.pseudostates if p.kind in BRANCHING]
    ways: dict[str, Iterable[str]] = {
        name: [t.target for t in tree.outgoing.get(name, ())] for name in inner
    }
    if not _has_circle(ways):
        return
    import networkx  # only here: it takes longer than the check of a model

    graph: networkx.DiGraph[str] = networkx.DiGraph(ways)
    for circle in networkx.strongly_connected_components(graph):
        members = [name for name in inner if name in circle]
        if not members or (len(members) == 1 and not graph.has_edge(members[0], members[0])):
            continue
        first = tree.pseudostates[members[0]]
        message = f"the {shown(first)} leads back to itself"
        if len(members) > 1:
            message += f", through {', '.join(members[1:])}"
        notes = [
            (t.origin, f"{t.name} leads from {name} to {t.target}")
            for name in members
            for t in tree.outgoing[name]
            if t.target in circle
        ]
        hint = "a step must end: put a state into the cycle"
        yield error("RV-0518", first.origin, message, notes=notes, hint=hint)


def _has_circle(ways: Mapping[str, Iterable[str]]) -> bool:
    try:
        TopologicalSorter(ways).prepare()
    except CycleError:
        return True
    return False


def _count(tree: Tree, target: str, known: dict[str, int]) -> int:
    """The ways through junctions from a vertex on."""
    if tree.kind(target) is not PseudoKind.JUNCTION:
        return 1
    if target not in known:
        leaving = tree.outgoing.get(target, ())
        known[target] = sum(_count(tree, t.target, known) for t in leaving)
    return known[target]


def _paths(tree: Tree) -> Iterator[Diagnostic]:
    """Not too many ways through junctions; those of a local transition stay in its source."""
    known: dict[str, int] = {}
    for transition in tree.region.transitions:
        if tree.kind(transition.source) is PseudoKind.JUNCTION:
            continue
        count = _count(tree, transition.target, known)
        if count > MOST_PATHS:
            message = f"{transition.name} has {count} ways through junctions"
            hint = f"a transition has at most {MOST_PATHS}: use a choice, where few decide"
            yield error("RV-0531", transition.origin, message, hint=hint)
        elif transition.kind is TransitionKind.LOCAL:
            yield from _local(tree, transition)


def _local(tree: Tree, transition: Transition) -> Iterator[Diagnostic]:
    for way in tree.ways(transition):
        ends = way.targets
        if tree.kind(way.target) is PseudoKind.FORK:
            ends = tuple(end for end in (tree.divide(way.targets),) if end is not None)
        for end in ends:
            if transition.source not in tree.above(end):
                message = (
                    f"{transition.name} is local, and by {way.path[-1].name} it leads to {end}, "
                    f"which is not inside {transition.source}"
                )
                hint = "leave `local` out, or name a target inside"
                yield error("RV-0523", transition.origin, message, hint=hint)


# --- Forks and joins ---------------------------------------------------------------


def _fork(tree: Tree, pseudo: Pseudostate) -> Iterator[Diagnostic]:
    leaving = tree.outgoing.get(pseudo.name, ())
    hint = "a fork enters states in different regions of one orthogonal state, at least two"
    if len(leaving) < 2:
        count = "one transition leaves" if leaving else "no transition leaves"
        message = f"{count} the {shown(pseudo)}"
        yield error("RV-0520", pseudo.origin, message, hint=hint)
        return
    strange = [t for t in leaving if t.target not in tree.states]
    for transition in strange:
        target = shown(tree.pseudostates[transition.target])
        message = f"{transition.name} leads from the {shown(pseudo)} to the {target}"
        yield error("RV-0520", transition.origin, message, hint="a fork leads to states only")
    if not strange and tree.divide(tuple(t.target for t in leaving)) is None:
        targets = _listed([t.target for t in leaving])
        message = f"the {shown(pseudo)} leads to {targets}: not one in each of several regions"
        notes = [(t.origin, f"{t.name} leads to {t.target}") for t in leaving]
        yield error("RV-0520", pseudo.origin, message, notes=notes, hint=hint)


def _join(tree: Tree, pseudo: Pseudostate) -> Iterator[Diagnostic]:
    leading = tree.incoming.get(pseudo.name, ())
    leaving = tree.outgoing.get(pseudo.name, ())
    hint = "a join waits for states in different regions of one orthogonal state, at least two"
    if len(leading) < 2:
        count = "one transition leads" if leading else "no transition leads"
        message = f"{count} to the {shown(pseudo)}"
        yield error("RV-0519", pseudo.origin, message, hint=hint)
    else:
        strange = [t for t in leading if t.source not in tree.states]
        for transition in strange:
            source = shown(tree.pseudostates[transition.source])
            message = f"{transition.name} leads from the {source} to the {shown(pseudo)}"
            told = "a join waits for states only"
            yield error("RV-0519", transition.origin, message, hint=told)
        if not strange and tree.divide(tuple(t.source for t in leading)) is None:
            sources = _listed([t.source for t in leading])
            message = f"the {shown(pseudo)} waits for {sources}: not one in each of several regions"
            notes = [(t.origin, f"{t.name} comes from {t.source}") for t in leading]
            yield error("RV-0519", pseudo.origin, message, notes=notes, hint=hint)
    for transition in leading:
        if transition.kind is TransitionKind.LOCAL:
            message = f"{transition.name} is local and leads to the {shown(pseudo)}"
            told = "leave `local` out: a join leaves the orthogonal state"
            yield error("RV-0519", transition.origin, message, hint=told)
    if len(leaving) != 1:
        count = _listed([t.name for t in leaving])
        message = f"{count} leave the {shown(pseudo)}" if leaving else ""
        message = message or f"no transition leaves the {shown(pseudo)}"
        told = "exactly one leaves a join; a choice behind it can have several ways"
        yield error("RV-0519", pseudo.origin, message, hint=told)


def _listed(names: list[str]) -> str:
    """Names in words."""
    return f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else "".join(names)


# --- Histories ---------------------------------------------------------------------


def _history(tree: Tree, pseudo: Pseudostate) -> Iterator[Diagnostic]:
    region = tree.region.region_of(pseudo.name)
    if region.owner is None:
        message = f"the {shown(pseudo)} stands in a top-level region, which is never left"
        hint = "move it into the `states` of the composite state that shall be restored"
        yield error("RV-0521", pseudo.origin, message, hint=hint)
    same = (p for p in tree.region.pseudostates if p.kind is pseudo.kind)
    first = next(p for p in same if tree.region.region_of(p.name) == region)
    if first is not pseudo:
        message = f"a second {PSEUDO_WORDS[pseudo.kind]} stands beside {first.name}"
        notes = [(first.origin, "the first is here")]
        hint = "let all transitions lead to one of them"
        yield error("RV-0521", pseudo.origin, message, notes=notes, hint=hint)
    leaving = tree.outgoing.get(pseudo.name, ())
    for second in leaving[1:]:
        message = f"{second.name} is a second transition from the {shown(pseudo)}"
        notes = [(leaving[0].origin, f"{leaving[0].name} is the first")]
        hint = "one transition at most, taken when nothing is recorded, leaves a history"
        yield error("RV-0521", second.origin, message, notes=notes, hint=hint)
    for transition in leaving:
        if transition.target not in tree.states or tree.child(region, transition.target) is None:
            message = (
                f"{transition.name} leads from the {shown(pseudo)} to {transition.target}, which "
                "is no state beside it or inside one"
            )
            hint = "the default of a history is a state of the region that the history stands in"
            yield error("RV-0521", transition.origin, message, hint=hint)


# --- Deferral ----------------------------------------------------------------------


def _deferrals(tree: Tree) -> Iterator[Diagnostic]:
    """No state defers an event that its own transition always takes."""
    for state in tree.region.states:
        for event in state.defers:
            for transition in tree.outgoing.get(state.name, ()):
                if transition.trigger == OnEvent(event) and always_enabled(tree, transition):
                    message = (
                        f"{state.name} never defers {event}: {transition.name} always takes it"
                    )
                    notes = [(transition.origin, f"{transition.name} has no guard")]
                    hint = f"give {transition.name} a guard, or take {event} out of `defer`"
                    yield error("RV-0525", state.origin, message, notes=notes, hint=hint)
                    break


CHECKS: dict[PseudoKind, Callable[[Tree, Pseudostate], Iterator[Diagnostic]]] = {
    PseudoKind.CHOICE: _branching,
    PseudoKind.JUNCTION: _branching,
    PseudoKind.HISTORY: _history,
    PseudoKind.DEEP_HISTORY: _history,
    PseudoKind.FORK: _fork,
    PseudoKind.JOIN: _join,
}
