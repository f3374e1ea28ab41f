# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions, flows and triggers as text, in the model's own syntax.

The text of `shown_expression` reads back as the same expression. Actions are written as YAML in
one line, without the quotes that a comma or a colon would need there.
"""

from __future__ import annotations

from collections.abc import Iterable

from ravenchart.gen.language.quantities import shown
from ravenchart.gen.language.terms import (
    Action,
    Expression,
    Flow,
    If,
    InState,
    Literal,
    Name,
    Operation,
    PortTest,
    Raise,
    Reading,
    Send,
    Set,
)
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    OnEvent,
    Segment,
    Trigger,
    When,
)

_CHOICE, _OR, _AND, _NOT, _COMPARISON, _SUM, _TERM, _SIGNED, _ATOM = range(9)
_BINARY = {
    "or": _OR,
    "and": _AND,
    **dict.fromkeys(("=", "/=", "<", "<=", ">", ">="), _COMPARISON),
    **dict.fromkeys("+-", _SUM),
    **dict.fromkeys("*/", _TERM),
}
"""How tightly each operator binds, loosest first."""


def shown_expression(item: Expression) -> str:
    """The expression, with no more parentheses than it needs."""
    return _bound(item)[1]


def _bound(item: Expression) -> tuple[int, str]:
    """How tightly the text of an expression binds, and the text."""
    match item:
        case Literal(int() as number):
            return (_SIGNED if number < 0 else _ATOM), str(number)
        case Literal(value):
            return _ATOM, value.lower() if value in ("True", "False") else str(value)
        case Name(kind, name, field):
            base = "event" if kind is Reading.EVENT else name
            text = f"{base}.{field}" if field else base
            is_function = kind in (Reading.OLD, Reading.SENT)
            return _ATOM, f"{kind.value}({text})" if is_function else text
        case PortTest(port, state):
            return _ATOM, f"{state}({port})"
        case InState(region, state):
            return _ATOM, f"in({region}.{state})"
        case Operation(operator, operands):
            return _operation(operator, operands)


def _operation(operator: str, operands: tuple[Expression, ...]) -> tuple[int, str]:
    if operator == "if":
        condition, then, otherwise = (_at_least(_CHOICE, o) for o in operands)
        return _CHOICE, f"if {condition} then {then} else {otherwise}"
    if operator == "not":
        return _NOT, f"not {_at_least(_NOT, operands[0])}"
    if operator == "neg":
        return _SIGNED, f"-{_at_least(_SIGNED, operands[0])}"
    if operator in _BINARY:
        binding = _BINARY[operator]
        first = binding + 1 if binding == _COMPARISON else binding
        left, *right = operands
        words = (_at_least(first, left), *(_at_least(binding + 1, o) for o in right))
        return binding, f" {operator} ".join(words)
    return _ATOM, f"{operator}({', '.join(map(shown_expression, operands))})"


def _at_least(binding: int, item: Expression) -> str:
    """The text as an operand of an operator that binds as tightly as that."""
    own, text = _bound(item)
    return text if own >= binding else f"({text})"


def action(item: Action) -> str:
    """One action, such as ``send: order, with: {kind: Home, target: 0}``."""
    match item:
        case Set(_, data, field, value):
            target = f"{data}.{field}" if field else data
            return f"set: {target}, to: {shown_expression(value)}"
        case Send(_, port, values):
            return f"send: {port}{_with(values)}"
        case Raise(_, event, values):
            return f"raise: {event}{_with(values)}"
        case If(_, condition, then, otherwise):
            text = f"if: {shown_expression(condition)}, then: {_list(then)}"
            return f"{text}, else: {_list(otherwise)}" if otherwise else text


def _with(values: Iterable[tuple[str | None, Expression]]) -> str:
    parts = [(field, shown_expression(value)) for field, value in values]
    if not parts:
        return ""
    if parts[0][0] is None:
        return f", with: {parts[0][1]}"
    return f", with: {{{', '.join(f'{field}: {text}' for field, text in parts)}}}"


def _list(flow: Flow) -> str:
    return f"[{', '.join(f'{{{text}}}' for text in actions(flow))}]"


def actions(flow: Flow) -> tuple[str, ...]:
    """The actions of a flow, one text each."""
    return tuple(action(item) for item in flow)


def trigger(item: Trigger) -> str:
    """The trigger of a transition; nothing for a completion or a segment."""
    match item:
        case OnEvent(event):
            return event
        case After(delay):
            return f"after {shown(delay)}"
        case Every(delay):
            return f"every {shown(delay)}"
        case When(condition):
            return f"when {shown_expression(condition)}"
        case Completion() | Segment():
            return ""
