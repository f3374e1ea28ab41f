# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""The reasons why a transition is never taken."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from ravenchart.behaviour.tree import ChartTree, occurs
from ravenchart.gen.model.statechart import Transition
from ravenchart.gen.origins import Origin

from . import logic
from .logic import Term
from .reach import Reachable
from .stepping import Beaten, Defeat
from .threads import Edge, Thread

MOST_GUARDED = 64
"""Steps at most in which the guard of one transition is evaluated."""

Possible = Callable[[Edge, Term], bool]
"""Whether some data let a step be made and also meet a condition."""


@dataclass(frozen=True, slots=True)
class Obstacle:
    """The reason why a transition is never taken, as ``NAME is never taken: TEXT``."""

    text: str
    change: str
    """The correction, as the beginning of a hint."""
    removal: str
    """The removal instead of the correction, as the end of a hint: ``remove NAME``."""
    notes: tuple[tuple[Origin, str], ...] = ()
    successor: str = ""
    """The effect of the removal, where another transition may be taken instead."""
    is_guard: bool = False
    """Whether nothing comes before it: its own guard or trigger is the reason."""


def in_front(tree: ChartTree, transition: Transition, earlier: Sequence[str]) -> Obstacle:
    """The obstacle of earlier transitions: same source and trigger, and one is always taken."""
    found = [t for t in tree.region.transitions if t.name in earlier]
    notes = tuple((t.origin, f"{t.name} is earlier in the model") for t in found)
    text = f"{_and(t.name for t in found)} always comes before it"
    return Obstacle(text, "change the order or the guards", f"remove {transition.name}", notes)


def beaten(tree: ChartTree, transition: Transition, found: Sequence[Beaten]) -> Obstacle:
    """The obstacle in another region, which defers or acts instead of the enabled transition."""
    name, source = transition.name, transition.source
    states = [b.by for b in found if b.why is Defeat.DEFERRAL]
    if states:
        notes = tuple((tree.states[state].origin, f"{state} is here") for state in states)
        text = f"while {source} is active, {' or '.join(states)} defers the event"
        return Obstacle(text, f"remove `defer` from {_and(states)}", f"remove {name}", notes)
    winners = [_transition(tree, one) for one in dict.fromkeys(b.by for b in found)]
    notes = tuple((w.origin, f"{w.name} of an earlier region is taken") for w in winners)
    change = "change the order of the regions or the guards"
    if all(b.why is Defeat.END for b in found):
        text = f"{' or '.join(w.name for w in winners)} is taken before it and ends the region"
        return Obstacle(text, change, f"remove {name}", notes)
    successor = (
        f"where {name} is removed, the next transition of {source}, or of a state around it, "
        "takes its place and may be taken"
    )
    text = f"it conflicts with {_and(w.name for w in winners)}"
    return Obstacle(text, change, f"remove {name}", notes, successor)


def taken_inside(
    reach: Reachable, thread: Thread, transition: Transition, possible: Possible
) -> Obstacle | None:
    """The obstacle in states inside the source, which always defer or take a transition first."""
    tree, source = thread.tree, transition.source
    if source not in tree.states or not tree.states[source].regions:
        return None
    due = [
        edge
        for edge in thread.edges
        if source in edge.before.configuration.active
        and occurs(transition, edge.outcome.occurrence)
    ]
    guard = transition.guard
    if guard is not None:
        if len(due) > MOST_GUARDED:
            return None
        met = logic.term(guard, reach.symbol)
        due = [edge for edge in due if possible(edge, met)]
    firing: dict[str, None] = {}
    deferring: dict[str, None] = {}
    for edge in due:
        deferral = [
            state
            for state in edge.before.configuration.active
            if edge.outcome.deferred
            and edge.outcome.occurrence.subject in tree.states[state].defers
            and source in tree.chains[state][1:]
        ]
        inside = [
            name for name in edge.outcome.fired if source in tree.chains[tree.source_of(name)][1:]
        ]
        if not deferral and not inside:
            return None
        deferring |= dict.fromkeys(deferral[:1])
        firing |= dict.fromkeys(inside[:1])
    if not firing and not deferring:
        return None
    return _inside(tree, transition, tuple(firing), tuple(deferring))


def _inside(
    tree: ChartTree, transition: Transition, firing: Sequence[str], deferring: Sequence[str]
) -> Obstacle:
    """The obstacle of transitions and deferrals of states inside the source."""
    source = transition.source
    said, changes = [], []
    if deferring:
        said.append(f"{' or '.join(deferring)} defers the event")
        changes.append(f"remove `defer` from {_and(deferring)}")
    if firing:
        said.append(f"{' or '.join(firing)} is taken first")
        changes.append(f"change the guard of {_and(firing)}")
    notes = [(tree.states[state].origin, f"{state} is inside {source}") for state in deferring]
    for name in firing:
        one = _transition(tree, name)
        notes.append((one.origin, f"{name} starts from {one.source}, inside {source}"))
    text = f"while {source} is active, {', or '.join(said)}"
    return Obstacle(text, " or ".join(changes), f"remove {transition.name}", tuple(notes))


def _transition(tree: ChartTree, name: str) -> Transition:
    return next(t for t in tree.region.transitions if t.name == name)


def _and(names: Iterable[str]) -> str:
    return " and ".join(names)
