# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Rules of one region's control: unused states and transitions, and steps that get stuck."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

import networkx
import z3

from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.model.statechart import OnEvent, Region, State, Transition
from ravenchart.gen.origins import Origin

from . import logic
from .labels import active_leaves, step_label, trace, valuation, way_to
from .logic import Term
from .reach import Reachable
from .reasons import Obstacle, beaten, in_front, taken_inside
from .stepping import Beaten
from .threads import Edge, Thread

Rule = Callable[[Reachable, Thread], Iterator[Diagnostic]]


def _active(thread: Thread) -> set[str]:
    """The states that some node has."""
    return {name for node in thread.nodes for name in node.configuration.active}


def _fired(thread: Thread) -> set[str]:
    """The transitions and segments that some step takes."""
    return {name for edge in thread.edges for name in edge.outcome.fired}


def _model(reach: Reachable, thread: Thread, edge: Edge, condition: Term) -> Term | None:
    """Data with which a step is made and a condition also holds."""
    solver = logic.solver()
    solver.add(*reach.typed, *reach.of_others(thread))
    solver.add(*reach.of_node(thread, edge.before.cells), edge.outcome.condition, condition)
    return solver.model() if solver.check() == z3.sat else None


def _transition(region: Region, name: str) -> Transition:
    return next(t for t in region.transitions if t.name == name)


# --- Never entered, never fired ------------------------------------------------------


def _lost(thread: Thread) -> list[State]:
    """The states that are never entered, without those inside others."""
    active = _active(thread)
    states = [s for s in thread.tree.region.states if s.name not in active]
    return [s for s in states if s.parent is None or s.parent in active]


def states_are_entered(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """Some data lead into each state."""
    tree, fired, shut_out = thread.tree, _fired(thread), _rivals(reach, thread)
    for state in _lost(thread):
        leading = [
            t
            for t in tree.region.transitions
            if state.name in tree.chains[t.target] and state.name not in tree.chains[t.source]
        ]
        message = f"the state {state.name} of {thread.name} is never entered, whatever the data"
        notes: list[tuple[Origin, str]] = []
        changes: list[str] = []
        for transition in leading:
            if transition.name in fired:
                continue
            note = f"{transition.name} leads to it, but is never taken"
            reason = None
            if _is_heard(reach, thread, transition, fired) and not transition.otherwise:
                reason = _reason(reach, thread, transition, shut_out)
            if reason is None or reason.is_guard:
                notes.append((transition.origin, note))
            else:
                notes += [(transition.origin, f"{note}: {reason.text}"), *reason.notes]
                changes.append(reason.change)
        hint = "correct the guards on the way to it, or remove it"
        if changes:
            hint = f"{changes[0]}, or remove {state.name}"
        yield error("RV-1101", state.origin, message, notes=notes, hint=hint)


def transitions_fire(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """Some data let each transition be taken, and no earlier one always comes before it."""
    tree, fired = thread.tree, _fired(thread)
    lost = {state.name for state in _lost(thread)}
    shut_out = _rivals(reach, thread)
    for transition in tree.region.transitions:
        if (
            transition.name in fired
            or transition.otherwise
            or lost & {*tree.chains[transition.target]}
            or not _is_heard(reach, thread, transition, fired)
        ):
            continue
        reason = _reason(reach, thread, transition, shut_out)
        message = f"{transition.name} is never taken: {reason.text}"
        otherwise = f"; {reason.successor}" if reason.successor else f", or {reason.removal}"
        hint = f"{reason.change}{otherwise}"
        yield error("RV-1102", transition.origin, message, notes=reason.notes, hint=hint)


def _is_heard(reach: Reachable, thread: Thread, transition: Transition, fired: set[str]) -> bool:
    """Whether its source is ever active, or reached by a transition, and its event ever comes."""
    tree, trigger = thread.tree, transition.trigger
    if isinstance(trigger, OnEvent) and trigger.event not in reach.events:
        return False
    if transition.source in tree.kinds:
        return any(t.name in fired for t in tree.incoming[transition.source])
    return transition.source in _active(thread)


def _reason(
    reach: Reachable,
    thread: Thread,
    transition: Transition,
    shut_out: Mapping[tuple[str, str], object],
) -> Obstacle:
    """Why a transition is never taken, although its source is active and its event comes."""
    tree = thread.tree
    earlier = [first for first, second in shut_out if second == transition.name]
    if earlier:
        return in_front(tree, transition, earlier)
    defeats = [b for b in _beaten(thread) if b.transition == transition.name]
    if defeats:
        return beaten(tree, transition, defeats)
    inside = taken_inside(
        reach, thread, transition, lambda e, met: _model(reach, thread, e, met) is not None
    )
    if inside is not None:
        return inside
    what = "its guard never holds" if transition.guard is not None else "nothing lets it"
    text = f"{what} in {transition.source}"
    if transition.source not in tree.kinds and not _waits(thread, transition.source):
        text = f"{transition.source} is left at once, as it is complete when entered"
    return Obstacle(text, "correct its guard", "remove it", is_guard=True)


def _beaten(thread: Thread) -> Iterator[Beaten]:
    """The transitions that some step selects and does not take, each once."""
    yield from dict.fromkeys(b for edge in thread.edges for b in edge.outcome.beaten)


def _waits(thread: Thread, state: str) -> bool:
    """Whether a region ever takes anything but a completion in a state."""
    return any(
        state in node.configuration.active and not node.configuration.pending
        for node in thread.nodes
    )


def _rivals(reach: Reachable, thread: Thread) -> dict[tuple[str, str], tuple[Edge, str]]:
    """The pairs of transitions that are enabled together, with the nearest step and its data."""
    found: dict[tuple[str, str], tuple[Edge, str]] = {}
    for edge in thread.edges:
        for rival in edge.outcome.rivals:
            pair = (rival.first, rival.second)
            if pair in found:
                continue
            model = _model(reach, thread, edge, rival.condition)
            if model is not None:
                data = valuation(reach, model, (edge.outcome.condition, rival.condition))
                found[pair] = (edge, data)
    return found


def guards_exclude_each_other(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """Of transitions with one source and trigger, at most one guard holds; else the first wins.

    A last transition without guard takes the remaining cases, and is not reported.
    """
    region, fired = thread.tree.region, _fired(thread)
    for (first, second), (edge, data) in _rivals(reach, thread).items():
        one, other = _transition(region, first), _transition(region, second)
        if second not in fired or other.guard is None:
            continue
        with_data = f" with {data}" if data else ""
        message = (
            f"{first} and {second} can both be taken in {one.source}{with_data}: "
            f"{first} is, as the first in the model"
        )
        notes = [
            (one.origin, f"{first} is here"),
            (other.origin, way_to(reach, thread, edge)),
        ]
        hint = f"let the guard of {second} exclude that of {first}"
        yield warning("RV-1103", other.origin, message, notes=notes, hint=hint)


# --- Stuck ---------------------------------------------------------------------------


def choices_have_a_way_out(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """No data leave a step in a choice without an enabled segment."""
    told: set[str] = set()
    for edge in thread.edges:
        stuck = edge.outcome.stuck
        if stuck is None or stuck in told:
            continue
        told.add(stuck)
        model = _model(reach, thread, edge, z3.BoolVal(True))
        data = "" if model is None else valuation(reach, model, (edge.outcome.condition,))
        pseudo = thread.tree.region.pseudostate(stuck)
        assert pseudo is not None
        message = f"{thread.name} may get stuck in {stuck}: no segment leaves it"
        message += f" with {data}" if data else ""
        leaves = active_leaves(thread.tree, edge.before.configuration)
        step = f"{leaves} -{step_label(thread.tree, edge.outcome)}->"
        notes = [
            (pseudo.origin, way_to(reach, thread, edge)),
            (_transition(thread.tree.region, edge.outcome.fired[0]).origin, f"then {step} {stuck}"),
        ]
        hint = "add a segment with `guard: else`"
        yield error(
            "RV-1104",
            pseudo.origin,
            message,
            notes=notes if edge.outcome.fired else notes[:1],
            hint=hint,
        )


# --- Events that are not expected ------------------------------------------------------


def events_are_expected(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """A warning for a state that alone among its siblings ignores an event.

    At least three others must exist, and all must handle or defer it. A chart that
    ignores an event in several states intends it.
    """
    tree = thread.tree
    for slot in dict.fromkeys(tree.slots[name] for name in tree.states):
        group = [s for s in tree.states.values() if tree.slots[s.name] == slot and not s.final]
        if len(group) < 4:
            continue
        around = tree.chains[group[0].name][1:]
        for event in tree.region.events():
            if event not in reach.events or any(_handles(thread, s, event) for s in around):
                continue
            silent = [s for s in group if not _expected(thread, s.name, event)]
            if len(silent) != 1 or not _waits(thread, silent[0].name):
                continue
            others = [s.name for s in group if s is not silent[0]]
            message = f"{silent[0].name} ignores {event}, which {_listed(others)} expect"
            hint = (
                f"add a transition, `defer: [{event}]`, or "
                f"`{{from: {silent[0].name}, on: {event}}}` to say that it is meant"
            )
            yield warning("RV-1105", silent[0].origin, message, hint=hint)


def _handles(thread: Thread, state: str, event: str) -> bool:
    """Whether a state itself handles or defers an event."""
    leaving = thread.tree.outgoing[state]
    return event in thread.tree.states[state].defers or any(
        t.trigger == OnEvent(event) for t in leaving
    )


def _expected(thread: Thread, state: str, event: str) -> bool:
    """Whether a state, or something inside it, handles or defers an event."""
    return any(
        _handles(thread, name, event)
        for name in thread.tree.states
        if state in thread.tree.chains[name]
    )


def _listed(names: list[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}"


# --- The safe state --------------------------------------------------------------------


def safe_state_is_near(reach: Reachable, thread: Thread) -> Iterator[Diagnostic]:
    """From each node some way leads to the safe state, guards considered."""
    tree, safe = thread.tree, thread.tree.region.safe_state
    if safe is None:
        return
    graph: networkx.DiGraph[object] = networkx.DiGraph()
    graph.add_edges_from((edge.after, edge.before) for edge in thread.edges)
    goals = [node for node in thread.nodes if safe in node.configuration.active]
    graph.add_edges_from((safe, goal) for goal in goals)
    if thread.parts is not None:
        #  a situation of one region of a state is reached together with the other regions
        for node in thread.nodes:
            for name in tree.orthogonal & {*node.configuration.active}:
                graph.add_edges_from(((node, ("in", name)), (("in", name), node)))
    near = networkx.descendants(graph, safe) if goals else set()
    for node, edge in thread.nodes.items():
        if node in near or edge is None:
            continue
        at = active_leaves(tree, node.configuration)
        message = f"no way leads from {at} to {safe}, the safe state of {thread.name}"
        notes = [
            (tree.region.state(safe).origin, "the safe state is here"),
            (_origin(thread, edge), f"the way there: {trace(tree, reach.way(thread, node))}"),
        ]
        hint = f"add a transition to {safe} that no guard shuts out"
        yield error("RV-1106", _origin(thread, edge), message, notes=notes, hint=hint)
        return


def _origin(thread: Thread, edge: Edge) -> Origin:
    """The state that a step leads to, or the region."""
    leaves = [n for n in edge.after.configuration.active if thread.tree.states[n].is_leaf]
    return thread.tree.states[leaves[0]].origin if leaves else thread.tree.region.origin


RULES: tuple[Rule, ...] = (
    states_are_entered,
    transitions_fire,
    guards_exclude_each_other,
    choices_have_a_way_out,
    events_are_expected,
    safe_state_is_near,
)
