# SPDX-FileCopyrightText: Ravenchart contributors
# SPDX-License-Identifier: Apache-2.0

"""Expressions and actions as text: what is printed reads back as the same."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravenchart.gen.language.expressions import Term, parse
from ravenchart.gen.language.terms import (
    BOOLEAN,
    Action,
    Expression,
    If,
    InState,
    IntegerType,
    Literal,
    Name,
    Ns,
    Operation,
    PortTest,
    Raise,
    Reading,
    Send,
    Set,
)
from ravenchart.gen.model.notation import action, shown_expression, trigger
from ravenchart.gen.model.statechart import (
    After,
    Completion,
    Every,
    OnEvent,
    Segment,
    Trigger,
    When,
)
from ravenchart.gen.origins import Origin

HERE = Origin("m.yaml", 1, 1)
COUNT = IntegerType("Count", HERE, 0, 9)
LEVEL = Name(Reading.DATA, "level", None, COUNT)
ARITIES = {
    "not": 1, "neg": 1, "abs": 1, "min": 2, "max": 2, "clamp": 3, "if": 3,
    **dict.fromkeys(("and", "or", "=", "/=", "<", "<=", ">", ">=", "+", "-", "*", "/"), 2),
}  # fmt: skip

leaves: st.SearchStrategy[Expression] = st.one_of(
    st.integers(-3, 1000).map(lambda value: Literal(value, None)),
    st.sampled_from(
        (
            Literal("True", BOOLEAN),
            LEVEL,
            Name(Reading.PORT, "order", "kind", COUNT),
            Name(Reading.EVENT, "Go", None, COUNT),
            Name(Reading.EVENT, "Go", "speed", COUNT),
            PortTest("order", "never_received"),
            InState("Motion", "Idle"),
        )
    ),
)


def _operations(inner: st.SearchStrategy[Expression]) -> st.SearchStrategy[Expression]:
    def applied(operator: str) -> st.SearchStrategy[Expression]:
        count = ARITIES[operator]
        operands = st.lists(inner, min_size=count, max_size=count)
        return operands.map(lambda items: Operation(operator, tuple(items), None))

    return st.sampled_from(sorted(ARITIES)).flatmap(applied)


def _of_expression(item: Expression) -> object:
    match item:
        case Literal(int() as value):
            return ("neg", -value) if value < 0 else value
        case Literal(value):
            return str(value).lower()
        case Name(kind, name, field):
            base = "event" if kind is Reading.EVENT else name
            return (base, field) if field else base
        case PortTest(port, state):
            return (state, port)
        case InState(region, state):
            return ("in", region, state)
        case Operation(operator, operands):
            return (operator, *map(_of_expression, operands))


def _of_term(term: Term) -> object:
    operands = tuple(map(_of_term, term.operands))
    match term.kind:
        case "number":
            return int(term.word)
        case "name":
            return term.word
        case "member":
            return (term.word, term.member)
        case "inside":
            return ("in", term.word, term.member)
        case "operator" if term.word == "-" and len(operands) == 1:
            return ("neg", *operands)
        case _:
            return (term.word, *operands)


@given(st.recursive(leaves, _operations, max_leaves=12))
def test_what_is_printed_parses_as_the_same(item: Expression) -> None:
    term = parse(shown_expression(item))
    assert isinstance(term, Term), shown_expression(item)
    assert _of_term(term) == _of_expression(item)


def test_no_more_parentheses_than_needed() -> None:
    total = Operation("+", (LEVEL, Operation("*", (LEVEL, Literal(2, None)), None)), None)
    small = Operation("<", (total, Literal(-1, None)), BOOLEAN)
    fresh = PortTest("order", "fresh")
    both = Operation("and", (small, Operation("not", (fresh,), BOOLEAN)), BOOLEAN)
    assert shown_expression(both) == "level + level * 2 < -1 and not fresh(order)"


@pytest.mark.parametrize(
    ("item", "text"),
    [
        (Set(HERE, "goal", "target", LEVEL), "set: goal.target, to: level"),
        (Send(HERE, "out", ((None, LEVEL),)), "send: out, with: level"),
        (
            Send(HERE, "out", (("kind", Literal("Home", BOOLEAN)), ("to", LEVEL))),
            "send: out, with: {kind: Home, to: level}",
        ),
        (Raise(HERE, "Go"), "raise: Go"),
        (Raise(HERE, "Go", ((None, LEVEL),)), "raise: Go, with: level"),
        (
            If(HERE, PortTest("order", "stale"), (Raise(HERE, "Go"),), ()),
            "if: stale(order), then: [{raise: Go}]",
        ),
        (
            If(HERE, InState("R", "S"), (), (Set(HERE, "level", None, Literal(3, None)),)),
            "if: in(R.S), then: [], else: [{set: level, to: 3}]",
        ),
    ],
)
def test_actions_are_written_as_in_a_model(item: Action, text: str) -> None:
    assert action(item) == text


@pytest.mark.parametrize(
    ("item", "text"),
    [
        (OnEvent("Go"), "Go"),
        (After(Ns(50_000_000), 5), "after 50 ms"),
        (Every(Ns(1_500_000), 1), "every 1500 us"),
        (When(PortTest("order", "fresh")), "when fresh(order)"),
        (Completion(), ""),
        (Segment(), ""),
    ],
)
def test_triggers_are_written_as_uml_does(item: Trigger, text: str) -> None:
    assert trigger(item) == text
