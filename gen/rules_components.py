"""Validity rules of one component: writers, sends, charts and events.

Guards are not looked into, but for the literals ``true`` and ``false``.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import networkx

from .diagnostics import Diagnostic, error, warning
from .flows import actions_of
from .model import Activity, Component
from .resolve import Resolved
from .statechart import OnEvent, Region, Transition, TransitionKind, When
from .terms import BOOLEAN, Expression, Flow, If, Literal, Origin, Send, Set

ComponentRule = Callable[[Component, Resolved], Iterator[Diagnostic]]


def _sound_regions(component: Component, resolved: Resolved) -> list[Region]:
    """The regions without errors: only of these can be said what they cannot do."""
    damaged = resolved.damaged
    return [r for r in component.regions if f"{component.name}.{r.name}" not in damaged]


def _is_literal(expression: Expression | None, value: str) -> bool:
    return expression == Literal(value, BOOLEAN)


# --- Writers -----------------------------------------------------------------------


def data_have_one_writer(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """Each data item is written by one region or activity at most."""
    writers: defaultdict[str, list[tuple[str, Origin]]] = defaultdict(list)
    for item in component.runnables():
        for name in item.writes:
            writers[name].append((item.name, _writes_at(item, name)))
    for data in component.data:
        found = writers[data.name]
        if len(found) > 1:
            names = [writer for writer, _ in found]
            listed = f"{', '.join(names[:-1])} and {names[-1]}"
            count = {2: "two", 3: "three"}.get(len(found), str(len(found)))
            message = f"{component.name}.{data.name} has {count} writers: {listed}"
            notes = [(origin, f"{writer} writes it here") for writer, origin in found]
            hint = "let one write it, and the other send or raise what it wants to the first"
            yield error("RV-0412", data.origin, message, notes=notes, hint=hint)


def _writes_at(item: Region | Activity, data: str) -> Origin:
    """Where a region or activity writes a data item: its first action, or itself."""
    for flow in _flows(item):
        for action in actions_of(flow):
            if isinstance(action, Set) and action.data == data:
                return action.origin
    return item.origin


def _flows(item: Region | Activity) -> list[Flow]:
    """Every flow of a region or activity."""
    if isinstance(item, Region):
        states = [flow for state in item.states for flow in (state.entry, state.exit)]
        return [*states, *(transition.effect for transition in item.transitions)]
    return [] if item.flow is None else [item.flow]


# --- Sends -------------------------------------------------------------------------

Sends = dict[str, tuple[Origin, ...]]
"""For each port the sends on the way that has most of them."""


def _sends(flows: Sequence[Flow]) -> Sends:
    """The sends of flows that run one after the other."""
    found: Sends = {}
    for flow in flows:
        for action in flow:
            if isinstance(action, Send):
                found[action.port] = (*found.get(action.port, ()), action.origin)
            elif isinstance(action, If):
                then, otherwise = _sends([action.then]), _sends([action.otherwise])
                for port in {**then, **otherwise}:
                    more = max(then.get(port, ()), otherwise.get(port, ()), key=len)
                    found[port] = (*found.get(port, ()), *more)
    return found


def steps_send_once(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """No step, and no execution of an activity, can send twice on one port."""
    reported: set[tuple[Origin, Origin]] = set()
    ways: list[tuple[str, Sends]] = []
    for region in _sound_regions(component, resolved):
        ways.append(
            (f"entering {region.name}", _sends(_entries(region, None, region.initial.target)))
        )
        for transition in region.transitions:
            what = f"the transition {transition.name} of {region.name}"
            ways += [(what, _sends(flows)) for flows in _steps(region, transition)]
    ways += [
        (f"one execution of {activity.name}", _sends([activity.flow]))
        for activity in component.activities
        if activity.flow is not None
    ]
    for what, sends in ways:
        for port, origins in sends.items():
            if len(origins) > 1 and origins[:2] not in reported:
                reported.add((origins[0], origins[1]))
                message = f"{what} may send twice on `{port}`"
                notes = [(origins[0], "it sends here first")]
                hint = "send once, with a value chosen by `if ... then ... else ...`"
                yield error("RV-0413", origins[1], message, notes=notes, hint=hint)


def _steps(region: Region, transition: Transition) -> Iterator[list[Flow]]:
    """The flows of a transition in the order they run, from each leaf it may start in."""
    if transition.kind is TransitionKind.INTERNAL:
        yield [transition.effect]
        return
    scope = _scope(region, transition)
    entries = _entries(region, scope, transition.target)
    for leaf in region.leaves(transition.source):
        chain = region.ancestors(leaf)
        left = chain if scope is None else chain[: chain.index(scope)]
        yield [*(region.state(name).exit for name in left), transition.effect, *entries]


def _scope(region: Region, transition: Transition) -> str | None:
    """The innermost state that is neither left nor entered; None for the region."""
    around = region.ancestors(transition.target)[1:]
    return next((s for s in region.ancestors(transition.source)[1:] if s in around), None)


def _entries(region: Region, scope: str | None, target: str) -> list[Flow]:
    """The entry flows from inside ``scope`` to the leaf that ``target`` leads to."""
    chain = region.ancestors(region.default_leaf(target))
    entered = chain if scope is None else chain[: chain.index(scope)]
    return [region.state(name).entry for name in reversed(entered)]


# --- Charts ------------------------------------------------------------------------


def _graph(region: Region) -> networkx.DiGraph[Any]:
    """The leaves of a region, with an edge where a transition leads from one to another."""
    graph: networkx.DiGraph[Any] = networkx.DiGraph()
    graph.add_nodes_from(region.leaves())
    for transition in region.transitions:
        if transition.kind is TransitionKind.EXTERNAL:
            target = region.default_leaf(transition.target)
            graph.add_edges_from((leaf, target) for leaf in region.leaves(transition.source))
    return graph


def states_are_reachable(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """Each state is entered on some way from the initial one."""
    for region in _sound_regions(component, resolved):
        start = region.default_leaf(region.initial.target)
        reached = {start} | networkx.descendants(_graph(region), start)
        lost = [s for s in region.states if not reached & set(region.leaves(s.name))]
        names = {state.name for state in lost}
        for state in lost:
            if state.parent in names:
                continue
            message = f"no transition ever leads to the state {state.name} of {region.name}"
            inside = {s.name for s in region.states if state.name in region.ancestors(s.name)}
            notes = [
                (t.origin, f"so {t.name} never fires")
                for t in region.transitions
                if t.source in inside
            ]
            hint = "add a transition to it, or remove it"
            yield error("RV-0505", state.origin, message, notes=notes, hint=hint)


def safe_states_are_reachable(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """From each state that is reached, some way leads to the safe state."""
    for region in _sound_regions(component, resolved):
        if region.safe_state is None:
            continue
        graph, start = _graph(region), region.default_leaf(region.initial.target)
        safe = set(region.leaves(region.safe_state))
        for leaf in region.leaves():
            if leaf != start and leaf not in networkx.descendants(graph, start):
                continue
            if not safe & ({leaf} | networkx.descendants(graph, leaf)):
                message = f"no way leads from {leaf} to {region.safe_state}, the safe state"
                state = region.state(leaf)
                notes = [(region.state(region.safe_state).origin, "the safe state is here")]
                hint = f"add a transition from {leaf}, or from a state around it"
                yield error("RV-0506", state.origin, message, notes=notes, hint=hint)
                break


def transitions_can_fire(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """No transition is shut out by an earlier one, or by its own condition."""
    for region in component.regions:
        always: dict[tuple[str, str], Transition] = {}
        for transition in region.transitions:
            trigger = transition.trigger
            met = trigger.condition if isinstance(trigger, When) else None
            if _is_literal(transition.guard, "False") or _is_literal(met, "False"):
                what = "trigger" if _is_literal(met, "False") else "guard"
                message = f"{transition.name} never fires: its {what} is false"
                yield error("RV-0508", transition.origin, message, hint="remove it")
            if not isinstance(trigger, OnEvent):
                continue
            key = (transition.source, trigger.event)
            if key in always:
                first = always[key]
                message = (
                    f"{transition.name} never fires: {first.name} always takes {trigger.event} "
                    f"in {transition.source}"
                )
                notes = [(first.origin, f"{first.name} has no guard")]
                hint = f"give {first.name} a guard, or remove {transition.name}"
                yield error("RV-0507", transition.origin, message, notes=notes, hint=hint)
            elif transition.guard is None or _is_literal(transition.guard, "True"):
                always[key] = transition


# --- Events ------------------------------------------------------------------------


def events_are_raised_and_used(component: Component, resolved: Resolved) -> Iterator[Diagnostic]:
    """A warning for each event that nothing raises or no region waits for."""
    system = resolved.system
    instances = {i.name for i in system.instances if i.component.name == component.name}
    whole = {"instances", "processors"} <= resolved.sound_sections
    if component.name in resolved.damaged or not whole or not instances:
        return
    raised = {e for item in component.runnables() for e in item.raises}
    raised |= {e for p in component.ports for e in (p.on_arrival, p.on_stale, p.on_overflow) if e}
    raised |= {region.on_overflow for region in component.regions if region.on_overflow}
    outside = [pair for processor in system.processors for pair in processor.on_deadline_miss]
    raised |= {e for owner, e in (*outside, *system.shutdown.raises) if owner in instances}
    used = {event for region in component.regions for event in region.events()}
    for event in component.events:
        is_raised, is_used = event.name in raised, event.name in used
        if is_raised and not is_used:
            message = f"no region of {component.name} waits for {event.name}: it is lost"
            yield warning("RV-0510", event.origin, message)
        elif not is_raised:
            message = f"nothing raises {event.name}"
            if not is_used:
                message += f", and no region of {component.name} waits for it"
            yield warning("RV-0509", event.origin, message)


COMPONENT_RULES: tuple[ComponentRule, ...] = (
    data_have_one_writer,
    steps_send_once,
    states_are_reachable,
    safe_states_are_reachable,
    transitions_can_fire,
    events_are_raised_and_used,
)
