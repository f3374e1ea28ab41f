# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Validity rules of charts: states never reached, and transitions never taken or in conflict.

Guards are not looked into, but for the literals ``true`` and ``false``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

from ravenchart.gen.diagnostics import Diagnostic, error, warning
from ravenchart.gen.model.chart.reach import Reach
from ravenchart.gen.model.chart.steps import RAISED, Steps, Tally
from ravenchart.gen.model.chart.tree import Tree, is_segment
from ravenchart.gen.model.component import Activity, Component
from ravenchart.gen.model.statechart import (
    DONE,
    RAISED_PER_STEP,
    Completion,
    OnEvent,
    Region,
    Transition,
    When,
)
from ravenchart.gen.origins import Origin
from ravenchart.gen.resolve.chart_names import FINAL_STATE, PSEUDO_WORDS
from ravenchart.gen.resolve.chart_structure import BRANCHING, always_enabled, is_literal
from ravenchart.gen.resolve.system import Resolved


def sound_regions(component: Component, resolved: Resolved) -> list[Region]:
    """The regions without errors: only of these can be said what they cannot do."""
    damaged = resolved.damaged
    return [r for r in component.regions if f"{component.name}.{r.name}" not in damaged]


# --- What one step does ------------------------------------------------------------


def steps_stay_within_bounds(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """No step sends twice on one port, or raises more events than fit."""
    reported: set[tuple[Origin, Origin]] = set()
    for region in sound_regions(component, resolved):
        steps = Steps(Tree(region))
        single, shared = list(steps.single()), list(steps.shared())
        for what, tally in single:
            yield from twice(what, tally, reported)
        for what, tally in shared:
            hint = "send from one of its regions only, or from an activity"
            yield from twice(what, tally, reported, hint)
        for what, tally in (*single, *shared):
            raised = tally.get(RAISED, ())
            if len(raised) > RAISED_PER_STEP:
                message = f"{what} raises up to {len(raised)} events in one step"
                message += f"; the limit is {RAISED_PER_STEP}"
                hint = "raise fewer, or spread them over several steps"
                yield error("RV-0530", raised[RAISED_PER_STEP], message, hint=hint)
                break


ONE_SEND = "send once, with a value chosen by `if ... then ... else ...`"


def twice(
    what: str, tally: Tally, reported: set[tuple[Origin, Origin]], hint: str = ONE_SEND
) -> Iterator[Diagnostic]:
    """An error for each port that is sent on twice."""
    for port, origins in tally.items():
        if port == RAISED or len(origins) < 2 or origins[:2] in reported:
            continue
        reported.add((origins[0], origins[1]))
        message = f"{what} may send twice on `{port}`"
        notes = [(origins[0], "it sends here first")]
        yield error("RV-0413", origins[1], message, notes=notes, hint=hint)


# --- Completion --------------------------------------------------------------------


def _working_in(component: Component, region: Region, state: str) -> list[Activity]:
    """The do activities of a state."""
    return [
        activity
        for activity in component.activities
        if activity.while_in is not None
        and (activity.while_in.region, activity.while_in.state) == (region.name, state)
    ]


def _ends(component: Component, region: Region, state: str) -> bool:
    """Whether the do activities of a state, when it has any, can complete it."""
    working = _working_in(component, region, state)
    return not working or any(DONE in activity.raises for activity in working)


def _endless(
    component: Component, region: Region, tree: Tree, state: str
) -> tuple[str, str] | None:
    """Why a state can never complete, and what would help; None when it can."""
    if not _ends(component, region, state):
        name = _working_in(component, region, state)[0].name
        return f"its do activity {name} never raises `{DONE}`", f"let {name} raise `{DONE}`"
    for nested in tree.regions(state):
        if not any(inner.final for inner in tree.content.get(nested, ())):
            where = f"its region {nested.name}" if nested.name else state
            return f"{where} has no final state", "add one: `Name: {kind: final}`"
    return None


def _incomplete(component: Component, region: Region) -> Iterator[Diagnostic]:
    """An error for each completion transition whose source never completes."""
    tree = Tree(region)
    for transition in region.transitions:
        if not isinstance(transition.trigger, Completion):
            continue
        reason = _endless(component, region, tree, transition.source)
        if reason is not None:
            message = f"{transition.name} is never taken: {transition.source} never completes"
            notes = [(tree.origin(transition.source), reason[0])]
            hint = f"{reason[1]}; or name a trigger (`on`, `after`, `every`, `when`)"
            yield error("RV-0524", transition.origin, message, notes=notes, hint=hint)


def completions_can_come(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """A completion transition can get its completion, and one waits for each `DONE` raised."""
    for region in sound_regions(component, resolved):
        yield from _incomplete(component, region)
    regions = {region.name: region for region in sound_regions(component, resolved)}
    for activity in component.activities:
        waits = activity.while_in
        if waits is None or DONE not in activity.raises or waits.region not in regions:
            continue
        waiting = regions[waits.region].outgoing(waits.state)
        if not any(isinstance(t.trigger, Completion) for t in waiting):
            message = f"{activity.name} raises `{DONE}`, but nothing waits for it"
            notes = [
                (
                    regions[waits.region].state(waits.state).origin,
                    f"no completion transition leaves {waits.state}",
                )
            ]
            yield warning("RV-0533", activity.origin, message, notes=notes)


# --- Reachability ------------------------------------------------------------------


def _reach(component: Component, region: Region) -> Reach:
    return Reach(Tree(region), lambda state: _ends(component, region, state))


def states_are_reachable(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """Each state and pseudostate is entered on some way from the initial state."""
    for region in sound_regions(component, resolved):
        if any(_incomplete(component, region)):
            continue
        reach = _reach(component, region)
        tree = reach.tree
        vertices = [(s.name, FINAL_STATE if s.final else "state") for s in region.states]
        vertices += [(p.name, PSEUDO_WORDS[p.kind]) for p in region.pseudostates]
        lost = {name for name, _ in vertices} - reach.found
        for name, what in vertices:
            if name not in lost or lost & set(tree.above(name)):
                continue
            if what != "state" and any(t.source in lost for t in tree.incoming.get(name, ())):
                continue  # what leads to it is reported
            message = f"no transition ever leads to the {what} {name} of {region.name}"
            notes = [
                (t.origin, f"so {t.name} is never taken")
                for t in region.transitions
                if t.source == name or name in tree.above(t.source)
            ]
            hint = "add a transition to it, or remove it"
            yield error("RV-0505", tree.origin(name), message, notes=notes, hint=hint)


def safe_states_are_reachable(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """From each state that is reached, some way leads to the safe state."""
    for region in sound_regions(component, resolved):
        if region.safe_state is None:
            continue
        reach = _reach(component, region)
        safe = reach.leading_to(region.safe_state)
        for leaf in region.leaves():
            if leaf in safe or leaf not in reach.found:
                continue
            state = region.state(leaf)
            message = f"no way leads from {leaf} to {region.safe_state}, the safe state"
            notes = [(region.state(region.safe_state).origin, "the safe state is here")]
            hint = f"add a transition from {leaf}, or from a state around it"
            if state.final:
                hint = f"add a transition from a state around {leaf}, or let it be a plain state"
            yield error("RV-0506", state.origin, message, notes=notes, hint=hint)
            break


# --- Transitions -------------------------------------------------------------------


def transitions_can_fire(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """No transition is shut out by an earlier one, or by its own condition."""
    for region in sound_regions(component, resolved):
        tree = Tree(region)
        for transition in region.transitions:
            trigger = transition.trigger
            met = trigger.condition if isinstance(trigger, When) else None
            if is_literal(transition.guard, "False") or is_literal(met, "False"):
                what = "trigger" if is_literal(met, "False") else "guard"
                message = f"{transition.name} is never taken: its {what} is false"
                yield error("RV-0508", transition.origin, message, hint="remove it")
        for leaving in tree.outgoing.values():
            yield from _shut_out(tree, leaving)


def _shut_out(tree: Tree, leaving: tuple[Transition, ...]) -> Iterator[Diagnostic]:
    """The transitions of one vertex that an earlier one always takes the place of."""
    always: dict[str, Transition] = {}
    for transition in leaving:
        taken = _taken(tree, transition)
        if taken is None:
            continue
        if taken in always:
            first = always[taken]
            message = f"{transition.name} is never taken: {first.name} always {taken}"
            notes = [(first.origin, f"{first.name} has no guard")]
            hint = f"give {first.name} a guard, or remove {transition.name}"
            yield error("RV-0507", transition.origin, message, notes=notes, hint=hint)
        elif always_enabled(tree, transition):
            always[taken] = transition


def _taken(tree: Tree, transition: Transition) -> str | None:
    """The occurrence that a transition takes from the later ones of its source, in words."""
    source = transition.source
    match transition.trigger:
        case OnEvent(event):
            return f"takes {event} in {source}"
        case Completion():
            return f"takes the completion of {source}"
    if is_segment(transition) and tree.kind(source) in BRANCHING:
        return f"leaves the {PSEUDO_WORDS[tree.pseudostates[source].kind]} {source}"
    return None


def firings_agree(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning where an event can take a transition out of an orthogonal state and one in it."""
    for region in sound_regions(component, resolved):
        if not any(state.is_orthogonal for state in region.states):
            continue
        tree = Tree(region)
        by_event: defaultdict[str, list[Transition]] = defaultdict(list)
        for transition in region.transitions:
            if isinstance(transition.trigger, OnEvent):
                by_event[transition.trigger.event].append(transition)
        regions = region.concurrent_regions()
        rank = {
            t.name: regions.index(region.concurrent_region(t.source)) for t in region.transitions
        }
        for event, transitions in by_event.items():
            for index, first in enumerate(transitions):
                for second in transitions[index + 1 :]:
                    found = _conflict(tree, first, second)
                    if found is None:
                        continue
                    leaver, state = found
                    other = second if leaver is first else first
                    early, late = sorted((first, second), key=lambda t: rank[t.name])
                    message = (
                        f"on {event}, {leaver.name} leaves {state} while {other.name} is taken"
                    )
                    message += " in it"
                    notes = [(other.origin, f"{other.name} is here")]
                    hint = (
                        f"where both are enabled, {early.name} is taken and {late.name} is "
                        "dropped: let guards exclude each other, or use two events"
                    )
                    yield warning("RV-0529", leaver.origin, message, notes=notes, hint=hint)


def _conflict(tree: Tree, first: Transition, second: Transition) -> tuple[Transition, str] | None:
    """Which of two transitions leaves the orthogonal state that both are inside."""
    state = tree.divide((first.source, second.source))
    if state is None:
        return None
    for transition in (first, second):
        if any(way.left in (state, *tree.above(state)) for way in tree.ways(transition)):
            return transition, state
    return None


def deferred_events_are_taken(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning for an event that is deferred and that nothing takes afterwards."""
    for region in sound_regions(component, resolved):
        taken = {t.trigger.event for t in region.transitions if isinstance(t.trigger, OnEvent)}
        for state in region.states:
            for event in (one for one in state.defers if one not in taken):
                message = f"{state.name} defers {event}, but {region.name} never takes it"
                hint = f"add a transition on {event}, or take it out of `defer`"
                yield warning("RV-0532", state.origin, message, hint=hint)
