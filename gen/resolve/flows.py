# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Flows: actions resolved, and the names that they read, write, send on and raise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from ravenchart.gen.files.located import TextPlace
from ravenchart.gen.files.schema import CallForm, IfForm, RaiseForm, SendForm, SetForm
from ravenchart.gen.language.names import Findings, NameScope, NameUse, meant
from ravenchart.gen.language.terms import (
    BOOLEAN,
    Action,
    Expression,
    Flow,
    If,
    InState,
    Literal,
    Name,
    PortTest,
    Raise,
    Reading,
    RecordType,
    ScalarType,
    Send,
    Set,
    Type,
    leaves,
)
from ravenchart.gen.model.commands import Need
from ravenchart.gen.model.component import Event
from ravenchart.gen.model.statechart import DONE
from ravenchart.gen.origins import Origin

from .typed import condition, fitting, read_expression
from .vocabulary import Vocabulary

ActionForms = Sequence[SetForm | SendForm | CallForm | RaiseForm | IfForm]


@dataclass(frozen=True, slots=True)
class Targets:
    """The data, ports, commands and events that the flows of a component may use."""

    data: NameScope[Type]
    outputs: NameScope[Type]
    events: NameScope[Event]
    calls: NameScope[Need]
    do_activity: bool = False
    """These are the flows of a do activity: it may raise `DONE`."""


def flow_of(
    forms: ActionForms | None, words: Vocabulary, targets: Targets, findings: Findings
) -> Flow:
    """The sound actions of a flow; what is wrong with the others is reported."""
    actions: list[Action] = []
    for form in forms or ():
        found = _actions(form, words, targets, findings)
        actions += found
        sets = {(one.data, one.field) for one in actions_of(found) if isinstance(one, Set)}
        words = words.after(sets)
    return tuple(actions)


def _actions(
    form: SetForm | SendForm | CallForm | RaiseForm | IfForm,
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> Flow:
    """The actions of a form: one, but for a record one for each field."""
    action: Action | None
    match form:
        case SetForm():
            return _set(form, words, targets, findings)
        case SendForm():
            action = _send(form, words, targets, findings)
        case CallForm():
            action = _call(form, words, targets, findings)
        case RaiseForm():
            action = _raise(form, words, targets, findings)
        case IfForm():
            action = _if(form, words, targets, findings)
    return () if action is None else (action,)


def _if(form: IfForm, words: Vocabulary, targets: Targets, findings: Findings) -> Action | None:
    """Each branch knows what the condition says."""
    guard = condition(form.if_, form.place("if"), words, findings, "if")
    holds = fails = words
    if guard is not None:
        holds, fails = words.where(guard, True), words.where(guard, False)
    then = flow_of(form.then, holds, targets, findings)
    otherwise = flow_of(form.else_, fails, targets, findings)
    return None if guard is None else If(form.at_key("if"), guard, then, otherwise)


def _set(form: SetForm, words: Vocabulary, targets: Targets, findings: Findings) -> Flow:
    item, _, member = form.set.partition(".")
    origin = form.at("set")
    hint: str | None
    targets.data.used(item, origin, findings)
    if not targets.data.knows(item):
        if words.readable.knows(item) or targets.outputs.knows(item):
            message = f"`{item}` is not a data item; only a data item can be set"
            is_output = targets.outputs.knows(item)
            hint = "send on an output port by `send:` and `with:`" if is_output else None
        else:
            message = f"there is no data item named `{item}`"
            hint = meant(item, targets.data.names())
        findings.error("RV-0411", origin, message, hint=hint)
        return ()
    type_ = targets.data.find(item)
    if type_ is None:
        findings.lose()
        return ()
    name = targets.data.items[item.lower()][0]
    target: ScalarType
    if isinstance(type_, RecordType):
        if not member:
            return _set_record(form, name, type_, words, findings)
        fields = {one.name.lower(): one for one in type_.fields}
        if member.lower() not in fields:
            hint = meant(member, (one.name for one in type_.fields))
            message = f"`{name}` is of type {type_.name}, which has no field `{member}`"
            findings.error("RV-0403", origin, message, hint=hint)
            return ()
        chosen = fields[member.lower()]
        findings.uses.append(NameUse(chosen.name, origin, "field", chosen.origin))
        target, member = chosen.type, chosen.name
    elif member:
        findings.error("RV-0403", origin, f"`{name}` is a scalar and has no field `{member}`")
        return ()
    else:
        target = type_
    shown = f"{name}.{member}" if member else name
    value = fitting(form.to, form.place("to"), shown, target, words, findings)
    if value == Name(Reading.DATA, name, member or None, target):
        return _refuse_itself(form, shown, findings)
    return () if value is None else (Set(form.at_key("set"), name, member or None, value),)


def _set_record(
    form: SetForm, name: str, type_: RecordType, words: Vocabulary, findings: Findings
) -> Flow:
    """A record set to another one: field by field, for no field of one depends on another."""
    message = f"`{name}` is a record: `to` must be a name of the type {type_.name}"
    refusal = (message, f"or set its fields one by one: `set: {name}.{type_.fields[0].name}`")
    values = _whole(form.to, form.place("to"), type_, refusal, words, findings)
    if values == _fields_of(Reading.DATA, name, type_):
        return _refuse_itself(form, name, findings)
    return tuple(Set(form.at_key("set"), name, member, value) for member, value in values or ())


def _refuse_itself(form: SetForm, shown: str, findings: Findings) -> Flow:
    message = f"`{shown}` is set to itself"
    findings.error("RV-0418", form.at("to"), message, hint="remove this action")
    return ()


def _send(form: SendForm, words: Vocabulary, targets: Targets, findings: Findings) -> Action | None:
    origin = form.at("send")
    targets.outputs.used(form.send, origin, findings)
    if not targets.outputs.knows(form.send):
        kind = "an input port" if words.inputs.knows(form.send) else "no output port"
        message = f"`{form.send}` is {kind}; `send` needs an output port"
        hint = meant(form.send, targets.outputs.names())
        if targets.calls.find(form.send) is not None:
            hint = f"a command is called: `call: {form.send}`"
        findings.error("RV-0411", origin, message, hint=hint)
        return None
    type_ = targets.outputs.find(form.send)
    if type_ is None:
        findings.lose()
        return None
    name = targets.outputs.items[form.send.lower()][0]
    values = _values(form, form.with_, name, type_, words, findings)
    return None if values is None else Send(form.at_key("send"), name, values)


def _call(form: CallForm, words: Vocabulary, targets: Targets, findings: Findings) -> Action | None:
    need = called_command(form.call, form.at("call"), words, targets, findings)
    if need is None:
        return None
    origin = form.at_key("call")
    if need.argument is None:
        if form.has("with"):
            message = f"the command {need.name} has no argument"
            findings.error("RV-1206", form.at_key("with"), message, hint="remove `with`")
            return None
        return Send(origin, need.name, ((None, Literal("True", BOOLEAN)),))
    if form.with_ is None:
        if not form.lost("with"):
            message = f"the command {need.name} needs an argument of type {need.argument.name}"
            findings.error("RV-1206", form.at("call"), message, hint="give it by `with: ...`")
        findings.lose()
        return None
    values = _values(form, form.with_, need.name, need.argument, words, findings)
    return None if values is None else Send(origin, need.name, values)


def called_command(
    name: str, origin: Origin, words: Vocabulary, targets: Targets, findings: Findings
) -> Need | None:
    """The required command of that name that can be called."""
    if not targets.calls.knows(name) and words.readable.knows(name):
        message = f"`{name}` is read and not called"
        hint = "use its name in an expression, or name it under `reads`"
        findings.error("RV-1206", origin, message, hint=hint)
        return None
    return targets.calls.look_up(name, origin, findings)


def _raise(
    form: RaiseForm, words: Vocabulary, targets: Targets, findings: Findings
) -> Action | None:
    origin = form.at("raise")
    if form.raise_.lower() == DONE:
        if not targets.do_activity:
            message = f"only a do activity raises `{DONE}`"
            hint = "a do activity has `while: Region.State`, and completes that state"
            findings.error("RV-0527", origin, message, hint=hint)
        elif form.has("with"):
            message = f"`{DONE}` carries no value"
            findings.error("RV-0528", form.at_key("with"), message, hint="remove `with`")
        else:
            return Raise(form.at_key("raise"), DONE)
        return None
    event = targets.events.look_up(form.raise_, origin, findings)
    if event is None:
        return None
    if event.type is None:
        if form.has("with"):
            message = f"the event {event.name} carries no value"
            hint = f"remove `with`, or declare `{event.name}: {{type: ...}}` under `events`"
            findings.error("RV-0528", form.at_key("with"), message, hint=hint)
            return None
        return Raise(form.at_key("raise"), event.name)
    if form.with_ is None:
        if not form.lost("with"):
            message = f"the event {event.name} needs a value of type {event.type.name}"
            hint = "give it by `with: ...`"
            findings.error("RV-0528", origin, message, hint=hint)
        findings.lose()
        return None
    values = _values(form, form.with_, event.name, event.type, words, findings)
    return None if values is None else Raise(form.at_key("raise"), event.name, values)


FlowValues = tuple[tuple[str | None, Expression], ...]
Given = int | bool | str | Mapping[str, int | bool | str]


def _values(
    form: SendForm | CallForm | RaiseForm,
    given: Given,
    carrier: str,
    type_: Type,
    words: Vocabulary,
    findings: Findings,
) -> FlowValues | None:
    """The values that ``with`` gives to a port or event that carries ``type_``."""
    if isinstance(type_, RecordType):
        return _fields(form, given, carrier, type_, words, findings)
    if isinstance(given, Mapping):
        message = f"`{carrier}` carries the scalar type {type_.name}: give one expression"
        findings.error("RV-0415", form.at("with"), message)
        return None
    value = fitting(given, form.place("with"), carrier, type_, words, findings)
    return None if value is None else ((None, value),)


def _fields(
    form: SendForm | CallForm | RaiseForm,
    given: Given,
    carrier: str,
    type_: RecordType,
    words: Vocabulary,
    findings: Findings,
) -> FlowValues | None:
    """The values of a record, in the type's field order."""
    if not isinstance(given, Mapping):
        fields = ", ".join(f"{one.name}: ..." for one in type_.fields[:4])
        message = f"`{carrier}` carries {type_.name}: give its fields, or a name of that type"
        refusal = (message, f"`with: {{{fields}}}`")
        return _whole(given, form.place("with"), type_, refusal, words, findings)
    before = findings.count()
    names = {name.lower(): name for name in given}
    lost = {name.lower() for name in form.dropped("with")}
    values: list[tuple[str | None, Expression]] = []
    for one in type_.fields:
        key = names.pop(one.name.lower(), None)
        if key is None:
            if one.name.lower() not in lost:
                message = f"`with` gives no value for the field `{one.name}` of {type_.name}"
                findings.error("RV-0415", form.at_key("with"), message)
            continue
        at = form.entry_at("with", key)
        findings.uses.append(NameUse(one.name, at, "field", one.origin))
        place = form.place("with", key)
        value = fitting(given[key], place, f"{carrier}.{one.name}", one.type, words, findings)
        if value is not None:
            values.append((one.name, value))
    for key in names.values():
        hint = meant(key, (one.name for one in type_.fields))
        message = f"{type_.name}, the type of `{carrier}`, has no field `{key}`"
        findings.error("RV-0415", form.entry_at("with", key), message, hint=hint)
    whole = findings.count() == before and len(values) == len(type_.fields)
    return tuple(values) if whole else None


def _whole(
    text: int | bool | str,
    place: TextPlace,
    type_: RecordType,
    refusal: tuple[str, str],
    words: Vocabulary,
    findings: Findings,
) -> FlowValues | None:
    """A record given as it was read from something of the same type; else message and hint."""
    checked = read_expression(text, place, words, findings)
    if checked is None:
        return None
    source = checked.expression
    if checked.type is not type_ or not isinstance(source, Name):
        message, hint = refusal
        findings.error("RV-0415", place.origin, message, hint=hint)
        return None
    return _fields_of(source.kind, source.name, type_)


def _fields_of(kind: Reading, name: str, type_: RecordType) -> FlowValues:
    """All fields of something that is read."""
    return tuple((one.name, Name(kind, name, one.name, one.type)) for one in type_.fields)


# --- The names that flows use ----------------------------------------------------


@dataclass(slots=True)
class Use:
    """The names that flows and conditions read, write, send on and raise, in order of first use."""

    reads: dict[str, None] = field(default_factory=dict)
    writes: dict[str, Origin] = field(default_factory=dict)
    sends: dict[str, Origin] = field(default_factory=dict)
    raises: dict[str, Origin] = field(default_factory=dict)

    def expression(self, expression: Expression | None) -> None:
        """Add the names that an expression reads."""
        for leaf in () if expression is None else leaves(expression):
            match leaf:
                case Name(kind=Reading.EVENT):
                    pass
                case Name(name=name) | PortTest(port=name) | InState(region=name):
                    self.reads.setdefault(name)

    def flow(self, flow: Flow) -> None:
        """Add the names that a flow uses."""
        for action in actions_of(flow):
            match action:
                case Set(origin, data, _, value):
                    self.expression(value)
                    self.writes.setdefault(data, origin)
                case Send(origin, port, values):
                    for _, value in values:
                        self.expression(value)
                    self.sends.setdefault(port, origin)
                case Raise(origin, event, values):
                    for _, value in values:
                        self.expression(value)
                    self.raises.setdefault(event, origin)
                case If():
                    self.expression(action.condition)


def actions_of(flow: Flow) -> Iterator[Action]:
    """Every action of a flow, those inside others too, outer before inner."""
    for action in flow:
        yield action
        if isinstance(action, If):
            yield from actions_of(action.then)
            yield from actions_of(action.otherwise)
