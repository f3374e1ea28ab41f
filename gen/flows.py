"""Flows: actions resolved, and what they read, write, send and raise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from .names import Findings, Scope, meant
from .schema import IfForm, RaiseForm, SendForm, SetForm
from .terms import (
    Action,
    Expression,
    Flow,
    If,
    InState,
    Name,
    Operation,
    Origin,
    PortTest,
    Raise,
    RecordType,
    ScalarType,
    Send,
    Set,
    Type,
)
from .tree import Place
from .typed import condition, fitting, read
from .vocabulary import Vocabulary

ActionForms = Sequence[SetForm | SendForm | RaiseForm | IfForm]


@dataclass(frozen=True, slots=True)
class Targets:
    """What the flows of a component may write, send on and raise."""

    data: Scope[Type]
    outputs: Scope[Type]
    events: Scope[str]


def flow_of(
    forms: ActionForms | None, words: Vocabulary, targets: Targets, findings: Findings
) -> Flow:
    """The sound actions of a flow; what is wrong with the others is reported."""
    actions = (_action(form, words, targets, findings) for form in forms or ())
    return tuple(action for action in actions if action is not None)


def _action(
    form: SetForm | SendForm | RaiseForm | IfForm,
    words: Vocabulary,
    targets: Targets,
    findings: Findings,
) -> Action | None:
    match form:
        case SetForm():
            return _set(form, words, targets, findings)
        case SendForm():
            return _send(form, words, targets, findings)
        case RaiseForm():
            event = targets.events.look_up(form.raise_, form.at("raise"), findings)
            return None if event is None else Raise(form.at_key("raise"), event)
    guard = condition(form.if_, form.place("if"), words, findings, "if")
    then = flow_of(form.then, words, targets, findings)
    otherwise = flow_of(form.else_, words, targets, findings)
    return None if guard is None else If(form.at_key("if"), guard, then, otherwise)


def _set(form: SetForm, words: Vocabulary, targets: Targets, findings: Findings) -> Action | None:
    item, _, member = form.set.partition(".")
    origin = form.at("set")
    hint: str | None
    if not targets.data.knows(item):
        if words.readable.knows(item) or targets.outputs.knows(item):
            message = f"`{item}` is no data item, and only those can be set"
            is_output = targets.outputs.knows(item)
            hint = "send on an output port by `send:` and `with:`" if is_output else None
        else:
            message = f"there is no data item named `{item}`"
            hint = meant(item, targets.data.names())
        findings.error("RV-0411", origin, message, hint=hint)
        return None
    type_ = targets.data.find(item)
    if type_ is None:
        findings.lose()
        return None
    name = targets.data.items[item.lower()][0]
    target: ScalarType
    if isinstance(type_, RecordType):
        fields = {one.name.lower(): one for one in type_.fields}
        if member.lower() not in fields:
            hint = meant(member, (one.name for one in type_.fields))
            if member:
                message = f"`{name}` is of type {type_.name}, which has no field `{member}`"
                findings.error("RV-0403", origin, message, hint=hint)
            else:
                message = f"`{name}` is a record: set its fields one by one"
                findings.error("RV-0415", origin, message, hint=f"`set: {name}.<field>`")
            return None
        target, member = fields[member.lower()].type, fields[member.lower()].name
    elif member:
        findings.error("RV-0403", origin, f"`{name}` is a scalar and has no field `{member}`")
        return None
    else:
        target = type_
    shown = f"{name}.{member}" if member else name
    value = fitting(form.to, form.place("to"), shown, target, words, findings)
    return None if value is None else Set(form.at_key("set"), name, member or None, value)


def _send(form: SendForm, words: Vocabulary, targets: Targets, findings: Findings) -> Action | None:
    origin = form.at("send")
    if not targets.outputs.knows(form.send):
        kind = "an input port" if words.inputs.knows(form.send) else "no output port"
        message = f"`{form.send}` is {kind}, and only output ports can be sent on"
        hint = meant(form.send, targets.outputs.names())
        findings.error("RV-0411", origin, message, hint=hint)
        return None
    type_ = targets.outputs.find(form.send)
    if type_ is None:
        findings.lose()
        return None
    name = targets.outputs.items[form.send.lower()][0]
    values: Iterable[tuple[str | None, Expression]] | None
    if isinstance(type_, RecordType):
        values = _fields(form, name, type_, words, findings)
    elif isinstance(form.with_, dict):
        message = f"`{name}` carries the scalar type {type_.name}: give one expression"
        findings.error("RV-0415", form.at("with"), message)
        return None
    else:
        value = fitting(form.with_, form.place("with"), name, type_, words, findings)
        values = None if value is None else [(None, value)]
    return None if values is None else Send(form.at_key("send"), name, tuple(values))


def _fields(
    form: SendForm, port: str, type_: RecordType, words: Vocabulary, findings: Findings
) -> Iterable[tuple[str | None, Expression]] | None:
    """The values of a record that is sent, in the type's field order."""
    if not isinstance(form.with_, dict):
        return _whole(form.with_, form.place("with"), port, type_, words, findings)
    before = findings.count()
    given = {name.lower(): name for name in form.with_}
    lost = {name.lower() for name in form.dropped("with")}
    values: list[tuple[str | None, Expression]] = []
    for one in type_.fields:
        key = given.pop(one.name.lower(), None)
        if key is None:
            if one.name.lower() not in lost:
                message = f"`with` gives no value for the field `{one.name}` of {type_.name}"
                findings.error("RV-0415", form.at_key("with"), message)
            continue
        place = form.place("with", key)
        value = fitting(form.with_[key], place, f"{port}.{one.name}", one.type, words, findings)
        if value is not None:
            values.append((one.name, value))
    for key in given.values():
        hint = meant(key, (one.name for one in type_.fields))
        message = f"{type_.name}, the type of `{port}`, has no field `{key}`"
        findings.error("RV-0415", form.entry_at("with", key), message, hint=hint)
    return values if findings.count() == before and len(values) == len(type_.fields) else None


def _whole(
    text: int | bool | str,
    place: Place,
    port: str,
    type_: RecordType,
    words: Vocabulary,
    findings: Findings,
) -> Iterable[tuple[str | None, Expression]] | None:
    """A record sent as it was read from data or a port of the same type."""
    checked = read(text, place, words, findings)
    if checked is None:
        return None
    source = checked.expression
    if checked.type is not type_ or not isinstance(source, Name):
        fields = ", ".join(f"{one.name}: ..." for one in type_.fields[:4])
        message = f"`{port}` carries {type_.name}: give its fields, or a name of that type"
        findings.error("RV-0415", place.origin, message, hint=f"`with: {{{fields}}}`")
        return None
    return [(one.name, Name(source.kind, source.name, one.name, one.type)) for one in type_.fields]


# --- What flows do ---------------------------------------------------------------


@dataclass(slots=True)
class Use:
    """What flows and conditions read, write, send and raise; keys in order of first use."""

    reads: dict[str, None] = field(default_factory=dict)
    writes: dict[str, Origin] = field(default_factory=dict)
    sends: dict[str, Origin] = field(default_factory=dict)
    raises: dict[str, Origin] = field(default_factory=dict)

    def expression(self, expression: Expression | None) -> None:
        """Add what an expression reads."""
        match expression:
            case Name(name=name) | PortTest(port=name) | InState(region=name):
                self.reads.setdefault(name)
            case Operation(operands=operands):
                for operand in operands:
                    self.expression(operand)

    def flow(self, flow: Flow) -> None:
        """Add what a flow does."""
        for action in actions_of(flow):
            match action:
                case Set(origin, data, _, value):
                    self.expression(value)
                    self.writes.setdefault(data, origin)
                case Send(origin, port, values):
                    for _, value in values:
                        self.expression(value)
                    self.sends.setdefault(port, origin)
                case Raise(origin, event):
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
