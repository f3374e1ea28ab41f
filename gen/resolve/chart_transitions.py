# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Transitions resolved: their ends, triggers and guards, each judged by itself."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from ravenchart.gen.files.schema import TransitionForm
from ravenchart.gen.language.terms import Expression, Ns
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    OnEvent,
    PseudoKind,
    Segment,
    Transition,
    TransitionKind,
    Trigger,
    When,
)

from .chart_names import NamedVertex
from .chart_states import Setting
from .flows import flow_of
from .typed import condition
from .vocabulary import Vocabulary

TRIGGERS = ("on", "after", "every", "when")
ELSE = "else"
BRANCHING = (PseudoKind.CHOICE, PseudoKind.JUNCTION)
UNGUARDED = {
    PseudoKind.FORK: "RV-0520",
    PseudoKind.JOIN: "RV-0519",
    PseudoKind.HISTORY: "RV-0521",
    PseudoKind.DEEP_HISTORY: "RV-0521",
}
"""Pseudostates whose outgoing segments have no guard, with the code that says so."""


def transition_of(name: str, form: TransitionForm, setting: Setting) -> Transition | None:
    """A transition; None when an error makes it unusable."""
    findings = setting.findings
    source = setting.states.vertex(form.from_, form.at("from"), findings)
    target = source
    if form.to is not None:
        target = setting.states.vertex(form.to, form.at("to"), findings)
    if form.lost("to"):
        target = None
    if source is not None and _has_no_exit(source):
        message = f"{name} cannot leave the {source.shown}"
        hint = "let it leave the state around, or use a plain state"
        if source.pseudo is not None:
            hint = "the region has ended there: use a plain state to go on from"
        findings.error("RV-0522", form.at("from"), message, hint=hint)
        source = None
    trigger = _trigger(name, form, source, target, setting)
    words = _words(form, source, trigger, setting)
    guard, is_sound = _guard(name, form, source, target, _asking(words, source, setting), setting)
    effect = flow_of(form.effect, words, setting.targets, findings)
    if source is None or target is None or trigger is None or not is_sound:
        return None
    kind = _kind(name, form, source, target, setting)
    return Transition(
        name,
        form.origin,
        source.name,
        source.name if kind is TransitionKind.INTERNAL else target.name,
        kind,
        trigger,
        guard,
        effect,
        otherwise=_is_else(form),
    )


def _has_no_exit(vertex: NamedVertex) -> bool:
    return vertex.is_final or vertex.pseudo is PseudoKind.TERMINATE


def _is_else(form: TransitionForm) -> bool:
    return isinstance(form.guard, str) and form.guard.strip().lower() == ELSE


# --- Kind --------------------------------------------------------------------------


def _kind(
    name: str, form: TransitionForm, source: NamedVertex, target: NamedVertex, setting: Setting
) -> TransitionKind:
    """External, local or internal; reported where the keys do not agree."""
    findings = setting.findings
    if not source.is_state:
        for key in ("local", "internal"):
            if form.has(key):
                message = f"`{key}` has no meaning for {name}, which leaves the {source.shown}"
                hint = "the transition of a state that leads here says what is left"
                findings.error("RV-0210", form.at_key(key), message, hint=hint)
        if form.to is None and not form.lost("to"):
            message = f"{name} leaves the {source.shown} and needs the key `to`"
            findings.error("RV-0202", form.origin, message)
        return TransitionKind.EXTERNAL
    if form.internal and form.local:
        message = f"{name} is both `local` and `internal`"
        hint = "`internal` leaves nothing, `local` what is inside its source: remove one"
        findings.error("RV-0210", form.at_key("local"), message, hint=hint)
    elif form.internal and target is not source:
        message = f"{name} is internal and leads from {source.name} to {target.name}"
        hint = "leave `to` out, or `internal`"
        findings.error("RV-0503", form.at("to"), message, hint=hint)
    elif form.to is None and (form.internal is False or form.local):
        what = "local" if form.local else "not internal"
        message = f"{name} is {what} and needs the key `to`"
        findings.error("RV-0202", form.origin, message)
    elif form.local:
        _check_local(name, form, source, target, setting)
        return TransitionKind.LOCAL
    internal = form.internal or form.to is None
    return TransitionKind.INTERNAL if internal else TransitionKind.EXTERNAL


def _check_local(
    name: str, form: TransitionForm, source: NamedVertex, target: NamedVertex, setting: Setting
) -> None:
    """A local transition leads from a composite state to something inside it."""
    message = hint = None
    if not source.is_composite:
        message = f"{name} is local, but {source.name} has no states inside"
        hint = "leave `local` out: it leaves its source"
    elif target.name in setting.states.around(source.name):
        message = f"{name} is local: a local transition to an enclosing state is refused"
        hint = f"leave `local` out: {target.name} is then left and entered again"
    elif source.name not in setting.states.around(target.name):
        message = f"{name} is local, but {target.name} is not inside {source.name}"
        hint = "leave `local` out, or name a target inside"
        if target is source:
            message = f"{name} is local and leads from {source.name} to itself"
            hint = "`internal: true` leaves nothing; without either, the state is entered again"
    if message is not None:
        setting.findings.error("RV-0523", form.at("to"), message, hint=hint)


# --- Triggers ----------------------------------------------------------------------


def _trigger(
    name: str,
    form: TransitionForm,
    source: NamedVertex | None,
    target: NamedVertex | None,
    setting: Setting,
) -> Trigger | None:
    keys = [key for key in TRIGGERS if form.has(key) or form.lost(key)]
    findings = setting.findings
    if source is not None and not source.is_state:
        for key in keys:
            message = f"{name} leaves the {source.shown}, so it has no trigger of its own"
            hint = f"remove `{key}`: it goes to the transition of a state that leads here"
            findings.error("RV-0515", form.at_key(key), message, hint=hint)
        return None if keys else Segment()
    if target is not None and target.pseudo is PseudoKind.JOIN and keys:
        message = f"{name} leads to the join {target.name}, so it has no trigger"
        hint = "a join waits until its sources complete: by a final state, or by `done`"
        findings.error("RV-0519", form.at_key(keys[0]), message, hint=hint)
        return None
    if len(keys) > 1:
        given = " and ".join(f"`{key}`" for key in keys)
        message = f"{name} has more than one trigger: {given}"
        hint = "write a transition for each"
        findings.error("RV-0502", form.at_key(keys[1]), message, hint=hint)
        return None
    if not keys:
        return _completion(name, form, setting)
    return _one_trigger(form, source, setting)


def _completion(name: str, form: TransitionForm, setting: Setting) -> Completion | None:
    """Without a trigger: by completion, unless nothing at all is said."""
    if form.damaged:
        setting.findings.lose()
        return None
    if form.to is None and not form.effect:
        message = f"{name} has neither a trigger nor a target nor an effect"
        hint = "name a trigger (`on`, `after`, `every`, `when`), or where it leads by `to`"
        setting.findings.error("RV-0502", form.origin, message, hint=hint)
        return None
    return Completion()


def _one_trigger(
    form: TransitionForm, source: NamedVertex | None, setting: Setting
) -> Trigger | None:
    if form.on is not None:
        event = setting.targets.events.look_up(form.on, form.at("on"), setting.findings)
        return None if event is None else OnEvent(event.name)
    if form.after is not None:
        return After(Ns(form.after), max(1, -(-form.after // setting.period)))
    if form.every is not None:
        return Every(Ns(form.every), max(1, -(-form.every // setting.period)))
    if form.when is not None:
        words = _asking(setting.words, source, setting)
        met = condition(form.when, form.place("when"), words, setting.findings, "when")
        return None if met is None else When(met)
    return None


def _words(
    form: TransitionForm, source: NamedVertex | None, trigger: Trigger | None, setting: Setting
) -> Vocabulary:
    """The names that guard and effect may use: the event's value as well, when it carries one."""
    if isinstance(trigger, OnEvent):
        event = setting.targets.events.find(trigger.event)
        if event is not None and event.type is not None:
            return setting.words.with_event(event.name, event.type)
        return setting.words.without_event(f"the event {trigger.event} carries none")
    if source is not None and not source.is_state:
        reason = f"what leaves a {source.what} has no trigger of its own"
        return setting.words.without_event(reason)
    if form.on is not None:
        return setting.words.with_event(form.on, None)
    return setting.words.without_event("the transition is not triggered by an event")


# --- Guards ------------------------------------------------------------------------


def _asking(words: Vocabulary, source: NamedVertex | None, setting: Setting) -> Vocabulary:
    """The words of a condition read before any transition is taken: also states of its region."""
    if source is None or source.pseudo not in (None, PseudoKind.JUNCTION):
        return words
    return replace(words, may_ask=partial(setting.states.is_beside, source.name))


def _guard(
    name: str,
    form: TransitionForm,
    source: NamedVertex | None,
    target: NamedVertex | None,
    words: Vocabulary,
    setting: Setting,
) -> tuple[Expression | None, bool]:
    """The guard, and whether it is sound."""
    findings = setting.findings
    if form.guard is None:
        return None, True
    if target is not None and target.pseudo is PseudoKind.JOIN:
        message = f"{name} leads to the join {target.name}, so it has no guard"
        hint = "let a choice or junction after the join decide"
        findings.error("RV-0519", form.at_key("guard"), message, hint=hint)
        return None, False
    kind = None if source is None else source.pseudo
    if source is not None and kind in UNGUARDED:
        message = f"{name} leaves the {source.shown}, so it has no guard"
        hint = "let a choice before it decide" if kind is PseudoKind.FORK else "remove the guard"
        if kind is PseudoKind.JOIN:
            hint = "let it lead to a choice or junction that decides"
        findings.error(UNGUARDED[kind], form.at_key("guard"), message, hint=hint)
        return None, False
    if not _is_else(form):
        guard = condition(form.guard, form.place("guard"), words, findings, "guard")
        return guard, guard is not None
    if source is not None and kind not in BRANCHING:
        message = f"`else` has no meaning for {name}, which leaves the {source.shown}"
        hint = "transitions are tried in model order: write it last, without a guard"
        findings.error("RV-0516", form.at("guard"), message, hint=hint)
        return None, False
    return None, True
