"""Regions resolved: states in tree order, transitions with their triggers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from .flows import Targets, Use, flow_of
from .names import Findings, Scope
from .schema import RegionForm, StateForm, TransitionForm
from .statechart import (
    After,
    Initial,
    NestedRegion,
    OnEvent,
    Overflow,
    Region,
    State,
    Timing,
    Transition,
    TransitionKind,
    When,
)
from .terms import Ns, Origin
from .typed import condition
from .vocabulary import Vocabulary


def walk(
    states: Mapping[str, StateForm] | None, parent: str | None = None
) -> Iterator[tuple[str, StateForm, str | None]]:
    """Every state with its form and parent, in tree order."""
    for name, form in (states or {}).items():
        yield name, form, parent
        yield from walk(form.states, name)


def states_of(region: str, form: RegionForm, findings: Findings) -> Scope[str]:
    """The names of a region's states; open when some were lost."""
    scope: Scope[str] = Scope(f"state of {region}")
    for name in form.dropped("states"):
        scope.declare(name, None, None)
    scope.open = bool(form.dropped("states")) or form.lost("states")
    for name, state, _ in walk(form.states):
        scope.declare(name, state.origin, name, findings)
        for gone in state.dropped("states"):
            scope.declare(gone, None, None)
        scope.open = scope.open or bool(state.dropped("states")) or state.lost("states")
    return scope


def region_of(
    name: str,
    form: RegionForm,
    timing: Timing,
    states: Scope[str],
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> Region | None:
    """A region; None when it has no initial state."""
    use = Use()
    resolved: list[State] = []
    for state, at, parent in walk(form.states):
        resolved.append(_state(state, at, parent, states, words, targets, findings))
        use.flow(resolved[-1].entry)
        use.flow(resolved[-1].exit)
    transitions: list[Transition] = []
    names: Scope[str] = Scope(f"transition of {name}")
    for transition, given in form.transitions.items():
        names.declare(transition, given.origin, transition, findings)
        made = _transition(transition, given, timing.period, states, words, targets, findings)
        if made is not None:
            transitions.append(made)
            use.expression(made.guard)
            if isinstance(made.trigger, When):
                use.expression(made.trigger.condition)
            use.flow(made.effect)
    initial = states.look_up(form.initial, form.at("initial"), findings)
    safe = None
    if form.safe_state is not None:
        safe = states.look_up(form.safe_state, form.at("safe_state"), findings)
    on_overflow = None
    if form.on_overflow is not None:
        on_overflow = targets.events.look_up(form.on_overflow, form.at("on_overflow"), findings)
    if form.queue is None and not form.lost("queue"):
        waits = [t for t in form.transitions.values() if t.on is not None]
        if waits:
            message = f"{name} waits for events and has no queue for them"
            notes = [(waits[0].at("on"), f"`{waits[0].on}` is one of them")]
            findings.error(
                "RV-0504",
                form.origin,
                message,
                notes=notes,
                hint="give the depth of the queue, such as `queue: 8`",
            )
        for key in ("overflow", "on_overflow"):
            if form.has(key) and not waits:
                message = f"`{key}` has no meaning without `queue`"
                findings.error("RV-0210", form.at_key(key), message)
    if initial is None:
        return None
    return Region(
        name=name,
        origin=form.origin,
        timing=timing,
        queue_depth=form.queue or 1,
        overflow=Overflow(form.overflow or "reject_newest"),
        on_overflow=on_overflow,
        steps_per_execution=form.steps,
        initial=Initial(initial),
        safe_state=safe,
        states=tuple(resolved),
        transitions=tuple(transitions),
        reads=tuple(use.reads),
        writes=tuple(use.writes),
        sends=tuple(use.sends),
        raises=tuple(use.raises),
    )


def _state(
    name: str,
    form: StateForm,
    parent: str | None,
    states: Scope[str],
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> State:
    initial = None
    if form.states:
        inside = {inner.lower() for inner, _, _ in walk(form.states)}
        if form.initial is not None:
            initial = states.look_up(form.initial, form.at("initial"), findings)
            if initial is not None and initial.lower() not in inside:
                message = f"`{initial}` is not inside {name}, whose initial state it shall be"
                findings.error("RV-0501", form.at("initial"), message)
                initial = None
        elif not form.lost("initial"):
            message = f"{name} has substates and needs the key `initial`"
            hint = f"`initial: {next(iter(form.states))}`?"
            findings.error("RV-0202", form.origin, message, hint=hint)
        initial = initial or next(iter(form.states))
    elif form.initial is not None and not form.lost("states"):
        message = "`initial` has no meaning without `states`"
        findings.error("RV-0210", form.at_key("initial"), message)
    entry = flow_of(form.entry, words, targets, findings)
    exit_flow = flow_of(form.exit, words, targets, findings)
    regions = (NestedRegion("", form.origin, Initial(initial)),) if initial else ()
    return State(name, form.origin, parent, "", regions, entry, exit_flow)


def _transition(
    name: str,
    form: TransitionForm,
    period: Ns,
    states: Scope[str],
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> Transition | None:
    source = states.look_up(form.from_, form.at("from"), findings)
    internal = form.internal or form.to is None
    target = source
    if form.to is not None:
        target = states.look_up(form.to, form.at("to"), findings)
        if form.internal and source is not None and target not in (source, None):
            message = f"{name} is internal and leads from {source} to {target}"
            hint = "leave `to` out, or `internal`"
            findings.error("RV-0503", form.at("to"), message, hint=hint)
    elif form.internal is False:
        message = f"{name} is not internal and needs the key `to`"
        findings.error("RV-0202", form.origin, message)
    if form.lost("to"):
        target = None
    trigger = _trigger(name, form, period, words, targets, findings)
    guard = None
    if form.guard is not None:
        guard = condition(form.guard, form.place("guard"), words, findings, "guard")
        trigger = None if guard is None else trigger
    effect = flow_of(form.effect, words, targets, findings)
    if source is None or target is None or trigger is None:
        return None
    kind = TransitionKind.INTERNAL if internal else TransitionKind.EXTERNAL
    target = source if internal else target
    return Transition(name, form.origin, source, target, kind, trigger, guard, effect)


def _trigger(
    name: str,
    form: TransitionForm,
    period: Ns,
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> OnEvent | After | When | None:
    keys = [key for key in ("on", "after", "when") if form.has(key) or form.lost(key)]
    if not keys and form.damaged:
        findings.lose()
        return None
    if len(keys) != 1:
        given = " and ".join(f"`{key}`" for key in keys) or "none"
        message = f"{name} needs exactly one of `on`, `after` and `when`, and has {given}"
        at: Origin = form.at_key(keys[1]) if keys else form.origin
        findings.error("RV-0502", at, message)
        return None
    if form.on is not None:
        event = targets.events.look_up(form.on, form.at("on"), findings)
        return None if event is None else OnEvent(event)
    if form.after is not None:
        return After(Ns(form.after), max(1, -(-form.after // period)))
    if form.when is not None:
        met = condition(form.when, form.place("when"), words, findings, "when")
        return None if met is None else When(met)
    return None
